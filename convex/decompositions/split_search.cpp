#include "convex/decompositions/split_search.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "convex/composite/closed_form.hpp"
#include "convex/composite/metric_difference.hpp"
#include "convex/decompositions/cutting_planes.hpp"
#include "convex/functions/interior.hpp"
#include "convex/functions/other_pairs.hpp"
#include "convex/gamma0/work_limit.hpp"
#include "convex/operations/metric_algebra.hpp"
#include "convex/operations/operation.hpp"

namespace convex::inline decompositions {
namespace {

/// What each prox, each move into a domain and each other way to a pair may take of the work that a question
/// may.
constexpr double part_of_a_prox = 0.8, part_of_a_move = 0.1, part_of_a_way = 0.3;

/// Of cuts beside a kink: above the curvature of most functions, of many, and none.
constexpr double stiffnesses[] = {1e6, 1e3, 1};

/// `found`, or a point of which nothing is known.
Prox made_up(const std::optional<Prox>& found, const Vector& point) {
  if (found) return *found;
  Prox made;
  made.x = point;
  made.error_bound = std::numeric_limits<double>::infinity();
  made.status = Status::gave_up;
  return made;
}

class SplitSearch {
 public:
  SplitSearch(const SplitFunctions& of, const Vector& z, const Metric& W, double tolerance, const Look& look)
      : of_(of),
        z_(z),
        W_(W),
        tolerance_(tolerance),
        look_(look),
        covector_(metric_difference(W, z, Vector::Zero(z.size()))) {}

  Decomposition run() {
    find_proxes();
    for (const Way& way : ways) attempt(way);
    // Another way may have come nearer where f has no kink.
    if (kink_ && !(is_found() && best_.split.error_bound <= kink_->split.error_bound))
      best_ = *std::move(kink_);
    if (is_found() && best_.x_is_outside) tell_x_inside();
    const bool y_is_rounded = unit_roundoff * W_.norm(z_) > accuracy_of_prox * W_.norm(best_.split.y.x);
    if (is_found() && y_is_rounded && !tells_g(best_)) tell_g();
    if (wrong_ && !is_found()) throw InvalidInput(*wrong_);
    Decomposition split = bounded_by_values();
    const bool is_outside = best_.x_is_outside && is_beyond_domain(of_.f, split.x.x, z_.norm());
    if (!is_outside && !is_denied(split, best_.rounding + best_.error)) return split;
    split.status = Status::inaccurate;
    split.error_bound = split.x.error_bound = split.y.error_bound = std::numeric_limits<double>::infinity();
    return split;
  }

 private:
  /// A way to other pairs, and what it may take of the work, so that a costly one leaves some to the next.
  struct Way {
    double work;
    void (SplitSearch::*go)();
  };
  static const Way ways[14];

  /// Whether f(p) + g(q) >= (p|q) fails for z and y, or for x and what the prox of g gave, of a split that
  /// hangs on values: they may be of a covector beside its domain, or cut short with the work.
  bool is_denied(const Decomposition& split, double rounding) const {
    if (split.x.route != ProxRoute::iterative) return false;
    if (holds_nearer_point(of_, split, z_, W_)) return true;
    if (!f_of_z_) f_of_z_ = told_value(of_.f, z_);
    const auto contradicts = [&](const Value& f_p, const Vector& p, const Value& g_q, const Vector& q) {
      const double sizes = W_.norm(p) * W_.norm(q) + std::abs(f_p.value) + std::abs(g_q.value);
      const double doubt = rounding + f_p.error + g_q.error +
                           (roundings_of_a_term * unit_roundoff + tolerance_) * sizes +
                           split.error_bound * (W_.norm(p) + W_.norm(q));
      return f_p.value + g_q.value < W_.inner(p, q) - doubt;
    };
    return contradicts(*f_of_z_, z_, {split.g_y, 0}, split.y.x) ||
           contradicts({split.f_x, 0}, split.x.x, g_of_y_, y_.x);
  }
  bool bears_out(const SplitCandidate& made) const {
    return is_borne_out(made, enough_, tolerance_) && !is_denied(made.split, made.rounding + made.error);
  }
  bool is_found() const { return bears_out(best_); }
  bool ended() const { return is_found() || WorkLimit::passed(); }
  bool is_near(const std::optional<Prox>& found) const { return found && found->error_bound <= enough_; }

  /// A way on which numbers leave the range of doubles has found nothing.
  void attempt(const Way& way) {
    if (is_found()) return;
    const WorkLimit part(way.work);
    try {
      (this->*way.go)();
    } catch (const InvalidInput&) {
      return;
    }
  }

  /// So has a prox; and one into a domain that is empty, which is told where no way finds a pair.
  Prox prox_of(const Function& h, const Vector& point, const Metric& V) {
    const WorkLimit part(part_of_a_prox);
    try {
      return h.prox(point, V, look_);
    } catch (const InvalidInput& said) {
      if (!wrong_) wrong_ = said;
      return Prox{};
    }
  }

  void find_proxes() {
    x_ = prox_of(of_.f, z_, W_), y_ = prox_of(of_.g, z_, W_);
    // What gave up without a point is found from the other, or not at all.
    const auto none = [&](const Prox& part) { return part.x.size() != z_.size(); };
    if (none(x_)) x_ = made_up(none(y_) ? std::nullopt : moreau_partner(y_, z_, W_), z_);
    if (none(y_)) y_ = made_up(moreau_partner(x_, z_, W_), Vector::Zero(z_.size()));
    best_ = at_points(of_, x_, y_, z_, W_);
    if (std::isfinite(best_.split.g_y)) g_of_y_ = {best_.split.g_y, best_.error};
    enough_ = tolerance_ * std::max({1.0, W_.norm(z_), W_.norm(x_.x)});
  }

  std::optional<Prox> moved_inside(const Function& h, const std::optional<Prox>& found) const {
    const WorkLimit part(part_of_a_move);
    const double size = W_.norm(z_) + W_.norm(x_.x) + W_.norm(y_.x);
    return is_near(found) ? moved_into_domain(h, *found, size, W_, look_) : std::nullopt;
  }

  void consider(const std::optional<Prox>& x, const std::optional<Prox>& y) {
    if (is_found() || !is_near(x) || !is_near(y)) return;
    SplitCandidate other = at_points(of_, *x, *y, z_, W_);
    if (bears_out(other)) best_ = std::move(other);
  }

  /// x with its covector beside y, where the values bear that out.
  std::optional<SplitCandidate> borne_out_at_covector(const Prox& x, const Prox& y) const {
    SplitCandidate other = at_covector(of_, x, y, z_, W_, tolerance_);
    if (!bears_out(other) || !is_inner_of_points(other.split, tolerance_, W_)) return std::nullopt;
    return other;
  }

  /// x with its covector, beside y and beside the y that the covector gives.
  void consider_covector(const std::optional<Prox>& x) {
    if (is_found() || !is_near(x) || x->v.size() != z_.size() || !x->v.allFinite()) return;
    for (const std::optional<Prox>& y : {std::optional(y_), moreau_partner(*x, z_, W_)}) {
      if (!is_near(y)) continue;
      if (auto other = borne_out_at_covector(*x, *y)) {
        best_ = *std::move(other);
        return;
      }
    }
  }

  /// The same with the slope that f has there, and with x moved into the domain.
  void consider_all(const std::optional<Prox>& x) {
    consider_covector(x);
    if (!ended()) consider_covector(with_slope(of_.f, x, z_, W_));
    if (!ended()) consider_covector(moved_inside(of_.f, x));
  }

  void by_own_covectors() {
    consider_covector(x_);
    if (!is_found()) consider_covector(moreau_partner(y_, z_, W_));
  }

  void by_values_at_zero() {
    for (const Vector& point : {Vector(Vector::Zero(z_.size())), z_}) {
      if (ended()) return;
      auto other = at_zero(of_, point, z_, W_, enough_);
      if (other && bears_out(*other)) best_ = *std::move(other);
    }
  }

  void by_slopes() { consider_covector(along_slopes(of_.f, x_, z_, W_)); }

  /// Kept apart: a way after this one may come nearer.
  void by_kinks() {
    SplitCandidate before = best_;
    for (const double stiffness : stiffnesses)
      if (!ended()) consider_covector(at_kink(of_.f, x_, z_, W_, stiffness, look_));
    if (is_found()) kink_ = std::exchange(best_, std::move(before));
  }

  void by_points_inside() {
    const auto x_inside = moved_inside(of_.f, x_), y_inside = moved_inside(of_.g, y_);
    consider(x_, y_inside);
    consider(x_inside, y_);
    consider(x_inside, y_inside);
  }

  /// What costs little beside the proxes is tried however much work these took.
  void by_partners() {
    const std::optional<Prox> x_of_y = moreau_partner(y_, z_, W_);
    consider(x_, moreau_partner(x_, z_, W_));
    consider_covector(x_);
    consider(x_of_y, y_);
    consider_covector(x_of_y);
    const std::optional<Prox> x_cut = without_small_entries(x_, W_), y_cut = without_small_entries(y_, W_);
    consider(x_cut, y_);
    consider(x_, y_cut);
    consider(x_cut, y_cut);
  }

  void by_other_prox() {
    const auto* made = dynamic_cast<const Operation*>(&of_.f.node());
    if (!made) return;
    const std::optional<Prox> other = made->other_prox(z_, W_, look_);
    consider(other, y_);
    consider_covector(other);
  }

  void by_slope_and_domain() { consider_all(x_); }

  void by_balance() {
    for (const Prox& pair : balanced(of_.f, x_, z_, W_, look_))
      if (!ended()) consider_all(pair);
  }

  void by_partner_inside() { consider(moved_inside(of_.f, moreau_partner(y_, z_, W_)), y_); }

  const Metric& dual_metric() {
    if (!V_) V_ = inverse(W_);
    return *V_;
  }

  /// The prox of f* at Wz in W⁻¹, and what is near it.
  void by_dual() {
    dual_ = prox_of(of_.plain, covector_, dual_metric());
    consider_all(turned(dual_, z_, W_));
  }

  void by_dual_slopes() {
    consider_covector(turned(along_slopes(of_.plain, dual_, covector_, dual_metric()), z_, W_));
  }

  void by_dual_kinks() {
    for (const double stiffness : stiffnesses)
      if (!ended())
        consider_covector(
            turned(at_kink(of_.plain, dual_, covector_, dual_metric(), stiffness, look_), z_, W_));
  }

  void by_dual_balance() {
    for (const Prox& pair : balanced(of_.plain, dual_, covector_, dual_metric(), look_))
      if (!ended()) consider_all(turned(pair, z_, W_));
  }

  /// Rounding of a far z may have left x outside: a point of the domain that the values bear out is told.
  void tell_x_inside() {
    const WorkLimit part(part_of_a_move);
    const auto x = moved_inside(of_.f, best_.split.x);
    if (!x) return;
    const Prox y = best_.split.y;
    for (SplitCandidate other :
         {at_points(of_, *x, y, z_, W_), at_covector(of_, *x, y, z_, W_, tolerance_)}) {
      if (!bears_out(other) || other.x_is_outside) continue;
      if (!is_inner_of_points(other.split, tolerance_, W_)) continue;
      best_ = std::move(other);
      return;
    }
  }

  bool tells_g(const SplitCandidate& made) const { return std::isfinite(of_.g(made.split.y.x)); }

  /// So it may have left y: W⁻¹v may be inside, or a point beside y; else one is told where g is known.
  void tell_g() {
    const WorkLimit part(part_of_a_move);
    const std::optional<Prox> x = best_.split.x, y = best_.split.y;
    const std::pair<std::optional<Prox>, std::optional<Prox>> others[] = {
        {x, moreau_partner(*x, z_, W_)}, {x, moved_inside(of_.g, y)}, {moreau_partner(y_, z_, W_), y_}};
    std::optional<SplitCandidate> known = best_.knows_g() ? std::optional(best_) : std::nullopt;
    best_.open = true;
    for (const auto& [x_told, y_told] : others) {
      if (is_found() || !x_told || !y_told) continue;
      auto other = borne_out_at_covector(*x_told, *y_told);
      if (!other) continue;
      if (tells_g(*other))
        best_ = *std::move(other);
      else if (!known && other->knows_g())
        known = std::move(other);
    }
    if (!is_found() && known) best_ = *std::move(known);
  }

  /// The bound is no less than what the values deny, and no more than what they prove.
  Decomposition bounded_by_values() {
    Decomposition& split = best_.split;
    if (best_.excess() > 0 && std::isfinite(best_.excess()))
      best_.rounding += roundings_of_a_term * unit_roundoff *
                        (size_of_slope(of_.f, split.x.x) + size_of_slope(of_.g, split.y.x));
    if (best_.excess() > 0) split.error_bound = std::max(split.error_bound, best_.proved());
    const double proved = best_.proved();
    if (proved < split.error_bound) {
      split.x.error_bound = std::min(split.x.error_bound, proved);
      split.y.error_bound = std::min(split.y.error_bound, proved + split.residual);
      split.error_bound = bound_with_residual(split);
    }
    split.status = best_.known(tolerance_) ? Status::solved : Status::inaccurate;
    return std::move(split);
  }

  const SplitFunctions& of_;
  const Vector& z_;
  const Metric& W_;
  const double tolerance_;
  const Look& look_;
  const Vector covector_;  ///< Wz
  Prox x_, y_;             ///< as the two proxes gave them
  double enough_ = 0;      ///< what a bound may be
  mutable std::optional<Value> f_of_z_;
  Value g_of_y_{std::numeric_limits<double>::infinity(), 0};
  SplitCandidate best_;
  std::optional<SplitCandidate> kink_;
  std::optional<Metric> V_;  ///< W⁻¹
  std::optional<Prox> dual_;
  std::optional<InvalidInput> wrong_;
};

const SplitSearch::Way SplitSearch::ways[] = {
    {part_of_a_way, &SplitSearch::by_own_covectors}, {part_of_a_move, &SplitSearch::by_values_at_zero},
    {part_of_a_way, &SplitSearch::by_slopes},        {part_of_a_way, &SplitSearch::by_kinks},
    {part_of_a_way, &SplitSearch::by_points_inside}, {part_of_a_way, &SplitSearch::by_partners},
    {part_of_a_prox, &SplitSearch::by_other_prox},   {part_of_a_way, &SplitSearch::by_slope_and_domain},
    {part_of_a_way, &SplitSearch::by_balance},       {part_of_a_way, &SplitSearch::by_partner_inside},
    {part_of_a_prox, &SplitSearch::by_dual},         {part_of_a_move, &SplitSearch::by_dual_slopes},
    {part_of_a_move, &SplitSearch::by_dual_kinks},   {part_of_a_way, &SplitSearch::by_dual_balance}};

}  // namespace

bool is_borne_out(const SplitCandidate& made, double enough, double tolerance) {
  return made.excess() <= 0 && made.known(tolerance) && made.split.error_bound <= enough;
}

Decomposition searched_split(const SplitFunctions& of, const Vector& z, const Metric& W, double tolerance,
                             const Look& look) {
  return SplitSearch(of, z, W, tolerance, look).run();
}

}  // namespace convex::inline decompositions
