"""The expected values of docs/problems/*.toml, found without the product, written to tests/cases/*.expected.json.

Usage: python3 tests/oracles/expected_values.py [NAME ...]     (Python 3.11, sympy, mpmath; all files unless named)

Lagrange's equations come from computer algebra (lagrange_equations.py). The acceleration is the one of the
enumerated active sets that satisfies the optimality conditions (there is only one), in fractions where all data are
rational and with 60 digits otherwise. Vertices and rays of the multipliers are enumerated as well.
"""

import itertools
import json
import pathlib
import sys
import tomllib
from decimal import Decimal
from fractions import Fraction

import mpmath
import sympy

from closed_forms import CLOSED_FORMS
from cone_values import expected_cone
from decomposition_values import expected_decomposition
from lagrange_equations import equations, number
from singular_states import added_rows

ROOT = pathlib.Path(__file__).resolve().parents[2]
mpmath.mp.dps = 60
ZERO = mpmath.mpf(10) ** -40


def is_zero(x):
    """Exactly zero for fractions; below 1e-40 for numbers of 60 digits."""
    return abs(x) < ZERO if isinstance(x, mpmath.mpf) else x == 0


def nonnegative(x):
    """x >= 0, up to `is_zero`."""
    return x >= 0 or is_zero(x)


def dot(a, b):
    """Sum of products."""
    return sum(x * y for x, y in zip(a, b))


def times(rows, vector):
    """Matrix times vector."""
    return [dot(row, vector) for row in rows]


def transposed(rows):
    """The transpose of a nonempty matrix."""
    return [list(column) for column in zip(*rows)]


def eliminate(rows, right):
    """Reduced row echelon form of [rows | right] with its pivot columns (largest pivots)."""
    work = [list(row) + [b] for row, b in zip(rows, right)]
    pivots, columns = [], len(rows[0]) if rows else 0
    for column in range(columns):
        top = len(pivots)
        best = max(range(top, len(work)), key=lambda i: abs(work[i][column]), default=None)
        if best is None or is_zero(work[best][column]):
            continue
        work[top], work[best] = work[best], work[top]
        work[top] = [x / work[top][column] for x in work[top]]
        for i in range(len(work)):
            if i != top and work[i][column] != 0:
                factor = work[i][column]
                work[i] = [x - factor * y for x, y in zip(work[i], work[top])]
        pivots.append(column)
    return work, pivots


def solve(rows, right):
    """One solution of a consistent linear system (free unknowns 0), and its rank; None when inconsistent."""
    work, pivots = eliminate(rows, right)
    if any(not is_zero(row[-1]) for row in work[len(pivots):]):
        return None, len(pivots)
    x = [0 * entry for entry in rows[0]] if rows else []
    for row, column in zip(work, pivots):
        x[column] = row[-1]
    return x, len(pivots)


def null_vector(columns):
    """The one direction w with sum w_i columns_i = 0, when there is exactly one; else None."""
    work, pivots = eliminate(transposed(columns), [0] * len(columns[0]))
    free = [j for j in range(len(columns)) if j not in pivots]
    if len(free) != 1:
        return None
    w = [0 * column[0] for column in columns]
    w[free[0]] += 1
    for row, column in zip(work, pivots):
        w[column] = -row[free[0]]
    return w


class Gauss:
    """min 1/2 q''.A q'' - z.q'' over U q'' >= s (= s where two_sided), by enumeration."""

    def __init__(self, A, z, U, s, two_sided):
        self.A, self.z, self.U, self.s, self.two_sided = A, z, U, s, two_sided
        self.rows = range(len(U))
        inverse_rows = [solve(A, list(u))[0] for u in U]  # A^-1 u_a
        self.M = [[dot(u, x) for x in inverse_rows] for u in U]
        self.inverse_rows, self.free = inverse_rows, solve(A, z)[0]
        self.w = [dot(u, self.free) - b for u, b in zip(U, s)]  # slacks without reactions

    def acceleration(self, multipliers):
        """A^-1 (z + U^T lambda)."""
        return [a + sum(m * x[i] for m, x in zip(multipliers, self.inverse_rows))
                for i, a in enumerate(self.free)]

    def held(self, chosen):
        """Multipliers when exactly the rows `chosen` are held two-sided; None if dependent or inconsistent."""
        part, rank = solve([[self.M[i][j] for j in chosen] for i in chosen], [-self.w[i] for i in chosen])
        if part is None or rank < len(chosen):
            return None
        return [part[chosen.index(i)] if i in chosen else 0 for i in self.rows]

    def slacks(self, multipliers):
        """U q'' - s."""
        return [dot(row, multipliers) + w for row, w in zip(self.M, self.w)]

    def optimum(self):
        """Multipliers of the first independent set that satisfies all conditions, largest sets first, or None."""
        fixed = [i for i in self.rows if self.two_sided[i]]
        loose = [i for i in self.rows if not self.two_sided[i]]
        for size in range(len(loose), -1, -1):
            for subset in itertools.combinations(loose, size):
                found = self.held(sorted(fixed + list(subset)))
                if found is None or not all(nonnegative(found[i]) for i in loose):
                    continue
                slack = self.slacks(found)
                if all(is_zero(x) if self.two_sided[i] else nonnegative(x) for i, x in enumerate(slack)):
                    return found
        return None

    def farkas(self):
        """w >= 0 (free where two-sided) with w.U = 0 and w.s > 0, least weight 1."""
        for size in range(1, len(self.U) + 1):
            for subset in itertools.combinations(self.rows, size):
                w = null_vector([self.U[i] for i in subset])
                if w is None or is_zero(dot(w, [self.s[i] for i in subset])):
                    continue
                sign = 1 if dot(w, [self.s[i] for i in subset]) > 0 else -1
                if all(self.two_sided[i] or nonnegative(sign * x) for i, x in zip(subset, w)):
                    least = min(abs(x) for x in w if not is_zero(x))
                    return {i: sign * x / least for i, x in zip(subset, w) if not is_zero(x)}
        raise ValueError("no witness")


def least_norm(columns, target, signed):
    """The shortest lambda with sum lambda_i columns_i = target and lambda_i >= 0 where `signed`."""
    best = None
    places = range(len(columns))
    loose = [i for i in places if signed[i]]
    for size in range(len(loose) + 1):
        for dropped in itertools.combinations(loose, size):
            kept = [i for i in places if i not in dropped]
            if not kept:
                y = [0] * len(target)
                part = [] if all(map(is_zero, target)) else None
            else:
                B = transposed([columns[i] for i in kept])
                y, _ = solve([[dot(a, b) for b in B] for a in B], target)
                part = None if y is None else times(transposed(B), y)
            if part is None:
                continue
            found = dict(zip(kept, part))
            full = [found.get(i, 0) for i in places]
            if all(nonnegative(full[i]) for i in loose) and (best is None or dot(full, full) < dot(best, best)):
                best = full
                if all(nonnegative(-dot(columns[i], y)) for i in dropped):
                    return best  # lambda = max(0, columns . y): the optimality conditions hold
    return best


def ranges(columns, target, signed):
    """[lo, hi] of every lambda_i over sum lambda_i columns_i = target, lambda_i >= 0 where `signed`."""
    rank = len(eliminate(transposed(columns), target)[1])
    free = [column for column, bounded in zip(columns, signed) if not bounded]
    if free and len(eliminate(free, [0] * len(free))[1]) < len(free):
        raise ValueError("two-sided rows are dependent: lines of multipliers are not enumerated")
    low, high = [None] * len(columns), [None] * len(columns)
    for subset in itertools.combinations(range(len(columns)), rank):
        part, found_rank = solve(transposed([columns[i] for i in subset]), target)
        if part is None or found_rank < rank:
            continue
        if not all(nonnegative(x) for i, x in zip(subset, part) if signed[i]):
            continue
        for i in range(len(columns)):
            x = part[subset.index(i)] if i in subset else 0
            low[i] = x if low[i] is None else min(low[i], x)
            high[i] = x if high[i] is None else max(high[i], x)
    for subset in itertools.combinations(range(len(columns)), rank + 1):
        w = null_vector([columns[i] for i in subset])
        for sign in (1, -1):
            if w is not None and all(nonnegative(sign * x) for i, x in zip(subset, w) if signed[i]):
                for i, x in zip(subset, w):
                    if not is_zero(x):
                        low[i], high[i] = (low[i], "inf") if sign * x > 0 else ("-inf", high[i])
    return [[a, b] for a, b in zip(low, high)]


def two_sided_hypothesis(problem, truth):
    """The classical hypothesis on K: its acceleration and least-norm multipliers, and the two verdicts."""
    squared = [[dot(row, column) for column in problem.M] for row in problem.M]
    y, rank = solve(squared, [-w for w in problem.w])
    multipliers = None if y is None else times(problem.M, y)
    if multipliers is None or not all(map(is_zero, problem.slacks(multipliers))):
        return None, False, None
    acceleration = problem.acceleration(multipliers)
    same = lambda a, b: all(is_zero(x - y) for x, y in zip(a, b))
    accepted = same(acceleration, truth)  # then the true reaction is nonnegative multipliers on K, and conversely
    if accepted or rank < len(problem.U):
        return (acceleration, multipliers), accepted, None
    kept = [i for i in problem.rows if problem.two_sided[i] or nonnegative(multipliers[i])]
    return (acceleration, multipliers), False, same(problem.acceleration(problem.held(kept)), truth)


def text(x):
    """A fraction as it is, any other number with 40 digits."""
    if isinstance(x, str):
        return x
    return str(x) if not isinstance(x, mpmath.mpf) else "0" if is_zero(x) else mpmath.nstr(x, 40)


def named(names, values):
    """{name: text of the value}."""
    return {name: text(value) for name, value in zip(names, values)}


def from_numbers(table):
    """The data of a [projection]: strings are exact, floats are the double nearest to them."""
    exact = lambda x: Fraction(x) if isinstance(x, (str, int)) else Fraction(float(x))
    A = table["A"]
    if isinstance(A, dict):
        A = [[x if i == j else 0 for j in range(len(A["diagonal"]))] for i, x in enumerate(A["diagonal"])]
    U = [list(map(exact, row)) for row in table["U"]]
    names = [f"c[{i}]" for i in range(len(U))]
    return {"coordinates": [f"q[{i}]" for i in range(len(A))], "constraints": names, "contacts": names,
            "two_sided": [i in table.get("two_sided", []) for i in range(len(U))],
            "A": [list(map(exact, row)) for row in A], "z": list(map(exact, table["z"])), "U": U,
            "s": list(map(exact, table["s"]))}


def vanishing(given):
    """The two-sided contacts whose gradient is 0 at the state; those of the library depend on others in no other way."""
    return [i for i, u in enumerate(given["U"]) if given["two_sided"][i] and all(map(is_zero, u))]


def expected_singular(name, given, zero_rows):
    """The expected object where gradients vanish: their rows give way to those of third derivatives."""
    q, K = given["coordinates"], given["contacts"]
    if any(not is_zero(given["s"][i]) for i in zero_rows):
        raise ValueError("second derivatives contradict each other")
    added = added_rows(given, [{K[i]: 1} for i in zero_rows], number)
    kept = [i for i in range(len(K)) if i not in zero_rows]
    problem = Gauss(given["A"], given["z"], [given["U"][i] for i in kept] + [row for _, row, _ in added],
                    [given["s"][i] for i in kept] + [rhs for _, _, rhs in added],
                    [given["two_sided"][i] for i in kept] + [True] * len(added))
    found = problem.optimum()
    acceleration = problem.acceleration(found)
    reaction = [sum(m * u[i] for m, u in zip(found, problem.U)) for i in range(len(q))]
    multipliers = dict(zip([K[i] for i in kept], found))
    result = {
        "status": "solved", "contacts": K, "active": K,
        "acceleration": named(q, acceleration),
        "multipliers": {a: None if K.index(a) in zero_rows else text(multipliers[a]) for a in K},
        "reaction": named(q, reaction),
        "gauss": text(dot(acceleration, times(problem.A, acceleration)) / 2 - dot(problem.z, acceleration)),
        "added_rows": [{"weights": {a: text(w) for a, w in weights.items()}, "row": named(q, row), "rhs": text(rhs),
                        "multiplier": text(multiplier)}
                       for (weights, row, rhs), multiplier in zip(added, found[len(kept):])],
        "derive": {"A": [list(map(text, row)) for row in given["A"]], "z": named(q, given["z"]),
                   "U": {a: named(q, u) for a, u in zip(K, given["U"])}, "s": named(K, given["s"])},
        "source": "Lagrange's equations and third derivatives by computer algebra, rows held in exact fractions; "
                  "agrees with the closed form.",
    }
    check_closed_forms(name, given, result)
    return result


def expected(name, data):
    """The expected object of one problem."""
    given = equations(data) if "system" in data else from_numbers(data["projection"])
    if zero_rows := vanishing(given):
        return expected_singular(name, given, zero_rows)
    numbers = given["A"] + given["U"] + [given["z"], given["s"]]
    exact = all(isinstance(x, Fraction) for row in numbers for x in row)
    alike = (lambda x: x) if exact else (lambda x: mpmath.mpf(x.numerator) / x.denominator
                                         if isinstance(x, Fraction) else x)
    A, U = ([list(map(alike, row)) for row in given[key]] for key in ("A", "U"))
    problem = Gauss(A, list(map(alike, given["z"])), U, list(map(alike, given["s"])), given["two_sided"])
    q, K = given["coordinates"], given["contacts"]
    found = problem.optimum()
    result = {"status": "infeasible" if found is None else "solved"}
    if found is None:
        witness = problem.farkas()
        result["farkas"] = {K[i]: text(x) for i, x in witness.items()}
    else:
        result |= solution(given, problem, found)
    result["contacts"] = K
    if "system" in data:
        result["derive"] = {"A": [list(map(text, row)) for row in given["A"]], "z": named(q, given["z"]),
                            "U": {a: named(q, u) for a, u in zip(K, given["U"])}, "s": named(K, given["s"])}
    result["source"] = (("Lagrange's equations by computer algebra, " if "system" in data else "")
                        + ("no active set feasible, witness" if found is None else "active set") + " by enumeration in "
                        + ("exact fractions" if exact else "60-digit arithmetic")
                        + ("; agrees with the closed form." if name in CLOSED_FORMS else "."))
    check_closed_forms(name, given, result)
    return result


def solution(given, problem, found):
    """The part of the expected object that exists when there is a solution."""
    q, K = given["coordinates"], given["contacts"]
    acceleration, slack = problem.acceleration(found), problem.slacks(found)
    active = [i for i in problem.rows if is_zero(slack[i])]
    columns, signed = [problem.U[i] for i in active], [not problem.two_sided[i] for i in active]
    reaction = [sum(m * u[i] for m, u in zip(found, problem.U)) for i in range(len(q))]
    spans = {i: [0] * 2 for i in problem.rows} | {i: [found[i]] * 2 for i in active}
    if active and len(eliminate(columns, [0] * len(columns))[1]) < len(active):
        spans |= dict(zip(active, ranges(columns, reaction, signed)))
        shortest = dict(zip(active, least_norm(columns, reaction, signed)))
        found = [shortest.get(i, 0) for i in problem.rows]
    unique = all(lo == hi or not isinstance(hi, str) and not isinstance(lo, str) and is_zero(hi - lo)
                 for lo, hi in spans.values())
    classical, accepted, rule = two_sided_hypothesis(problem, acceleration)
    multipliers = dict(zip(K, found))
    everywhere = {a: text(multipliers.get(a, 0)) for a in given["constraints"]}
    bounds = dict(zip(K, spans.values()))
    return {
        "active": [K[i] for i in active],
        "acceleration": named(q, acceleration),
        "multipliers": everywhere,
        "multipliers_unique": unique,
        "multiplier_ranges": {a: [text(x) for x in bounds.get(a, [0] * 2)] for a in given["constraints"]},
        "reaction": named(q, reaction),
        "gauss": text(dot(acceleration, times(problem.A, acceleration)) / 2 - dot(problem.z, acceleration)),
        "two_sided": {"consistent": classical is not None,
                      "acceleration": named(q, classical[0]) if classical else {},
                      "multipliers": named(K, classical[1]) if classical else {}},
        "hypothesis": {"accepted": accepted, "drop_negative_is_right": rule},
    }


def check_closed_forms(name, given, result):
    """Compares the values with the closed forms of `closed_forms.py`, to 30 digits."""
    for (where, what), formula in CLOSED_FORMS.get(name, {}).items():
        value = given["scene"].read(formula).xreplace(given["state"])
        place = result
        for key in where.split("."):
            place = place[key]
        number = sympy.Rational(place[what]) if "/" in place[what] else sympy.Float(place[what], 45)
        if abs(sympy.N(value - number, 45)) > Decimal("1e-30") * max(1, abs(sympy.N(value))):
            raise ValueError(f"{name}: {where} {what} is {place[what]}, its closed form gives {sympy.N(value, 40)}")
        result.setdefault("closed_form", {}).setdefault(where, {})[what] = formula


def main():
    """Regenerates the files named on the command line, or all."""
    for path in sorted((ROOT / "docs" / "problems").glob("*.toml")):
        if sys.argv[1:] and path.stem not in sys.argv[1:]:
            continue
        if path.stem.startswith("motion_"):  # expected_motions.py
            continue
        data = tomllib.loads(path.read_text(), parse_float=Decimal)
        target = ROOT / "tests" / "cases" / f"{path.stem}.expected.json"
        if "cone" in data:
            values = expected_cone(data["cone"])
        elif "decomposition" in data:
            values = expected_decomposition(path.stem, data["decomposition"])
        else:
            values = expected(path.stem, data)
        target.write_text(json.dumps(values, indent=1) + "\n")
        print(target.relative_to(ROOT))


if __name__ == "__main__":
    main()
