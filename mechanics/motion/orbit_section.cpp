#include "mechanics/motion/orbit_section.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "mechanics/motion/taylor_series.hpp"

namespace mechanics::inline motions {
namespace {

/// Points of an arc between which a gap, or a multiplier, is taken to turn around at most once.
constexpr int looks_at_gap = 16;

/// An instant within so many roundings of an event's is the event's.
constexpr double roundings_of_instant = 1e4;

bool is_held(const Arc& arc, Index a) {
  return std::find(arc.persist.begin(), arc.persist.end(), a) != arc.persist.end();
}

/// The least value of a gap or a multiplier where it turns around within an arc.
double least_turn(std::span<const double> f, double length) {
  double least = std::numeric_limits<double>::infinity(), from = 0;
  bool falls = slope_at(f, 0) < 0;
  for (int k = 1; k <= looks_at_gap; ++k) {
    const double to = length * k / looks_at_gap;
    const bool falls_there = slope_at(f, to) < 0;
    if (falls && !falls_there) {
      double low = from, high = to;
      for (double middle = 0.5 * (low + high); middle > low && middle < high; middle = 0.5 * (low + high))
        (slope_at(f, middle) < 0 ? low : high) = middle;
      least = std::min(least, value_at(f, high));
    }
    falls = falls_there;
    from = to;
  }
  return least;
}

void note_contacts(const Flight& flight, const LagrangianSystem& system, Orbit& orbit) {
  const auto m = static_cast<Index>(system.constraints().size());
  orbit.least_gap = orbit.least_closing = orbit.least_pressing =
      Vector::Constant(m, std::numeric_limits<double>::infinity());
  orbit.releases.assign(system.constraints().size(), 0);
  for (const FlightPiece& piece : flight.pieces) {
    if (!(piece.arc.length > 0)) continue;
    for (Index a = 0; a < m; ++a)
      if (!is_held(piece.arc, a))
        orbit.least_gap[a] =
            std::min(orbit.least_gap[a], least_turn(coefficients(piece.arc.f, a), piece.arc.length));
    for (const Index a : piece.arc.persist)
      if (!system.constraints()[static_cast<std::size_t>(a)].two_sided)
        orbit.least_pressing[a] = std::min(orbit.least_pressing[a],
                                           least_turn(coefficients(piece.arc.lambda, a), piece.arc.length));
    for (const MotionEvent& event : piece.events)
      for (const Index a : event.constraints)
        if (event.kind == EventKind::release) ++orbit.releases[static_cast<std::size_t>(a)];
    for (const MotionEvent& event : piece.events)
      for (const Index a : event.constraints)
        if (event.kind == EventKind::impact && !is_held(piece.arc, a))
          orbit.least_closing[a] = std::min(
              orbit.least_closing[a], std::abs(slope_at(coefficients(piece.arc.f, a), piece.arc.length)));
  }
}

}  // namespace

void note_passage(const Flight& flight, const LagrangianSystem& system, Orbit& orbit) {
  note_contacts(flight, system, orbit);
  orbit.largest = flight.largest;
  const double begin = orbit.start.t, T = orbit.period;
  orbit.quiet = orbit.start;
  orbit.start_margin = orbit.quiet_margin = T;
  std::vector<double> times;
  for (const MotionEvent& event : flight.events()) times.push_back(event.t);
  if (times.empty()) return;
  std::sort(times.begin(), times.end());
  orbit.start_margin = orbit.quiet_margin = std::min(times.front() - begin, begin + T - times.back());
  bool was_free = false;
  for (std::size_t k = 0; k < times.size(); ++k) {
    const double next = k + 1 < times.size() ? times[k + 1] : times.front() + T;
    double middle = 0.5 * (times[k] + next);
    if (middle >= begin + T) middle -= T;
    const double margin = 0.5 * (next - times[k]);
    for (const FlightPiece& piece : flight.pieces) {
      const double tau = middle - piece.arc.t;
      if (!(piece.arc.length > 0) || tau < 0 || tau > piece.arc.length) continue;
      const auto held = std::count_if(piece.arc.persist.begin(), piece.arc.persist.end(), [&](Index a) {
        return !system.constraints()[static_cast<std::size_t>(a)].two_sided;
      });
      // On contacts that are held a state cannot be varied freely.
      const bool is_free = held == 0;
      if (is_free < was_free || (is_free == was_free && margin <= orbit.quiet_margin)) break;
      was_free = was_free || is_free;
      orbit.quiet_margin = margin;
      orbit.quiet = piece.arc.state(tau);
      orbit.quiet.t = middle;
      break;
    }
  }
}

Orbit orbit_from(const LagrangianSystem& system, const Orbit& orbit, const OrbitQuestion& question,
                 double t) {
  const double T = orbit.period, begin = orbit.start.t;
  if (t == begin) return orbit;
  const PeriodMap map(system, begin, question);
  const Vector x = as_one(orbit.start);
  const Flight flight = map.fly(x, T);
  if (!flight.arrives) return orbit;
  const Index n = orbit.start.q.size();
  const Vector turn = flight.end - x - map.miss(flight, x);  // of coordinates that come back up to a multiple
  double ahead = std::fmod(t - begin, T);
  if (ahead < 0) ahead += T;
  const double instant = begin + ahead, periods = std::round((instant - t) / T);
  const double one_instant =
      roundings_of_instant * std::numeric_limits<double>::epsilon() * (std::abs(begin) + std::abs(t) + T);
  State there = orbit.start;
  for (const FlightPiece& piece : flight.pieces) {
    const double end = piece.arc.t + piece.arc.length;
    if (piece.arc.length > 0 && piece.arc.t <= instant)
      there = piece.arc.state(std::min(instant - piece.arc.t, piece.arc.length));
    if (!piece.events.empty() && std::abs(end - instant) <= one_instant) there = piece.after;
  }
  Orbit moved = orbit;
  moved.start.t = t;
  moved.start.q = there.q - periods * turn.head(n);
  moved.start.v = there.v;
  for (MotionEvent& impact : moved.impacts) impact.t += T * std::ceil((t + one_instant - impact.t) / T);
  std::sort(moved.impacts.begin(), moved.impacts.end(),
            [](const MotionEvent& a, const MotionEvent& b) { return a.t < b.t; });
  const Vector y = as_one(moved.start);
  const PeriodMap from_there(system, t, question);
  if (const Flight round = from_there.fly(y, T); round.arrives) {
    moved.residual = from_there.relative(from_there.miss(round, y), round);
    note_passage(round, system, moved);
  }
  return moved;
}

}  // namespace mechanics::inline motions
