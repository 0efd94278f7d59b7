#include "convex/proved_prox/proved_split.hpp"

#include <cmath>

#include "convex/exact/rounding_bounds.hpp"
#include "convex/exact_program/program_of_call.hpp"
#include "convex/exact_program/program_operations.hpp"
#include "convex/invalid_input.hpp"
#include "convex/invariant.hpp"
#include "convex/nearest_point/solution.hpp"
#include "convex/proved_prox/pair_of_call.hpp"
#include "convex/proved_prox/proof_in_doubles.hpp"

namespace convex::inline proved_prox {

ProvedInterval outwards(const Fraction& low, const Fraction& high) {
  ProvedInterval made{nearest_double(low), nearest_double(high)};
  // Beyond all doubles the nearest one is infinite.
  if (std::isinf(made.low) ? made.low > 0 : low < fraction(made.low))
    made.low = std::nextafter(made.low, -INFINITY);
  if (std::isinf(made.high) ? made.high < 0 : fraction(made.high) < high)
    made.high = std::nextafter(made.high, INFINITY);
  return made;
}

namespace {

/// A pair, and how far x* and y* are from its x and W⁻¹v at most.
struct Proof {
  std::optional<ProofPair> pair;
  double radius = INFINITY;
  std::string why_none;
};

Proof judged(PairSearch search, const ProvedMetric& W, const Fractions& z) {
  if (!search.pair) return {std::nullopt, INFINITY, std::move(search.why_none)};
  const double radius = proved_radius(W, z, *search.pair);
  if (!std::isfinite(radius))
    return {std::nullopt, INFINITY,
            W.is_proved_definite() ? "the values enclosed contradict Fenchel's inequality"
                                   : "the metric is not proved positive definite"};
  return {std::move(search.pair), radius, {}};
}

bool usable(const Vector& v, const Vector& z) { return v.size() == z.size() && v.allFinite(); }

bool has_points(const Decomposition& split, std::size_t n) {
  const Vector &x = split.x.x, &y = split.y.x;
  return x.size() == static_cast<Index>(n) && x.allFinite() && usable(y, x);
}

/// x* is within `radius` of pair.x, y* of W⁻¹pair.v. f(x*) >= v·x* - f*(v), g(y*) >= x·Wy* - f(x), and both
/// add up to (x*|y*).
void enclose_values(const ProvedMetric& W, const Proof& proof, ProvedSplit& made) {
  const ProofPair& pair = *proof.pair;
  const Fraction radius = fraction(proof.radius), product = dot(pair.x, pair.v),
                 X = fraction(W.norm_above(pair.x)), Y = fraction(W.dual_norm_above(pair.v));
  const Fraction of_inner = radius * (X + Y + radius), f_low = product - Y * radius - pair.f_v.high,
                 g_low = product - X * radius - pair.f_x.high;
  made.inner = outwards(product - of_inner, product + of_inner);
  made.f_x = outwards(f_low, product + of_inner - g_low);
  made.g_y = outwards(g_low, product + of_inner - f_low);
}

/// Programs with larger parts are not put on a graph in fractions; those beyond the second are not solved in
/// fractions where doubles do not find the active rows, and those beyond the third not at all.
constexpr std::size_t most_on_graph = 1500, most_without_guess = 300, most_in_fractions = 1000;
constexpr const char* too_large = "its program has too many variables for fractions";

/// The graph point of a pair search that doubles did not put right, from the exact prox.
PairSearch exact_pair(const ExactProgram& f, const ProvedMetric& W, const Fractions& z) {
  if (largest_part(f, &W.gram()) > most_without_guess) return {std::nullopt, too_large};
  if (ExactMinimum found = exact_prox(f, W.gram(), z); found.at)
    return {proof_pair(std::move(*found.at)), {}};
  return {std::nullopt, "its quadratic program has no minimum in fractions"};
}

}  // namespace

double proved_radius(const ProvedMetric& W, const Fractions& z, const ProofPair& pair) {
  const Fraction gap_square = gap_above(pair) * Fraction{2};
  if (sign(gap_square) < 0) return INFINITY;  // no function and its conjugate have such values
  const Fractions residual = difference(multiply(W.gram(), difference(z, pair.x)), pair.v);
  const double miss = W.dual_norm_above(residual);
  const double gap = root_above(gap_square);
  return above(std::hypot(miss, gap));
}

namespace {

ProvedSplit prove_in_fractions(const SplitQuestion& question, const Decomposition& split) {
  ProvedSplit made;
  const Vector &x = split.x.x, &y = split.y.x;
  if (!has_points(split, question.z.size())) {
    made.why_none = "there is no point to prove anything of";
    return made;
  }
  const ProvedMetric W(question.W);
  const Metric& in_doubles = W.in_doubles();
  const Vector z = nearest(question.z);
  const Vector of_x = usable(split.x.v, x) ? split.x.v : in_doubles.multiply(z - x);
  const Vector of_y = usable(split.y.v, y) ? split.y.v : in_doubles.multiply(z - y);
  Proof first, second;
  if (const auto program = exact_program(question.f, question.W)) {
    if (largest_part(*program, nullptr) > most_on_graph) {
      made.why_none = too_large;
      return made;
    }
    const ExactProgram dual = exact_programs::conjugate(*program);
    PairSearch near_x, near_y;
    if (auto at = near_graph_point(*program, x + of_x)) near_x.pair = proof_pair(std::move(*at));
    first = near_x.pair ? judged(std::move(near_x), W, question.z)
                        : judged(exact_pair(*program, W, question.z), W, question.z);
    if (auto at = near_graph_point(dual, in_doubles.multiply(y) + in_doubles.solve(of_y)))
      near_y.pair = turned_round(proof_pair(std::move(*at)));
    const bool may_solve = largest_part(*program, &question.W) <= most_without_guess;
    if (!near_y.pair && !may_solve) near_y.why_none = too_large;
    if (!near_y.pair && may_solve) {  // the prox of g in W: y, and a covector Wx of it
      const ExactProgram g = exact_programs::conjugate(*program, question.W);
      if (ExactMinimum found = exact_prox(g, question.W, question.z); found.at) {
        near_y.pair = ProofPair{difference(question.z, found.at->x),
                                multiply(question.W, found.at->x),
                                {found.at->f_v, found.at->f_v},
                                {found.at->f_x, found.at->f_x},
                                true};
      }
    }
    second = judged(std::move(near_y), W, question.z);
  } else {
    first = judged(pair_of_call(question.f, question.W, fractions(x), fractions(of_x)), W, question.z);
    second = judged(pair_of_call(question.f, question.W, fractions(in_doubles.solve(of_y)),
                                 fractions(in_doubles.multiply(y))),
                    W, question.z);
  }
  if (!first.pair || !second.pair) {
    made.why_none = first.pair ? second.why_none : first.why_none;
    return made;
  }
  made.x_bound = above(W.norm_above(difference(fractions(x), first.pair->x)) + first.radius);
  made.y_bound = above(W.dual_norm_above(difference(multiply(question.W, fractions(y)), second.pair->v)) +
                       second.radius);
  const Fractions missing = difference(difference(question.z, fractions(x)), fractions(y));
  made.sum_miss = W.norm_above(missing);
  enclose_values(W, first.radius <= second.radius ? first : second, made);
  // Two balls that do not meet would be a contradiction: nothing is claimed then.
  if (!(made.sum_miss <= above(made.x_bound + made.y_bound)) || !std::isfinite(made.error_bound())) {
    made.x_bound = made.y_bound = INFINITY;
    made.why_none = "what was proved of x and of y contradicts their sum";
    return made;
  }
  const bool is_rational = W.is_exact() && first.pair->is_rational && second.pair->is_rational;
  made.level = is_rational ? ProofLevel::exact : ProofLevel::enclosure;
  return made;
}

/// Pairs in fractions that take more of `most_word_operations` than this part, by their count, are left to
/// doubles first: they would take some ten times as long as the prox itself in the program.
constexpr double part_at_once = 0.03;

bool is_quick_in_fractions(const SplitQuestion& question) {
  const auto program = exact_program(question.f, question.W);
  return program && pair_operations(*program, question.W) <= part_at_once * most_word_operations;
}

/// Both proxes in fractions take at most this part of `most_word_operations`, some ten times as long as in
/// doubles. A full W couples all entries, so that a pair near the doubles would not do: the residual W(z - x)
/// - v is 0 of the prox alone, and W⁻¹ is not needed then.
constexpr double part_for_both = 0.01;

bool is_split_quickly_in_fractions(const SplitQuestion& question) {
  if (question.W.is_diagonal) return false;
  const auto program = exact_program(question.f, question.W);
  return program && split_operations(*program, question.W) <= part_for_both * most_word_operations &&
         is_proved_in_integers(question.W);
}

/// Relative error of the doubles nearest to entries of W: 0 where they are the entries.
double rounding_of(const ExactGram& W) {
  for (const ExactRow& row : W.rows)
    for (const auto& [j, entry] : row)
      if (!(fraction(nearest_double(entry)) == entry)) return unit_roundoff;
  return 0;
}

}  // namespace

ProvedSplit prove(const SplitQuestion& question, const Decomposition& split) {
  if (is_quick_in_fractions(question)) {
    ProvedSplit made = prove_in_fractions(question, split);
    if (made.level == ProofLevel::exact) return made;
  }
  if (is_split_quickly_in_fractions(question) && has_points(split, question.z.size()))
    return proof_of(exact_split(question), split, question);
  const Metric W = rounded(question.W);
  const Vector z = nearest(question.z);
  Vector z_radius = Vector::Zero(z.size());
  for (Index i = 0; i < z.size(); ++i)
    if (!(fraction(z[i]) == question.z[static_cast<std::size_t>(i)]))
      z_radius[i] = std::nextafter(std::abs(z[i]), INFINITY) - std::abs(z[i]);
  if (const auto proof = proof_in_doubles({question.f, z, z_radius, W, rounding_of(question.W)}, split))
    return *proof;
  return prove_in_fractions(question, split);
}

ProvedSplit prove(const Call& f, const Vector& z, const Metric& W, const Decomposition& split) {
  if (const auto proof = proof_in_doubles({f, z, Vector::Zero(z.size()), W, 0}, split)) return *proof;
  return prove_in_fractions({f, fractions(z), exact_gram(W)}, split);
}

namespace {

/// Both proxes, each from its own program; none where one has no minimum.
std::optional<ExactSplit> split_of_program(const ExactProgram& f, const SplitQuestion& question) {
  const ExactMinimum x = exact_prox(f, question.W, question.z);
  if (!x.at) return std::nullopt;
  const ExactMinimum y = exact_prox(exact_programs::conjugate(f, question.W), question.W, question.z);
  if (!y.at) return std::nullopt;
  for (std::size_t i = 0; i < question.z.size(); ++i)
    invariant(x.at->x[i] + y.at->x[i] == question.z[i], "prox_f z + prox_g z is z in fractions");
  const Fraction inner = dot(x.at->x, multiply(question.W, y.at->x));
  invariant(x.at->f_x + y.at->f_x == inner, "f(x) + g(y) is (x|y) in fractions");
  return ExactSplit{x.at->x, y.at->x, x.at->f_x, y.at->f_x, inner};
}

}  // namespace

ExactSplit exact_split(const SplitQuestion& question) {
  const auto program = exact_program(question.f, question.W);
  if (!program)
    throw InvalidInput(
        "method \"exact\" solves piecewise linear-quadratic functions in fractions, and this is none; leave "
        "the method out, or ask for --certify");
  if (!is_proved_in_integers(question.W))
    throw InvalidInput("metric: not positive definite as it is written; correct it");
  if (largest_part(*program, &question.W) > most_in_fractions)
    throw InvalidInput(
        "method \"exact\": fractions are out of reach for so many variables; leave the method out");
  std::optional<ExactSplit> found = split_of_program(*program, question);
  invariant(found.has_value(), "the prox of a convex function exists, and is found in fractions");
  return *std::move(found);
}

std::optional<ExactSplit> exact_split_within(const SplitQuestion& question, double most) {
  const auto program = exact_program(question.f, question.W);
  if (!program || !(split_operations(*program, question.W) <= most) || !is_proved_in_integers(question.W))
    return std::nullopt;
  return split_of_program(*program, question);
}

ProvedSplit proof_of(const ExactSplit& exact, const Decomposition& split, const SplitQuestion& question) {
  const ProvedMetric W(question.W);
  const Fractions x = fractions(split.x.x), y = fractions(split.y.x);
  ProvedSplit made;
  made.level = ProofLevel::exact;
  made.x_bound = W.norm_above(difference(x, exact.x));
  made.y_bound = W.norm_above(difference(y, exact.y));
  made.f_x = outwards(exact.f_x, exact.f_x);
  made.g_y = outwards(exact.g_y, exact.g_y);
  made.inner = outwards(exact.inner, exact.inner);
  made.sum_miss = W.norm_above(difference(difference(question.z, x), y));
  return made;
}

Decomposition rounded(const ExactSplit& exact, const SplitQuestion& question) {
  Decomposition made;
  const ProvedMetric W(question.W);
  const auto part = [&](const Fractions& point, const Fractions& other) {
    Prox prox;
    prox.x = nearest(point);
    prox.v = nearest(multiply(question.W, other));
    prox.error_bound = W.norm_above(difference(point, fractions(prox.x)));
    prox.route = ProxRoute::active_set;
    prox.method = "in fractions";
    return prox;
  };
  made.x = part(exact.x, exact.y);
  made.y = part(exact.y, exact.x);
  made.f_x = nearest_double(exact.f_x);
  made.g_y = nearest_double(exact.g_y);
  made.inner = nearest_double(exact.inner);
  made.residual = W.in_doubles().norm(nearest(question.z) - made.x.x - made.y.x);
  made.error_bound = std::max(made.x.error_bound, made.y.error_bound);
  made.status = Status::solved;
  return made;
}

}  // namespace convex::inline proved_prox
