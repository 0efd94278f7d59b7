#include "convex/proved_prox/pair_of_sum.hpp"

#include "convex/exact_program/exact_arguments.hpp"
#include "convex/exact_program/program_of_call.hpp"
#include "convex/exact_program/program_operations.hpp"
#include "convex/proved_prox/pair_search.hpp"
#include "convex/proved_prox/proved_metric.hpp"

namespace convex::inline proved_prox {

std::optional<ProgramAndBall> program_and_ball(const std::vector<Call>& parts, bool conjugate,
                                               const ExactGram& W) {
  for (std::size_t k = 0; k < parts.size(); ++k) {
    const Call* ball = &parts[k];
    if (ball->name == "indicator")
      ball = std::get<std::shared_ptr<const Call>>(ball->arguments[0].value).get();
    if (ball->name != (conjugate ? "norm2" : "ball2")) continue;
    const ExactArguments a(*ball, W.dimension());
    for (std::size_t j = 0; j < parts.size(); ++j) {
      const auto program = exact_program(parts[j], W);
      if (!program) continue;
      if (conjugate)
        return ProgramAndBall{exact_programs::conjugate(*program), a.number("weight"),
                              Fractions(W.dimension()), j, k};
      return ProgramAndBall{*program, a.number("radius"), a.vector("center"), j, k};
    }
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

/// Pairs of the parts of a sum at one point, and what they add up to.
struct SharedPoint {
  std::vector<Call> parts;
  std::vector<ProofPair> of_parts;

  ProofPair sum() const {
    ProofPair all = of_parts.front();
    for (std::size_t k = 1; k < of_parts.size(); ++k) all = pairs::sum_at_one_point(all, of_parts[k]);
    return all;
  }
  /// With the covector v itself: one part takes what the others leave of it.
  /// (f + g)*(v) <= f*(u) + g*(v - u).
  pairs::MaybePair with_covector(const ExactGram& W, const Fractions& v) const {
    ProofPair all = sum();
    if (all.v == v) return all;
    const Fractions missing = difference(v, all.v);
    for (std::size_t k = 0; k < parts.size(); ++k) {
      const PairSearch taken = pair_at_covector(parts[k], W, all.x, pairs::sum_of(of_parts[k].v, missing));
      if (!taken.pair) continue;
      all.v = v;
      all.f_v = taken.pair->f_v;
      for (std::size_t other = 0; other < parts.size(); ++other)
        if (other != k) all.f_v = all.f_v + of_parts[other].f_v;
      all.is_rational = all.is_rational && taken.pair->is_rational;
      return all;
    }
    return std::nullopt;
  }
};

/// The parts at that very point whose pairs are not yet known: gradients, then of a program the covector
/// nearest to what they leave of v, then what is left at corners. False where one has none.
bool find_parts_at(SharedPoint& shared, std::vector<bool> known, const ExactGram& W, const Fractions& x,
                   const Fractions& v) {
  Fractions left = v;
  const auto take = [&](std::size_t k, PairSearch at) {
    if (!at.pair || at.pair->x != x) return false;
    left = difference(left, at.pair->v);
    shared.of_parts[k] = *std::move(at.pair);
    known[k] = true;
    return true;
  };
  for (std::size_t k = 0; k < known.size(); ++k)
    if (known[k]) left = difference(left, shared.of_parts[k].v);
  const std::size_t last = known.size() - 1;  // the programs, where there are any
  const bool has_program = exact_program(shared.parts[last], W).has_value();
  for (std::size_t k = 0; k < known.size(); ++k)
    if (!known[k] && !(has_program && k == last)) take(k, pair_at_point(shared.parts[k], W, x));
  if (has_program && !known[last] && !take(last, program_pair_towards(shared.parts[last], W, x, left)))
    take(last, pair_at_point(shared.parts[last], W, x));
  for (std::size_t k = 0; k < known.size(); ++k)
    if (!known[k] && !take(k, pair_of_call(shared.parts[k], W, x, left))) return false;
  return true;
}

/// Points near x that the parts of a sum share: one part takes what the others leave of v, or a program and a
/// ball do.
std::vector<SharedPoint> shared_points(const std::vector<Call>& parts, const ExactGram& W, const Fractions& x,
                                       const Fractions& v) {
  const std::size_t count = parts.size();
  const ProofPair nothing{x, Fractions(x.size()), only(Fraction{}), only(Fraction{}), true};
  std::vector<SharedPoint> found;
  // Pairs near x of some parts, from what the others leave of v, and those of the others at their point.
  const auto consider = [&](const std::vector<std::size_t>& free, const auto& pairs_near) {
    SharedPoint shared{parts, std::vector<ProofPair>(count, nothing)};
    std::vector<bool> is_free(count, false);
    for (const std::size_t k : free) is_free[k] = true;
    // Where the others are no functions at x itself, nothing is known of what they leave.
    const bool is_guessed = find_parts_at(shared, is_free, W, x, v);
    const std::vector<ProofPair> own = pairs_near(is_guessed ? difference(v, shared.sum().v) : v);
    if (own.empty()) return;
    for (std::size_t i = 0; i < free.size(); ++i) shared.of_parts[free[i]] = own[i];
    if (find_parts_at(shared, is_free, W, own.front().x, v)) found.push_back(std::move(shared));
  };
  for (std::size_t k = 0; k < count; ++k)
    consider({k}, [&](const Fractions& left) {
      PairSearch own = pair_of_call(parts[k], W, x, left);
      return own.pair ? std::vector<ProofPair>{*std::move(own.pair)} : std::vector<ProofPair>();
    });
  if (const auto both = program_and_ball(parts, false, W))
    consider({both->program, both->ball}, [&](const Fractions& left) {
      auto own = pairs::of_program_beside_ball(both->P, both->radius, both->centre, x, left);
      return own ? std::vector<ProofPair>{std::move(own->P), std::move(own->ball)} : std::vector<ProofPair>();
    });
  return found;
}

}  // namespace

PairSearch pair_of_sum(const Call& f, const ExactGram& W, const Fractions& x, const Fractions& v) {
  std::vector<pairs::MaybePair> candidates;
  for (const SharedPoint& shared : shared_points(parts_of_sum(f, W), W, x, v))
    candidates.push_back(shared.sum());
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
  SharedPoint shared{parts_of_sum(f, W), {}};
  for (const Call& part : shared.parts) {
    PairSearch at = pair_at_point(part, W, x);
    if (!at.pair) return at;
    shared.of_parts.push_back(*std::move(at.pair));
  }
  return {shared.sum(), {}};
}

}  // namespace convex::inline proved_prox
