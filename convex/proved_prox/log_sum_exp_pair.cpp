#include <algorithm>

#include "convex/proved_prox/pair_search.hpp"
#include "convex/proved_prox/proved_metric.hpp"

namespace convex::inline proved_prox::pairs {
namespace {

/// The values at x and at v >= 0 of sum 1, both looked at.
MaybePair simplex_pair(Fractions x, Fractions v) {
  const Fraction most = *std::max_element(x.begin(), x.end());
  Ball sum = ball(Fraction{}), entropy = ball(Fraction{});
  for (std::size_t i = 0; i < x.size(); ++i) {
    sum = sum + exp(ball(x[i] - most));
    if (sign(v[i]) > 0) entropy = entropy + ball(v[i]) * log(ball(v[i]));
  }
  const auto f_x = interval(ball(most) + log(sum)), f_v = interval(entropy);
  if (!f_x || !f_v) return std::nullopt;
  return ProofPair{std::move(x), std::move(v), *f_x, *f_v, false};
}

/// v >= 0 with the sum 1, exactly; none where nothing of it is positive.
std::optional<Fractions> on_simplex(Fractions v) {
  Fraction sum;
  for (Fraction& entry : v) {
    if (sign(entry) < 0) entry = Fraction{};
    sum = sum + entry;
  }
  if (sign(sum) <= 0) return std::nullopt;
  return multiple_of(Fraction{1} / sum, std::move(v));
}

}  // namespace

MaybePair log_sum_exp_at_point(const Fractions& x) {
  const Fraction most = *std::max_element(x.begin(), x.end());
  // e^x_i over their sum; what is nothing beside it counts as 0, any point of the simplex will do.
  const Fraction far{-1000};
  Fractions gradient;
  for (const Fraction& entry : x)
    gradient.push_back(entry - most < far ? Fraction{} : near(exp(ball(entry - most))).value_or(Fraction{}));
  const auto on = on_simplex(std::move(gradient));
  return on ? simplex_pair(x, *on) : std::nullopt;
}

MaybePair of_log_sum_exp(const Fractions& x, const Fractions& v) {
  std::vector<MaybePair> candidates{log_sum_exp_at_point(x)};
  if (const auto at_v = on_simplex(v)) {
    candidates.push_back(simplex_pair(x, *at_v));
    // log v + c, c the mean of x - log v.
    Fractions logs;
    Fraction shift;
    for (std::size_t i = 0; i < x.size(); ++i) {
      const auto one = sign((*at_v)[i]) > 0 ? near(log(ball((*at_v)[i]))) : std::nullopt;
      if (!one) return best_of(std::move(candidates), x, v);
      logs.push_back(*one);
      shift = shift + x[i] - *one;
    }
    shift = shift / Fraction{static_cast<std::int64_t>(x.size())};
    for (Fraction& entry : logs) entry = entry + shift;
    candidates.push_back(simplex_pair(std::move(logs), *at_v));
  }
  return best_of(std::move(candidates), x, v);
}

}  // namespace convex::inline proved_prox::pairs
