"""The splits of docs/problems/decomposition_*.toml without the product.

Each function has a solver of its own, by trying every sign, support or case, in fractions where the data allow it and
with 60 digits otherwise; `checked` then proves the answer by the optimality condition that belongs to it: with v = W(z - x)
in the subdifferential of f at x, x is prox_f z and y = z - x is prox_g z.
"""
from fractions import Fraction
from itertools import combinations, product

import mpmath

mpmath.mp.dps = 60


def dot(a, b):
    return sum(x * y for x, y in zip(a, b))


def times(rows, x):
    return [dot(row, x) for row in rows]


def solved(rows, right):
    """The solution of a square system, by elimination."""
    work = [list(row) + [b] for row, b in zip(rows, right)]
    n = len(work)
    for k in range(n):
        pivot = max(range(k, n), key=lambda i: abs(work[i][k]))
        work[k], work[pivot] = work[pivot], work[k]
        for i in range(n):
            if i != k:
                factor = work[i][k] / work[k][k]
                work[i] = [a - factor * b for a, b in zip(work[i], work[k])]
    return [work[k][n] / work[k][k] for k in range(n)]


def sign_patterns_norm1(z, W, weight):
    """argmin ½|x - z|_W² + weight |x|_1: the one pattern of signs with |v_i| <= weight, = weight sign(x_i)."""
    n = len(z)
    for signs in product((-1, 0, 1), repeat=n):
        S = [i for i in range(n) if signs[i]]
        x = [Fraction(0)] * n
        if S:
            right = [dot(W[i], z) - weight * signs[i] for i in S]
            for i, value in zip(S, solved([[W[i][j] for j in S] for i in S], right)):
                x[i] = value
        v = times(W, [a - b for a, b in zip(z, x)])
        if all(x[i] * signs[i] > 0 for i in S) and all(abs(v[i]) <= weight for i in range(n)):
            return x, weight * sum(map(abs, x)), Fraction(0)
    raise ValueError("no pattern of signs")


def jumps_total_variation(z, weight):
    """The same for the sum of |x_{i+1} - x_i| in the identity metric: x is a mean on each run between jumps."""
    n = len(z)
    for signs in product((-1, 0, 1), repeat=n - 1):
        x, first = [None] * n, 0
        for last in range(n):
            if last < n - 1 and signs[last] == 0:
                continue
            left = weight * signs[first - 1] if first else 0
            right = weight * signs[last] if last < n - 1 else 0
            mean = Fraction(sum(z[first:last + 1]) - left + right) / (last + 1 - first)
            x[first:last + 1] = [mean] * (last + 1 - first)
            first = last + 1
        u, right_signs = Fraction(0), True
        for i in range(n - 1):
            u -= z[i] - x[i]
            jump = x[i + 1] - x[i]
            right_signs = right_signs and abs(u) <= weight and jump * signs[i] >= 0 and (signs[i] == 0 or jump != 0)
        if right_signs:
            return x, weight * sum(abs(b - a) for a, b in zip(x, x[1:])), Fraction(0)
    raise ValueError("no pattern of jumps")


def supports_simplex(z, W, total):
    """The nearest point of {x >= 0, sum x = total} in W: the one support with v_i = tau on it and <= tau elsewhere."""
    n = len(z)
    for size in range(1, n + 1):
        for S in combinations(range(n), size):
            rows = [[W[i][j] for j in S] + [Fraction(1)] for i in S] + [[Fraction(1)] * size + [Fraction(0)]]
            found = solved(rows, [dot(W[i], z) for i in S] + [total])
            x = [Fraction(0)] * n
            for i, value in zip(S, found):
                x[i] = value
            v = times(W, [a - b for a, b in zip(z, x)])
            if min(x) >= 0 and max(v) == v[S[0]]:
                return x, Fraction(0), total * max(v)
    raise ValueError("no support")


def boundary_second_order_cone(z, W):
    """The nearest point of {|u| <= t}, neither z nor 0: x = (W + mu J)^-1 W z with x.Jx = 0, J = diag(1, .., 1, -1)."""
    n = len(z)
    W = [[mpmath.mpf(w.numerator) / w.denominator for w in row] for row in W]
    z = [mpmath.mpf(a.numerator) / a.denominator for a in z]
    force = times(W, z)

    def point(mu):
        return solved([[W[i][j] + (mu * (1 if i < n - 1 else -1) if i == j else 0) for j in range(n)]
                       for i in range(n)], force)

    def outside(mu):
        x = point(mu)
        return dot(x[:-1], x[:-1]) - x[-1] ** 2

    # mu stays below the pole, where W + mu J is no longer positive definite.
    low, high = mpmath.mpf(0), mpmath.mpf(1)
    while outside(low + high) > 0:
        high *= mpmath.mpf("1.01")
    for _ in range(250):
        middle = (low + high) / 2
        low, high = (middle, high) if outside(middle) > 0 else (low, middle)
    x = point(low)
    v = [low * a for a in x[:-1]] + [-low * x[-1]]
    if not (x[-1] > 0 and mpmath.norm(v[:-1]) <= -v[-1] * (1 + mpmath.mpf(10) ** -40)):
        raise ValueError("not on the boundary")
    return x, 0, 0


def newton_entropy(z, W):
    """0 = W(x - z) + log x + 1, x > 0, by Newton's method in log x."""
    n = len(z)
    W = [[mpmath.mpf(w.numerator) / w.denominator for w in row] for row in W]
    z = [mpmath.mpf(a.numerator) / a.denominator for a in z]
    p = [mpmath.mpf(0)] * n
    for _ in range(200):
        x = [mpmath.exp(a) for a in p]
        right = [-(a + b + 1) for a, b in zip(times(W, [a - b for a, b in zip(x, z)]), p)]
        step = solved([[W[i][j] * x[j] + (1 if i == j else 0) for j in range(n)] for i in range(n)], right)
        longest = max(map(abs, step))
        p = [a + b * min(1, 1 / longest) for a, b in zip(p, step)]
        if longest < mpmath.mpf(10) ** -55:
            break
    x = [mpmath.exp(a) for a in p]
    v = times(W, [a - b for a, b in zip(z, x)])
    return x, dot(x, map(mpmath.log, x)), sum(mpmath.exp(a - 1) for a in v)


def eigenvalues_psd(z, size):
    """The positive part of a symmetric matrix."""
    M = mpmath.matrix(size, size)
    for i in range(size):
        for j in range(size):
            M[i, j] = mpmath.mpf(z[i + size * j].numerator) / z[i + size * j].denominator
    values, vectors = mpmath.eigsy(M)
    positive = mpmath.diag([max(value, 0) for value in values])
    X = vectors * positive * vectors.T
    return [X[i, j] for j in range(size) for i in range(size)], 0, 0


def distance_to_box(z, lower, upper, distance):
    """The Euclidean distance to a box, known to be a fraction greater than 1: one step of length 1 towards it."""
    p = [min(max(a, l), u) for a, l, u in zip(z, lower, upper)]
    if sum((a - b) ** 2 for a, b in zip(z, p)) != distance ** 2:
        raise ValueError("another distance")
    y = [(a - b) / distance for a, b in zip(z, p)]
    support = sum(max(a * l, a * u) for a, l, u in zip(y, lower, upper))
    return [a - b for a, b in zip(z, y)], distance - 1, support


SOLVERS = {
    "decomposition_sparse_coupled": lambda z, W: sign_patterns_norm1(z, W, Fraction(1)),
    "decomposition_step_in_noise": lambda z, W: jumps_total_variation(z, Fraction(1)),
    "decomposition_portfolio": lambda z, W: supports_simplex(z, W, Fraction(1)),
    "decomposition_friction_cone": boundary_second_order_cone,
    "decomposition_entropy": newton_entropy,
    "decomposition_nearest_semidefinite": lambda z, W: eigenvalues_psd(z, 3),
    "decomposition_distance_to_box":
        lambda z, W: distance_to_box(z, [Fraction(-1)] * 2, [Fraction(1)] * 2, Fraction(13)),
}


def text(x):
    """A fraction as p/q, or 40 digits; what 60 digits cannot tell from 0 is 0."""
    if abs(x) < 1e-40:
        return "0"
    return str(x) if isinstance(x, (int, Fraction)) else mpmath.nstr(x, 40)


def expected_decomposition(name, data):
    """x, y, f(x), g(y) and (x|y) of a [decomposition] table as text."""
    z = [Fraction(str(a)) for a in data["z"]]
    n = len(z)
    W = [[Fraction(str(w)) for w in row] for row in data.get("metric", [])]
    if not W:
        W = [[Fraction(i == j) for j in range(n)] for i in range(n)]
    x, f_x, g_y = SOLVERS[name](z, W)
    if not all(isinstance(a, Fraction) for a in x):
        z = [mpmath.mpf(a.numerator) / a.denominator for a in z]
        W = [[mpmath.mpf(w.numerator) / w.denominator for w in row] for row in W]
    y = [a - b for a, b in zip(z, x)]
    inner = dot(x, times(W, y))
    if abs(f_x + g_y - inner) > 1e-40:
        raise ValueError(f"{name}: x and y are not conjugate: {f_x + g_y - inner}")
    return {"kind": "decomposition", "status": "solved", "x": [text(a) for a in x], "y": [text(a) for a in y],
            "f_x": text(f_x), "g_y": text(g_y), "inner": text(inner)}
