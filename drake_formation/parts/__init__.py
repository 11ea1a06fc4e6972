"""The boxes of the diagram, one file each: robots, objects, laws of springs, controllers, references, channels.

A part is a class with its configuration, its law, its block and its numbers, named by its role and kind::

    @part("tracking", kind="pd")
    class Pd(Part):
        class Config(Section):
            kp: Positive = Field(description="stiffness (N/m)")
            ...

A scenario chooses it by ``kind``, and nothing else need know of it. A package announces its parts by entry points of
the group ``drake_formation.parts``; a notebook calls ``register``.
"""

from drake_formation.parts.part import Numbers, Part, SpringLaw
from drake_formation.parts.registry import PartError, find, kinds, part, register
from drake_formation.parts.roles import ROLES, Port, Role

__all__ = [
    "ROLES",
    "Numbers",
    "Part",
    "PartError",
    "Port",
    "Role",
    "SpringLaw",
    "find",
    "kinds",
    "part",
    "register",
]
