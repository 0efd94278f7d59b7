"""Proved and exact splits, derivatives of proxes, symbols; the oracle is arithmetic in fractions, or the numbers."""

import math
import unittest
from decimal import Decimal, getcontext
from fractions import Fraction

import numpy as np

try:
    import sympy
    from sympy.parsing.sympy_parser import rationalize, standard_transformations
    sympy_fractions = (*standard_transformations, rationalize)
except ImportError:
    sympy = None

import moreau
from moreau import ball2, box, entropy, huber, indicator, norm1, norm2, simplex

getcontext().prec = 50


def entropy_prox(z):
    """x + log x + 1 = z by Newton's method in fifty digits."""
    z = Decimal(z.numerator) / Decimal(z.denominator)
    x = Decimal(1) if z > 1 else (z - 1).exp()
    for _ in range(60):
        x -= (x + x.ln() + 1 - z) / (1 + 1 / x)
    return x


class Proofs(unittest.TestCase):
    def test_the_bound_covers_the_error_in_fifty_digits(self):
        z = [Fraction(1, 2), Fraction(-7, 3), Fraction(9, 4), Fraction(1, 10)]
        split = moreau.decompose(entropy(), z, certify=True)
        self.assertEqual(split.proof["level"], "enclosure")
        exact = [entropy_prox(one) for one in z]
        error = sum((Decimal(float(x)) - true) ** 2 for x, true in zip(split.x, exact)).sqrt()
        self.assertLessEqual(error, Decimal(split.proof["x"]))
        self.assertLess(split.proof["error_bound"], 1e-13)
        low, high = split.proof["f_x"]
        value = sum(x * x.ln() for x in exact)
        self.assertTrue(Decimal(low) <= value <= Decimal(high))

    def test_fractions_satisfy_the_conditions_of_a_prox(self):
        W = [[2, 1, 0], [1, 2, 0], [0, 0, 1]]
        exact = moreau.exact_decomposition(moreau.function("norm1(1/3)"), [3, -1, "1/5"], W)
        z = [Fraction(3), Fraction(-1), Fraction(1, 5)]
        v = [sum(w * (a - b) for w, a, b in zip(row, z, exact.x)) for row in W]
        for x, slope in zip(exact.x, v):
            third = Fraction(1, 3)
            self.assertTrue(slope == third if x > 0 else slope == -third if x < 0 else abs(slope) <= third)
        self.assertEqual([x + y for x, y in zip(exact.x, exact.y)], z)
        self.assertEqual(exact.f_x, sum(map(abs, exact.x)) / 3)
        self.assertEqual(exact.f_x + exact.g_y, exact.inner)

    def test_a_proof_is_of_the_numbers_as_they_are_written(self):
        written = moreau.decompose(indicator(simplex(1)), ["1/3", "1/3", "1/3"], certify=True)
        self.assertEqual(written.proof["level"], "exact")
        self.assertGreater(written.proof["error_bound"], 0)  # thirds are no doubles
        self.assertEqual(moreau.decompose(norm1(), [3, 0.5], certify=True).proof["error_bound"], 0)
        self.assertIsNone(moreau.decompose(norm1(), [3, 0.5]).proof)

    def test_what_has_no_proof_is_refused_or_told(self):
        own = moreau.user_function(lambda x: 0.5 * float(x @ x),
                                   lambda z, W: np.linalg.solve(W.gram + np.eye(len(z)), W.multiply(z)))
        for call in (lambda: moreau.decompose(2 * own, [1.0, 2], certify=True),
                     lambda: moreau.exact_decomposition(own, [1.0]), lambda: moreau.symbolic(own),
                     lambda: moreau.prox_derivative(own, [1], [1])):
            with self.assertRaisesRegex(moreau.InvalidInput, "one of your own"):
                call()
        with self.assertRaisesRegex(moreau.InvalidInput, "piecewise linear-quadratic"):
            moreau.exact_decomposition(entropy(), [1, 2])


class Derivatives(unittest.TestCase):
    def test_the_one_sided_derivative_is_the_difference_quotient_in_fractions(self):
        # A small step stays in one cell: the prox is piecewise affine.
        random = np.random.default_rng(3)
        W = [[3, 1], [1, 2]]
        step = Fraction(1, 10**6)
        for f in (norm1(), huber(2), indicator(box(0, 1)), moreau.max()):
            for z in ([1, 1], [3, -1], [0, 0], [Fraction(1, 2), 2]):
                d = [Fraction(int(k)) for k in random.integers(-3, 4, size=2)]
                there = moreau.exact_decomposition(f, [a + step * b for a, b in zip(z, d)], W).x
                here = moreau.exact_decomposition(f, z, W).x
                self.assertEqual(moreau.prox_derivative(f, z, d, W), [(a - b) / step for a, b in zip(there, here)])

    def test_the_jacobian_maps_directions_to_derivatives_where_there_is_no_corner(self):
        z, step = np.array([0.3, -2.0, 1.7]), 1e-6
        for f in (norm1(), norm2(), ball2(), entropy()):
            J = moreau.prox_jacobian(f, z)
            for i in range(3):
                d = step * np.eye(3)[i]
                np.testing.assert_allclose(J[:, i], (moreau.prox(f, z + d) - moreau.prox(f, z - d)) / (2 * step), atol=1e-8)


class Symbols(unittest.TestCase):
    def test_formulas_have_the_values_of_the_numbers(self):
        for f in (norm1(), huber(2), entropy(), moreau.logistic(), moreau.exponential() + moreau.squared_norm2(),
                  moreau.pointwise_max(moreau.squared_norm2(2), moreau.constant(2)),
                  moreau.pointwise_max(moreau.squared_norm2(2), moreau.linear([1]) + 1)):
            made = moreau.symbolic(f)
            for z in np.linspace(-3.3, 3.1, 17):
                self.assertAlmostEqual(made.prox(z), moreau.prox(f, [z])[0], delta=1e-9)
                x, y = float(made.prox(z)), z - float(made.prox(z))
                self.assertAlmostEqual(made.f(x) + made.conjugate(y), x * y, delta=1e-9)

    @unittest.skipIf(sympy is None, "sympy is not installed")
    def test_the_derivatives_that_sympy_takes_of_the_formulas_satisfy_the_equation_of_the_prox(self):
        names = {"W": sympy.LambertW, "log": sympy.log, "exp": sympy.exp, "sqrt": sympy.sqrt, "abs": sympy.Abs,
                 "sign": sympy.sign}
        read = lambda text: sympy.parse_expr(text.replace("^", "**"), names, transformations=sympy_fractions)
        compared = 0
        for text in ("sum(exponential(), norm1())", "sum(log_barrier(), indicator(box(1/3, 2)))", "entropy()",
                     "sum(entropy(), huber(1/2))", "sum(norm1(2), translate(exponential(), [1]), hinge())",
                     "sum(kullback_leibler(2), translate(norm1(), [1]))", "huber(1/3)"):
            made = moreau.symbolic(moreau.function(text))
            for piece in made.prox.cases:
                p = read(piece["formula"])
                ends = [None if piece[end] is None else float(piece[end]) for end in ("low", "high")]
                at = sum(end for end in ends if end is not None) / max(1, 2 - ends.count(None))
                at += 0 if None not in ends else 1.5 if ends[1] is None else -1.5
                exact = sympy.Rational(Fraction(at).limit_denominator(1000))
                value = sympy.N(p.subs(sympy.Symbol("z"), exact), 50)
                inside = [case for case in made.f.cases if (case["low"] is None or case["low"] < value)
                          and (case["high"] is None or value < case["high"])]
                if len(inside) != 1:  # at a corner: the slope lies between those beside it
                    continue
                slope = sympy.diff(read(inside[0]["formula"]), sympy.Symbol("x")).subs(sympy.Symbol("x"), value)
                self.assertLess(abs(sympy.N(exact - value - slope, 50)), 1e-40, (text, piece["formula"]))
                compared += 1
        self.assertGreater(compared, 12)

    def test_crossings_that_are_roots_are_told_as_roots(self):
        made = moreau.symbolic(moreau.pointwise_max(moreau.squared_norm2(2), moreau.linear([1]) + 1))
        self.assertIn("(1 + sqrt(5))/2", made.f.text)
        self.assertIn(r"\frac{1 + \sqrt{5}}{2}", made.f.latex)
        self.assertEqual(made.f.cases[0]["high"], (1 - math.sqrt(5)) / 2)

    def test_cases_have_bounds_in_fractions(self):
        cases = moreau.symbolic(moreau.function("huber(1/3)")).prox.cases
        self.assertEqual([case["low"] for case in cases], [None, Fraction(-4, 3), Fraction(4, 3)])
        self.assertEqual(cases[1]["formula"], "z/4")
        self.assertEqual(moreau.symbolic(norm1(), [2]).prox(1), 0.5)
        self.assertEqual(moreau.symbolic(norm1(), [2]).prox([-1, 0, 0.25, 1]).tolist(), [-0.5, 0, 0, 0.5])
        with self.assertRaises(moreau.InvalidInput):
            moreau.symbolic(moreau.function("norm1([1, 2])"))


if __name__ == "__main__":
    unittest.main()
