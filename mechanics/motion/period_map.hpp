#pragma once

#include "mechanics/motion/orbit.hpp"
#include "mechanics/motion/saltation.hpp"
#include "mechanics/motion/tangent_chart.hpp"

namespace mechanics::inline motions {

/// A motion over a period, or what stopped it.
struct Flight {
  bool arrives = false;
  std::string why;
  Vector end;   ///< q and v: 2n
  Vector rate;  ///< v and q''
  std::vector<FlightPiece> pieces;
  Vector largest;  ///< how far each of q and v goes on the way
  std::vector<MotionEvent> events() const;
};

/// The question for the motions that Newton's method tries near a flight: one with several times its steps,
/// and some, leads to no orbit near it, and may go on for as long as it likes.
OrbitQuestion few_steps(OrbitQuestion question, const Flight& flight);

/// q and v, one after the other.
Vector as_one(const State& state);

/// The map of states at t to those a period later.
class PeriodMap {
 public:
  /// `system` and `question` must outlive it.
  PeriodMap(const LagrangianSystem& system, double t, const OrbitQuestion& question);

  Flight fly(const Vector& x, double period) const;
  /// By how much the end misses the start: 2n.
  Vector miss(const Flight& flight, const Vector& x) const;
  /// The largest of |miss| over how far the motion goes.
  double relative(const Vector& miss, const Flight& flight) const;

  /// ∂end/∂y in the coordinates of a chart, by the variational equations and saltation matrices.
  FlowDerivative derivative(const TangentChart& chart, const Flight& flight) const;
  /// The same by central differences of order 2 times `levels`, extrapolated (Richardson), for laws of impact
  /// whose derivative is not known, and for Newton's method where there is none; none if a motion on the way
  /// has other events, unless `at_any_rate`.
  std::optional<convex::Matrix> differences(const TangentChart& chart, double period, const Flight& flight,
                                            double step, int levels, bool at_any_rate) const;

 private:
  const LagrangianSystem& system_;
  double t_;
  const OrbitQuestion& question_;
  std::vector<Index> two_sided_;
  Variation variation_;
};

}  // namespace mechanics::inline motions
