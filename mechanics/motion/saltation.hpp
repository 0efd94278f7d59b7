#pragma once

#include "mechanics/motion/motion.hpp"
#include "mechanics/motion/variation.hpp"

namespace mechanics::inline motions {

/// A step of a motion, with what happens at its end.
struct FlightPiece {
  Arc arc;  ///< of length 0 at the very start
  std::vector<MotionEvent> events;
  State after;          ///< after the events
  Vector acceleration;  ///< there, the right limit
};

/// ∂(q, v) at the end of a motion by (q, v) at its start: 2n×2n.
struct FlowDerivative {
  enum class Kind {
    known,
    none,  ///< impacts at once that do not commute, a contact that is grazed, an event that is no crossing
    undecided,  ///< a law of impact whose derivative is not known here
  };
  Kind kind = Kind::known;
  convex::Matrix value;
  double growth = 0;  ///< its largest norm on the way: what roundings there may grow by
};

/// Along arcs the variational equations δx' = (∂x'/∂x) δx with the contacts held; at an event h(x, t) = 0 the
/// saltation matrix (Aizerman and Gantmakher 1958; Leine and Nijmeijer 2004, section 7.2)
///   S = ∂g + (x'_+ - ∂g x'_- - ∂g/∂t) ∇h / (∇h x'_- + ∂h/∂t),     x_+ = g(x_-, t),
/// where g is the law of impact, or changes nothing. It is of lower rank where a contact comes to rest.
/// Impacts at once are taken one after the other, in every order: there is a derivative where these agree.
/// A start on contacts that are held may vary on them alone.
FlowDerivative flow_derivative(const Variation& variation, const std::vector<FlightPiece>& flight,
                               const MotionOptions& options, const std::vector<Index>& two_sided);

}  // namespace mechanics::inline motions
