#pragma once

#include <algorithm>
#include <cmath>
#include <vector>

#include "convex/infinity.hpp"
#include "convex/vector.hpp"

namespace convex::inline sparse {

/// A point inside: slack = Uq - s and lambda positive on one-sided rows, slack 0 on two-sided ones. Also a
/// direction there.
struct InteriorPointState {
  Vector q, slack, lambda;
};

/// Mehrotra's predictor-corrector step (1992) for A q - Uᵀlambda = z, U q - slack = s, slack ∘ lambda = 0.
class MehrotraStep {
 public:
  explicit MehrotraStep(const std::vector<bool>& two_sided) : two_sided_(two_sided) {
    for (const bool is : two_sided) one_sided_count_ += !is;
  }

  bool one_sided(Index a) const { return !two_sided_[static_cast<std::size_t>(a)]; }
  double count() const { return static_cast<double>(std::max<Index>(1, one_sided_count_)); }

  /// The mean of lambda ∘ slack over one-sided rows.
  double mean(const InteriorPointState& at) const { return at.slack.dot(at.lambda) / count(); }

  /// Takes one. solve(target, to): the direction `to` with lambda dslack + slack dlambda = target on
  /// one-sided rows, dslack = 0 on the others, towards the two linear equations. Returns the part of it that
  /// was taken, `short_of_boundary` of the way there at most.
  template <class Solve>
  double take(InteriorPointState& at, double short_of_boundary, Solve solve) {
    target_ = -at.slack.cwiseProduct(at.lambda);
    solve(target_, to_);  // the predictor: complementarity at once
    const double reach = std::min(1.0, longest(at)), before = mean(at);
    const double ahead = (at.slack + reach * to_.slack).dot(at.lambda + reach * to_.lambda) / count();
    const double centring = before > 0 ? std::pow(std::max(0.0, ahead) / before, 3) : 0;
    for (Index a = 0; a < target_.size(); ++a)
      if (one_sided(a)) target_[a] += centring * before - to_.slack[a] * to_.lambda[a];
    solve(target_, to_);
    const double step = std::min(1.0, short_of_boundary * longest(at));
    at.q += step * to_.q;
    at.slack += step * to_.slack;
    at.lambda += step * to_.lambda;
    return step;
  }

 private:
  /// The step that keeps slack and lambda nonnegative.
  double longest(const InteriorPointState& at) const {
    double step = infinity;
    for (Index a = 0; a < at.lambda.size(); ++a) {
      if (!one_sided(a)) continue;
      if (to_.slack[a] < 0) step = std::min(step, -at.slack[a] / to_.slack[a]);
      if (to_.lambda[a] < 0) step = std::min(step, -at.lambda[a] / to_.lambda[a]);
    }
    return step;
  }

  const std::vector<bool>& two_sided_;
  Index one_sided_count_ = 0;
  Vector target_;
  InteriorPointState to_;
};

}  // namespace convex::inline sparse
