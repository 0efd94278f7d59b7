"""Problems given by numbers; the oracle is the enumeration of active sets, or scipy's non-negative least squares."""

import itertools
import unittest

import numpy as np
import scipy.optimize
import scipy.sparse

import moreau


def drawn(seed, n=6, m=4):
    random = np.random.default_rng(seed)
    B = random.integers(-3, 4, size=(n, n)).astype(float)
    return B @ B.T + n * np.eye(n), random.normal(size=n), random.normal(size=(m, n)), random.normal(size=m)


def by_enumeration(A, z, U, s):
    """q of the one active set whose multipliers and slacks have their signs."""
    for count in range(len(U) + 1):
        for chosen in itertools.combinations(range(len(U)), count):
            rows = U[list(chosen)]
            K = np.block([[A, -rows.T], [rows, np.zeros((count, count))]])
            found = np.linalg.solve(K, np.concatenate([z, s[list(chosen)]]))
            if (found[len(z):] >= -1e-12).all() and (U @ found[: len(z)] >= s - 1e-12).all():
                return found[: len(z)]
    raise AssertionError("no active set fits")


class Numbers(unittest.TestCase):
    def test_the_answer_is_that_of_the_one_active_set_that_fits(self):
        for seed in range(20):
            A, z, U, s = drawn(seed)
            found = moreau.solve(A=A, z=z, U=U, s=s)
            self.assertEqual(found.status, "solved")
            np.testing.assert_allclose(found.acceleration, by_enumeration(A, z, U, s), rtol=1e-11, atol=1e-12)

    def test_multipliers_are_the_non_negative_least_squares_of_the_dual(self):
        for seed in range(20):
            A, z, U, _ = drawn(seed)
            inverse_root = np.linalg.inv(np.linalg.cholesky(A))
            # With s = 0 the reaction is the nearest point of the cone of U to -z in the metric of A^-1.
            expected, _ = scipy.optimize.nnls(inverse_root @ U.T, -inverse_root @ z)
            found = moreau.solve(A=A, z=z, U=U)
            np.testing.assert_allclose(found.multipliers, expected, rtol=1e-10, atol=1e-11)
            np.testing.assert_allclose(found.reaction, U.T @ expected, rtol=1e-10, atol=1e-11)

    def test_a_sparse_and_a_dense_matrix_a_diagonal_and_a_metric_are_the_same_problem(self):
        d, (_, z, U, s) = np.array([2.0, 1, 3, 5, 4, 1]), drawn(3)
        expected = moreau.solve(A=np.diag(d), z=z, U=U, s=s).acceleration
        sparse_rows = scipy.sparse.coo_matrix(U)
        for A in (d, list(d), scipy.sparse.diags(d), moreau.Metric(d), np.asfortranarray(np.diag(d)), d[None, :][0]):
            for rows in (U, U.tolist(), np.asfortranarray(U), sparse_rows, scipy.sparse.csc_matrix(U)):
                found = moreau.solve(A=A, z=z, U=rows, s=s)
                np.testing.assert_allclose(found.acceleration, expected, rtol=1e-13, atol=1e-14)

    def test_what_is_given_stays_as_it_is_and_what_comes_is_a_view_that_outlives_its_owner(self):
        A, z, U, s = drawn(1)
        before = [x.copy() for x in (A, z, U, s)]
        found = moreau.solve(A=A, z=z, U=U, s=s)
        q = found.acceleration
        self.assertFalse(q.flags.writeable)
        self.assertIs(q.base, found)
        expected = q.copy()
        del found
        self.assertTrue((q == expected).all())
        for x, y in zip((A, z, U, s), before):
            self.assertTrue((x == y).all())

    def test_what_has_no_solution_says_so_with_weights_that_prove_it(self):
        U, s = np.array([[1.0, 0], [-1, 0], [0, 1]]), np.array([1.0, 1, 0])
        found = moreau.solve(z=[0, 0], U=U, s=s)
        self.assertEqual(found.status, "infeasible")
        w = found.farkas
        self.assertTrue((w >= 0).all() and w @ s > 0)
        np.testing.assert_allclose(w @ U, 0, atol=1e-15)
        with self.assertRaisesRegex(moreau.InvalidInput, "infeasible"):
            found.acceleration

    def test_multipliers_that_are_not_unique_come_with_their_ranges(self):
        found = moreau.solve(z=[-1.0], U=[[1.0], [1.0]], s=[0.0, 0.0])
        self.assertFalse(found.multipliers_unique)
        np.testing.assert_allclose(found.multipliers, [0.5, 0.5])
        np.testing.assert_allclose(found.multiplier_ranges, [[0, 1], [0, 1]])
        self.assertEqual(found.active, [0, 1])

    def test_two_sided_rows_pull_as_well_as_push(self):
        found = moreau.solve(z=[1.0, 0], U=[[1.0, 0]], s=[0.0], two_sided=[0])
        np.testing.assert_allclose(found.multipliers, [-1.0])

    def test_wrong_numbers_are_refused_with_the_message_of_the_program(self):
        good = dict(A=np.eye(2), z=np.zeros(2), U=np.eye(2), s=np.zeros(2))
        for wrong, message in ((dict(A=[[1, 2], [2, 1]]), "not positive definite"),
                               (dict(A=[[1, 2], [0, 5]]), "not symmetric"),
                               (dict(A=np.eye(3)), "z: 2"),
                               (dict(A=np.ones((2, 3))), "A"),
                               (dict(z=[0, np.nan]), "not finite"),
                               (dict(z=[0, 1j]), "z: (complex|not numbers)"),
                               (dict(z="ab"), "z: not numbers"),
                               (dict(z=np.zeros((1, 1, 2))), "z: "),
                               (dict(U=np.ones((2, 3))), "U"),
                               (dict(U=[[1, 0], [1]]), "U: rows of different lengths"),
                               (dict(s=[0.0]), "s: "),
                               (dict(two_sided=[5]), "no row 5"),
                               (dict(two_sided=np.array([False, True])), "two_sided: booleans; .*flatnonzero"),
                               (dict(z=np.zeros((3, 2)), two_sided=[True, False]), "two_sided: booleans"),
                               (dict(method="activ-set"), 'did you mean "active-set"')):
            with self.subTest(message), self.assertRaisesRegex(moreau.InvalidInput, message):
                moreau.solve(**(good | wrong))

    def test_rows_without_a_force_are_told_that_z_is_missing(self):
        with self.assertRaisesRegex(TypeError, "^z is missing"):
            moreau.solve(U=[[1, 0]], s=[1])
        with self.assertRaisesRegex(TypeError, "^nothing to solve"):
            moreau.solve()

    def test_the_same_problem_as_a_dict_has_the_same_answer_in_full(self):
        A, z, U, s = drawn(5)
        numbers = moreau.solve(A=A, z=z, U=U, s=s)
        full = moreau.solve({"projection": {"A": A, "z": z, "U": U, "s": s}})
        np.testing.assert_allclose(list(full.acceleration.values()), numbers.acceleration, rtol=1e-13)
        self.assertEqual(full.active, [f"c[{a}]" for a in numbers.active])
        self.assertEqual(numbers.result.hypothesis, full.hypothesis)


class Batches(unittest.TestCase):
    def check(self, A, z, U, s, count):
        found = moreau.solve(A=A, z=z, U=U, s=s)
        self.assertTrue(found.all_solved)
        for k in range(0, count, 37):
            pick = lambda x, axes: x[k] if np.ndim(x) == axes + 1 else x
            one = moreau.solve(A=pick(A, 2) if np.ndim(A) != 2 or np.shape(A)[0] == np.shape(A)[1] else A[k],
                               z=pick(z, 1), U=pick(U, 2), s=pick(s, 1))
            np.testing.assert_allclose(found.acceleration[k], one.acceleration, rtol=1e-11, atol=1e-12)
            np.testing.assert_allclose(found.multipliers[k], one.multipliers, rtol=1e-10, atol=1e-11)

    def test_each_problem_of_a_batch_has_the_answer_that_it_has_alone(self):
        count, random = 700, np.random.default_rng(8)
        A, z, U, s = drawn(2)
        many_z, many_s = random.normal(size=(count, 6)), random.normal(size=(count, 4))
        many_U = random.normal(size=(count, 4, 6))
        B = random.normal(size=(count, 6, 6))
        many_A = B @ B.transpose(0, 2, 1) + np.eye(6)
        many_d = random.uniform(1, 3, size=(count, 6))
        for arguments in ((A, many_z, U, s), (A, many_z, U, many_s), (A, z, U, many_s), (A, many_z, many_U, s),
                          (many_A, many_z, many_U, many_s), (many_A, z, U, s), (many_d, many_z, U, s),
                          (None, many_z, U, s), (np.ones(6), z, many_U, s)):
            self.check(*arguments, count)

    def test_what_is_infeasible_in_a_batch_is_told_from_the_rest(self):
        s = np.array([[0.0, 0], [1, 1], [0, 0]])
        found = moreau.solve(z=[0.0], U=[[1.0], [-1.0]], s=s)
        self.assertEqual(list(found.status), ["solved", "infeasible", "solved"])
        self.assertTrue(np.isnan(found.acceleration[1]).all() and np.isfinite(found.acceleration[[0, 2]]).all())
        self.assertEqual(list(found.farkas), [1])
        self.assertFalse(found.all_solved)

    def test_an_error_in_a_batch_names_the_first_problem_that_has_it(self):
        z = np.zeros((1000, 2))
        z[700, 1] = z[20, 0] = np.nan
        with self.assertRaisesRegex(moreau.InvalidInput, "problem 20: z"):
            moreau.solve(z=z, U=np.eye(2))
        with self.assertRaisesRegex(moreau.InvalidInput, "s: 3 problems along the first axis, others have 1000"):
            moreau.solve(z=np.zeros((1000, 2)), U=np.eye(2), s=np.zeros((3, 2)))

    def test_no_problems_have_no_answers(self):
        self.assertEqual(len(moreau.solve(z=np.zeros((0, 2)), U=np.eye(2))), 0)
