#pragma once

#include <optional>
#include <string>
#include <vector>

#include "convex/vector.hpp"

namespace cli::inline drawings {

/// A point on the page, in pixels from its lower left corner.
using PagePoint = Eigen::Vector2d;

/// A label's left end, middle or right end, as `aligned` says, at half its height.
struct PlacedLabel {
  PagePoint at;
  const char* aligned = "center";
  std::string text = {};
};

/// Finds room for the labels of a picture: inside the frame, off each other, and off lines and points as far
/// as there is room. Each is tried around its anchors, nearest first.
class LabelPlacement {
 public:
  LabelPlacement(PagePoint low, PagePoint high) : low_(std::move(low)), high_(std::move(high)) {}

  /// What labels had better not lie on; a curve of many corners counts once. Labels may lie on what is faint
  /// if they are nearer to their anchors there.
  void avoid_line(std::vector<PagePoint> corners, bool is_faint = false) {
    lines_.push_back({std::move(corners), is_faint});
  }
  void avoid_point(const PagePoint&, double radius);

  /// Where the label goes, the first of `texts` that lies on no line and no point, or else the one that
  /// stands best; none where every place would lie on another label or out of the frame. Later labels keep
  /// off it.
  std::optional<PlacedLabel> place(const std::vector<PagePoint>& anchors,
                                   const std::vector<std::string>& texts, double font_size);

 private:
  struct Box {
    PagePoint low, high;
  };
  struct Found {
    std::string text;
    PagePoint middle, half, direction;
    double cost, distance;  ///< of what it lies on; from its anchor
  };
  double cost(const Box&) const;
  double parted(const PagePoint& anchor, const PagePoint& end) const;
  Found best(const std::vector<PagePoint>& anchors, const std::string& text, double font_size) const;

  PagePoint low_, high_;
  struct Line {
    std::vector<PagePoint> corners;
    bool is_faint;
  };
  std::vector<Line> lines_;
  std::vector<Box> points_, labels_;
};

/// The width in pixels that a text has at most in a font of that size (pixels an em), sans serif.
double text_width(const std::string& text, double font_size);

/// A line of a title, cut to so many pixels.
std::string heading_line(std::string line, double room);

/// The parts of a title with semicolons between them, in lines of so many pixels at most.
std::string heading_lines(const std::vector<std::string>& parts, double room);

/// The width of a page with a key outside on the right, of these words in small letters, whose diagrams end
/// at `right`, in pixels.
int width_with_key(double right, const std::vector<std::string>& words);

}  // namespace cli::inline drawings
