import os
from collections.abc import Callable, Sequence
from fractions import Fraction
from typing import Any, Literal, NamedTuple, overload

import numpy as np
from numpy.typing import ArrayLike, NDArray

from .catalogue import *
from .contact_atlas import Atlas as Atlas, Cell as Cell
from .functions import Inaccurate as Inaccurate, MapReport as MapReport
from .motion import Event as Event, Motion as Motion, Trajectory as Trajectory
from .problems import Result as Result, SceneWarning as SceneWarning, Solutions as Solutions

Vector = NDArray[np.float64]
Status = Literal["solved", "inaccurate", "infeasible", "gave-up"]
__version__: str

class InvalidInput(ValueError):
    line: int | None
    column: int | None
    key: str | None
    others: list[InvalidInput]

class Metric:
    def __init__(self, W: Any) -> None: ...
    @property
    def dimension(self) -> int: ...
    @property
    def gram(self) -> Vector: ...
    @property
    def step(self) -> float: ...
    def multiply(self, x: ArrayLike) -> Vector: ...
    def solve(self, c: ArrayLike) -> Vector: ...
    def inner(self, x: ArrayLike, y: ArrayLike) -> float: ...
    def norm(self, x: ArrayLike) -> float: ...

class Function:
    text: str
    name: str
    is_user: bool
    def __call__(self, x: ArrayLike, W: Any = None) -> float: ...
    def __add__(self, other: Function | float) -> Function: ...
    def __radd__(self, other: float) -> Function: ...
    def __sub__(self, other: float) -> Function: ...
    def __mul__(self, alpha: float) -> Function: ...
    def __rmul__(self, alpha: float) -> Function: ...
    def __truediv__(self, alpha: float) -> Function: ...
    def __matmul__(self, A: ArrayLike) -> Function: ...
    def conjugate(self, W: Any = None) -> Function: ...
    def evaluate(self, x: ArrayLike, W: Any = None) -> tuple[float, float]: ...

class Set(Function):
    def __contains__(self, x: ArrayLike) -> bool: ...
    def __and__(self, other: Set) -> Function: ...

class Subdifferential:
    f: str
    x: list[Fraction]
    is_empty: bool
    is_single: bool
    is_exact: bool
    set: Set | None
    polyhedron: dict[str, list[Any]] | None
    least: Vector
    tangent_cone: dict[str, list[Any]] | None
    def __contains__(self, v: ArrayLike) -> bool: ...
    def support(self, d: ArrayLike) -> float: ...
    def projection(self, u: ArrayLike, V: Any = None) -> Vector: ...
    def critical_cone(self, v: ArrayLike) -> dict[str, list[Any]]: ...

class Solution:
    status: Status
    acceleration: Vector
    multipliers: Vector
    multipliers_unique: bool
    multiplier_ranges: Vector | None
    reaction: Vector
    slack: Vector
    active: list[int]
    gauss: float
    residuals: dict[str, float]
    error_bound: float
    method: str
    steps: int
    farkas: Vector | None
    result: Result

class Decomposition:
    z: Vector
    x: Vector
    y: Vector
    f: str
    f_x: float
    g_y: float
    inner: float
    fenchel_gap: float
    residual: float
    error_bound: float
    status: Status
    route: dict[str, str]
    proof: dict[str, Any] | None

class ExactDecomposition(NamedTuple):
    x: list[Fraction]
    y: list[Fraction]
    f_x: Fraction
    g_y: Fraction
    inner: Fraction

class Formula:
    text: str
    latex: str
    cases: list[dict[str, Any]]
    def __call__(self, at: float) -> float: ...

class Symbols:
    f: Formula
    prox: Formula
    conjugate: Formula

class Check:
    name: str
    value: float
    bound: float
    passed: bool
    counterexample: str

class LawReport:
    checks: list[Check]
    no_evidence: list[str]
    passed: bool
    def __bool__(self) -> bool: ...

@overload
def solve(problem: str | os.PathLike[str] | dict[str, Any], /, *, method: str | None = None,
          tolerance: float | None = None, set: dict[str, Any] | None = None, **options: Any) -> Result: ...
@overload
def solve(*, A: Any = None, z: ArrayLike, U: Any = None, s: ArrayLike | None = None,
          two_sided: Sequence[int] | None = None, method: str | None = None,
          tolerance: float | None = None) -> Solution | Solutions: ...
def prox(f: Function, z: ArrayLike, W: Any = None) -> Vector: ...
def decompose(f: Function, z: Sequence[Any] | ArrayLike, W: Any = None, tolerance: float = 1e-9,
              certify: bool = False) -> Decomposition: ...
def exact_decomposition(f: Function, z: Sequence[Any] | ArrayLike, W: Any = None) -> ExactDecomposition: ...
def prox_derivative(f: Function, z: Sequence[Any] | ArrayLike, d: Sequence[Any] | ArrayLike,
                    W: Any = None) -> list[Fraction]: ...
def prox_jacobian(f: Function, z: ArrayLike, W: Any = None) -> Vector: ...
def symbolic(f: Function, W: Any = None) -> Symbols: ...
def conjugate(f: Function, W: Any = None) -> Function: ...
def function(text: str) -> Function: ...
def user_function(value: Callable[[Vector], float], prox: Callable[[Vector, Metric], ArrayLike], n: int = 0,
                  name: str = "user_function", check: int = 3) -> Function: ...
def subdifferential(f: Function, x: Sequence[Any] | ArrayLike, W: Any = None) -> Subdifferential: ...
@overload
def laws(f: Function, n: int = 3) -> LawReport: ...
@overload
def laws(f: Callable[[Vector], ArrayLike], n: int = 3, W: Any = None,
         box: tuple[float, float] = (-4, 4)) -> MapReport: ...
def atlas(problem: str | os.PathLike[str] | dict[str, Any] | None = None, /, *, A: Any = None,
          z: ArrayLike | None = None, U: Any = None, s: ArrayLike | None = None,
          two_sided: Sequence[int] | None = None, mean: Literal["file"] | ArrayLike | None = None,
          covariance: ArrayLike | None = None, over: dict[str, tuple[float, float]] | None = None,
          tolerance: float = 1e-6, cells: int | None = None, set: dict[str, Any] | None = None) -> Atlas: ...
def methods() -> dict[str, str]: ...
