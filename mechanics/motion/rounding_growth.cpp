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
  const auto look = [&](const Vector& a, const Vector& b, const Vector& size, double error,
                        bool of_velocity) {
    for (Index i = 0; i < a.size(); ++i)
      if (const double change = std::abs(a[i] - b[i]);
          change > std::max(found.part * size[i], least_growth * error))
        found = {i, of_velocity, change, change / size[i]};
  };
  const double dq = (other.q - start.q).lpNorm<Eigen::Infinity>();
  const double dv = (other.v - start.v).lpNorm<Eigen::Infinity>(), time = end.t - start.t;
  look(then.q, end.q, sizes.q, dq + dv * time, false);
  look(then.v, end.v, sizes.v, dv + (time > 0 ? dq / time : 0), true);
  return found;
}

}  // namespace mechanics::inline motions
