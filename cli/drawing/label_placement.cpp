#include "cli/drawing/label_placement.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <sstream>

namespace cli::inline drawings {
namespace {

constexpr double heading_letters = 11;  ///< pixels an em
constexpr double line_height = 1.25;    ///< over the font size
constexpr double clearance = 3;         ///< of the words from what they had better not lie on, in pixels
constexpr double impossible = 1e9;      ///< on another label, or out of the frame
constexpr double line_cost = 60;        ///< of lying on a line, in pixels of distance
constexpr double faint_line_cost = 10;
constexpr double parted_cost = 40;   ///< of a line between the label and what it names
constexpr double shorter_cost = 20;  ///< of the next shorter text
constexpr double point_cost = 200;

bool overlap(const PagePoint& low, const PagePoint& high, const PagePoint& other_low,
             const PagePoint& other_high) {
  return low.x() < other_high.x() && other_low.x() < high.x() && low.y() < other_high.y() &&
         other_low.y() < high.y();
}

/// Whether a segment has a point in a box (Liang and Barsky 1984).
bool crosses(const PagePoint& from, const PagePoint& to, const PagePoint& low, const PagePoint& high) {
  double begin = 0, end = 1;
  const PagePoint step = to - from;
  for (int k = 0; k < 2; ++k) {
    if (step[k] == 0) {
      if (from[k] < low[k] || from[k] > high[k]) return false;
      continue;
    }
    const double a = (low[k] - from[k]) / step[k], b = (high[k] - from[k]) / step[k];
    begin = std::max(begin, std::min(a, b));
    end = std::min(end, std::max(a, b));
  }
  return begin <= end;
}

}  // namespace

double text_width(const std::string& text, double font_size) {
  // Averages of sans serif type: narrow and wide letters, in em.
  double width = 0;
  for (const char c : text) {
    if ((static_cast<unsigned char>(c) & 0xC0U) == 0x80U) continue;
    width += std::string("iljtf.,:;'|![]() ").find(c) != std::string::npos ? 0.36
             : std::string("mwMWGOQ@%").find(c) != std::string::npos       ? 0.9
                                                                           : 0.62;
  }
  return width * font_size;
}

int width_with_key(double right, const std::vector<std::string>& words) {
  constexpr double usual = 700, letters = 9.5, sample = 66;
  double widest = 0;
  for (const std::string& text : words) widest = std::max(widest, text_width(text, letters));
  return static_cast<int>(std::max(usual, right + sample + widest));
}

std::string heading_lines(const std::vector<std::string>& parts, double room) {
  std::string text, line;
  const auto add = [&](const std::string& words, const char* between) {
    if (line.empty())
      line = words;
    else if (text_width(line + between + words, heading_letters) <= room)
      line += between + words;
    else {
      text += line + (between[0] == ';' ? ";\n" : "\n");
      line = words;
    }
  };
  for (const std::string& part : parts) {
    if (text_width(part, heading_letters) <= room) {
      add(part, "; ");
      continue;
    }
    std::istringstream words(part);
    const char* between = "; ";
    for (std::string word; words >> word; between = " ") add(heading_line(word, room), between);
  }
  return text + line;
}

std::string heading_line(std::string line, double room) {
  if (text_width(line, heading_letters) <= room) return line;
  while (!line.empty() && text_width(line + "…", heading_letters) > room) {
    while ((static_cast<unsigned char>(line.back()) & 0xC0U) == 0x80U) line.pop_back();
    line.pop_back();
  }
  return line + "…";
}

void LabelPlacement::avoid_point(const PagePoint& p, double radius) {
  points_.push_back({p.array() - radius, p.array() + radius});
}

double LabelPlacement::cost(const Box& box) const {
  if (box.low.x() < low_.x() || box.low.y() < low_.y() || box.high.x() > high_.x() ||
      box.high.y() > high_.y())
    return impossible;
  double sum = 0;
  for (const Box& other : labels_)
    if (overlap(box.low, box.high, other.low, other.high)) return impossible;
  for (const Box& other : points_)
    if (overlap(box.low, box.high, other.low, other.high)) sum += point_cost;
  for (const auto& [corners, is_faint] : lines_)
    for (std::size_t k = 0; k + 1 < corners.size(); ++k) {
      if (!crosses(corners[k], corners[k + 1], box.low, box.high)) continue;
      sum += is_faint ? faint_line_cost : line_cost;
      break;
    }
  return sum;
}

double LabelPlacement::parted(const PagePoint& anchor, const PagePoint& end) const {
  const auto side = [](const PagePoint& a, const PagePoint& b, const PagePoint& p) {
    return (b.x() - a.x()) * (p.y() - a.y()) - (b.y() - a.y()) * (p.x() - a.x());
  };
  for (const auto& [corners, is_faint] : lines_)
    for (std::size_t k = 0; !is_faint && k + 1 < corners.size(); ++k) {
      const PagePoint &a = corners[k], &b = corners[k + 1];
      if (side(a, b, anchor) * side(a, b, end) < 0 && side(anchor, end, a) * side(anchor, end, b) < 0)
        return parted_cost;
    }
  return 0;
}

LabelPlacement::Found LabelPlacement::best(const std::vector<PagePoint>& anchors, const std::string& text,
                                           double font_size) const {
  const PagePoint half(text_width(text, font_size) / 2 + clearance, line_height * font_size / 2 + clearance);
  constexpr int directions = 16;
  constexpr double nearest = 6, farthest = 120, step = 6;
  Found found{text, PagePoint::Zero(), half, PagePoint::Zero(), impossible, 0};
  for (const PagePoint& anchor : anchors)
    for (double away = nearest; away <= farthest; away += step)
      for (int k = 0; k < directions; ++k) {
        const double angle = 2 * std::numbers::pi * k / directions;
        const PagePoint way(std::cos(angle), std::sin(angle));
        // The nearest side of the box is that far away.
        const PagePoint middle = anchor + away * way + way.cwiseProduct(half);
        if (away >= found.cost + found.distance) continue;
        // What goes through the anchor parts nothing from it.
        constexpr double beside = 3;
        const double lies_on =
            cost({middle - half, middle + half}) + parted(anchor + beside * way, anchor + away * way);
        if (away + lies_on >= found.cost + found.distance) continue;
        found = {text, middle, half, way, lies_on, away};
      }
  return found;
}

std::optional<PlacedLabel> LabelPlacement::place(const std::vector<PagePoint>& anchors,
                                                 const std::vector<std::string>& texts, double font_size) {
  std::optional<Found> chosen;
  double worth = 0;
  for (const std::string& text : texts) {
    const Found found = best(anchors, text, font_size);
    if (!chosen || found.cost + found.distance + shorter_cost < worth) {
      chosen = found;
      worth = found.cost + found.distance;
    }
  }
  if (!chosen || chosen->cost >= impossible) return std::nullopt;
  const auto& [text, middle, half, direction, cost, distance] = *chosen;
  labels_.push_back({middle - half, middle + half});
  constexpr double sideways = 0.3;
  if (direction.x() > sideways)
    return PlacedLabel{{middle.x() - half.x() + clearance, middle.y()}, "left", text};
  if (direction.x() < -sideways)
    return PlacedLabel{{middle.x() + half.x() - clearance, middle.y()}, "right", text};
  return PlacedLabel{middle, "center", text};
}

}  // namespace cli::inline drawings
