#include "convex/functions/decomposition.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "convex/composite/metric_difference.hpp"
#include "convex/composite/work_limit.hpp"
#include "convex/cutting_planes.hpp"
#include "convex/functions/closed_form.hpp"
#include "convex/functions/split_candidate.hpp"
#include "convex/operations/metric_algebra.hpp"
#include "convex/operations/operation.hpp"
#include "convex/other_pairs.hpp"
#include "convex/proved_prox/proved_split.hpp"

namespace convex::inline named_functions {
namespace {

/// What a rounding of x makes of f(x), to first order: |v|·|x| for a subgradient there.
double size_of_slope(const Function& f, const Vector& x) {
  const std::optional<Vector> v = f.subgradient(x);
  return v && v->allFinite() ? v->cwiseAbs().dot(x.cwiseAbs()) : 0;
}

/// What each prox, each move into a domain and each other way to a pair may take of the work that a question
/// may.
constexpr double part_of_a_prox = 0.8, part_of_a_move = 0.1, part_of_a_way = 0.3, part_of_cuts = 0.4;

/// Of cuts beside a kink: above the curvature of most functions, of many, and none.
constexpr double stiffnesses[] = {1e6, 1e3, 1};

/// How a question is looked at until an answer is borne out, and what each look may take of the work.
struct LookWithWork {
  Look look;
  double work;
};
constexpr LookWithWork looks[] = {
    {{}, 2}, {{.at_other_scales = true}, 0.5}, {{.at_other_scales = true, .by_steep_terms = true}, 0.25}};

/// `found`, or a point of which nothing is known.
Prox made_up(const std::optional<Prox>& found, const Vector& point) {
  if (found) return *found;
  Prox made;
  made.x = point;
  made.error_bound = INFINITY;
  made.status = Status::gave_up;
  return made;
}

bool is_borne_out(const SplitCandidate& made, double enough, double tolerance) {
  return made.excess() <= 0 && made.known(tolerance) && made.split.error_bound <= enough;
}

/// What the two proxes gave, held against the values. Where these do not bear it out, other pairs are tried:
/// the points moved into their domains, one of the two by Moreau's identity from the other, the covectors in
/// place of y, and x and v balanced.
Decomposition guarded(const SplitFunctions& of, const Vector& z, const Metric& W, double tolerance,
                      const Look& look) {
  // A way on which numbers leave the range of doubles has found nothing; so has one into a domain that is
  // empty, which is told where no other way finds a point.
  std::optional<InvalidInput> wrong;
  const auto prox_of = [&](const Function& h, const Vector& point, const Metric& V) {
    const WorkLimit part(part_of_a_prox);
    try {
      return h.prox(point, V, look);
    } catch (const InvalidInput& said) {
      if (!wrong) wrong = said;
      return Prox{};
    }
  };
  Prox x = prox_of(of.f, z, W), y = prox_of(of.g, z, W);
  // What gave up without a point is found from the other, or not at all.
  const auto none = [&](const Prox& part) { return part.x.size() != z.size(); };
  if (none(x)) x = made_up(none(y) ? std::nullopt : moreau_partner(y, z, W), z);
  if (none(y)) y = made_up(moreau_partner(x, z, W), Vector::Zero(z.size()));
  SplitCandidate best = at_points(of, x, y, z, W);
  const double size = W.norm(z) + W.norm(x.x), enough = tolerance * std::max({1.0, W.norm(z), W.norm(x.x)});
  const auto is_borne_out = [&](const SplitCandidate& made) {
    return named_functions::is_borne_out(made, enough, tolerance);
  };
  const auto is_found = [&] { return is_borne_out(best); };
  const auto ended = [&] { return is_found() || WorkLimit::passed(); };
  const auto near = [&](const std::optional<Prox>& found) { return found && found->error_bound <= enough; };
  const auto into = [&](const Function& h, const std::optional<Prox>& found) {
    const WorkLimit part(part_of_a_move);
    return near(found) ? moved_into_domain(h, *found, size + W.norm(y.x), W, look) : std::nullopt;
  };
  const auto consider = [&](const std::optional<Prox>& of_x, const std::optional<Prox>& of_y) {
    if (is_found() || !near(of_x) || !near(of_y)) return;
    SplitCandidate other = at_points(of, *of_x, *of_y, z, W);
    if (is_borne_out(other)) best = std::move(other);
  };
  // x with its covector, beside y and beside the y that the covector gives.
  const auto consider_covector = [&](const std::optional<Prox>& of_x) {
    if (is_found() || !near(of_x) || of_x->v.size() != z.size() || !of_x->v.allFinite()) return;
    for (const std::optional<Prox>& of_y : {std::optional(y), moreau_partner(*of_x, z, W)}) {
      if (!near(of_y)) continue;
      SplitCandidate other = at_covector(of, *of_x, *of_y, z, W, tolerance);
      if (!is_borne_out(other) || !is_inner_of_points(other.split, tolerance, W)) continue;
      best = std::move(other);
      return;
    }
  };
  const auto consider_all = [&](const std::optional<Prox>& of_x) {
    consider_covector(of_x);
    if (!ended()) consider_covector(with_slope(of.f, of_x, z, W));
    if (!ended()) consider_covector(into(of.f, of_x));
  };
  // Each of the ways takes its own part of the work, so that a costly one leaves some to the next. One on
  // which numbers leave the range of doubles has found nothing.
  const auto attempt = [&](double most, const auto& way) {
    if (is_found()) return;
    const WorkLimit part(most);
    try {
      way();
    } catch (const InvalidInput&) {
      return;
    }
  };
  attempt(part_of_a_way, [&] {
    consider_covector(x);
    if (!is_found()) consider_covector(moreau_partner(y, z, W));
  });
  attempt(part_of_a_move, [&] {
    for (const Vector& point : {Vector(Vector::Zero(z.size())), z}) {
      if (ended()) return;
      auto other = at_zero(of, point, z, W, enough);
      if (other && is_borne_out(*other)) best = *std::move(other);
    }
  });
  attempt(part_of_a_way, [&] { consider_covector(along_slopes(of.f, x, z, W)); });
  // Another way may come nearer where f has no kink.
  std::optional<SplitCandidate> kink;
  attempt(part_of_a_way, [&] {
    SplitCandidate before = best;
    for (const double stiffness : stiffnesses)
      if (!ended()) consider_covector(at_kink(of.f, x, z, W, stiffness, look));
    if (is_found()) kink = std::exchange(best, std::move(before));
  });
  attempt(part_of_a_way, [&] {
    const auto x_inside = into(of.f, x), y_inside = into(of.g, y);
    consider(x, y_inside);
    consider(x_inside, y);
    consider(x_inside, y_inside);
  });
  // What costs little beside the proxes is tried however much work these took.
  attempt(part_of_a_way, [&] {
    const std::optional<Prox> x_of_y = moreau_partner(y, z, W);
    consider(x, moreau_partner(x, z, W));
    consider_covector(x);
    consider(x_of_y, y);
    consider_covector(x_of_y);
    const std::optional<Prox> x_cut = without_small_entries(x, W), y_cut = without_small_entries(y, W);
    consider(x_cut, y);
    consider(x, y_cut);
    consider(x_cut, y_cut);
  });
  attempt(part_of_a_prox, [&] {
    const auto* made = dynamic_cast<const Operation*>(&of.f.node());
    if (!made) return;
    const std::optional<Prox> other = made->other_prox(z, W, look);
    consider(other, y);
    consider_covector(other);
  });
  attempt(part_of_a_way, [&] { consider_all(x); });
  attempt(part_of_a_way, [&] {
    for (const Prox& pair : balanced(of.f, x, z, W, look))
      if (!ended()) consider_all(pair);
  });
  attempt(part_of_a_way, [&] { consider(into(of.f, moreau_partner(y, z, W)), y); });
  const Vector covector = metric_difference(W, z, Vector::Zero(z.size()));
  const Metric V = inverse(W);
  std::optional<Prox> dual;
  attempt(part_of_a_prox, [&] {
    dual = prox_of(of.plain, covector, V);
    consider_all(turned(dual, z, W));
  });
  attempt(part_of_a_move,
          [&] { consider_covector(turned(along_slopes(of.plain, dual, covector, V), z, W)); });
  attempt(part_of_a_move, [&] {
    for (const double stiffness : stiffnesses)
      if (!ended()) consider_covector(turned(at_kink(of.plain, dual, covector, V, stiffness, look), z, W));
  });
  attempt(part_of_a_way, [&] {
    for (const Prox& pair : balanced(of.plain, dual, covector, V, look))
      if (!ended()) consider_all(turned(pair, z, W));
  });
  if (kink && !(is_found() && best.split.error_bound <= kink->split.error_bound)) best = *std::move(kink);
  // Rounding of a far z may have left x outside: a point of the domain that the values bear out is told.
  if (is_found() && best.x_is_outside) {
    const WorkLimit part(part_of_a_move);
    if (const auto x_inside = into(of.f, best.split.x))
      for (SplitCandidate other : {at_points(of, *x_inside, best.split.y, z, W),
                                   at_covector(of, *x_inside, best.split.y, z, W, tolerance)}) {
        if (!is_borne_out(other) || other.x_is_outside) continue;
        if (!is_inner_of_points(other.split, tolerance, W)) continue;
        best = std::move(other);
        break;
      }
  }
  // So it may have left y: W⁻¹v may be inside, or a point beside y; else one is told where g is known.
  const auto tells_g = [&](const SplitCandidate& made) { return std::isfinite(of.g(made.split.y.x)); };
  const bool y_is_rounded = unit_roundoff * W.norm(z) > accuracy_of_prox * W.norm(best.split.y.x);
  if (is_found() && y_is_rounded && !tells_g(best)) {
    const WorkLimit part(part_of_a_move);
    const std::optional<Prox> of_x = best.split.x, of_y = best.split.y;
    const std::pair<std::optional<Prox>, std::optional<Prox>> others[] = {
        {of_x, moreau_partner(*of_x, z, W)}, {of_x, into(of.g, of_y)}, {moreau_partner(y, z, W), y}};
    std::optional<SplitCandidate> known = best.knows_g() ? std::optional(best) : std::nullopt;
    best.open = true;
    for (const auto& [x_told, y_told] : others) {
      if (is_found() || !x_told || !y_told) continue;
      SplitCandidate other = at_covector(of, *x_told, *y_told, z, W, tolerance);
      if (!is_borne_out(other) || !is_inner_of_points(other.split, tolerance, W)) continue;
      if (tells_g(other))
        best = std::move(other);
      else if (!known && other.knows_g())
        known = std::move(other);
    }
    if (!is_found() && known) best = *std::move(known);
  }
  if (wrong && !is_found()) throw InvalidInput(*wrong);
  Decomposition& split = best.split;
  if (best.excess() > 0 && std::isfinite(best.excess()))
    best.rounding += roundings_of_a_term * unit_roundoff *
                     (size_of_slope(of.f, split.x.x) + size_of_slope(of.g, split.y.x));
  if (best.excess() > 0) split.error_bound = std::max(split.error_bound, best.proved());
  // The values alone may prove more than the proxes know of themselves.
  const double proved = best.proved();
  if (proved < split.error_bound) {
    split.x.error_bound = std::min(split.x.error_bound, proved);
    split.y.error_bound = std::min(split.y.error_bound, proved + split.residual);
    split.error_bound = bound_with_residual(split);
  }
  split.status = best.known(tolerance) ? Status::solved : Status::inaccurate;
  return std::move(best.split);
}

/// One look at f, its status by the tolerance.
Decomposition looked_at(const SplitFunctions& of, const Vector& z, const Metric& W, double tolerance,
                        const Look& look) {
  Decomposition split = guarded(of, z, W, tolerance, look);
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

/// What doubles leave open of a piecewise linear-quadratic f, decided in fractions and rounded; none where
/// that takes too many word operations, or doubles cannot hold the answer to the tolerance.
std::optional<Decomposition> in_fractions(const Function& f, const Vector& z, const Metric& W,
                                          double tolerance) {
  if (!f.facts().piecewise_quadratic) return std::nullopt;
  const SplitQuestion question{f.call(), fractions(z), exact_gram(W)};
  const auto exact = exact_split_within(question, most_word_operations);
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
    if (split.status == Status::solved) return split;
    if (!best || split.error_bound < best->error_bound) best = std::move(split);
    if (f.facts().piecewise_quadratic) break;  // no saddle problem is in it
  }
  if (auto exact = in_fractions(f, z, W, tolerance)) return *std::move(exact);
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
  const double size = norm_at_any_scale(W, z);
  if (!(size <= largest_size)) return beyond_squares(f, z, W, tolerance);
  Decomposition split = looked_at_in_turn(f, z, W, tolerance);
  // Squares of what is smaller are 0, and a bound made of them tells nothing.
  const double most = std::max({size, norm_at_any_scale(W, split.x.x), norm_at_any_scale(W, split.y.x)});
  if (most > 0 && most < 1 / largest_size)
    for (double* bound : {&split.error_bound, &split.x.error_bound, &split.y.error_bound})
      *bound = std::max(*bound, 1 / largest_size);
  return split;
}

}  // namespace convex::inline named_functions
