#pragma once

#include <string>
#include <vector>

#include "cli/drawing/gnuplot.hpp"
#include "cli/drawing/label_placement.hpp"

namespace cli::inline drawings {

/// A point or a curve in the units of a picture.
using Point = Eigen::Vector2d;
using Polygon = std::vector<Point>;

/// Pixels: a square picture with its axes and its title, and where it stands on a page of several.
inline constexpr int page_size = 700;
struct PageArea {
  int left = 0, page_width = page_size;

  /// Letters beside another picture are larger, for the page is shown in the same width.
  double letters() const { return page_width > page_size ? 1.4 : 1; }
  /// For a line of the title over the frame, whose letters grow less.
  double title_room() const;
};

/// The window: all points with room around, that part of their size; where all are one, `otherwise` is its
/// size.
struct PageWindow {
  Point low, high;
  PageWindow(const Polygon& points, double otherwise, double room = 0.45);
  Polygon frame() const { return {low, {high.x(), low.y()}, high, {low.x(), high.y()}}; }
  double size() const { return (high - low).maxCoeff(); }
  /// In pixels from the lower left corner of the picture.
  PagePoint pixel(const Point& p) const;
};

/// A picture: data blocks first, then what is plotted of them, arrows, and labels where there is room.
class LabelledPage {
 public:
  /// One unit of the window is `unit` of the numbers at the axes.
  LabelledPage(const PageWindow& window, PageArea area, Point unit = {1, 1});

  /// Plots the points, `how` in gnuplot's words.
  void add(const Polygon& points, const std::string& how);
  /// The same, as something that labels keep off.
  void line(const Polygon& points, const std::string& how);
  /// The same, as something that they may lie on if they are nearer there to what they name.
  void faint_line(const Polygon& points, const std::string& how);
  void point(const Point& p, const std::string& how);
  void arrow(const Point& from, const Point& to, const char* style);
  /// The first of the texts that lies on nothing, or the one that stands best. Whether there was room.
  bool label(const Polygon& anchors, const std::vector<std::string>& texts, const char* tint);
  /// The whole, with the names of its axes and its title of some lines, for `page_of`.
  Drawing drawing(const std::string& x, const std::string& y, const std::string& title) const;

 private:
  std::vector<PagePoint> pixels(const Polygon&) const;
  double across(double pixel) const { return (area_.left + pixel) / area_.page_width; }

  const PageWindow& window_;
  PageArea area_;
  Point unit_;
  LabelPlacement labels_;
  std::string blocks_, plots_;
  int count_ = 0;
};

/// A page of a picture, or of two beside each other, as high as their titles need.
Drawing page_of(const std::vector<Drawing>& pictures);

}  // namespace cli::inline drawings
