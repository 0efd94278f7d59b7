#include "convex/nearest_point/methods/block_pivoting.hpp"

#include <Eigen/Cholesky>

#include "convex/nearest_point/complementarity.hpp"

namespace convex {
namespace {

/// Added to M, whose diagonal is 1.
constexpr double ridge = 1e-9;
constexpr int most_proximal_steps = 12;

/// Blocks that need not lower the number of wrong signs.
constexpr int patience = 3;

/// Signs are wrong beyond this part of the largest multiplier or bound.
constexpr double noise = 1e-13;

class Pivoting {
 public:
  explicit Pivoting(const Matrix& M) : M_(M), in_(static_cast<std::size_t>(M.rows()), false) {}

  /// Solves w = M y - c, y, w >= 0, y·w = 0 from the rows that the last call ended with; false at the limit.
  bool solve(const Vector& c, Index limit, Vector& y) {
    Index fewest = M_.rows() + 1;
    int left = patience;
    for (; steps_ < limit; ++steps_) {
      point(c, y);
      const std::vector<Index> wrong = wrong_rows(c, y);
      const Index count = static_cast<Index>(wrong.size());
      if (count == 0) return true;
      bool all = true;
      if (count < fewest) {
        fewest = count;
        left = patience;
      } else if (left > 0) {
        --left;
      } else {
        all = false;
      }
      for (std::size_t k = all ? 0 : wrong.size() - 1; k < wrong.size(); ++k) {
        const auto a = static_cast<std::size_t>(wrong[k]);
        in_[a] = !in_[a];
      }
    }
    return false;
  }
  Index steps() const { return steps_; }

 private:
  void point(const Vector& c, Vector& y) {
    std::vector<Index> rows;
    for (Index a = 0; a < c.size(); ++a)
      if (in_[static_cast<std::size_t>(a)]) rows.push_back(a);
    y.setZero(c.size());
    if (!rows.empty()) {
      const Eigen::LLT<Matrix> factor(Matrix(M_(rows, rows)));
      const Vector right = c(rows);
      Vector part = factor.solve(right);
      part += factor.solve(right - M_(rows, rows) * part);
      y(rows) = part;
    }
    w_.noalias() = M_ * y - c;
  }

  std::vector<Index> wrong_rows(const Vector& c, const Vector& y) const {
    std::vector<Index> rows;
    const double least = noise * (c.cwiseAbs().maxCoeff() + y.cwiseAbs().maxCoeff());
    for (Index a = 0; a < c.size(); ++a)
      if (in_[static_cast<std::size_t>(a)] ? y[a] < 0 : w_[a] < -least) rows.push_back(a);
    return rows;
  }

  const Matrix& M_;
  std::vector<bool> in_;
  Vector w_;
  Index steps_ = 0;
};

}  // namespace

Solution block_pivoting(const NearestPointProblem& problem, const Accuracy& accuracy) {
  validate(problem);
  if (const auto found = without_a_method(problem, "block-pivoting", accuracy)) return *found;
  const WhitenedProblem white(problem);
  const Complementarity lcp(white);
  const Index k = lcp.b.size();
  const Index limit = accuracy.step_limit > 0 ? accuracy.step_limit : 200 + 50 * k;
  const Matrix definite = lcp.M + ridge * Matrix::Identity(k, k);
  Pivoting pivoting(definite);
  Candidate candidate{.method = "block-pivoting", .q = {}, .lambda = {}, .farkas = {}};
  Vector center = Vector::Zero(k), y;
  Solution found;
  for (int step = 0; step < most_proximal_steps; ++step) {
    candidate.finished = pivoting.solve(lcp.b + ridge * center, limit, y);
    candidate.steps = pivoting.steps();
    candidate.lambda = white.multipliers(problem, lcp.with_free(white, y));
    candidate.farkas = white.weights(problem, lcp.with_free(white, y - center));
    found = judged(problem, candidate, accuracy);
    if (found.status == Status::solved || found.status == Status::infeasible || !candidate.finished)
      return found;
    center = y;
  }
  if (found.status == Status::inaccurate && !(found.error_bound < 1)) found.status = Status::gave_up;
  return found;
}

}  // namespace convex
