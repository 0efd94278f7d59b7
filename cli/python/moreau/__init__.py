"""Convex analysis and the mechanics of one-sided constraints, after J. J. Moreau (1966). See docs/python.md.

    solve(A=..., z=..., U=..., s=...)    the nearest-point problem from numbers, one or many
    solve("scene.toml"), solve({...})    a problem file, or a dict of the same form
    prox(f, z, W), decompose(f, z, W)    the proximal map of f in a metric; the split z = x + y
    norm1(), box(0, 1), ...              sets, functions and operations, to be composed with + * @
    user_function(value, prox)           a function of your own, put through the laws
    decompose(..., certify=True)         the same with a proof; exact_decomposition in fractions
    symbolic(f)                          f of one variable, its prox and conjugate by cases
    prox_derivative, prox_jacobian       one-sided derivatives of a prox, in fractions; generalised Jacobians
    subdifferential(f, x), laws(T)       all subgradients, as a set; is a map the prox of some function?
    atlas("scene.toml")                  the forces for which one set of contacts persists, with probabilities
    Motion("scene.toml")                 the motion with impacts and rests
"""

from . import catalogue
from ._moreau import Check, Decomposition, Formula, Function, InvalidInput, LawReport, Metric, Set, Solution, Subdifferential
from ._moreau import __version__, methods
from .catalogue import *  # noqa: F403  (every set, function and operation)
from .contact_atlas import Atlas, Cell, atlas
from .functions import ExactDecomposition, Inaccurate, MapReport, Symbols, conjugate, decompose, exact_decomposition, function
from .functions import laws, prox, prox_derivative, prox_jacobian, subdifferential, symbolic, user_function
from .motion import Event, Motion, Trajectory
from .problems import Result, Solutions, SceneWarning, solve
from . import messages, pictures

messages.attach()
pictures.attach()

__all__ = [
    *(name for name in catalogue.__all__ if name not in catalogue.builtin_names),
    *["Atlas", "Cell", "Check", "Decomposition", "Event", "ExactDecomposition", "Formula", "Function", "Inaccurate"],
    *["InvalidInput", "LawReport", "MapReport", "Metric", "Motion", "Result", "SceneWarning", "Set", "Solution", "Solutions"],
    *["Subdifferential", "Symbols", "Trajectory", "atlas", "conjugate", "decompose", "exact_decomposition", "function", "laws"],
    *["methods", "prox", "prox_derivative", "prox_jacobian", "solve", "subdifferential", "symbolic", "user_function"],
]
