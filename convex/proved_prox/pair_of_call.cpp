#include "convex/proved_prox/pair_of_call.hpp"

#include <cmath>

#include "convex/catalogue/catalogue.hpp"
#include "convex/exact_program/exact_arguments.hpp"
#include "convex/exact_program/linear_equations.hpp"
#include "convex/exact_program/program_of_call.hpp"
#include "convex/exact_program/program_operations.hpp"
#include "convex/proved_prox/entry_formulas.hpp"
#include "convex/proved_prox/joined_pairs.hpp"
#include "convex/proved_prox/pair_search.hpp"
#include "convex/proved_prox/proved_metric.hpp"

namespace convex::inline proved_prox {
namespace {

using pairs::MaybePair;

/// A full metric of more entries is not solved with in fractions.
constexpr std::size_t most_solved_entries = 40;

PairSearch found_or(MaybePair pair, const Call& f) {
  if (pair) return {std::move(pair), {}};
  return {{}, f.name + ": its values at the point are not enclosed"};
}

std::optional<Fractions> solved(const ExactGram& W, const Fractions& c) {
  if (!W.is_diagonal && W.dimension() > most_solved_entries) return std::nullopt;
  std::vector<ExactEquation> equations;
  for (std::size_t i = 0; i < c.size(); ++i) equations.push_back({W.rows[i], c[i]});
  return solve_near(std::move(equations), Fractions(c.size()));
}

/// The balls that a call is the indicator of, or the support function of: of the whole, of groups, and of one
/// row or column, whose norm is its only singular value.
struct Balls {
  bool is_support = false;
  Fraction radius;
  Fractions centre;
  std::vector<std::size_t> sizes;
};

std::optional<Balls> balls_of(const Call& f, std::size_t n) {
  const ExactArguments a(f, n);
  const std::string& name = f.name;
  if (name == "norm2") return Balls{true, a.number("weight"), Fractions(n), {n}};
  if (name == "ball2") return Balls{false, a.number("radius"), a.vector("center"), {n}};
  if (name == "group_norm" || name == "group_ball") {
    const bool is_support = name == "group_norm";
    const Fractions given = a.is_vector("sizes") ? a.vector("sizes") : Fractions{a.number("sizes")};
    Balls made{is_support, a.number(is_support ? "weight" : "radius"), Fractions(n), {}};
    std::size_t covered = 0;
    for (std::size_t k = 0; covered < n; ++k) {
      const Fraction& size = given[a.is_vector("sizes") ? k : 0];
      made.sizes.push_back(static_cast<std::size_t>(nearest_double(size)));
      covered += made.sizes.back();
    }
    return made;
  }
  if ((name == "k_support" || name == "largest_entries_ball") &&
      !(a.number("k") < Fraction{static_cast<std::int64_t>(n)})) {
    const bool is_support = name == "k_support";
    return Balls{is_support, a.number(is_support ? "weight" : "radius"), Fractions(n), {n}};
  }
  if (name == "nuclear_norm" || name == "spectral_ball" || name == "schatten" || name == "schatten_ball") {
    const bool is_support = name == "nuclear_norm" || name == "schatten";
    const auto rows = static_cast<std::size_t>(nearest_double(a.number("rows")));
    if (rows != 1 && rows != n && n != 1) return std::nullopt;
    return Balls{is_support, a.number(is_support ? "weight" : "radius"), Fractions(n), {n}};
  }
  return std::nullopt;
}

enum class Wanted { near, at_point, at_covector };

PairSearch pair_of_balls(const Balls& balls, const Call& f, const Fractions& x, const Fractions& v,
                         Wanted wanted) {
  return joined(balls.sizes, [&](std::size_t, std::size_t first, std::size_t n) -> PairSearch {
    const Fractions centre = part_of(balls.centre, first, n);
    Fractions point = part_of(x, first, n), covector = part_of(v, first, n);
    if (balls.is_support) std::swap(point, covector);
    const bool at_point = wanted == (balls.is_support ? Wanted::at_covector : Wanted::at_point);
    MaybePair found = wanted == Wanted::near ? pairs::of_ball(balls.radius, centre, point, covector)
                      : at_point             ? pairs::ball_at_point(balls.radius, centre, point)
                                             : pairs::ball_at_covector(balls.radius, centre, covector);
    if (found && balls.is_support) found = turned_round(std::move(*found));
    return found_or(std::move(found), f);
  });
}

MaybePair of_cone(const Call& f, const Fractions& x, const Fractions& v) {
  const ExactArguments a(f, x.size());
  if (f.name == "second_order_cone") return pairs::of_second_order_cone(x, v);
  if (f.name == "rotated_second_order_cone") return pairs::of_rotated_cone(x, v);
  if (f.name == "psd_cone") return pairs::of_psd_cone(x, v);
  if (f.name == "neg_log_det") return pairs::of_neg_log_det(x, v);
  if (f.name == "exponential_cone") return pairs::of_exponential_cone(x, v);
  if (f.name == "power_cone") return pairs::of_power_cone(a.number("alpha"), x, v);
  // x in K*, v in -K: the pair of K at -v and -x.
  const Fraction minus{-1};
  const Fractions point = pairs::multiple_of(minus, v), covector = pairs::multiple_of(minus, x);
  MaybePair primal;
  if (f.name == "dual_exponential_cone") primal = pairs::of_exponential_cone(point, covector);
  if (f.name == "dual_power_cone") primal = pairs::of_power_cone(a.number("alpha"), point, covector);
  if (!primal) return std::nullopt;
  return ProofPair{pairs::multiple_of(minus, primal->v), pairs::multiple_of(minus, primal->x), primal->f_v,
                   primal->f_x, primal->is_rational};
}

/// ½ γ ||v||²_(W⁻¹) on both values, and x further by γ W⁻¹v (Moreau 1965).
PairSearch pair_of_envelope(const Call& part, const ExactGram& inner, const Fraction& gamma,
                            const ExactGram& W, const Fractions& x, const Fractions& v) {
  const auto step = solved(W, v);
  if (!step) return {{}, "envelope: the metric is too large to be solved with in fractions"};
  PairSearch found = pair_of_call(part, inner, difference(x, pairs::multiple_of(gamma, *step)), v);
  if (!found.pair) return found;
  ProofPair& pair = *found.pair;
  const Fractions exact_step = solved(W, pair.v).value();
  const FractionInterval half = only(gamma * dot(pair.v, exact_step) * Fraction{1, 2});
  pair.x = pairs::sum_of(pair.x, pairs::multiple_of(gamma, exact_step));
  pair.f_x = pair.f_x + half;
  pair.f_v = pair.f_v + half;
  return found;
}

/// h(y) = f*(Wy): f at W⁻¹v and the covector Wy.
PairSearch pair_of_conjugate(const Call& part, const ExactGram& W, const Fractions& y, const Fractions& v,
                             const PairOfPart& pair_of) {
  const auto x = solved(W, v);
  if (!x) return {{}, "conjugate: the metric is too large to be solved with in fractions"};
  PairSearch found = pair_of(part, W, *x, multiply(W, y));
  if (!found.pair) return found;
  const ProofPair& pair = *found.pair;
  return {ProofPair{solved(W, pair.v).value(), multiply(W, pair.x), pair.f_v, pair.f_x, pair.is_rational},
          {}};
}

/// The call that f is the conjugate of.
const Call* conjugate_of(const Call& f, const ExactArguments& a) {
  return f.name == "conjugate" ? &a.call("f") : f.name == "support" ? &a.call("set") : nullptr;
}

/// weight times the plain distance to C: at most weight |x - p| for p in C, and σ_C on |v| <= weight.
PairSearch pair_of_distance(const Call& f, const ExactGram& W, const Fractions& x, const Fractions& v) {
  const ExactArguments a(f, W.dimension());
  const Fraction weight = a.number("weight");
  const ExactGram plain = identity_gram(x.size());
  const Vector near_x = nearest(x);
  const Prox onto = make_set(a.call("set"), {rounded(W)}).indicator.prox(near_x, rounded(plain));
  std::vector<MaybePair> candidates;
  const auto within = [&](const ProofPair& pair) { return !(weight * weight < pairs::square_of(pair.v)); };
  if (const PairSearch inside = pair_of_call(a.call("set"), W, x, v); inside.pair && within(*inside.pair))
    candidates.push_back(inside.pair);
  if (onto.x.size() == near_x.size() && onto.x.allFinite()) {
    const Fractions p = fractions(onto.x);
    const PairSearch at = pair_of_call(a.call("set"), W, p, difference(x, p));
    if (at.pair && sign(pairs::square_of(at.pair->v)) != 0) {
      const Fractions q = at.pair->v;
      const Ball length = sqrt(ball(pairs::square_of(q)));
      const Fraction factor = a_little_below(ball(weight) / length);
      ProofPair outside{pairs::sum_of(at.pair->x, q), pairs::multiple_of(factor, q), only(Fraction{}),
                        times(factor, at.pair->f_v), false};
      if (const auto distance = interval(ball(weight) * length); distance && within(outside)) {
        outside.f_x = *distance;
        candidates.push_back(std::move(outside));
      }
    }
  }
  return found_or(pairs::best_of(std::move(candidates), x, v), f);
}

PairSearch pair_of_operation(const Call& f, const ExactGram& W, const Fractions& x, const Fractions& v) {
  const ExactArguments a(f, W.dimension());
  const std::string& name = f.name;
  if (auto changed = pair_by_change_of_variables(f, W, x, v, pair_of_call)) return *std::move(changed);
  if (const Call* part = conjugate_of(f, a)) return pair_of_conjugate(*part, W, x, v, pair_of_call);
  if (name == "envelope") return pair_of_envelope(a.call("f"), W, a.number("gamma"), W, x, v);
  if (name == "distance") return pair_of_distance(f, W, x, v);
  if (name == "squared_distance" && sign(a.number("weight")) > 0)
    return pair_of_envelope(a.call("set"), W, Fraction{1} / a.number("weight"), identity_gram(x.size()), x,
                            v);
  return pair_of_combination(f, W, x, v);
}

Vector both(const Fractions& x, const Fractions& v) { return nearest(pairs::sum_of(x, v)); }

/// A graph point of a program with this x exactly: the multipliers of w at x.
PairSearch program_at_point(const ExactProgram& f, const Fractions& x) {
  if (const auto at = graph_point_at(f, x)) return {proof_pair(*at), {}};
  return {{}, "the point is outside of a domain"};
}

}  // namespace

PairSearch pair_of_call(const Call& f, const ExactGram& W, const Fractions& x, const Fractions& v) {
  if (const auto program = exact_program(f, W)) {
    if (auto at = near_graph_point(*program, both(x, v))) return {proof_pair(std::move(*at)), {}};
    return {{}, f.name + ": doubles do not find the rows that are active"};
  }
  if (!Ball::why_none().empty()) return {{}, Ball::why_none()};
  if (const auto entries = entry_formulas(f, x.size()); !entries.empty())
    return found_or(pair_of_entries(entries, x, v), f);
  if (const auto balls = balls_of(f, x.size())) return pair_of_balls(*balls, f, x, v, Wanted::near);
  if (f.name == "neg_log_det" || find_entry(f.name)->kind == EntryKind::set)
    if (MaybePair found = of_cone(f, x, v)) return {std::move(found), {}};
  if (f.name == "log_sum_exp") return found_or(pairs::of_log_sum_exp(x, v), f);
  return pair_of_operation(f, W, x, v);
}

PairSearch pair_at_point(const Call& f, const ExactGram& W, const Fractions& x) {
  if (const auto program = exact_program(f, W)) return program_at_point(*program, x);
  if (const auto entries = entry_formulas(f, x.size()); !entries.empty())
    return found_or(entries_at_point(entries, x), f);
  if (const auto balls = balls_of(f, x.size())) return pair_of_balls(*balls, f, x, x, Wanted::at_point);
  const auto of_part = [](const Call& part, const ExactGram& metric, const Fractions& point,
                          const Fractions&) { return pair_at_point(part, metric, point); };
  const Fractions any(x.size());
  if (auto changed = pair_by_change_of_variables(f, W, x, any, of_part)) return *std::move(changed);
  if (f.name == "log_sum_exp") return found_or(pairs::log_sum_exp_at_point(x), f);
  const ExactArguments a(f, x.size());
  if (const Call* part = conjugate_of(f, a))
    return pair_of_conjugate(
        *part, W, x, any,
        [](const Call& of, const ExactGram& metric, const Fractions&, const Fractions& covector) {
          return pair_at_covector(of, metric, covector);
        });
  return combination_at_point(f, W, x);
}

PairSearch pair_at_covector(const Call& f, const ExactGram& W, const Fractions& v) {
  if (const auto program = exact_program(f, W)) {
    PairSearch found = program_at_point(exact_programs::conjugate(*program), v);
    if (found.pair) found.pair = turned_round(std::move(*found.pair));
    return found;
  }
  if (const auto entries = entry_formulas(f, v.size()); !entries.empty())
    return found_or(entries_at_covector(entries, v), f);
  if (const auto balls = balls_of(f, v.size())) return pair_of_balls(*balls, f, v, v, Wanted::at_covector);
  const auto of_part = [](const Call& part, const ExactGram& metric, const Fractions&,
                          const Fractions& covector) { return pair_at_covector(part, metric, covector); };
  const Fractions any(v.size());
  if (auto changed = pair_by_change_of_variables(f, W, any, v, of_part)) return *std::move(changed);
  const ExactArguments a(f, v.size());
  if (const Call* part = conjugate_of(f, a))
    return pair_of_conjugate(*part, W, any, v,
                             [](const Call& of, const ExactGram& metric, const Fractions& point,
                                const Fractions&) { return pair_at_point(of, metric, point); });
  return combination_at_covector(f, W, v);
}

PairSearch pair_at_covector(const Call& f, const ExactGram& W, const Fractions& x, const Fractions& v) {
  PairSearch found = pair_at_covector(f, W, v);
  if (found.pair || exact_program(f, W)) return found;
  const PairOfPart of_part = [](const Call& part, const ExactGram& metric, const Fractions& point,
                                const Fractions& covector) {
    return pair_at_covector(part, metric, point, covector);
  };
  if (auto changed = pair_by_change_of_variables(f, W, x, v, of_part)) return *std::move(changed);
  return combination_near_covector(f, W, x, v);
}

}  // namespace convex::inline proved_prox
