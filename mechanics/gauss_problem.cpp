#include "mechanics/gauss_problem.hpp"

#include <algorithm>
#include <cmath>
#include <span>

#include "mechanics/exact_text.hpp"
#include "mechanics/written_mechanism.hpp"

namespace mechanics {
namespace {

/// Below this many coordinates, or when more than a quarter of A is there, dense is faster.
constexpr Index small_system = 64;
constexpr double sparse_part = 0.25;

/// Values and derivatives of expressions are rounded about so many times: a guess, for rows of which nothing
/// else is known.
constexpr double roundings_of_data = 16;

/// The first coordinate whose velocity adds no kinetic energy to the ones before it.
Index pivot_at_fault(convex::Matrix A) {
  for (Index k = 0; k < A.rows(); ++k) {
    const double pivot = A(k, k);
    if (!(pivot > 0)) return k;
    for (Index j = k + 1; j < A.cols(); ++j)
      A.col(j).tail(A.rows() - k - 1) -= A.col(k).tail(A.rows() - k - 1) * (A(k, j) / pivot);
  }
  return A.rows() - 1;
}

}  // namespace

convex::Metric kinetic_metric(const convex::SparseMatrix& A, const std::vector<std::string>& coordinates) {
  const Index n = A.rows();
  try {
    const double entries = static_cast<double>(A.nonZeros());
    const double all = static_cast<double>(n) * static_cast<double>(n);
    if (A.nonZeros() > n && (n <= small_system || entries > sparse_part * all))
      return convex::Metric::dense(convex::Matrix(A));
    return convex::Metric::sparse(A);
  } catch (const convex::InvalidInput&) {
    if (n > 0 && A.squaredNorm() == 0)
      throw convex::InvalidInput(
          "kinetic: T is not positive definite in the velocities at this state, it is 0 whatever they are; "
          "give every motion a positive kinetic energy, a mass above 0 and a velocity, that of " +
          coordinates[0] + " is " + coordinates[0] + "'");
    Index fault = -1;
    for (Index i = 0; i < n && fault < 0; ++i)
      if (!(A.coeff(i, i) > 0)) fault = i;
    constexpr Index largest_dense = 2000;
    if (fault < 0 && n <= largest_dense) fault = pivot_at_fault(convex::Matrix(A));
    const std::string what = "kinetic: T is not positive definite in the velocities at this state";
    const std::string coordinate = fault < 0 ? "" : coordinates[static_cast<std::size_t>(fault)];
    if (fault >= 0 && A.col(fault).squaredNorm() == 0)
      throw convex::InvalidInput(what + ", " + coordinate + "' is not in it; give " + coordinate +
                                 " a mass, or write the constraints without it, that of a pin in a slot as "
                                 "x*sin(b) = y*cos(b)");
    throw convex::InvalidInput(what + (fault < 0 ? "" : " (fails at " + coordinate + "')") +
                               "; give every motion a positive kinetic energy, or choose other coordinates");
  }
}

namespace {

/// With the doubles as the numbers that are meant.
GaussProblem as_evaluated(const System& system, const State& state, const Vector& contact_tolerance) {
  Inertia inertia = system.inertia(state);
  convex::Metric A = kinetic_metric(inertia.A, system.coordinates());
  Contacts present = contacts(system, state, contact_tolerance);
  ContactRows rows = system.contact_rows(state, present.present);
  std::vector<Index> two_sided;
  for (std::size_t k = 0; k < present.present.size(); ++k)
    if (system.constraints()[static_cast<std::size_t>(present.present[k])].two_sided)
      two_sided.push_back(static_cast<Index>(k));
  const double entries = static_cast<double>(rows.U.nonZeros());
  const double all = static_cast<double>(rows.U.rows()) * static_cast<double>(rows.U.cols());
  const bool dense = rows.U.cols() <= small_system || entries > sparse_part * all;
  convex::ConstraintRows U =
      dense ? convex::ConstraintRows(convex::RowMatrix(rows.U)) : convex::ConstraintRows(std::move(rows.U));
  return {{std::move(A), std::move(inertia.z), std::move(U), std::move(rows.s), std::move(two_sided)},
          std::move(present)};
}

}  // namespace

GaussProblem gauss_problem(const System& system, const State& state, const Vector& contact_tolerance) {
  GaussProblem found = as_evaluated(system, state, contact_tolerance);
  found.problem.radii = convex::rounding_radii(found.problem, roundings_of_data);
  return found;
}

namespace {

/// The same with 0 for the rows chosen.
convex::ConstraintRows with_zero_rows(const convex::ConstraintRows& U, const std::vector<Index>& rows) {
  if (U.is_sparse()) {
    convex::SparseRows kept = U.sparse();
    const std::vector<bool> is_chosen = convex::marked(kept.rows(), rows);
    kept.prune([&](Index row, Index, double) { return !is_chosen[static_cast<std::size_t>(row)]; });
    return convex::ConstraintRows(std::move(kept));
  }
  convex::RowMatrix kept = U.dense();
  for (const Index row : rows) kept.row(row).setZero();
  return convex::ConstraintRows(std::move(kept));
}

/// One-sided rows that may be 0 within their radii: 0 where the text proves that they are (cos at pi/2).
void settle_vanishing_rows(const WrittenMechanism& written, const std::vector<Index>& contacts,
                           convex::NearestPointProblem& problem, convex::DataRadii& radii) {
  std::vector<Index> rows, suspects;
  for (Index k = 0; k < problem.rows(); ++k) {
    if (problem.is_two_sided(k) || !(radii.row[k] > 0)) continue;
    if (!(problem.A.dual_norm(problem.U.row(k)) <= radii.row[k])) continue;
    rows.push_back(k);
    suspects.push_back(contacts[static_cast<std::size_t>(k)]);
  }
  if (rows.empty()) return;
  const auto found = where_gradients_vanish(*written.system, written.text, suspects);
  std::vector<Index> vanishing;
  for (std::size_t k = 0; k < rows.size(); ++k) {
    if (!found[k]) continue;
    vanishing.push_back(rows[k]);
    problem.s[rows[k]] = found[k]->value;
    radii.s[rows[k]] = found[k]->radius;
    radii.row[rows[k]] = 0;
  }
  if (!vanishing.empty()) problem.U = with_zero_rows(problem.U, vanishing);
}

}  // namespace

namespace {

/// Whether A or z is not what the text says.
bool is_motion_rounded(const WrittenMechanism& written) {
  const convex::EntryRadii radii = data_radii(*written.system, written.state, written.radii, {});
  const auto values = std::span(radii.A.valuePtr(), static_cast<std::size_t>(radii.A.nonZeros()));
  return !radii.z.isZero(0) || std::any_of(values.begin(), values.end(), [](double r) { return r != 0; });
}

}  // namespace

GaussProblem gauss_problem(const WrittenMechanism& written, const Vector& contact_tolerance) {
  GaussProblem found = as_evaluated(*written.system, written.state, contact_tolerance);
  convex::NearestPointProblem& problem = found.problem;
  convex::DataRadii radii =
      row_radii(*written.system, written.state, written.radii, found.contacts.present, problem.A);
  // Rows without radii say that z is rounded, unless nothing is.
  if (radii.is_zero()) {
    if (is_motion_rounded(written)) problem.radii = std::move(radii);
    return found;
  }
  if (!radii.row.allFinite() || !radii.s.allFinite()) {
    const convex::DataRadii guess = convex::rounding_radii(problem, roundings_of_data);
    for (Index a = 0; a < problem.rows(); ++a) {
      if (!std::isfinite(radii.row[a])) radii.row[a] = guess.row[a];
      if (!std::isfinite(radii.s[a])) radii.s[a] = guess.s[a];
    }
  }
  settle_vanishing_rows(written, found.contacts.present, problem, radii);
  if (!radii.is_zero()) problem.radii = std::move(radii);
  return found;
}

}  // namespace mechanics
