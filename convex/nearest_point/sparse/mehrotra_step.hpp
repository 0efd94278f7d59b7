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

/// Mehrotra's predictor-corrector step (1992) for A q - Uᵀlambda = z, U q - slack = s, slack ∘ lambda = 0,
/// with Gondzio's correctors (1996): a short step is made longer by pulling the products that it would leave
/// far from their mean towards that, at the price of a solve with the same factor.
class MehrotraStep {
 public:
  explicit MehrotraStep(const std::vector<bool>& two_sided) : two_sided_(two_sided) {
    for (const bool is : two_sided) one_sided_count_ += !is;
  }

  /// Correctors of a step, at most: none unless told.
  void set_correctors(int most) { most_correctors_ = most; }

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
    const double step = corrected(at, short_of_boundary, centring * before, solve);
    at.q += step * to_.q;
    at.slack += step * to_.slack;
    at.lambda += step * to_.lambda;
    return step;
  }

 private:
  /// No correctors where a step is this long; products are to be within a factor of
  /// their mean for a step that much longer, of which a corrector must gain a part to be followed by another.
  static constexpr double long_step = 0.9, longer_by = 0.3, factor = 10, gain = 0.1;

  template <class Solve>
  double corrected(const InteriorPointState& at, double short_of_boundary, double mean, Solve solve) {
    const auto length = [&] { return std::min(1.0, short_of_boundary * longest(at)); };
    double step = length();
    for (int k = 0; k < most_correctors_ && step < long_step; ++k) {
      const double ahead = std::min(1.0, step + longer_by);
      for (Index a = 0; a < target_.size(); ++a) {
        if (!one_sided(a)) continue;
        const double product = (at.slack[a] + ahead * to_.slack[a]) * (at.lambda[a] + ahead * to_.lambda[a]);
        target_[a] += std::max(std::clamp(product, mean / factor, factor * mean) - product, -factor * mean);
      }
      std::swap(before_, to_);
      solve(target_, to_);
      const double longer = length();
      if (longer < step) {
        std::swap(before_, to_);
        break;
      }
      const bool is_worth_it = longer >= step + gain * longer_by;
      step = longer;
      if (!is_worth_it) break;
    }
    return step;
  }

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
  InteriorPointState to_, before_;
  int most_correctors_ = 0;
};

}  // namespace convex::inline sparse
