"""Looking into formation diagrams; shared by the tests."""

import numpy as np


def context_at(diagram, state):
    """A Context of a formation diagram with the robots in a state of shape (N, 4)."""
    context = diagram.CreateDefaultContext()
    context.SetContinuousState(np.ravel(state))
    return context


def robot_outputs(diagram, context, name):
    """An output port of every robot, shape (N, size)."""
    count = context.num_continuous_states() // 4
    return np.array([diagram.GetOutputPort(f"robot_{i + 1}_{name}").Eval(context) for i in range(count)])


def state_of(context):
    """State of every robot, shape (N, 4)."""
    return context.get_continuous_state_vector().CopyToVector().reshape(-1, 4)


def derivatives(diagram, context):
    """Time derivatives of the state of all robots, of any scalar type, flat."""
    return diagram.EvalTimeDerivatives(context).CopyToVector()


def parameters(context):
    """All numeric parameters of a Context, one after the other."""
    groups = [context.get_numeric_parameter(k).CopyToVector() for k in range(context.num_numeric_parameter_groups())]
    return np.concatenate([np.zeros(0), *groups])
