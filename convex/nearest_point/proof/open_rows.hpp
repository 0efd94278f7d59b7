#pragma once

#include <algorithm>
#include <cmath>
#include <optional>
#include <vector>

#include "convex/nearest_point/proof/held_point.hpp"

namespace convex::inline proof {

/// A row that is not held and whose slack at the held point may be negative, by `below_zero` at most.
struct OpenRow {
  Index row = 0;
  double below_zero = 0;
};

/// What is known of the slacks of rows that are not held.
class HeldSlacks {
 public:
  explicit HeldSlacks(const HeldRows& held)
      : problem_(held.problem),
        radii_(held.radii),
        point_(held.point),
        held_(marked(held.problem.rows(), held.rows)) {
    const Preconditioned& P = held.P;
    // |v_i| <= ||v||_A sqrt((A⁻¹)_ii), and A⁻¹ = Xᵀ A'⁻¹ X.
    const Index n = P.dimension();
    per_length_.resize(n);
    for (Index i = 0; i < n; ++i) per_length_[i] = P.is_diagonal ? std::abs(P.x[i]) : norm_above(P.X.col(i));
    per_length_ *= above(1 / std::sqrt(below(1 - P.delta)));
    size_ = above(1) * (point_.q.cwiseAbs() + point_.dq.cwiseAbs());
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

/// Coefficients c of the combination U_Sᵀc of the working set that is nearest to u, as doubles find them.
Vector coefficients_on_held(const HeldRows&, const Vector& u);

/// How far the solution q* is from the point q_S of the working set when rows besides may be violated there:
/// rows that depend on those held, or do but for rounding.
struct OpenBound {
  double shift = 0;  ///< ||q* - q_S||_A at most
  double reach =
      0;  ///< rows whose slack no motion of this length in ||·||_A takes away were rightly left out
};

/// Proved for every problem within the radii (docs/proof.md, section 3, "Rows that depend on others"), from a
/// direction that opens all rows, found on the way; it proves that there is a solution, too. None where there
/// is no such direction, or a multiplier of a row of the working set may be 0.
std::optional<OpenBound> bound_with_open_rows(const HeldRows&, const std::vector<OpenRow>&);

}  // namespace convex::inline proof
