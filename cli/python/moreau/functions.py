"""The proximal map, conjugates, and functions of the user's own."""

from fractions import Fraction
from typing import NamedTuple

import numpy as np

from . import _moreau
from ._moreau import Function, InvalidInput

STATUS = np.array(["solved", "inaccurate", "infeasible", "gave-up"])


class Inaccurate(ArithmeticError):
    """A prox that is not known to the accuracy that it aims at.

    x: what was found; error_bound: of it, in the metric; status: 'inaccurate', 'infeasible' or 'gave-up'. Of many
    points these are arrays.
    """

    def __init__(self, message, x, status, error_bound):
        super().__init__(message)
        self.x, self.status, self.error_bound = x, status, error_bound


def axes_of(numbers, name):
    """How many axes a list or an array has. Raises InvalidInput where its rows differ in length."""
    try:
        return np.ndim(numbers)
    except ValueError:
        raise InvalidInput(f"{name}: rows of different lengths; give rows of one length") from None


def _require_function(f):
    if not isinstance(f, Function):
        raise InvalidInput(f"f: a {type(f).__name__}; give a Function, such as norm1() or function(\"norm1()\")")


def prox(f, z, W=None):
    """prox_f z = argmin over u of 1/2 ||u - z||_W^2 + f(u) (Moreau 1965).

    z: n numbers, or many points along the first axis (all processors work on them).
    W: a Metric, a symmetric positive definite matrix, its diagonal, or None for the identity. A step is a metric:
    W = I/gamma gives the prox of gamma f.
    Raises InvalidInput when sizes do not fit or f is not convex, closed and proper; Inaccurate, with what was found,
    when the error bound is not met.
    """
    _require_function(f)
    if axes_of(z, "z") == 2:
        x, codes, bounds = _moreau.prox_batch(f, z, W)
        if codes.any():
            first = int(np.flatnonzero(codes)[0])
            message = f"prox of point {first} and {np.count_nonzero(codes) - 1} more: {STATUS[codes[first]]}"
            raise Inaccurate(message, x, STATUS[codes], bounds)
        return x
    x, status, bound, method = _moreau.prox(f, z, W)
    if status != "solved":
        raise Inaccurate(f"prox: {status}, error at most about {bound:.1e} ({method})", x, status, bound)
    return x


def conjugate(f, W=None):
    """g(y) = sup over x of (x|y) - f(x), (x|y) = x.Wy (Fenchel 1949), as an expression by rule where there is one.

    W: the identity unless given. In a metric W, z = prox(f, z, W) + prox(conjugate(f, W), z, W).
    """
    _require_function(f)
    return f.conjugate(W)


def decompose(f, z, W=None, tolerance=1e-9, certify=False):
    """The decomposition of z (Moreau 1965): x = prox_f z, y = prox_g z, g the conjugate in the metric W.

    f: a Function; z: n numbers; W: a Metric, a symmetric positive definite matrix, its diagonal, or None (identity).
    certify: also prove it (docs/proof.md, 10): `proof` is a dict with level 'exact', 'enclosure' or 'none', bounds x
    and y on ||x - x*||_W and ||y - y*||_W, and intervals that hold f(x*), g(y*) and (x*|y*). z may then hold
    fractions.Fraction and texts such as "1/3".
    Raises InvalidInput when sizes do not fit, or f is not convex, closed and proper; with certify, when f is made of a
    function of your own.
    """
    _require_function(f)
    split = _moreau.proved_decomposition if certify else _moreau.decompose
    return split(f, z, W, tolerance)


class ExactDecomposition(NamedTuple):
    """z = x + y in fractions: lists x and y, and f_x = f(x), g_y = g(y), inner = (x|y) = f_x + g_y."""

    x: list[Fraction]
    y: list[Fraction]
    f_x: Fraction
    g_y: Fraction
    inner: Fraction

    def __repr__(self):
        x, y = (", ".join(map(str, part)) for part in (self.x, self.y))
        return f"ExactDecomposition(x=({x}), y=({y}))"


def exact_decomposition(f, z, W=None):
    """The decomposition in fractions, of a piecewise linear-quadratic f: x* from f and y* from its conjugate, each by
    itself; that they add up to z is looked at.

    z: floats at their exact value, integers, fractions.Fraction, or texts such as "1/3".
    Raises InvalidInput where f is not piecewise linear-quadratic.
    """
    _require_function(f)
    x, y, values = _moreau.exact_decomposition(f, z, W)
    return ExactDecomposition(x, y, *values)


def prox_derivative(f, z, d, W=None):
    """The one-sided derivative of z -> prox_f z in the direction d, lim (prox_f(z + t d) - prox_f z)/t for t > 0, of a
    piecewise linear-quadratic f, as fractions (Rockafellar and Wets 1998, exercise 13.24). Multipliers need not be
    unique.

    z, d: floats at their exact value, integers, fractions.Fraction, or texts such as "1/3".
    Raises InvalidInput for another f.
    """
    _require_function(f)
    return _moreau.prox_derivative(f, z, d, W)


def prox_jacobian(f, z, W=None):
    """An element of Clarke's generalised Jacobian of z -> prox_f z (Clarke 1983), n by n, where the prox has a formula;
    W J is symmetric positive semidefinite.

    W: None, or a diagonal where the formula takes one. Raises InvalidInput for another f or W.
    """
    _require_function(f)
    return _moreau.prox_jacobian(f, z, W)


class Symbols:
    """A function of one variable in symbols: formulas f of f(x), prox of prox_f z, conjugate of g(y).

    Each is a Formula: called with a number or an array it gives the values; text, latex, cases. Where there is no rule
    the formula raises InvalidInput.
    """

    def __init__(self, f, W):
        self._f, self._W = f, W

    @property
    def f(self):
        return _moreau.formula(self._f, self._W)

    @property
    def prox(self):
        return _moreau.prox_formula(self._f, self._W)

    @property
    def conjugate(self):
        return _moreau.conjugate_formula(self._f, self._W)

    def __repr__(self):
        return f"{self.f.text}{self.prox.text}"

    def _repr_latex_(self):
        return self.f.latex + self.prox.latex


def symbolic(f, W=None):
    """f of one variable, its prox and its conjugate by cases: pieces of quadratics in fractions, the rest by rules.

    W: one number w > 0, [w]; the product is then w x y. Raises InvalidInput where f takes more than one variable.
    """
    _require_function(f)
    made = Symbols(f, W)
    made.f  # what has no rule is told now
    return made


def subdifferential(f, x, W=None):
    """All subgradients of f at x (Moreau 1963), as a Subdifferential: membership, support function, projection, and the
    polyhedron in fractions where it is one. Of a set: its normal cone, with tangent and critical cones.

    x: floats at their exact value, integers, fractions.Fraction, or texts such as "1/3". No tolerance decides which
    constraints x touches. W: the product that conjugates, envelopes and the like of f take.
    Raises InvalidInput where no rule gives the set (docs/subdifferentials.md).
    """
    _require_function(f)
    return _moreau.subdifferential(f, x, W)


class MapReport:
    """What sampling a map came to. `passed` is not a proof: sampling can only refute.

    counterexample: None, or a dict: law ('nonexpansive' or 'cyclically monotone'), points and images in fractions,
    radii of what the images may be off, and excess, by how much the law fails there. asymmetry: the largest
    |S_ij - S_ji| over the largest |S_ij|, S = W T' by differences, 0 for a prox.
    """

    def __init__(self, counterexample, points, undefined, asymmetry):
        self.counterexample, self.points, self.undefined = counterexample, points, undefined
        self.asymmetry = asymmetry

    @property
    def passed(self):
        return self.counterexample is None

    def __bool__(self):
        return self.passed

    def __repr__(self):
        if self.passed:
            return f"MapReport(not refuted at {self.points} points; that is no proof)"
        found = self.counterexample
        points = "; ".join("(" + ", ".join(map(str, z)) + ")" for z in found["points"])
        return f"MapReport(no prox: not {found['law']} at {points}, by {float(found['excess']):.3g})"


def laws(f, n=3, W=None, box=(-4, 4)):
    """Puts a function, or a map, to Moreau's theorem on n entries.

    A Function, at trial points in trial metrics: z - x is a subgradient at x = prox_f z; the prox is firmly
    nonexpansive; one subgradient serves every metric. Of functions of the language also that z = x + y by two routes,
    f(x) + g(y) = (x|y), and f** = f. Gives a LawReport.

    A map T(z) -> array of n numbers: is it the prox of some function in the metric W (Moreau 1965, corollary 10.c)?
    It is exactly when it is nonexpansive and cyclically monotone; both are tried in the box, every coordinate within
    its bounds. Gives a MapReport, with a counterexample in fractions where there is one.

    What sampling finds refutes; what it does not find proves nothing.
    """
    if isinstance(f, Function):
        return _moreau.laws(f, n)
    if not callable(f):
        raise InvalidInput(f"f: a {type(f).__name__}; give a Function, or a map as a callable")
    low, high = box
    return MapReport(**_moreau.map_laws(f, n, W, _number(low, "box"), _number(high, "box")))


def _number(value, name):
    try:
        return float(value)
    except (TypeError, ValueError):
        raise InvalidInput(f"{name}: a {type(value).__name__}; give a number") from None


def function(text):
    """The function or set that a text of docs/functions.md means: function("norm1(weight=2)")."""
    if not isinstance(text, str):
        raise InvalidInput(f"text: a {type(text).__name__}; give a text such as \"norm1(weight=2)\"")
    return _moreau.parse(text)


def user_function(value, prox, n=0, name="user_function", check=3):
    """A function of your own, by value(x) -> float and prox(z, W) -> array.

    prox gets z as an array and W as a Metric: W.multiply(x) = Wx, W.solve(c) = W^-1 c, W.step where W = I/step (an
    error otherwise), W.gram the matrix.
    n: the number of entries that it takes, 0 for any.
    check: the laws of Moreau's theorem are tried on so many entries (n where that is given), in identity, diagonal
    and general metrics; InvalidInput tells the law that fails, with a counterexample. 0 leaves them out.
    Sums of such functions with others have no prox unless the others are quadratic; conjugates, envelopes,
    translations, multiples and separable sums have one.
    """
    for called, argument in ((value, "value"), (prox, "prox")):
        if not callable(called):
            raise InvalidInput(f"{argument}: a {type(called).__name__}; give a callable")
    made = _moreau.user(value, prox, n, name)
    if check:
        report = _moreau.laws(made, n or check)
        if not report.passed:
            law = next(check for check in report.checks if not check.passed)
            at = f" at {law.counterexample}" if law.counterexample else ""
            raise InvalidInput(f"{name}: it breaks the law \"{law.name}\"{at}; correct it, or give check=0\n{report}")
    return made
