#include <algorithm>

#include "convex/catalogue/catalogue.hpp"
#include "convex/exact_program/exact_arguments.hpp"
#include "convex/proved_prox/pair_of_call.hpp"
#include "convex/proved_prox/pair_of_sum.hpp"
#include "convex/proved_prox/pair_search.hpp"
#include "convex/proved_prox/proved_metric.hpp"

namespace convex::inline proved_prox {
namespace {

/// f □ g at x_1 + x_2, both with the covector v.
PairSearch pair_of_inf_convolution(const Call& f, const ExactGram& W, const Fractions& x,
                                   const Fractions& v) {
  const ExactArguments a(f, W.dimension());
  const Call* parts[] = {&a.call("f"), &a.call("g")};
  std::vector<pairs::MaybePair> candidates;
  for (int free : {0, 1}) {
    const PairSearch guess = pair_at_covector(*parts[1 - free], W, v);
    if (!guess.pair) continue;
    const PairSearch own = pair_of_call(*parts[free], W, difference(x, guess.pair->x), v);
    if (!own.pair) continue;
    const PairSearch other = pair_at_covector(*parts[1 - free], W, own.pair->v);
    if (!other.pair) continue;
    candidates.push_back(ProofPair{pairs::sum_of(own.pair->x, other.pair->x), own.pair->v,
                                   own.pair->f_x + other.pair->f_x, own.pair->f_v + other.pair->f_v,
                                   own.pair->is_rational && other.pair->is_rational});
  }
  if (const auto both = program_and_ball({*parts[0], *parts[1]}, true, W))
    if (const auto dual = pairs::of_program_beside_ball(both->P, both->radius, both->centre, v, x))
      candidates.push_back(turned_round(pairs::sum_at_one_point(dual->P, dual->ball)));
  if (auto best = pairs::best_of(std::move(candidates), x, v)) return {std::move(best), {}};
  return {{}, f.name + ": the conjugates of both parts have a corner at the covector"};
}

/// A pair of the part at x, of several covectors one towards v.
pairs::MaybePair at_point_towards(const Call& part, const ExactGram& W, const Fractions& x,
                                  const Fractions& v) {
  if (auto towards = program_pair_towards(part, W, x, v).pair) return towards;
  return pair_at_point(part, W, x).pair;
}

/// Where two parts are equal, the largest: x moved by what rounding leaves between their values, and t of one
/// covector with 1 - t of the other, for max(f, g)*(t v + (1 - t) w) <= t f*(v) + (1 - t) g*(w).
pairs::MaybePair pair_of_equal_parts(const Call& first, const Call& second, const ExactGram& W, Fractions x,
                                     const Fractions& v) {
  constexpr int most_steps = 3;
  Fraction t{1, 2};
  Fractions towards_first = v, towards_second = v;
  for (int step = 0;; ++step) {
    const auto p = at_point_towards(first, W, x, towards_first),
               q = at_point_towards(second, W, x, towards_second);
    if (!p || !q) return std::nullopt;
    const Fractions apart = difference(p->v, q->v);
    const Fraction square = pairs::square_of(apart);
    if (sign(square) == 0) return std::nullopt;
    t = fraction(std::clamp(nearest_double(dot(apart, difference(v, q->v)) / square), 0.0, 1.0));
    const Fraction rest = Fraction{1} - t;
    if (step == most_steps) {
      FractionInterval f_x = p->f_x;
      if (f_x.low < q->f_x.low) f_x.low = q->f_x.low;
      if (f_x.high < q->f_x.high) f_x.high = q->f_x.high;
      return ProofPair{std::move(x), pairs::sum_of(q->v, pairs::multiple_of(t, apart)), f_x,
                       times(t, p->f_v) + times(rest, q->f_v), p->is_rational && q->is_rational};
    }
    if (sign(t) > 0)
      towards_first = pairs::multiple_of(Fraction{1} / t, difference(v, pairs::multiple_of(rest, q->v)));
    if (sign(rest) > 0)
      towards_second = pairs::multiple_of(Fraction{1} / rest, difference(v, pairs::multiple_of(t, p->v)));
    const Fraction above = p->f_x.high - q->f_x.high;
    for (std::size_t i = 0; i < x.size(); ++i)
      x[i] = x[i] - fraction(nearest_double(above * apart[i] / square));
  }
}

bool is_indicator(const Call& f) {
  return f.name == "indicator" || find_entry(f.name)->kind == EntryKind::set;
}

/// The part that is largest at x, where it is so alone, or two that are.
PairSearch pair_of_max(const Call& f, const ExactGram& W, const Fractions& x, const Fractions& v) {
  const ExactArguments a(f, W.dimension());
  const std::vector<const Call*> parts = a.calls();
  std::vector<pairs::MaybePair> candidates;
  const auto consider = [&](pairs::MaybePair own) {
    if (!own) return;
    for (const Call* other : parts) {
      const PairSearch at = pair_at_point(*other, W, own->x);
      if (!at.pair) return;
      if (own->f_x.high < at.pair->f_x.high) own->f_x.high = at.pair->f_x.high;
    }
    candidates.push_back(std::move(own));
  };
  for (std::size_t k = 0; k < parts.size(); ++k) {
    consider(pair_of_call(*parts[k], W, x, v).pair);
    for (std::size_t j = 0; j < k; ++j) consider(pair_of_equal_parts(*parts[j], *parts[k], W, x, v));
    // Beside indicators it is at least the sum of these and of f_k.
    if (is_indicator(*parts[k])) continue;
    Call sum{"sum", {argument(*parts[k])}, {}};
    for (const Call* other : parts)
      if (is_indicator(*other)) sum.arguments.push_back(argument(*other));
    if (sum.arguments.size() > 1) consider(pair_of_sum(sum, W, x, v).pair);
  }
  if (auto best = pairs::best_of(std::move(candidates), x, v)) return {std::move(best), {}};
  return {{}, f.name + ": a part cannot be valued at the point of another"};
}

/// Ax + b, and the function there where it is differentiable.
struct Image {
  std::vector<ExactRow> A;
  Fractions b, point;
  PairSearch inner;

  Image(const Call& f, const ExactArguments& a, const Fractions& x)
      : A(a.rows("A")),
        b(a.is_vector("b") ? a.vector("b") : Fractions(A.size(), a.number("b"))),
        point(A.size()) {
    for (std::size_t i = 0; i < A.size(); ++i) point[i] = dot(A[i], x) + b[i];
    inner = pair_at_point(a.call("f"), identity_gram(A.size()), point);
    if (!inner.pair) inner.why_none = f.name + ": its function has a corner at the point";
  }
};

/// f(Ax + b): (f ∘ A)*(Aᵀu) <= f*(u) - b·u.
PairSearch pair_of_precompose(const Call& f, const ExactGram& W, const Fractions& x) {
  const Image image(f, ExactArguments(f, W.dimension()), x);
  if (!image.inner.pair) return image.inner;
  const ProofPair& inner = *image.inner.pair;
  Fractions v(x.size());
  for (std::size_t i = 0; i < image.A.size(); ++i)
    for (const auto& [j, value] : image.A[i]) v[j] = v[j] + value * inner.v[i];
  return {ProofPair{x, std::move(v), inner.f_x, inner.f_v + only(-dot(image.b, inner.v)), inner.is_rational},
          {}};
}

/// The same with a u near the gradient and Aᵀu = v.
PairSearch precompose_at_covector(const Call& f, const ExactGram& W, const Fractions& x, const Fractions& v) {
  const ExactArguments a(f, W.dimension());
  const Image image(f, a, x);
  if (!image.inner.pair) return image.inner;
  std::vector<ExactEquation> equations(v.size());
  for (std::size_t j = 0; j < v.size(); ++j) equations[j].right = v[j];
  for (std::size_t i = 0; i < image.A.size(); ++i)
    for (const auto& [j, value] : image.A[i]) equations[j].row.emplace(i, value);
  const auto u = solve_near(std::move(equations), image.inner.pair->v);
  if (!u) return {{}, f.name + ": the covector is in no image of the transpose of A"};
  PairSearch taken = pair_at_covector(a.call("f"), identity_gram(image.A.size()), image.point, *u);
  if (!taken.pair) return taken;
  const FractionInterval f_v = taken.pair->f_v + only(-dot(image.b, *u));
  return {ProofPair{x, v, image.inner.pair->f_x, f_v, false}, {}};
}

/// The part that is largest at x.
PairSearch max_at_point(const Call& f, const ExactGram& W, const Fractions& x) {
  const ExactArguments a(f, W.dimension());
  PairSearch largest;
  Fraction high;
  for (const Call* part : a.calls()) {
    PairSearch at = pair_at_point(*part, W, x);
    if (!at.pair) return at;
    if (!largest.pair || high < at.pair->f_x.high) high = at.pair->f_x.high;
    if (!largest.pair || largest.pair->f_x.low < at.pair->f_x.low) largest = std::move(at);
  }
  if (largest.pair) largest.pair->f_x.high = high;
  return largest;
}

}  // namespace

PairSearch combination_at_point(const Call& f, const ExactGram& W, const Fractions& x) {
  if (f.name == "sum" || f.name == "intersection") return sum_at_point(f, W, x);
  if (f.name == "pointwise_max") return max_at_point(f, W, x);
  if (f.name == "precompose") return pair_of_precompose(f, W, x);
  return {{}, f.name + ": no pair at a point that another part chooses"};
}

PairSearch combination_near_covector(const Call& f, const ExactGram& W, const Fractions& x,
                                     const Fractions& v) {
  if (f.name == "sum" || f.name == "intersection") return sum_at_covector(f, W, x, v);
  if (f.name == "precompose") return precompose_at_covector(f, W, x, v);
  PairSearch found = pair_of_call(f, W, x, v);
  if (found.pair && !(found.pair->v == v)) return {{}, f.name + ": no pair at the covector itself"};
  return found;
}

PairSearch combination_at_covector(const Call& f, const ExactGram& W, const Fractions& v) {
  if (f.name != "inf_convolution") return {{}, f.name + ": no pair at a covector that another part chooses"};
  const ExactArguments a(f, W.dimension());
  PairSearch first = pair_at_covector(a.call("f"), W, v);
  if (!first.pair) return first;
  const PairSearch second = pair_at_covector(a.call("g"), W, v);
  if (!second.pair) return second;
  ProofPair& sum = *first.pair;
  sum.x = pairs::sum_of(sum.x, second.pair->x);
  sum.f_x = sum.f_x + second.pair->f_x;
  sum.f_v = sum.f_v + second.pair->f_v;
  sum.is_rational = sum.is_rational && second.pair->is_rational;
  return first;
}

PairSearch pair_of_combination(const Call& f, const ExactGram& W, const Fractions& x, const Fractions& v) {
  if (f.name == "sum" || f.name == "intersection") return pair_of_sum(f, W, x, v);
  if (f.name == "inf_convolution") return pair_of_inf_convolution(f, W, x, v);
  if (f.name == "pointwise_max") return pair_of_max(f, W, x, v);
  if (f.name == "precompose") return pair_of_precompose(f, W, x);
  return {{}, f.name + " has no formula in balls"};
}

}  // namespace convex::inline proved_prox
