"""The proximal map, conjugates, and functions of the user's own."""

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


def prox(f, z, W=None):
    """prox_f z = argmin over u of 1/2 ||u - z||_W^2 + f(u) (Moreau 1965).

    z: n numbers, or many points along the first axis (all processors work on them).
    W: a Metric, a symmetric positive definite matrix, its diagonal, or None for the identity. A step is a metric:
    W = I/gamma gives the prox of gamma f.
    Raises InvalidInput when sizes do not fit or f is not convex, closed and proper; Inaccurate, with what was found,
    when the error bound is not met.
    """
    if np.ndim(z) == 2:
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
    return f.conjugate(W)


def function(text):
    """The function or set that a text of docs/functions.md means: function("norm1(weight=2)")."""
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
    made = _moreau.user(value, prox, n, name)
    if check:
        report = _moreau.laws(made, n or check)
        if not report.passed:
            raise InvalidInput(f"{name}: it breaks the laws of a prox; correct it, or give check=0\n{report}")
    return made
