#pragma once

#include <array>
#include <string>

#include "cli/drawing/gnuplot.hpp"
#include "cli/motion_files.hpp"
#include "mechanics/motion/motion.hpp"

namespace cli::inline drawings {

/// The velocity of a coordinate over the coordinate: a curve that is interrupted where the velocity jumps,
/// with marks where it begins and ends, or the points of a strobe (Poincaré's section).
class PhaseDrawing {
 public:
  PhaseDrawing(const mechanics::LagrangianSystem&, convex::Index coordinate, Instants instants,
               bool is_strobe, convex::Vector modulo);
  void follow(const mechanics::Motion& motion);
  void finish(const mechanics::Motion& motion);
  Drawing drawing(const std::string& title) const;

 private:
  void add(const mechanics::State&);

  const mechanics::LagrangianSystem& system_;
  convex::Index coordinate_;
  Instants instants_;
  bool is_strobe_;
  convex::Vector modulo_;
  long instant_ = 0, rows_ = 0;
  double last_ = 0;
  std::array<double, 2> begin_{}, end_{};
  std::string points_;
};

}  // namespace cli::inline drawings
