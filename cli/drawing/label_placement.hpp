#pragma once

#include <optional>
#include <string>
#include <vector>

#include "convex/vector.hpp"

namespace cli {

/// A point on the page, in pixels from its lower left corner.
using PagePoint = Eigen::Vector2d;

/// A label's left end, middle or right end, as `aligned` says, at half its height.
struct PlacedLabel {
  PagePoint at;
  const char* aligned = "center";
};

/// Finds room for the labels of a picture: inside the frame, off each other, and off lines and points as far
/// as there is room. Each is tried around its anchors, nearest first.
class LabelPlacement {
 public:
  LabelPlacement(PagePoint low, PagePoint high) : low_(std::move(low)), high_(std::move(high)) {}

  /// What labels had better not lie on; a curve of many corners counts once.
  void avoid_line(std::vector<PagePoint> corners) { lines_.push_back(std::move(corners)); }
  void avoid_point(const PagePoint&, double radius);

  /// Where the label goes; none where every place would lie on another label or out of the frame. Later
  /// labels keep off it.
  std::optional<PlacedLabel> place(const std::vector<PagePoint>& anchors, const std::string& text,
                                   double font_size);

 private:
  struct Box {
    PagePoint low, high;
  };
  double cost(const Box&) const;

  PagePoint low_, high_;
  std::vector<std::vector<PagePoint>> lines_;
  std::vector<Box> points_, labels_;
};

/// The width in pixels that a text has at most in a font of that size (pixels an em), sans serif.
double text_width(const std::string& text, double font_size);

}  // namespace cli
