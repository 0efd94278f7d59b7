#include "convex/nearest_point/working_set/working_set.hpp"

#include <algorithm>

#include "convex/infinity.hpp"

namespace convex::inline working_set {
namespace {

/// Below this part of |v_p| outside the span of S, doubles alone no longer tell how much is left, and the
/// split is sharpened in twice the working precision.
constexpr double doubtful_part = 1e-5;

/// Where the data have no radii, the way goes on as if a row were dependent on S when what is left of it is
/// at most so many roundings of what it is made of; the end decides it without rounding.
constexpr double dependence_roundings = 8;

}  // namespace

bool is_dense_size(const NearestPointProblem& problem) {
  constexpr double most_dense_numbers = 4e6;
  const double n = static_cast<double>(problem.dimension()), m = static_cast<double>(problem.rows());
  return n * std::min(n, m) <= most_dense_numbers;
}

Matrix whitened_rows(const NearestPointProblem& problem, const std::vector<Index>& rows) {
  Matrix block(problem.dimension(), static_cast<Index>(rows.size()));
  for (std::size_t k = 0; k < rows.size(); ++k) problem.U.copy_row(rows[k], block.col(static_cast<Index>(k)));
  problem.A.whiten_in_place(block);
  return block;
}

WorkingSet::WorkingSet(const NearestPointProblem& problem)
    : problem_(problem),
      factor_(problem.dimension(), std::min(problem.dimension(), problem.rows())),
      position_(at(problem.rows()), -1),
      two_sided_(marked(problem.rows(), problem.two_sided)),
      w_free_(problem.A.whiten(problem.z)),
      w_(w_free_),
      lambda_(factor_.capacity()) {
  rows_.reserve(at(factor_.capacity()));
}

Vector WorkingSet::point() const { return problem_.A.unwhiten(w_); }

void WorkingSet::split(Index p, Split& into) {
  into.direction.resize(problem_.dimension());
  problem_.U.copy_row(p, into.direction);
  problem_.A.whiten_in_place(Eigen::Map<Matrix>(into.direction.data(), problem_.dimension(), 1));
  into.length = into.direction.norm();
  into.c.resize(factor_.capacity());
  into.rho = factor_.split(into.direction, into.c);
  into.coefficients = into.c.head(size());
  factor_.solve_upper(into.coefficients);
  into.magnitude = into.length;
  into.rest = into.rho;
  into.within_radii = false;
  if (into.rho < doubtful_part * into.length) sharpen(p, into);
  // Nothing lies outside the span of as many rows as there are coordinates, whatever rounding leaves of it.
  if (size() == factor_.capacity()) into.rho = 0;
}

void WorkingSet::sharpen(Index p, Split& split) {
  DoubleDoubleVector r(Vector(split.coefficients));
  // Each pass multiplies the error of r by the condition of S times u: until nothing is left of it in twice
  // the precision, or it shrinks no more, as S is singular to rounding.
  constexpr int least_passes = 2, most_passes = 16;
  double moved = infinity;
  for (int pass = 0; pass < most_passes; ++pass) {
    DoubleDoubleVector rest(problem_.U.row(p));
    for (Index k = 0; k < size(); ++k) problem_.U.add_multiple(rows_[at(k)], {-r.hi[k], -r.lo[k]}, rest);
    split.direction = problem_.A.whiten(rest.value());
    Vector correction(factor_.capacity());
    split.rho = factor_.split(split.direction, correction);
    Vector step = correction.head(size());
    factor_.solve_upper(step);
    r.add(step);
    double moves = 0, size_of_r = split.length;
    for (Index k = 0; k < size(); ++k) {
      moves = std::max(moves, std::abs(step[k]) * factor_.length(k));
      size_of_r = std::max(size_of_r, std::abs(r.hi[k]) * factor_.length(k));
    }
    if (pass + 1 >= least_passes && (moves <= exact_dependence * size_of_r || !(moves < moved / 2))) break;
    moved = moves;
  }
  split.coefficients = r.hi;
  for (Index k = 0; k < size(); ++k) split.magnitude += std::abs(r.hi[k]) * factor_.length(k);
  split.rest = split.rho;
  double unsure = dependence_roundings * unit_roundoff * split.magnitude;
  if (const std::optional<DataRadii>& radii = problem_.radii) {
    unsure = radii->row[p];
    for (Index k = 0; k < size(); ++k) unsure += std::abs(r.hi[k]) * radii->row[rows_[at(k)]];
    split.within_radii = split.rho <= unsure && unsure > 0;
    unsure = std::max(unsure, exact_dependence * split.magnitude);
  }
  if (split.rho <= unsure) split.rho = 0;
}

void WorkingSet::take(Index p) {
  position_[at(p)] = static_cast<Index>(rows_.size());
  rows_.push_back(p);
}

void WorkingSet::append(Index p, const Split& split, double multiplier) {
  lambda_[size()] = multiplier;
  factor_.append(split.c, split.direction, split.rho);
  take(p);
}

void WorkingSet::remove(Index k) {
  factor_.remove(k);
  position_[at(rows_[static_cast<std::size_t>(k)])] = -1;
  rows_.erase(rows_.begin() + k);
  for (Index l = k; l < size(); ++l) {
    lambda_[l] = lambda_[l + 1];
    position_[at(rows_[static_cast<std::size_t>(l)])] = l;
  }
}

void WorkingSet::append_block(const std::vector<Index>& rows, double threshold) {
  Matrix whitened = whitened_rows(problem_, rows);
  factor_.append_block(whitened, threshold, [&](Index k) { take(rows[at(k)]); });
}

Vector WorkingSet::shortest_motion() const {
  Vector y(size());
  for (Index k = 0; k < size(); ++k) y[k] = problem_.s[rows_[at(k)]];
  factor_.solve_lower(y);
  return y;
}

double WorkingSet::scale() const { return std::max({w_.norm(), w_free_.norm(), shortest_motion().norm()}); }

void WorkingSet::solve() {
  Vector y = shortest_motion();
  y.noalias() -= factor_.Q().transpose() * w_free_;
  w_ = w_free_;
  w_.noalias() += factor_.Q() * y;
  factor_.solve_upper(y);
  lambda_.head(size()) = y;
}

void WorkingSet::correct(const Vector& g, Vector r2, Vector& dw, Vector& dlambda) const {
  factor_.solve_lower(r2);
  r2.noalias() -= factor_.Q().transpose() * g;
  dw = g;
  dw.noalias() += factor_.Q() * r2;
  factor_.solve_upper(r2);
  dlambda = r2;
}

}  // namespace convex::inline working_set
