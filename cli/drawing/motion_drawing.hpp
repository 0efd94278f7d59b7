#pragma once

#include <cmath>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include "cli/drawing/drawn_range.hpp"
#include "cli/drawing/gnuplot.hpp"
#include "mechanics/motion/motion.hpp"

namespace cli::inline drawings {

/// A motion over one axis of time: coordinates, gaps f of the constraints, multipliers, T + V; events are
/// marked. Of each kind the first eight are drawn.
class MotionDrawing {
 public:
  MotionDrawing(const mechanics::LagrangianSystem& system, double begin, double end);
  /// The points before the present time of the motion, from its last step, and its events.
  void follow(const mechanics::Motion& motion);
  /// The point of the present state, at the end of the motion.
  void finish(const mechanics::Motion& motion);
  Drawing drawing(const std::string& title) const;

 private:
  /// What is drawn of an instant: q, f, lambda and T + V.
  convex::Vector row(const mechanics::State&, const convex::Vector& lambda);
  convex::Vector row(const mechanics::State&, const convex::Vector& f, const convex::Vector& lambda);
  convex::Vector row(const mechanics::Arc&, double tau);
  void add(double t, const convex::Vector& row);
  /// An instant between two points, of which the extremes of all such are drawn before the next point.
  void pass(const convex::Vector& row);
  double time(double point) const;

  const mechanics::LagrangianSystem& system_;
  double begin_, end_;
  convex::Index coordinates_, constraints_;  // that are drawn
  long point_ = 0;
  convex::Vector least_, most_;  // passed since the last point; empty if nothing is
  long passed_ = 0;
  std::string points_;
  DrawnRange positions_, gaps_, forces_, energies_;
  std::set<std::pair<mechanics::EventKind, long>> events_;  // where they are marked
};

}  // namespace cli::inline drawings
