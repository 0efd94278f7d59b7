#include "convex/nearest_point/methods/crossover.hpp"
#include "convex/nearest_point/methods/every_method.hpp"

#include <cmath>

#include "convex/nearest_point/reductions/whitened_problem.hpp"

namespace convex::inline algorithms {
namespace {

/// A pivot below this, the columns of M being of size 1, is rounding about zero.
constexpr double least_pivot = 1e-11;

/// Added to M in the proximal problems.
constexpr double ridge = 1e-7;
constexpr int most_proximal_steps = 20;

enum class End { solution, ray, limit };

struct Pivoting {
  End end = End::limit;
  Vector y;  // the solution, or the direction of the ray
  Index steps = 0;
};

/// The tableau of w - M y - e y0 = c: columns w_1 … w_k, y_1 … y_k, y0, right side.
class Tableau {
 public:
  Tableau(const Matrix& M, const Vector& c) : size_(c.size()), T_(size_, 2 * size_ + 2), basic_(at(size_)) {
    T_.leftCols(size_).setIdentity();
    T_.middleCols(size_, size_) = -M;
    T_.col(2 * size_).setConstant(-1);
    T_.col(2 * size_ + 1) = c;
    for (Index i = 0; i < size_; ++i) basic_[at(i)] = i;
  }

  Pivoting run(Index limit) {
    Pivoting found;
    const Index cover = 2 * size_;
    Index entering = cover, row = -1;
    if (size_ == 0 || T_.col(cover + 1).minCoeff() >= 0) {
      found.end = End::solution;
      found.y = Vector::Zero(size_);
      return found;
    }
    // The first leaving row makes all rows lexicographically positive.
    for (Index i = 0; i < size_; ++i)
      if (row < 0 || is_less(i, row, 1, 1)) row = i;
    for (; found.steps < limit; ++found.steps) {
      const Index leaving = basic_[at(row)];
      pivot(row, entering);
      if (leaving == cover) {
        found.end = End::solution;
        found.y = values();
        return found;
      }
      entering = leaving < size_ ? leaving + size_ : leaving - size_;
      row = leaving_row(entering);
      if (row < 0) {
        found.end = End::ray;
        found.y = ray(entering);
        return found;
      }
    }
    found.y = values();
    return found;
  }

 private:
  /// Whether row i / by_i precedes row j / by_j lexicographically, right sides first.
  bool is_less(Index i, Index j, double by_i, double by_j) const {
    const Index right = 2 * size_ + 1;
    const double noise = 1e-13;
    const auto order = [&](Index column) {
      const double x = T_(i, column) / by_i, y = T_(j, column) / by_j;
      return std::abs(x - y) <= noise * std::max(std::abs(x), std::abs(y)) ? 0 : x < y ? -1 : 1;
    };
    if (const int first = order(right); first != 0) return first < 0;
    for (Index column = 0; column < size_; ++column)
      if (const int next = order(column); next != 0) return next < 0;
    return false;
  }

  Index leaving_row(Index entering) const {
    Index row = -1;
    for (Index i = 0; i < size_; ++i) {
      if (!(T_(i, entering) > least_pivot)) continue;
      // The covering variable leaves as soon as it may: that is the end.
      if (row < 0 || is_less(i, row, T_(i, entering), T_(row, entering))) row = i;
    }
    return row;
  }

  void pivot(Index row, Index column) {
    const Eigen::RowVectorXd pivot_row = T_.row(row) / T_(row, column);
    const Vector factors = T_.col(column);
    T_.noalias() -= factors * pivot_row;
    T_.row(row) = pivot_row;
    basic_[at(row)] = column;
    for (Index i = 0; i < size_; ++i)  // what rounding made negative
      if (T_(i, 2 * size_ + 1) < 0 && T_(i, 2 * size_ + 1) > -1e-13) T_(i, 2 * size_ + 1) = 0;
  }

  Vector values() const {
    Vector y = Vector::Zero(size_);
    for (Index i = 0; i < size_; ++i)
      if (const Index name = basic_[at(i)]; name >= size_ && name < 2 * size_)
        y[name - size_] = std::max(0.0, T_(i, 2 * size_ + 1));
    return y;
  }

  Vector ray(Index entering) const {
    Vector y = Vector::Zero(size_);
    if (entering >= size_ && entering < 2 * size_) y[entering - size_] = 1;
    for (Index i = 0; i < size_; ++i)
      if (const Index name = basic_[at(i)]; name >= size_ && name < 2 * size_)
        y[name - size_] = std::max(0.0, -T_(i, entering));
    return y;
  }

  Index size_;
  Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor> T_;
  std::vector<Index> basic_;
};

}  // namespace

Solution lemke(const NearestPointProblem& problem, const Accuracy& accuracy) {
  if (const auto found = without_a_method(problem, "lemke", accuracy)) return *found;
  const WhitenedProblem white(problem);
  const Complementarity lcp(white);
  const Index limit = accuracy.step_limit > 0 ? accuracy.step_limit : 50 + 10 * white.size();
  Candidate candidate{.method = "lemke", .q = {}, .lambda = {}, .farkas = {}};
  Pivoting pivoting = Tableau(lcp.M, -lcp.b).run(limit);
  candidate.steps = pivoting.steps;
  const Vector y = lcp.with_free(white, pivoting.y);
  if (pivoting.end == End::ray) candidate.farkas = white.weights(y);
  if (pivoting.end == End::solution) candidate.lambda = white.multipliers(y);
  candidate.finished = pivoting.end == End::solution;
  Solution found = crossover(problem, candidate, accuracy);
  if (found.status == Status::solved || found.status == Status::infeasible || accuracy.step_limit > 0)
    return found;
  // Dependent rows, or rows with no strictly feasible motion, that rounding has spoiled.
  const Index k = lcp.b.size();
  Vector center = Vector::Zero(k), previous = center;
  const Matrix definite = lcp.M + ridge * Matrix::Identity(k, k);
  candidate.finished = false;
  for (int step = 0; step < most_proximal_steps; ++step) {
    pivoting = Tableau(definite, -lcp.b - ridge * center).run(limit);
    candidate.steps += pivoting.steps;
    previous = center;
    center = pivoting.y;
    if (pivoting.end != End::solution) break;
    candidate.lambda = white.multipliers(lcp.with_free(white, center));
    candidate.farkas = white.weights(lcp.with_free(white, center - previous));
    found = crossover(problem, candidate, accuracy);
    if (found.status == Status::solved || found.status == Status::infeasible) return found;
  }
  return found;
}

}  // namespace convex::inline algorithms
