"""What the systems of a formation are called in its diagram, and so the streams of random numbers of their parts."""


def robot_name(robot: int) -> str:
    """Name of a robot's system; robots are numbered from 1 in names and from 0 in arrays."""
    return f"robot_{robot + 1}"


def channel_name(listener: int, speaker: int) -> str:
    """Name of the system of a channel between two robots, from 0."""
    return f"channel_{speaker + 1}_to_{listener + 1}"


def heeding_name(listener: int, speaker: int) -> str:
    """Name of the system by which a robot drops another or follows its slot, from 0."""
    return f"robot_{listener + 1}_heeds_{speaker + 1}"
