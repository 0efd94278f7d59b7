"""Functions from Python; the oracles are formulas in numpy, and scipy's minimiser."""

import inspect
import unittest

import numpy as np
import scipy.optimize

import moreau
from moreau import box, indicator, norm1, prox


def softened(z, t):
    return np.sign(z) * np.maximum(np.abs(z) - t, 0)


class Language(unittest.TestCase):
    def test_everything_in_the_catalogue_is_here_with_its_formula_and_signature(self):
        for name, entry in moreau.catalogue.entries.items():
            made = getattr(moreau, name)
            if name != "conjugate":
                self.assertIn(entry["formula"], made.__doc__)
                self.assertEqual(list(inspect.signature(made).parameters), [p[0] for p in entry["parameters"]])
            for example in entry["examples"]:
                self.assertEqual(repr(moreau.function(repr(moreau.function(example)))), repr(moreau.function(example)))

    def test_calls_say_the_same_as_their_text(self):
        cases = [(norm1(weight=2), "norm1(weight=2)"), (moreau.norm1([1, 2, 3]), "norm1([1,2,3])"),
                 (moreau.quadratic([[2, 0], [0, 1]]), "quadratic([[2,0],[0,1]])"),
                 (moreau.envelope(norm1(), gamma=0.5), "envelope(norm1(), gamma=0.5)"),
                 (2 * norm1() + indicator(box(0, 1)), "sum(scale(norm1(), 2), indicator(box(0, 1)))"),
                 (norm1() + box(0, np.inf) + 1, "sum(norm1(), box(0, inf), constant(1))"),
                 (norm1() / 4, "scale(norm1(), 0.25)"), (sum([norm1(), box(0, 1)]), "sum(norm1(), box(0, 1))"),
                 (norm1() @ [[1, 2], [3, 4]], "precompose(norm1(), [[1,2],[3,4]])")]
        for made, text in cases:
            self.assertEqual(repr(made), repr(moreau.function(text)))

    def test_wrong_calls_are_refused_where_they_stand(self):
        for wrong, message in ((lambda: norm1(wieght=2), "wieght"), (lambda: box(1), "upper is missing"),
                               (lambda: moreau.function("norm1("), "f"), (lambda: -2 * norm1(), "not convex"),
                               (lambda: moreau.function("nrm1()"), "norm1"), (lambda: norm1("a"), "neither"),
                               (lambda: prox(box(1, 0), [1, 2]), "empty"), (lambda: prox(norm1(), [np.inf]), "finite"),
                               (lambda: prox(norm1(), [1, 2], np.eye(3)), "W: 3 rows")):
            with self.subTest(message), self.assertRaisesRegex(moreau.InvalidInput, message):
                wrong()
        with self.assertRaisesRegex(TypeError, "a difference of convex functions"):
            norm1() - norm1()
        with self.assertRaises(TypeError):
            norm1() * norm1()

    def test_data_that_no_number_of_entries_makes_possible_are_refused_when_they_are_given(self):
        for make, message in ((lambda: moreau.quadratic([[1, 0], [0, -1]]), "quadratic.Q.: a diagonal entry is negative"),
                              (lambda: moreau.quadratic([[1, 0], [0]]), "rows of one length"),
                              (lambda: moreau.box(2, 1), "box: lower > upper"),
                              (lambda: moreau.norm1(-1), "norm1.weight.: negative"),
                              (lambda: moreau.polyhedron([[1], [-1]], [-1, -1]), "polyhedron: .inf everywhere"),
                              (lambda: moreau.function("sum(norm1(), ball2(-1))"), "ball2.radius.: negative")):
            with self.subTest(message), self.assertRaisesRegex(moreau.InvalidInput, message):
                make()
        # That there are enough entries shows with them: 0.3 in each of four adds up to 1.
        thin = moreau.indicator(moreau.simplex(1)) + moreau.indicator(moreau.box(0, 0.3))
        np.testing.assert_allclose(moreau.prox(thin, [0, 0, 0, 1]), [7/30, 7/30, 7/30, 0.3])
        np.testing.assert_allclose(moreau.prox(moreau.sum_largest(3), [9, 9, 9, 0]), [8, 8, 8, 0])
        self.assertRaises(moreau.InvalidInput, moreau.prox, thin, [0, 1])

    def test_a_function_times_zero_is_not_called_nonconvex(self):
        with self.assertRaisesRegex(moreau.InvalidInput, r"^a function times 0: .* zero\(\)$"):
            0 * norm1()

    def test_values_and_membership_are_those_of_numpy(self):
        x = np.array([0.5, -2, 3])
        self.assertEqual((2 * norm1() + 1)(x), 2 * np.abs(x).sum() + 1)
        self.assertIn([0.5, 1], box(0, 1))
        self.assertNotIn([0.5, 2], box(0, 1))
        self.assertEqual((box(0, 1) & moreau.halfspace([1, 1], 1))([0.5, 0.6]), np.inf)

    def test_a_value_by_a_program_comes_with_its_error_and_one_not_known_with_a_warning(self):
        a, c, x = 0.1, 0.10000000001, -0.5 / (0.10000000001 - 0.1)
        g = moreau.conjugate(moreau.exponential() + moreau.max_affine([[a], [c]], [0.25, 0.75]))
        for y in (0.1000000000099, 0.10000000000999999):  # the kink is at x, where e^x is 0
            value, error = g.evaluate([y])
            self.assertLess(error, 1e-12)
            self.assertLessEqual(abs(value - ((y - a) * x - 0.25)), error + 1e-15)
            self.assertEqual(g([y]), value)
        steep = moreau.conjugate(moreau.log_barrier() + moreau.max_affine([[a], [0.10000000000000031]], [2.5, 0]))
        with self.assertWarnsRegex(RuntimeWarning, "is not known to 1e-9: its error may be"):
            steep([0.10000000000000035])
        self.assertEqual(norm1().evaluate([1, -2])[0], 3)


class Proxes(unittest.TestCase):
    def test_soft_thresholding_in_identity_diagonal_and_many_points(self):
        z = np.random.default_rng(1).normal(size=(1000, 5)) * 3
        np.testing.assert_allclose(prox(norm1(), z), softened(z, 1), atol=1e-15)
        d = np.array([1.0, 2, 4, 5, 8])
        np.testing.assert_allclose(prox(norm1(), z[0], d), softened(z[0], 1 / d), rtol=1e-15)
        np.testing.assert_allclose(prox(norm1(), z, moreau.Metric(d)), softened(z, 1 / d), rtol=1e-15)

    def test_a_composition_in_a_general_metric_is_the_minimum_that_scipy_finds(self):
        W, z = np.array([[2.0, 1, 0], [1, 3, 1], [0, 1, 2]]), np.array([3.0, -1, 0.5])
        f = 0.5 * norm1() + box(-1, 2)
        x = prox(f, z, W)
        objective = lambda u: 0.5 * (u - z) @ W @ (u - z) + 0.5 * np.abs(u).sum()
        found = scipy.optimize.minimize(objective, np.zeros(3), bounds=[(-1, 2)] * 3, method="Nelder-Mead",
                                        options={"xatol": 1e-10, "fatol": 1e-14, "maxiter": 4000})
        self.assertLessEqual(objective(x), found.fun + 1e-12)
        np.testing.assert_allclose(x, found.x, atol=1e-6)

    def test_a_conjugate_in_the_metric_splits_the_point_with_its_function(self):
        W, z = np.array([[2.0, 1], [1, 2]]), np.array([3.0, -1])
        for f in (norm1(), moreau.norm2(), box(-1, 2), moreau.huber(0.5) + moreau.linear([1, 0])):
            g = moreau.conjugate(f, W)
            np.testing.assert_allclose(prox(f, z, W) + prox(g, z, W), z, atol=1e-11)
        self.assertEqual(repr(moreau.conjugate(norm1())), "indicator(ball_inf(radius=1))")

    def test_an_envelope_takes_the_norm_of_the_metric_that_it_meets(self):
        f, z, W = moreau.envelope(moreau.point([0, 0]), 1), np.array([2.0, 1]), np.array([1.0, 4.0])
        # ½||x||_W² has the prox z/2 in W, and another one in the identity.
        np.testing.assert_allclose(prox(f, z, W), z / 2, rtol=1e-14)
        np.testing.assert_allclose(prox(f, z), z / 2, rtol=1e-14)
        self.assertEqual(f([1, 1], W), 2.5)

    def test_a_decomposition_tells_how_good_it_is(self):
        split = moreau.decompose(norm1(), [3, -1, 0.5], [[2, 1, 0], [1, 2, 0], [0, 0, 1]])
        np.testing.assert_allclose(split.x + split.y, split.z, atol=1e-14)
        self.assertLess(abs(split.fenchel_gap), 1e-14)
        self.assertLess(split.error_bound, 1e-13)
        self.assertEqual(split.status, "solved")


class UserFunctions(unittest.TestCase):
    def test_a_right_one_passes_the_laws_and_composes(self):
        # f(x) = ½ max(0, ||x||² - 0): a quadratic, its prox (W + I)⁻¹ W z in any metric.
        f = moreau.user_function(lambda x: 0.5 * float(x @ x),
                                 lambda z, W: np.linalg.solve(W.gram + np.eye(len(z)), W.multiply(z)), name="half_square")
        self.assertTrue(moreau.laws(f).passed)
        z = np.array([3.0, -1, 2])
        np.testing.assert_allclose(prox(f, z), z / 2)
        np.testing.assert_allclose(prox(f.conjugate(), z), z / 2, rtol=1e-14)
        np.testing.assert_allclose(prox(moreau.translate(f, [1, 1, 1]), z), (z + 1) / 2, rtol=1e-14)
        np.testing.assert_allclose(prox(3 * f, z), z / 4, rtol=1e-14)
        np.testing.assert_allclose(prox(f, np.tile(z, (600, 1))), np.tile(z / 2, (600, 1)))
        self.assertEqual(repr(2 * f), "scale(half_square(), 2)")

    def test_a_wrong_prox_is_refused_with_the_law_and_a_counterexample(self):
        for wrong in (lambda z, W: 0.5 * z, lambda z, W: softened(z, 2 * W.solve(np.ones(len(z)))),
                      lambda z, W: -softened(z, 1)):
            with self.assertRaisesRegex(moreau.InvalidInput, r'(?s)breaks the law ".*" at z = \[.*FAILED.* at z = \['):
                moreau.user_function(lambda x: float(np.abs(x).sum()), wrong)

    def test_what_needs_more_than_value_and_prox_is_refused(self):
        f = moreau.user_function(lambda x: float(np.abs(x).sum()), lambda z, W: softened(z, W.step), check=0)
        with self.assertRaisesRegex(moreau.InvalidInput, "known by value and prox alone"):
            prox(f + norm1(), [1.0, 2])
        with self.assertRaisesRegex(moreau.InvalidInput, "no multiple of the identity"):
            prox(f, [1.0, 2], [1, 2])
        with self.assertRaisesRegex(moreau.InvalidInput, "give a set"):
            moreau.indicator(f)([1.0])

    def test_errors_of_the_user_come_through(self):
        def broken(z, W):
            raise ZeroDivisionError("mine")

        f = moreau.user_function(lambda x: 0.0, broken, check=0)
        for z in (np.ones(3), np.ones((1000, 3))):
            with self.assertRaisesRegex(ZeroDivisionError, "mine"):
                prox(f, z)
        short = moreau.user_function(lambda x: 0.0, lambda z, W: z[:1], check=0)
        with self.assertRaisesRegex(moreau.InvalidInput, "1 entry at a point of 3"):
            prox(short, np.ones(3))

    def test_a_prox_that_is_not_accurate_is_an_error_with_what_was_found(self):
        error = moreau.Inaccurate("why", np.ones(2), "inaccurate", 0.5)
        self.assertEqual((error.status, error.error_bound), ("inaccurate", 0.5))
