"""Convex analysis and the mechanics of one-sided constraints, after J. J. Moreau (1966). See docs/python.md.

    solve(A=..., z=..., U=..., s=...)    the nearest-point problem from numbers, one or many
    solve("scene.toml"), solve({...})    a problem file, or a dict of the same form
    prox(f, z, W), decompose(f, z, W)    the proximal map of f in a metric; the split z = x + y
    norm1(), box(0, 1), ...              sets, functions and operations, to be composed with + * @
    user_function(value, prox)           a function of your own, put through the laws
    Motion("scene.toml")                 the motion with impacts and rests
"""

from . import catalogue
from ._moreau import Check, Decomposition, Function, InvalidInput, LawReport, Metric, Set, Solution, __version__
from ._moreau import decompose, laws, methods
from .catalogue import *  # noqa: F403  (every set, function and operation)
from .functions import Inaccurate, conjugate, function, prox, user_function
from .motion import Event, Motion, Trajectory
from .problems import Result, Solutions, SceneWarning, solve
from . import pictures

pictures.attach()

__all__ = [
    *(name for name in catalogue.__all__ if name not in catalogue.builtin_names),
    *["Check", "Decomposition", "Event", "Function", "Inaccurate", "InvalidInput", "LawReport", "Metric", "Motion"],
    *["Result", "SceneWarning", "Set", "Solution", "Solutions", "Trajectory", "conjugate", "decompose", "function"],
    *["laws", "methods", "prox", "solve", "user_function"],
]
