"""Blocks over all of Drake's scalars."""

import sys
import threading
from collections.abc import Callable
from typing import Any

from pydrake.systems.scalar_conversion import TemplateSystem

CONVERTING = threading.RLock()
"""Held while Drake instantiates a template or converts a system: neither is safe in several threads at once."""


def block_template(name: str, module: str) -> Any:
    """Drake's decorator for a block over double, AutoDiffXd and Expression.

    Told the module, Drake need not search the stack for it, which would take longer than all else of an import.

    Args:
        name: name of the template.
        module: ``__name__`` where it is defined.
    """
    return TemplateSystem.define(name, scope=sys.modules[module])


def in_double(template: Any) -> Callable[..., Any]:
    """The block in double, Drake's default, as a function of its arguments.

    It is instantiated at the first call: while modules are imported, Drake would search a deep stack for it too.

    Args:
        template: the block over all scalars.
    """

    def block(*arguments: Any, **options: Any) -> Any:
        with CONVERTING:
            instance = template[float]
        return instance(*arguments, **options)

    return block
