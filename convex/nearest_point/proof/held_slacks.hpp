#pragma once

#include <algorithm>
#include <cmath>
#include <vector>

#include "convex/nearest_point/proof/open_rows.hpp"

namespace convex::inline proof {

/// What is known of the slacks of rows that are not held.
class HeldSlacks {
 public:
  HeldSlacks(const NearestPointProblem& problem, const RadiiOf& radii, const Preconditioned& P,
             const std::vector<Index>& rows, const HeldPoint& point)
      : problem_(problem), radii_(radii), point_(point), held_(marked(problem.rows(), rows)) {
    // |v_i| <= ||v||_A sqrt((A⁻¹)_ii), and A⁻¹ = Xᵀ A'⁻¹ X.
    const Index n = P.dimension();
    per_length_.resize(n);
    for (Index i = 0; i < n; ++i) per_length_[i] = P.is_diagonal ? std::abs(P.x[i]) : norm_above(P.X.col(i));
    per_length_ *= above(1 / std::sqrt(below(1 - P.delta)));
    size_ = above(1) * (point.q.cwiseAbs() + point.dq.cwiseAbs());
  }

  /// The rows whose slack may be gone, and all two-sided ones, when the held point moves by `reach` in
  /// ||·||_A.
  std::vector<OpenRow> open(double reach) const {
    const Index n = problem_.dimension();
    const Vector hidden = above(1) * (point_.radius + reach) * per_length_;
    const Vector loose = gamma(n + 1) * point_.q.cwiseAbs() + above(1) * point_.dq.cwiseAbs() + hidden;
    std::vector<OpenRow> found;
    Vector row(n);
    for (Index a = 0; a < problem_.rows(); ++a) {
      if (held_[at(a)]) continue;
      problem_.U.copy_row(a, row);
      const double s = problem_.s[a];
      const double uncertain = above(radii_.s(a) + radii_.row_times(a, size_ + hidden));
      const bool is_two_sided = problem_.is_two_sided(a);
      if (!is_two_sided &&
          row.dot(point_.q) - s > above(row.cwiseAbs().dot(loose) + gamma(n + 1) * std::abs(s) + uncertain))
        continue;
      CompensatedSum sum;
      sum.add(-s, 1);
      for (Index i = 0; i < n; ++i) {
        sum.add(row[i], point_.q[i]);
        sum.add(row[i], point_.dq[i]);
      }
      const Enclosed slack = sum.result();
      const double still = above(slack.radius + row.cwiseAbs().dot(hidden) + uncertain);
      if (!is_two_sided && below(slack.value) > still) continue;
      // At the held point itself.
      const double off =
          above(slack.radius + row.cwiseAbs().dot(Vector(point_.radius * per_length_)) + uncertain);
      found.push_back({a, above(std::max(0.0, off - slack.value))});
    }
    return found;
  }

 private:
  const NearestPointProblem& problem_;
  const RadiiOf& radii_;
  const HeldPoint& point_;
  std::vector<bool> held_;
  Vector per_length_, size_;
};

}  // namespace convex::inline proof
