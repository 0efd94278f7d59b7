"""Atlases, subdifferentials and maps; the oracle is the definition in fractions, sampling, or the solver."""

import pathlib
import unittest
from fractions import Fraction

import numpy as np
from scipy.stats import multivariate_normal

import moreau
from moreau import ball2, box, group_norm, norm1, norm2

ROOT = pathlib.Path(__file__).resolve().parents[2]


class Atlases(unittest.TestCase):
    def test_a_force_lies_in_the_cell_whose_contacts_persist_there(self):
        random = np.random.default_rng(2)
        A, U, s = np.array([[3, 1, 0], [1, 2, 0], [0, 0, 1]]), random.integers(-3, 4, size=(5, 3)), [0, -1, 0, -2, 0]
        atlas = moreau.atlas(A=A, U=U, s=s)
        self.assertLessEqual(abs(atlas.sum - 1), atlas.error_sum)
        for z in random.integers(-40, 40, size=(40, 3)):
            found = moreau.solve(A=A, z=z, U=U, s=s)
            cells = atlas.cells_at(z)
            if len(cells) == 1:
                self.assertEqual([f"c[{a}]" for a in found.active], list(cells[0].contacts))
            else:
                self.assertGreater(len(cells), 1)

    def test_cells_have_names_numbers_and_a_picture(self):
        atlas = moreau.atlas(ROOT / "docs/problems/delassus_drops_too_much.toml", over={"y": (-8, 8), "a": (-8, 8)})
        self.assertEqual(atlas.cell("left", "right").freedom, 0)
        with self.assertRaises(KeyError):
            atlas.cell("middle")
        self.assertEqual(len(atlas.probabilities), len(atlas.cells))
        self.assertIn("probability", atlas._repr_html_())
        picture = atlas._repr_svg_()
        self.assertTrue(picture is None or "<svg" in picture)

    def test_probabilities_of_four_contacts_in_four_dimensions_are_the_orthants_that_scipy_integrates(self):
        random = np.random.default_rng(7)
        B, U = random.integers(-3, 4, size=(4, 4)), random.integers(-2, 3, size=(4, 4)) + 4*np.eye(4, dtype=int)
        A = B @ B.T + 2*np.eye(4, dtype=int)
        atlas = moreau.atlas(A=A, U=U)
        slack = U @ np.linalg.solve(A, U.T)  # the covariance of Uq'' of the free motion
        slack = (slack + slack.T) / 2
        normal = lambda covariance: multivariate_normal.cdf(np.zeros(4), cov=covariance, maxpts=1_000_000, abseps=1e-6)
        self.assertAlmostEqual(atlas.cell().probability, normal(slack), delta=2e-5)
        self.assertAlmostEqual(atlas.cell(*(f"c[{a}]" for a in range(4))).probability, normal(np.linalg.inv(slack)), delta=2e-5)

    def test_contacts_that_exclude_each_other_are_named(self):
        atlas = moreau.atlas(U=[[1], [-1], [2]], s=[1, 0, 0])
        self.assertEqual(atlas.status, "infeasible")
        w = atlas.farkas
        self.assertEqual(w["c[0]"] - w["c[1]"] + 2*w["c[2]"], 0)
        self.assertGreater(w["c[0]"], 0)
        self.assertIn("c[0], c[1] exclude", repr(atlas))

    def test_a_distribution_can_be_given_and_one_that_does_not_fit_is_refused_by_its_name(self):
        far = moreau.atlas(U=[[1, 0], [0, 1]], mean=[100, 100], covariance=[[2, 1], [1, 2]])
        self.assertAlmostEqual(far.cell().probability, 1)
        with self.assertRaisesRegex(moreau.InvalidInput, "^--covariance: (?!metric)"):
            moreau.atlas(U=[[1, 0], [0, 1]], covariance=[[1, 2], [2, 1]])


class Subdifferentials(unittest.TestCase):
    def test_membership_is_the_definition_at_many_points(self):
        random = np.random.default_rng(4)
        for f, x in ((norm1(), [0, 2, 0]), (norm2() + 2*norm1(), [0, 0, 0]), (group_norm(sizes=2), [0, 0, 3, 4]),
                     (2*norm2() + norm1(), [3, 0, 4])):
            at = moreau.subdifferential(f, x)
            x = np.array(x, float)
            for _ in range(60):
                v = random.normal(size=len(x)) * 2
                inside = v in at
                u = x + random.normal(size=(400, len(x))) * np.exp(random.normal(size=(400, 1)))
                slope = min(f(p) - f(x) - v @ (p - x) for p in u)
                if inside:
                    self.assertGreaterEqual(slope, -1e-9)
                if slope < -1e-6:
                    self.assertFalse(inside)

    def test_numbers_count_as_they_are_written(self):
        third = moreau.function("box(1/3, 1)")
        self.assertFalse(moreau.subdifferential(third, [Fraction(1, 3)]).is_single)
        self.assertTrue(moreau.subdifferential(third, [0.5]).is_single)
        self.assertEqual(moreau.subdifferential(norm1(), ["1/3", 0]).polyhedron["equations"], [([1, 0], 1)])

    def test_support_projection_and_least_element_are_those_of_a_ball(self):
        at = moreau.subdifferential(norm2(3), [0, 0])
        self.assertAlmostEqual(at.support([3, 4]), 15)
        np.testing.assert_allclose(at.projection([6, 8]), [1.8, 2.4], rtol=1e-12)
        np.testing.assert_allclose(at.least, [0, 0], atol=1e-12)
        self.assertIsNone(at.polyhedron)

    def test_cones_of_a_corner(self):
        at = moreau.subdifferential(box(0, 1), [0, 0])
        self.assertEqual(sorted(at.tangent_cone["generators"]), [[0, 1], [1, 0]])
        self.assertEqual(at.critical_cone([-1, 0])["generators"], [[0, 1]])
        self.assertTrue(moreau.subdifferential(box(0, 1), [2, 0]).is_empty)


class Maps(unittest.TestCase):
    def test_a_prox_is_not_refuted_and_a_rotation_is(self):
        self.assertTrue(moreau.laws(lambda z: np.maximum(z, 0), 2))
        report = moreau.laws(lambda z: np.array([z[1], -z[0]]) / 2, 2)
        self.assertFalse(report)
        found = report.counterexample
        W = [[1, 0], [0, 1]]
        x, Tx = found["points"], found["images"]
        total = sum(sum(W[i][j]*Tx[k][i]*(x[k][j] - x[(k + 1) % len(x)][j]) for i in range(2) for j in range(2))
                    for k in range(len(x)))
        self.assertLess(total, 0)
        self.assertEqual(-total >= found["excess"] > 0, True)

    def test_the_metric_counts(self):
        W = np.array([[2.0, 1.0], [1.0, 2.0]])
        T = lambda z: np.linalg.solve(W + np.diag([1.0, 3.0]), W @ z)
        self.assertTrue(moreau.laws(T, 2, W=W))
        self.assertFalse(moreau.laws(T, 2))


class Messages(unittest.TestCase):
    def test_a_metric_is_called_by_the_name_of_its_argument(self):
        for W, message in (([[1, 2], [0, 1]], r"W: not symmetric: W\[0\]\[1\] and W\[1\]\[0\]"),
                           ([[1, 2], [2, 1]], "^W: not positive definite"), ([1, 0], r"W\[1\]\[1\] is not positive")):
            for call in (lambda: moreau.prox(norm1(), [1, 2], W), lambda: moreau.Metric(W)):
                with self.assertRaisesRegex(moreau.InvalidInput, message):
                    call()
        self.assertEqual(repr(moreau.Metric([1, 2])), "Metric(2 by 2, diagonal)")

    def test_numbers_of_entries_that_are_none_are_refused(self):
        for wrong in (lambda: moreau.laws(norm1(), 0), lambda: moreau.laws(norm1(), -1),
                      lambda: moreau.user_function(lambda x: 0.0, lambda z, W: z, n=-1, check=0),
                      lambda: moreau.user_function(lambda x: 0.0, lambda z, W: z, check=-1)):
            with self.assertRaisesRegex(moreau.InvalidInput, "^n: (not positive|negative)"):
                wrong()

    def test_wrong_arguments_are_told_in_the_modules_own_words(self):
        f, z = norm1(), [1, 2]
        at = moreau.subdifferential(f, z)
        wrong = [
            lambda: moreau.prox("norm1()", z), lambda: moreau.prox(f, "z"), lambda: moreau.prox(f, z, W="W"),
            lambda: moreau.prox(f, [[[1]]]), lambda: moreau.prox(f, None), lambda: moreau.conjugate(3),
            lambda: moreau.decompose(3, z), lambda: moreau.decompose(f, z, tolerance="small"),
            lambda: moreau.decompose(f, {}), lambda: moreau.laws(3), lambda: moreau.laws(lambda z: "a", 2),
            lambda: moreau.laws(lambda z: z[:1], 2), lambda: f(), lambda: f(1, 2, 3), lambda: f("a"), lambda: f(z, 3, 4),
            lambda: f.conjugate(1, 2), lambda: moreau.Metric(), lambda: moreau.Metric("a"), lambda: moreau.Metric(1, 2),
            lambda: moreau.Metric([1, 2]).multiply(), lambda: moreau.Metric([1, 2]).multiply("a"),
            lambda: moreau.function(3), lambda: moreau.function("norm3()"), lambda: norm1(weight="a"),
            lambda: norm1(wieght=2), lambda: box(0), lambda: moreau.solve(3), lambda: moreau.solve(z=z, tolerance="a"),
            lambda: moreau.solve(z=z, tolerance=-1), lambda: moreau.decompose(f, z, tolerance=0),
            lambda: moreau.solve({"projection": {"A": [[1]], "z": [float("nan")]}}),
            lambda: moreau.solve({"projection": {"A": [[1]], "z": None}}),
            lambda: moreau.solve(z=z, U=[[1, 0]], two_sided="a"), lambda: moreau.solve(z=z, method=3),
            lambda: moreau.solve("scene.toml", certfy=True), lambda: moreau.solve(z="a"),
            lambda: moreau.atlas(U=[1, 2]), lambda: moreau.atlas(U=[[1, 2]], tolerance="a"),
            lambda: moreau.atlas(U=[[1, 2]], tolerance=-1), lambda: moreau.atlas(U=[[1, 2]], mean=[1]),
            lambda: moreau.atlas(U=[[1, 2]], over={"z": (0, 1)}), lambda: moreau.atlas(U=[[1, 2]], cells="a"),
            lambda: moreau.subdifferential(3, z), lambda: moreau.subdifferential(f, "a"),
            lambda: moreau.subdifferential(f, [[1, 2]]), lambda: moreau.subdifferential(f, []),
            lambda: at.support(), lambda: at.support([1]), lambda: at.projection(3), lambda: [1] in at,
            lambda: at.critical_cone([1]), lambda: moreau.user_function(3, 4),
            lambda: moreau.user_function(lambda x: "a", lambda z, W: z), lambda: moreau.Motion(3),
        ]
        for k, call in enumerate(wrong):
            with self.subTest(k):
                with self.assertRaises(moreau.InvalidInput) as caught:
                    call()
                told = str(caught.exception)
                for word in ("incompatible", "_moreau", "pybind", "C++", "std::", "Unable to cast", "py::"):
                    self.assertNotIn(word, told)
                self.assertIn(";", told)


if __name__ == "__main__":
    unittest.main()
