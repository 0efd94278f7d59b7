#pragma once

#include <string>

#include "convex/nearest_point/problem.hpp"
#include "convex/nearest_point/solution.hpp"

/// The methods of this room, each a file of its own: direct ones, then iterations.
namespace convex::inline algorithms {

/// Every independent set of rows is held in turn, in the order of a tree over the rows, until one meets all
/// conditions to rounding; the one that violates them least is handed to `crossover`. The definition turned
/// into a method, for up to 20 one-sided rows.
Solution enumerate(const NearestPointProblem&, const Accuracy& = {});

/// The number of one-sided rows up to which `enumerate` applies.
inline constexpr Index most_enumerated_rows = 20;

/// Lawson and Hanson's nonnegative least squares (1974). When Uq = s has a solution q_0, R is the nearest
/// point to A q_0 - z in the cone of the u_a (Moreau 1966, section 5); otherwise the problem is brought to
/// least distance and homogenised (Lawson and Hanson, chapter 23, section 4), where a zero residual is a
/// proof that there is no solution.
Solution nnls(const NearestPointProblem&, const Accuracy& = {});

/// Lemke's complementary pivoting (1965) with the lexicographic ratio test, on the linear complementarity
/// problem w = M y - b, M = VᵀV of the whitened rows with the two-sided ones projected out. Ending on a ray,
/// it hands the ray's multipliers to `crossover` as a proof that there is no solution, and solves proximal
/// problems with M + ridge I (Rockafellar 1976) when they are none.
Solution lemke(const NearestPointProblem&, const Accuracy& = {});

/// Block principal pivoting (Júdice and Pires 1994; Portugal, Júdice and Vicente 1994): all rows of a wrong
/// sign change sides at once while their number falls, three blocks of patience beyond, then the worst of
/// them alone, twice as often as there can be rows of the working set. On M + ridge I, definite whatever the
/// rows, in proximal steps (Rockafellar 1976). What does not settle so goes on from the rows found by the
/// steps of `active_set`, principal pivots on one row at a time with an orthogonal factor (Dantzig and Cottle
/// 1968), which are finite.
Solution block_pivoting(const NearestPointProblem&, const Accuracy& = {});

/// The rule that Delassus gave (1917) and Moreau rejects (1966): hold all rows, drop those with negative
/// multipliers at once, hold the rest and take that for the answer. Wrong in general; for comparison.
/// `crossover` does not mend it: the status is `solved` only where the rule happens to be right.
Solution drop_negative(const NearestPointProblem&, const Accuracy& = {});

/// The proximal-point method on the multipliers, which is that of augmented Lagrangians (Rockafellar 1976),
/// each of them minimised by a damped Newton method on its pieces (Li, Sun and Toh 2018); dense or sparse. No
/// assumption on the rows: on dependent ones the multipliers converge to some that are right.
Solution proximal_point(const NearestPointProblem&, const Accuracy& = {});

/// The primal-dual active set method, which is a semismooth Newton method (Hintermüller, Ito and Kunisch
/// 2003): all rows with lambda_a > (u_a·q - s_a)/theta are held at once, again and again, until they are the
/// same. The same iteration with a small theta from the start; when rows come back and back, steps are damped
/// by the minimum of the augmented Lagrangian along them, which makes the method converge (Qi and Sun 1993).
Solution semismooth_newton(const NearestPointProblem&, const Accuracy& = {});

/// The predictor-corrector interior-point method of Mehrotra (1992) for quadratic programs, with regularised
/// equations (Vanderbei 1995; Altman and Gondzio 1999), dense or sparse as `RegularisedKkt` is. Two-sided
/// rows enter with the regularisation alone. Without a solution the multipliers diverge along a proof of
/// that, which `crossover` looks for.
Solution interior_point(const NearestPointProblem&, const Accuracy& = {});

/// The alternating direction method of multipliers (Gabay and Mercier 1976) in the form of Stellato and
/// others (2020): one regularised system with the weight 1/rho on all rows, a projection of the slacks,
/// over-relaxation, and a rho that balances the two residuals. Dense or sparse.
Solution admm(const NearestPointProblem&, const Accuracy& = {});

/// Nesterov's accelerated projected gradient on the dual (1983), restarted whenever a step points against the
/// gradient (O'Donoghue and Candès 2015). Dense or sparse: a step costs a product with U, one with Uᵀ and a
/// solve with A.
Solution accelerated_gradient(const NearestPointProblem&, const Accuracy& = {});

/// Projected Gauss-Seidel on the dual, with over-relaxation (Cryer 1971; in mechanics Jean and Moreau 1992):
/// row by row the multiplier takes the value that makes the row hold, or 0. Slow where heavy bodies stand on
/// light ones and where rows are near parallel. Dense.
Solution projected_gauss_seidel(const NearestPointProblem&, const Accuracy& = {});

/// Each proximal step on the multipliers y (Rockafellar 1976) is the nonlinear least-squares problem
/// ½|d|² + Σ ½/theta (theta y_a + b_a - v_a·d)²₊, solved by the trust-region method of Ceres (Agarwal, Mierle
/// and others) in a shared module that is loaded here. Its dual is least squares in y >= 0 with a proximal
/// term; given to Ceres in that form, with bounds, projected steps stall at the bounds.
Solution ceres_method(const NearestPointProblem&, const Accuracy& = {});

/// Empty, or why the module cannot be had.
std::string why_no_ceres();

}  // namespace convex::inline algorithms
