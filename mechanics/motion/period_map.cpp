#include "mechanics/motion/period_map.hpp"

#include <algorithm>
#include <cmath>

namespace mechanics::inline motions {
namespace {

using convex::Matrix;

/// A coordinate that hardly moves is measured by this part of the one that moves most.
double least_scale(const Flight& flight) { return 1e-3 * flight.largest.maxCoeff(); }

/// The same events in the same order; repetitions, of which an accumulation has more or fewer, count once.
bool alike_events(const std::vector<MotionEvent>& a, const std::vector<MotionEvent>& b) {
  const auto same = [](const MotionEvent& x, const MotionEvent& y) {
    return x.kind == y.kind && x.constraints == y.constraints;
  };
  const auto without_repetitions = [&](std::vector<MotionEvent> events) {
    events.erase(std::unique(events.begin(), events.end(), same), events.end());
    return events;
  };
  const auto x = without_repetitions(a), y = without_repetitions(b);
  return std::equal(x.begin(), x.end(), y.begin(), y.end(), same);
}

}  // namespace

std::vector<MotionEvent> Flight::events() const {
  std::vector<MotionEvent> all;
  for (const FlightPiece& piece : pieces) all.insert(all.end(), piece.events.begin(), piece.events.end());
  return all;
}

OrbitQuestion few_steps(OrbitQuestion question, const Flight& flight) {
  constexpr long times = 8, some = 100;
  question.motion.step_limit =
      std::min(question.motion.step_limit, times * static_cast<long>(flight.pieces.size()) + some);
  return question;
}

Vector as_one(const State& state) {
  Vector x(state.q.size() + state.v.size());
  x << state.q, state.v;
  return x;
}

PeriodMap::PeriodMap(const LagrangianSystem& system, double t, const OrbitQuestion& question)
    : system_(system), t_(t), question_(question), variation_(system) {
  for (Index a = 0; a < static_cast<Index>(system.constraints().size()); ++a)
    if (system.constraints()[static_cast<std::size_t>(a)].two_sided) two_sided_.push_back(a);
}

Flight PeriodMap::fly(const Vector& x, double period) const {
  Flight flight;
  const Index n = x.size() / 2;
  flight.largest = x.cwiseAbs();
  try {
    Motion motion(system_, {t_, x.head(n), x.tail(n)}, question_.motion);
    const auto goes_to = [&](const State& state) {
      flight.largest = flight.largest.cwiseMax(as_one(state).cwiseAbs());
    };
    const auto note = [&] {
      const Arc& arc = motion.arc();
      flight.pieces.push_back({arc, motion.events(), motion.state(), motion.acceleration()});
      if (arc.length > 0) goes_to(arc.state(0.5 * arc.length));  // it may end where it began
      goes_to(motion.state());
    };
    if (!motion.events().empty()) note();
    while (motion.advance(t_ + period)) note();
    flight.arrives = motion.status() == MotionStatus::done && motion.state().t >= t_ + period;
    flight.why = motion.why();
    flight.end = as_one(motion.state());
    if (flight.arrives) flight.rate = as_one({motion.state().t, motion.state().v, motion.acceleration()});
  } catch (const convex::InvalidInput& error) {
    flight.why = error.what();
  }
  return flight;
}

Vector PeriodMap::miss(const Flight& flight, const Vector& x) const {
  Vector difference = flight.end - x;
  for (Index i = 0; i < question_.modulo.size(); ++i)
    if (question_.modulo[i] > 0)
      difference[i] -= question_.modulo[i] * std::round(difference[i] / question_.modulo[i]);
  return difference;
}

double PeriodMap::relative(const Vector& miss, const Flight& flight) const {
  double worst = 0;
  for (Index i = 0; i < miss.size(); ++i)
    worst = std::max(worst, std::abs(miss[i]) / std::max(flight.largest[i], least_scale(flight)));
  return worst;
}

FlowDerivative PeriodMap::derivative(const TangentChart& chart, const Flight& flight) const {
  FlowDerivative found = flow_derivative(variation_, flight.pieces, question_.motion, two_sided_);
  if (found.kind != FlowDerivative::Kind::known) return found;
  const Index size = chart.dimension();
  Matrix directions(found.value.rows(), size), D(size, size);
  for (Index k = 0; k < size; ++k) directions.col(k) = chart.direction(k);
  variation_.hold(chart.origin(), two_sided_, directions);
  const Matrix ends = found.value * directions;
  for (Index k = 0; k < size; ++k) D.col(k) = chart.along(ends.col(k));
  return {found.kind, std::move(D), found.growth};
}

std::optional<Matrix> PeriodMap::differences(const TangentChart& chart, double period, const Flight& flight,
                                             double step, int levels, bool at_any_rate) const {
  const Index size = chart.dimension();
  const std::vector<MotionEvent> events = flight.events();
  Matrix D(size, size);
  for (Index k = 0; k < size; ++k) {
    double part = 0;  // of what the motion goes, by a unit of this coordinate
    const Vector direction = chart.direction(k);
    for (Index i = 0; i < direction.size(); ++i)
      part = std::max(part, std::abs(direction[i]) / std::max(flight.largest[i], least_scale(flight)));
    const auto beside = [&](double by) -> std::optional<Vector> {
      const Flight other = fly(chart.state_of(by * Vector::Unit(size, k)), period);
      if (!other.arrives || (!at_any_rate && !alike_events(other.events(), events))) return std::nullopt;
      return other.end;
    };
    std::vector<Vector> slopes;  // with h, 2h, 4h, …
    double h = step / part;
    for (int level = 0; level < levels; ++level, h *= 2) {
      const auto right = beside(h), left = beside(-h);
      if (!right || !left) return std::nullopt;
      slopes.push_back((*right - *left) / (2 * h));
    }
    double factor = 4;
    for (std::size_t left = slopes.size(); left > 1; --left, factor *= 4)
      for (std::size_t j = 0; j + 1 < left; ++j) slopes[j] += (slopes[j] - slopes[j + 1]) / (factor - 1);
    D.col(k) = chart.along(slopes[0]);
  }
  return D;
}

}  // namespace mechanics::inline motions
