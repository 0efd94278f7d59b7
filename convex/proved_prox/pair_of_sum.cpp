#include "convex/proved_prox/pair_of_sum.hpp"

#include "convex/exact_program/exact_arguments.hpp"
#include "convex/exact_program/program_of_call.hpp"
#include "convex/exact_program/program_operations.hpp"
#include "convex/proved_prox/pair_search.hpp"
#include "convex/proved_prox/proved_metric.hpp"

namespace convex::inline proved_prox {

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

/// Of two functions at one x the pair of their sum: (f + g)*(v + w) <= f*(v) + g*(w).
void add_covector(ProofPair& sum, const ProofPair& part) {
  sum.v = pairs::sum_of(sum.v, part.v);
  sum.f_x = sum.f_x + part.f_x;
  sum.f_v = sum.f_v + part.f_v;
  sum.is_rational = sum.is_rational && part.is_rational;
}

/// Pairs of the parts of a sum at one point, and what they add up to.
struct SharedPoint {
  std::vector<Call> parts;
  std::vector<ProofPair> pairs;

  ProofPair sum() const {
    const std::size_t n = pairs.front().x.size();
    ProofPair all{pairs.front().x, Fractions(n), only(Fraction{}), only(Fraction{}), true};
    for (const ProofPair& pair : pairs) add_covector(all, pair);
    return all;
  }
  /// With the covector v itself: one part takes what the others leave of it.
  /// (f + g)*(v) <= f*(u) + g*(v - u).
  pairs::MaybePair with_covector(const ExactGram& W, const Fractions& v) const {
    ProofPair all = sum();
    if (all.v == v) return all;
    const Fractions missing = difference(v, all.v);
    for (std::size_t k = 0; k < parts.size(); ++k) {
      const PairSearch taken = pair_at_covector(parts[k], W, all.x, pairs::sum_of(pairs[k].v, missing));
      if (!taken.pair) continue;
      all.v = v;
      all.f_v = taken.pair->f_v;
      for (std::size_t other = 0; other < parts.size(); ++other)
        if (other != k) all.f_v = all.f_v + pairs[other].f_v;
      all.is_rational = all.is_rational && taken.pair->is_rational;
      return all;
    }
    return std::nullopt;
  }
};

/// The part at that very point: its gradient, or where it has a corner a covector towards v.
PairSearch part_of_sum_at(const Call& part, const ExactGram& W, const Fractions& x, const Fractions& v) {
  PairSearch at = pair_at_point(part, W, x);
  if (at.pair) return at;
  PairSearch corner = pair_of_call(part, W, x, v);
  return corner.pair && corner.pair->x == x ? corner : at;
}

/// Points near x that the parts of a sum share: one part takes what the gradients of the others leave of v.
std::vector<SharedPoint> shared_points(const std::vector<Call>& parts, const ExactGram& W, const Fractions& x,
                                       const Fractions& v) {
  std::vector<SharedPoint> found;
  for (std::size_t free = 0; free < parts.size(); ++free) {
    // The parts at a point, beside the pair of the free one.
    const auto parts_at = [&](const Fractions& point, const ProofPair& own) -> std::optional<SharedPoint> {
      SharedPoint shared{parts, std::vector<ProofPair>(parts.size(), own)};
      Fractions left = difference(v, own.v);
      for (std::size_t k = 0; k < parts.size(); ++k) {
        if (k == free) continue;
        PairSearch at = part_of_sum_at(parts[k], W, point, left);
        if (!at.pair) return std::nullopt;
        if (parts.size() == 2) {
          PairSearch towards = program_pair_towards(parts[k], W, point, v);
          if (towards.pair) at = std::move(towards);
        }
        left = difference(left, at.pair->v);
        shared.pairs[k] = *std::move(at.pair);
      }
      return shared;
    };
    const ProofPair nothing{x, Fractions(x.size()), only(Fraction{}), only(Fraction{}), true};
    // Where the others are no functions at x itself, they say what is left of v at the point of the free one.
    const auto guess = parts_at(x, nothing);
    const Fractions left = guess ? difference(v, guess->sum().v) : v;
    const PairSearch own = pair_of_call(parts[free], W, x, left);
    if (!own.pair) continue;
    if (auto shared = parts_at(own.pair->x, *own.pair)) found.push_back(*std::move(shared));
  }
  return found;
}

}  // namespace

PairSearch pair_of_sum(const Call& f, const ExactGram& W, const Fractions& x, const Fractions& v) {
  const std::vector<Call> parts = parts_of_sum(f, W);
  std::vector<pairs::MaybePair> candidates;
  for (const SharedPoint& shared : shared_points(parts, W, x, v)) candidates.push_back(shared.sum());
  if (const auto both = program_and_ball(parts, false, W))
    candidates.push_back(pairs::of_program_and_ball(both->P, both->radius, both->centre, x, v));
  if (auto best = pairs::best_of(std::move(candidates), x, v)) return {std::move(best), {}};
  return {{}, f.name + ": more than one of its parts has a corner at the point"};
}

PairSearch sum_at_covector(const Call& f, const ExactGram& W, const Fractions& x, const Fractions& v) {
  std::vector<pairs::MaybePair> candidates;
  for (const SharedPoint& shared : shared_points(parts_of_sum(f, W), W, x, v))
    candidates.push_back(shared.with_covector(W, v));
  if (auto best = pairs::best_of(std::move(candidates), x, v)) return {std::move(best), {}};
  return {{}, f.name + ": no part takes of the covector what the others leave"};
}

PairSearch sum_at_point(const Call& f, const ExactGram& W, const Fractions& x) {
  ProofPair sum{x, Fractions(x.size()), only(Fraction{}), only(Fraction{}), true};
  for (const Call& part : parts_of_sum(f, W)) {
    const PairSearch at = pair_at_point(part, W, x);
    if (!at.pair) return at;
    add_covector(sum, *at.pair);
  }
  return {std::move(sum), {}};
}

}  // namespace convex::inline proved_prox
