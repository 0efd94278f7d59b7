#include <algorithm>

#include "convex/catalogue/catalogue.hpp"
#include "convex/exact_program/exact_arguments.hpp"
#include "convex/exact_program/program_of_call.hpp"
#include "convex/exact_program/program_operations.hpp"
#include "convex/proved_prox/pair_of_call.hpp"
#include "convex/proved_prox/pair_search.hpp"
#include "convex/proved_prox/proved_metric.hpp"

namespace convex::inline proved_prox {
namespace {

/// The parts of a sum: those with programs as one, the others each.
std::vector<Call> parts_of_sum(const Call& f, const ExactGram& W) {
  const ExactArguments a(f, W.dimension());
  Call programs{"sum", {}, {}};
  std::vector<Call> parts;
  for (const Call* one : a.calls()) {
    if (exact_program(*one, W))
      programs.arguments.push_back(argument(*one));
    else
      parts.push_back(*one);
  }
  if (!programs.arguments.empty()) parts.push_back(std::move(programs));
  return parts;
}

/// Where both parts have corners: a program and a ball, or the norm that supports one.
struct ProgramAndBall {
  ExactProgram P;
  Fraction radius;
  Fractions centre;
};

std::optional<ProgramAndBall> program_and_ball(const std::vector<Call>& parts, bool conjugate,
                                               const ExactGram& W) {
  if (parts.size() != 2) return std::nullopt;
  for (const std::size_t k : {0, 1}) {
    const Call* ball = &parts[1 - k];
    if (ball->name == "indicator")
      ball = std::get<std::shared_ptr<const Call>>(ball->arguments[0].value).get();
    if (ball->name != (conjugate ? "norm2" : "ball2")) continue;
    const auto program = exact_program(parts[k], W);
    if (!program) continue;
    const ExactArguments a(*ball, W.dimension());
    if (conjugate)
      return ProgramAndBall{exact_programs::conjugate(*program), a.number("weight"),
                            Fractions(W.dimension())};
    return ProgramAndBall{*program, a.number("radius"), a.vector("center")};
  }
  return std::nullopt;
}

/// Of a program at x, with the subgradient nearest to v: that of a short step along v.
PairSearch program_pair_towards(const Call& f, const ExactGram& W, const Fractions& x, const Fractions& v) {
  const auto program = exact_program(f, W);
  if (!program) return {};
  const Fraction step = fraction(0x1p-20);
  ExactGram V = identity_gram(x.size());
  for (std::size_t i = 0; i < x.size(); ++i) V.rows[i] = {{i, Fraction{1} / step}};
  const auto moved = exact_prox(*program, V, pairs::sum_of(x, pairs::multiple_of(step, v))).at;
  if (!moved) return {};
  auto at = near_graph_point(*program, nearest(pairs::sum_of(x, moved->v)));
  if (!at || at->x != x) return {};
  return {proof_pair(std::move(*at)), {}};
}

/// Of two functions at one x the pair of their sum: (f + g)*(v + w) <= f*(v) + g*(w).
void add_covector(ProofPair& sum, const ProofPair& part) {
  sum.v = pairs::sum_of(sum.v, part.v);
  sum.f_x = sum.f_x + part.f_x;
  sum.f_v = sum.f_v + part.f_v;
  sum.is_rational = sum.is_rational && part.is_rational;
}

/// f_1 + f_2 + …: one part takes what the gradients of the others leave of v, at a point that they share.
PairSearch pair_of_sum(const Call& f, const ExactGram& W, const Fractions& x, const Fractions& v) {
  const std::vector<Call> parts = parts_of_sum(f, W);
  std::vector<pairs::MaybePair> candidates;
  for (std::size_t free = 0; free < parts.size(); ++free) {
    const auto others_at = [&](const Fractions& point) -> pairs::MaybePair {
      ProofPair sum{point, Fractions(x.size()), only(Fraction{}), only(Fraction{}), true};
      for (std::size_t k = 0; k < parts.size(); ++k) {
        if (k == free) continue;
        PairSearch at = pair_at_point(parts[k], W, point);
        if (!at.pair) return std::nullopt;
        if (parts.size() == 2) {
          PairSearch towards = program_pair_towards(parts[k], W, point, v);
          if (towards.pair) at = std::move(towards);
        }
        add_covector(sum, *at.pair);
      }
      return sum;
    };
    // Where the others are no functions at x itself, they say what is left of v at the point of the free one.
    const pairs::MaybePair guess = others_at(x);
    const Fractions left = guess ? difference(v, guess->v) : v;
    const PairSearch own = pair_of_call(parts[free], W, x, left);
    if (!own.pair) continue;
    pairs::MaybePair whole = others_at(own.pair->x);
    if (!whole) continue;
    add_covector(*whole, *own.pair);
    candidates.push_back(std::move(whole));
  }
  if (const auto both = program_and_ball(parts, false, W))
    candidates.push_back(pairs::of_program_and_ball(both->P, both->radius, both->centre, x, v));
  if (auto best = pairs::best_of(std::move(candidates), x, v)) return {std::move(best), {}};
  return {{}, f.name + ": more than one of its parts has a corner at the point"};
}

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
    if (auto dual = pairs::of_program_and_ball(both->P, both->radius, both->centre, v, x))
      candidates.push_back(turned_round(std::move(*dual)));
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

/// f(Ax + b) where f is differentiable at Ax + b: (f ∘ A)*(Aᵀu) <= f*(u) - b·u.
PairSearch pair_of_precompose(const Call& f, const ExactGram& W, const Fractions& x) {
  const ExactArguments a(f, W.dimension());
  const std::vector<ExactRow> A = a.rows("A");
  const Fractions b = a.is_vector("b") ? a.vector("b") : Fractions(A.size(), a.number("b"));
  Fractions image(A.size());
  for (std::size_t i = 0; i < A.size(); ++i) image[i] = dot(A[i], x) + b[i];
  PairSearch inner = pair_at_point(a.call("f"), identity_gram(A.size()), image);
  if (!inner.pair) return {{}, f.name + ": its function has a corner at the point"};
  Fractions v(x.size());
  for (std::size_t i = 0; i < A.size(); ++i)
    for (const auto& [j, value] : A[i]) v[j] = v[j] + value * inner.pair->v[i];
  const FractionInterval f_v = inner.pair->f_v + only(-dot(b, inner.pair->v));
  return {ProofPair{x, std::move(v), inner.pair->f_x, f_v, inner.pair->is_rational}, {}};
}

/// Of the parts at x: of each gradient, so that the covectors add up.
PairSearch sum_at_point(const Call& f, const ExactGram& W, const Fractions& x) {
  ProofPair sum{x, Fractions(x.size()), only(Fraction{}), only(Fraction{}), true};
  for (const Call& part : parts_of_sum(f, W)) {
    const PairSearch at = pair_at_point(part, W, x);
    if (!at.pair) return at;
    add_covector(sum, *at.pair);
  }
  return {std::move(sum), {}};
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
