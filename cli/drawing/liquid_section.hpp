#pragma once

#include <array>
#include <functional>
#include <string>
#include <vector>

#include "mechanics/liquid/liquid_solution.hpp"

namespace cli::inline drawings {

/// Two coordinates of a liquid, in the order in which they are drawn, and the third at the middle of the
/// domain.
using SectionAxes = std::array<std::size_t, 3>;

/// Reads "x,z", of three dimensions. Throws InvalidInput.
SectionAxes section_axes(const std::vector<std::string>& coordinates, const std::string& plane);

/// Those of the section in which p differs most; the first two unless another tells more.
SectionAxes most_telling_axes(const mechanics::liquid::LiquidScene&,
                              const mechanics::liquid::LiquidSolution&);

/// What is drawn of a liquid in two or three dimensions, as gnuplot's data. Points are of the section: the
/// two coordinates drawn, then the third.
class LiquidSection {
 public:
  LiquidSection(const mechanics::liquid::LiquidScene&, const mechanics::liquid::LiquidSolution&,
                SectionAxes axes = {0, 1, 2});

  double side(std::size_t i) const;
  double low(std::size_t i) const;
  double height() const { return height_; }
  /// The largest p less the least, on a coarse grid.
  double spread() const;

  /// p by lines of equal y apart by empty lines, NaN outside of the domain.
  std::string field() const;
  /// The parts of lines x - y = c that lie in the cavity, as vectors.
  std::string hatching() const;
  /// The edge of the domain, as vectors: a segment a cell of the field that it passes.
  std::string border() const;
  /// The cavity's edge inside the domain, as vectors: a segment a cell of half the field's step that it
  /// passes.
  std::string outline() const;
  /// Points of the walls that part, where p = 0.
  std::vector<mechanics::liquid::Point> parted() const;

  /// u as vectors in their middles, the longest as long as they are apart, and the largest |u| drawn.
  struct Arrows {
    std::string vectors;
    double fastest = 0;
  };
  Arrows velocity() const;

 private:
  mechanics::liquid::Point at(double x, double y) const { return {x, y, height_}; }
  /// In the order of the file's coordinates, and back.
  mechanics::liquid::Point in_space(const mechanics::liquid::Point&) const;
  mechanics::liquid::Point in_section(const mechanics::liquid::Point&) const;
  bool is_inside(const mechanics::liquid::Point&) const;
  bool in_cavity(const mechanics::liquid::Point&) const;
  int count(std::size_t i) const;
  mechanics::liquid::Point edge_between(mechanics::liquid::Point in, mechanics::liquid::Point out) const;
  /// What a point is in: nothing, one side of an edge, the other.
  enum class Side { none, out, in };
  using Between = std::function<mechanics::liquid::Point(const mechanics::liquid::Point& in,
                                                         const mechanics::liquid::Point& out)>;
  /// Between `in` and `out`, on a grid of nx × ny cells and one more around.
  std::string edge(int nx, int ny, const std::function<Side(const mechanics::liquid::Point&)>&,
                   const Between&) const;
  const mechanics::liquid::LiquidScene& scene_;
  const mechanics::liquid::LiquidSolution& found_;
  SectionAxes axes_;
  double height_ = 0, step_ = 1;
};

}  // namespace cli::inline drawings
