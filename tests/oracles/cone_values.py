"""Polyhedral cones by trying every choice, in fractions: for the expected values of [cone] files.

Facets are the planes through dim - 1 of the vectors with all vectors on one side; the nearest point is the
only projection on the span of some generators that satisfies Moreau's characterisation.
"""
from fractions import Fraction
from itertools import combinations
from math import gcd, lcm


def dot(a, b):
    return sum(x * y for x, y in zip(a, b))


def echelon(rows, n):
    """The reduced row echelon form, with its pivot columns."""
    rows, pivots = [list(map(Fraction, row)) for row in rows], []
    for column in range(n):
        k = len(pivots)
        found = next((i for i in range(k, len(rows)) if rows[i][column]), None)
        if found is None:
            continue
        rows[k], rows[found] = rows[found], rows[k]
        rows[k] = [x / rows[k][column] for x in rows[k]]
        for i in range(len(rows)):
            if i != k and rows[i][column]:
                rows[i] = [x - rows[i][column] * p for x, p in zip(rows[i], rows[k])]
        pivots.append(column)
    return rows[:len(pivots)], pivots


def rank(rows, n):
    return len(echelon(rows, n)[1])


def kernel(rows, n):
    """A basis of the vectors at right angles to the rows."""
    reduced, pivots = echelon(rows, n)
    basis = []
    for free in (c for c in range(n) if c not in pivots):
        v = [Fraction(0)] * n
        v[free] = Fraction(1)
        for row, pivot in zip(reduced, pivots):
            v[pivot] = -row[free]
        basis.append(v)
    return basis


def primitive(v):
    scale = lcm(*(Fraction(x).denominator for x in v))
    whole = [int(x * scale) for x in v]
    return tuple(x // (gcd(*whole) or 1) for x in whole)


def solve(A, b):
    """The solution of a regular system."""
    n = len(b)
    return [row[n] for row in echelon([list(r) + [x] for r, x in zip(A, b)], n)[0]]


def described(vectors, lines, n):
    """generators, lines, halfspaces, equations of the cone that the vectors and lines span."""
    both = vectors + lines + [[-x for x in line] for line in lines]
    equations = kernel(both, n)
    dimension = n - len(equations)
    facets = set()
    for chosen in combinations(both, max(dimension - 1, 0)):
        normals = kernel(list(chosen) + equations, n)
        if len(normals) != 1:
            continue
        for sign in (1, -1):
            a = [sign * x for x in normals[0]]
            if all(dot(a, v) <= 0 for v in both) and any(dot(a, v) for v in both):
                facets.add(primitive(a))
    facets = sorted(facets)
    lineality = kernel(facets + equations, n)
    generators = []
    for v in vectors:
        tight = [a for a in facets if dot(a, v) == 0]
        extreme = n - rank(tight + equations, n) == len(lineality) + 1
        same = any(rank(lineality + [v, g], n) == len(lineality) + 1 and
                   all((dot(a, v) < 0) == (dot(a, g) < 0) for a in facets) for g in generators)
        if extreme and rank(lineality + [v], n) > len(lineality) and not same:
            generators.append(v)
    return generators, lineality, facets, equations


def nearest(generators, lines, W, z, n):
    times = lambda v: [dot(row, v) for row in W]
    for size in range(n + 1):
        for chosen in combinations(generators, size):
            span = lines + list(chosen)
            if rank(span, n) < len(span):
                continue
            weights = solve([[dot(u, times(v)) for v in span] for u in span], [dot(u, times(z)) for u in span])
            x = [sum((w * v[i] for w, v in zip(weights, span)), Fraction(0)) for i in range(n)]
            rest = times([a - b for a, b in zip(z, x)])
            if all(w >= 0 for w in weights[len(lines):]) and all(dot(g, rest) <= 0 for g in generators):
                return x
    raise ValueError("no projection found")


def expected_cone(table):
    """The expected values of a [cone] table."""
    exact = lambda rows: [[Fraction(x) for x in row] for row in rows]
    by_halfspaces = "halfspaces" in table or "equations" in table
    rows = exact(table.get("halfspaces" if by_halfspaces else "generators", []))
    two_way = exact(table.get("equations" if by_halfspaces else "lines", []))
    n = len((rows + two_way + [table["z"]])[0])
    metric = table.get("metric", {"diagonal": [1] * n})
    W = exact(metric) if isinstance(metric, list) else [
        [Fraction(d) if i == j else Fraction(0) for j in range(n)] for i, d in enumerate(metric["diagonal"])]
    generators, lines, halfspaces, equations = described(rows, two_way, n)
    if by_halfspaces:
        generators, lines, halfspaces, equations = halfspaces, equations, generators, lines
    inverse = lambda v: solve(W, v)
    times = lambda v: [dot(row, v) for row in W]
    polar = [[inverse(a) for a in halfspaces], [inverse(e) for e in equations],
             [times(g) for g in generators], [times(b) for b in lines]]
    names = ["generators", "lines", "halfspaces", "equations"]
    text = lambda vectors: [[str(x) for x in primitive(v)] for v in vectors]
    result = {"kind": "cone", "status": "solved"}
    result.update(zip(names, map(text, [generators, lines, halfspaces, equations])))
    result.update({"dimension": n - len(equations), "pointed": not lines, "polar": dict(zip(names, map(text, polar)))})
    z = [Fraction(v) for v in table["z"]]
    result["x"] = [str(v) for v in nearest(generators, lines, W, z, n)]
    result["y"] = [str(v) for v in nearest(polar[0], polar[1], W, z, n)]
    return result
