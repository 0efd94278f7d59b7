#include "mechanics/motion/rounding_growth.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace mechanics::inline motions {
namespace {

Vector one_rounding_away(Vector x) {
  for (double& entry : x)
    if (entry != 0)
      entry = std::nextafter(entry, std::copysign(std::numeric_limits<double>::infinity(), entry));
  return x;
}

/// What has not grown so many times is no loss: numbers that are rounding themselves change by all they are.
/// Roundings on the way of a regular motion add up to less. A rounding that reaches the digits that are
/// printed has grown 1e10 times, so that anything between decides alike.
constexpr double least_growth = 1e3;

/// The largest |q_i| and |v_i| so far.
struct Sizes {
  Vector q, v;
  void take(const State& at) {
    q = q.cwiseMax(at.q.cwiseAbs());
    v = v.cwiseMax(at.v.cwiseAbs());
  }
};

}  // namespace

std::optional<RoundingGrowth> rounding_growth(const LagrangianSystem& system, const State& start,
                                              const MotionOptions& options, const Motion& ended) {
  const State other{start.t, one_rounding_away(start.q), one_rounding_away(start.v)};
  if (other.q == start.q && other.v == start.v) return std::nullopt;
  const State& end = ended.state();
  Sizes sizes{start.q.cwiseAbs(), start.v.cwiseAbs()};
  sizes.take(end);
  State then;
  try {
    Motion motion(system, other, options);
    while (motion.advance(end.t)) {
      sizes.take(motion.arc().state(0.5 * motion.arc().length));
      sizes.take(motion.state());
    }
    if (motion.status() != MotionStatus::done || motion.state().t != end.t) return std::nullopt;
    then = motion.state();
  } catch (const convex::InvalidInput&) {
    return std::nullopt;  // contacts that a rounding opens or closes
  }
  RoundingGrowth found;
  const double dq = (other.q - start.q).lpNorm<Eigen::Infinity>();
  const double dv = (other.v - start.v).lpNorm<Eigen::Infinity>(), time = end.t - start.t;
  const auto look = [&](Index i, bool of_velocity, double change, double size, double error) {
    if (change > std::max(found.part * size, least_growth * error))
      found = {i, of_velocity, change, change / size};
  };
  for (Index i = 0; i < then.q.size(); ++i) {
    look(i, false, std::abs(then.q[i] - end.q[i]), sizes.q[i], dq + dv * time);
    // An oscillation turns an error of its position into one of its velocity.
    const double rate = std::max(time > 0 ? 1 / time : 0, sizes.q[i] > 0 ? sizes.v[i] / sizes.q[i] : 0);
    look(i, true, std::abs(then.v[i] - end.v[i]), sizes.v[i], dv + dq * rate);
  }
  return found;
}

}  // namespace mechanics::inline motions
