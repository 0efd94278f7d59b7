#include "convex/functions/decomposition.hpp"
#include "convex/counted.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "convex/composite/closed_form.hpp"
#include "convex/decompositions/cutting_planes.hpp"
#include "convex/decompositions/split_search.hpp"
#include "convex/functions/other_pairs.hpp"
#include "convex/gamma0/work_limit.hpp"
#include "convex/nearest_point/solution.hpp"
#include "convex/operations/metric_algebra.hpp"
#include "convex/operations/takes_product.hpp"
#include "convex/proved_prox/doubles/metric_bounds.hpp"
#include "convex/proved_prox/proved_split.hpp"

namespace convex::inline decompositions {
namespace {

/// What cuts may take of the work that a question may.
constexpr double part_of_cuts = 0.4;

/// How a question is looked at until an answer is borne out, and what each look may take of the work.
struct LookWithWork {
  Look look;
  double work;
};
constexpr LookWithWork looks[] = {
    {{}, 2}, {{.at_other_scales = true}, 0.5}, {{.at_other_scales = true, .by_steep_terms = true}, 0.25}};

/// One look at f, its status by the tolerance.
Decomposition looked_at(const SplitFunctions& of, const Vector& z, const Metric& W, double tolerance,
                        const Look& look) {
  Decomposition split = searched_split(of, z, W, tolerance, look);
  const double enough = tolerance * std::max({1.0, W.norm(z), W.norm(split.x.x)});
  const bool accurate = split.x.error_bound <= enough && split.y.error_bound <= enough &&
                        split.error_bound <= enough;  // each by itself: a maximum may hide a NaN
  // Where squares overflow, an infinite bound would be within an infinite tolerance.
  const bool finite =
      std::isfinite(split.f_x) && std::isfinite(split.g_y) && std::isfinite(split.error_bound);
  if (accurate && finite && split.status == Status::solved) return split;
  const bool gave_up = split.x.status == Status::gave_up || split.y.status == Status::gave_up;
  split.status = gave_up ? Status::gave_up : Status::inaccurate;
  return split;
}

/// Squares and products of numbers of this size, or of its inverse, leave the range of doubles.
constexpr double largest_size = 0x1p500;

/// What rounded numbers may do in W, as a part: with k >= trace(W) / λ_min(W), a matrix whose entries are
/// right to a rounding u is right to u k, as a part of W, and its inverse to u k².
double rounding_of_numbers(const Metric& W) {
  const double condition = W.diagonal().sum() / near_graphs::least_eigenvalue_below(gram(W));
  return unit_roundoff * condition * condition;
}

/// In a full metric that is nearly singular doubles lose digits, and what they tell of how many is an
/// estimate, or the bound of a function whose numbers were rounded. Where their bound is more than so many
/// roundings, or does not hold what such numbers may do, fractions give the answer if they take at most this
/// part of `most_word_operations`, some hundredths of a second.
constexpr double few_roundings = 64, part_beside_doubles = 0.001;

bool may_be_sharpened(const Function& f, const Decomposition& split, const Vector& z, const Metric& W) {
  if (!f.facts().piecewise_quadratic || is_diagonal_kind(W)) return false;
  const double size = W.norm(z) + W.norm(split.x.x);
  return !(split.error_bound <= few_roundings * unit_roundoff * size) ||
         (has_rounded_numbers(f.call()) && !(rounding_of_numbers(W) * size <= split.error_bound));
}

/// The bounds with what rounded numbers of f, which its quadratic program has, do in a full metric.
void count_rounded_numbers(const Function& f, const Vector& z, const Metric& W, double tolerance,
                           Decomposition& split) {
  if (!f.facts().piecewise_quadratic || is_diagonal_kind(W) || !has_rounded_numbers(f.call())) return;
  const double size = std::max({1.0, W.norm(z), W.norm(split.x.x)});
  const double rounding = rounding_of_numbers(W) * (W.norm(z) + W.norm(split.x.x));
  for (double* bound : {&split.error_bound, &split.x.error_bound, &split.y.error_bound}) *bound += rounding;
  if (split.status == Status::solved && !(split.error_bound <= tolerance * size))
    split.status = Status::inaccurate;
}

/// What doubles leave open of a piecewise linear-quadratic f, decided in fractions and rounded; none where
/// that takes more word operations than `most`, or doubles cannot hold the answer to the tolerance.
std::optional<Decomposition> in_fractions(const Function& f, const Vector& z, const Metric& W,
                                          double tolerance, double most) {
  if (!f.facts().piecewise_quadratic) return std::nullopt;
  const SplitQuestion question{of_plain_product(f.call(), z.size()), fractions(z), exact_gram(W)};
  const auto exact = exact_split_within(question, most);
  if (!exact) return std::nullopt;
  Decomposition split = rounded(*exact, question);
  const double enough = tolerance * std::max({1.0, W.norm(z), W.norm(split.x.x)});
  const bool finite = std::isfinite(split.f_x) && std::isfinite(split.g_y) && std::isfinite(split.inner);
  if (!finite || !(split.error_bound <= enough)) return std::nullopt;
  split.fenchel_gap = split.f_x + split.g_y - split.inner;
  return split;
}

/// What programs leave open of f or of its conjugate, seen through the values of one of them alone: where one
/// is a maximum or a sum of cheap parts the other may need a program for each.
std::optional<Decomposition> by_cuts(const SplitFunctions& of, const Decomposition& near, const Vector& z,
                                     const Metric& W, double tolerance) {
  const double enough = tolerance * std::max(1.0, W.norm(z));
  for (const bool of_dual : {false, true}) {
    const WorkLimit question(part_of_cuts);
    auto x =
        of_dual
            ? turned(prox_by_cuts(of.plain, W.multiply(near.y.x), W.multiply(z), inverse(W), enough, Look{}),
                     z, W)
            : prox_by_cuts(of.f, near.x.x, z, W, enough, Look{});
    if (!x) continue;
    // Values elsewhere bear the cuts out, or nothing does: their own would compare a number with itself.
    x->values.reset();
    const auto y = moreau_partner(*x, z, W);
    if (!y) continue;
    SplitCandidate made = at_covector(of, *x, *y, z, W, tolerance);
    if (!is_borne_out(made, enough, tolerance) || !is_inner_of_points(made.split, tolerance, W)) continue;
    made.split.status = Status::solved;
    return std::move(made.split);
  }
  return std::nullopt;
}

/// Looks at f until one bears an answer out.
Decomposition looked_at_in_turn(const Function& f, const Vector& z, const Metric& W, double tolerance) {
  const SplitFunctions of{f, f.conjugate(W), f.conjugate()};
  std::optional<Decomposition> best;
  for (const auto& [look, work] : looks) {
    const WorkLimit question(work);
    Decomposition split = looked_at(of, z, W, tolerance, look);
    if (split.status == Status::solved) {
      if (may_be_sharpened(f, split, z, W))
        if (auto exact = in_fractions(f, z, W, tolerance, part_beside_doubles * most_word_operations))
          return *std::move(exact);
      count_rounded_numbers(f, z, W, tolerance, split);
      if (split.status == Status::solved) return split;
    }
    if (!best || split.error_bound < best->error_bound) best = std::move(split);
    if (f.facts().piecewise_quadratic) break;  // no saddle problem is in it
  }
  if (auto exact = in_fractions(f, z, W, tolerance, most_word_operations)) return *std::move(exact);
  if (auto seen = by_cuts(of, *best, z, W, tolerance)) return *std::move(seen);
  return *std::move(best);
}

/// A split of which no bound is known, or the reason why there is none.
Decomposition beyond_squares(const Function& f, const Vector& z, const Metric& W, double tolerance) {
  try {
    Decomposition split = looked_at_in_turn(f, z, W, tolerance);
    split.status = Status::inaccurate;
    for (double* bound : {&split.error_bound, &split.x.error_bound, &split.y.error_bound})
      *bound = std::numeric_limits<double>::infinity();
    return split;
  } catch (const InvalidInput&) {
    throw InvalidInput("z: its square leaves the range of doubles; measure x in units nearer to its size");
  }
}

}  // namespace

Decomposition decompose(const Function& f, const Vector& z, const Metric& W, double tolerance) {
  if (z.size() != W.dimension())
    throw InvalidInput("z: " + counted(z.size(), "entry", "entries") + "; give " +
                       std::to_string(W.dimension()) + ", as many as the metric has");
  const double size = W.norm(z);
  if (!(size <= largest_size)) return beyond_squares(f, z, W, tolerance);
  Decomposition split = looked_at_in_turn(f, z, W, tolerance);
  // Squares of what is smaller are 0, and a bound made of them tells nothing.
  const double most = std::max({size, W.norm(split.x.x), W.norm(split.y.x)});
  if (most > 0 && most < 1 / largest_size)
    for (double* bound : {&split.error_bound, &split.x.error_bound, &split.y.error_bound})
      *bound = std::max(*bound, 1 / largest_size);
  return split;
}

}  // namespace convex::inline decompositions
