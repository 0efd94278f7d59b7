#include "mechanics/motion/saltation.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "mechanics/motion/linear_flow.hpp"

namespace mechanics::inline motions {
namespace {

using convex::Matrix;
using Kind = FlowDerivative::Kind;

/// What is equal by theory agrees to rounding times a condition, and what is not differs by far more: half
/// the digits lie between. So of a rate after an impact, beside the one before, where the contact rests;
/// velocities after impacts one by one beside those of all at once, and saltation matrices of two orders;
/// accelerations before and after an event.
const double half_the_digits = std::sqrt(std::numeric_limits<double>::epsilon());

/// An instant within so many roundings of an event's is the event's.
constexpr double roundings_of_event = 1e4;

/// More impacts at once are not tried in all orders.
constexpr std::size_t most_at_once = 4;

bool is_member(const std::vector<Index>& all, Index a) {
  return std::find(all.begin(), all.end(), a) != all.end();
}

Vector joined_vector(const Vector& a, const Vector& b) {
  Vector x(a.size() + b.size());
  x << a, b;
  return x;
}

class Saltation {
 public:
  Saltation(const Variation& variation, const MotionOptions& options, const std::vector<Index>& two_sided)
      : variation_(variation), options_(options), two_sided_(two_sided), n_(variation.coordinates()) {}

  /// S of what happens at the end of a piece. next: the contacts held after it, as far as they are known.
  FlowDerivative at_end(const FlightPiece& piece, const std::vector<Index>& next) const {
    std::vector<Index> closing;
    const MotionEvent* hit = nullptr;
    bool is_contact = false, has_events = false;
    for (const MotionEvent& event : piece.events) {
      if (event.kind == EventKind::accumulation) continue;  // its impacts were its course
      has_events = true;
      is_contact = is_contact || event.kind == EventKind::contact;
      if (event.kind == EventKind::impact) hit = &event;
    }
    FlowDerivative found{Kind::known, Matrix::Identity(2 * n_, 2 * n_)};
    if (!has_events) return found;
    if (is_contact) return {Kind::none, {}};
    const std::vector<Index>& held = piece.arc.persist.empty() ? two_sided_ : piece.arc.persist;
    State before = piece.after;
    if (hit == nullptr) return change_of_force(piece, before, held);
    before.v = hit->velocity_before;
    if (is_at_switch(piece, before, held)) return {Kind::none, {}};
    std::vector<Index> joining;  // come to rest with others, by the end of infinitely many impacts
    for (const Index a : hit->constraints)
      if (!is_member(held, a) && variation_.rate(before, a).value < 0) closing.push_back(a);
    for (const Index a : next)
      if (!is_member(held, a) && !is_member(closing, a)) joining.push_back(a);
    if (closing.empty() || closing.size() > most_at_once) return {Kind::none, {}};
    bool is_first = true;
    do {
      FlowDerivative one = in_order(piece, before, held, closing, joining);
      if (one.kind != Kind::known) return one;
      if (!is_first && (one.value - found.value).norm() > half_the_digits * found.value.norm())
        return {Kind::none, {}};
      found = std::move(one);
      is_first = false;
    } while (std::next_permutation(closing.begin(), closing.end()));
    return found;
  }

 private:
  /// Velocities go on; q'' may jump where an expression changes its branch.
  FlowDerivative change_of_force(const FlightPiece& piece, const State& at,
                                 const std::vector<Index>& held) const {
    FlowDerivative found{Kind::known, Matrix::Identity(2 * n_, 2 * n_)};
    if (variation_.switches() == 0) return found;
    const Vector before = piece.arc.length > 0 ? piece.arc.acceleration(piece.arc.length)
                                               : variation_.acceleration(at, held).value;
    const Vector jump = piece.acceleration - before;
    if (jump.norm() <= half_the_digits * (before.norm() + piece.acceleration.norm())) return found;
    const Vector along = flow(at.v, before);
    std::optional<Vector> across;
    for (Index k = 0; k < variation_.switches(); ++k) {
      const Variation::Number argument = variation_.switch_argument(at, k);
      const double rate = argument.gradient.dot(along);
      if (!is_now(argument.value, rate, piece)) continue;
      const Vector direction = argument.gradient.head(2 * n_) / rate;
      if (across && (*across - direction).norm() > half_the_digits * direction.norm())
        return {Kind::none, {}};
      across = direction;
    }
    if (!across) return {Kind::none, {}};
    found.value.bottomRows(n_) += jump * across->transpose();
    return found;
  }

  /// Whether something that falls at this rate is 0 but for the rounding of t.
  static bool is_now(double value, double rate, const FlightPiece& piece) {
    const double times = std::abs(piece.arc.t) + piece.arc.length;
    return rate != 0 &&
           std::abs(value / rate) <= roundings_of_event * std::numeric_limits<double>::epsilon() * times;
  }

  bool is_at_switch(const FlightPiece& piece, const State& at, const std::vector<Index>& held) const {
    if (variation_.switches() == 0) return false;
    const Vector along = flow(at.v, variation_.acceleration(at, held).value);
    for (Index k = 0; k < variation_.switches(); ++k) {
      const Variation::Number argument = variation_.switch_argument(at, k);
      if (is_now(argument.value, argument.gradient.dot(along), piece)) return true;
    }
    return false;
  }

  static Vector flow(const Vector& v, const Vector& q2) {
    Vector x(2 * v.size() + 1);
    x << v, q2, 1;
    return x;
  }

  bool rests(const State& before, const State& after, Index a) const {
    return std::abs(variation_.rate(after, a).value) <=
           half_the_digits * std::abs(variation_.rate(before, a).value);
  }

  FlowDerivative in_order(const FlightPiece& piece, const State& before, const std::vector<Index>& held,
                          const std::vector<Index>& order, const std::vector<Index>& joining) const {
    // Held contacts that push on, or have nothing to do with it.
    std::vector<Index> with = held;
    const double moved = (piece.after.v - before.v).norm();
    std::erase_if(with, [&](Index a) {
      const Variation::Number after = variation_.rate(piece.after, a);
      return !is_member(two_sided_, a) &&
             after.value > half_the_digits * after.gradient.segment(n_, n_).norm() * moved;
    });
    State now = before;
    Vector q2 = variation_.acceleration(before, held).value;
    FlowDerivative all{Kind::known, Matrix::Identity(2 * n_, 2 * n_)};
    for (const Index a : order) {
      const Variation::Number f = variation_.constraint(now, a);
      const double rate = variation_.rate(now, a).value;
      if (!(rate < 0)) return {Kind::none, {}};
      const bool is_last = a == order.back();
      std::vector<Index> enforced = with;
      enforced.push_back(a);
      if (is_last) enforced.insert(enforced.end(), joining.begin(), joining.end());
      const bool is_alone = std::all_of(enforced.begin(), enforced.end(),
                                        [&](Index k) { return k == a || is_member(two_sided_, k); });
      if (options_.impact_law != ImpactLaw::moreau && !(is_alone && order.size() == 1))
        return {Kind::undecided, {}};
      Vector e = Vector::Zero(static_cast<Index>(enforced.size()));
      const bool stays = rests(before, piece.after, a);
      if (!stays && options_.restitution.size() > 0)
        e[static_cast<Index>(with.size())] = options_.restitution[a];
      const Variation::Impact impact = variation_.impact(now, enforced, e);
      if (stays) with.push_back(a);
      State after = now;
      after.v = impact.velocity;
      const Vector q2_after = is_last ? piece.acceleration : variation_.acceleration(after, with).value;
      Matrix g = Matrix::Zero(2 * n_, 2 * n_ + 1);
      g.topLeftCorner(n_, n_) = Matrix::Identity(n_, n_);
      g.bottomRows(n_) = impact.gradient;
      Matrix S = g.leftCols(2 * n_);
      S += (joined_vector(after.v, q2_after) - g * flow(now.v, q2)) *
           (f.gradient.head(2 * n_) / rate).transpose();
      all.value = S * all.value;
      now = after;
      q2 = q2_after;
    }
    if ((now.v - piece.after.v).norm() > half_the_digits * (before.v.norm() + piece.after.v.norm()))
      return {options_.impact_law == ImpactLaw::moreau ? Kind::none : Kind::undecided, {}};
    return all;
  }

  const Variation& variation_;
  const MotionOptions& options_;
  const std::vector<Index>& two_sided_;
  Index n_;
};

}  // namespace

FlowDerivative flow_derivative(const Variation& variation, const std::vector<FlightPiece>& flight,
                               const MotionOptions& options, const std::vector<Index>& two_sided) {
  const Index n = variation.coordinates();
  const Saltation saltation(variation, options, two_sided);
  FlowDerivative found{Kind::known, Matrix::Identity(2 * n, 2 * n), 1};
  const auto held_after = [&](std::size_t k) {
    while (++k < flight.size())
      if (flight[k].arc.length > 0) return flight[k].arc.persist;
    return std::vector<Index>{};
  };
  bool is_new = true;  // a start, or after an event
  for (std::size_t k = 0; k < flight.size(); ++k) {
    const FlightPiece& piece = flight[k];
    if (const double length = piece.arc.length; length > 0) {
      if (is_new) variation.hold(piece.arc.state(0), piece.arc.persist, found.value);
      const auto J = [&](double tau) {
        Matrix of = Matrix::Zero(2 * n, 2 * n);
        of.topRightCorner(n, n) = Matrix::Identity(n, n);
        of.bottomRows(n) =
            variation.acceleration(piece.arc.state(tau), piece.arc.persist).gradient.leftCols(2 * n);
        return of;
      };
      found.value = linear_flow(J, length) * found.value;
      found.growth = std::max(found.growth, found.value.norm());
      is_new = false;
    }
    if (piece.events.empty()) continue;
    const FlowDerivative S = saltation.at_end(piece, held_after(k));
    if (S.kind != Kind::known) return S;
    found.value = S.value * found.value;
    is_new = true;
  }
  return found;
}

}  // namespace mechanics::inline motions
