#include "cli/drawing/liquid_animation.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>

#include "cli/drawing/liquid_section.hpp"
#include "cli/json_writer.hpp"

namespace cli::inline drawings {
namespace {

using mechanics::liquid::LiquidScene;
using mechanics::liquid::LiquidSolution;
using FramePoint = mechanics::liquid::Point;

/// Points along the longest side of a frame, of a line and of a plane.
constexpr int points_of_line = 500, points_of_side = 120;
/// Values of a frame are whole numbers in two bytes: 0 to most_code from none to the largest, then the
/// cavity.
constexpr int most_code = 65000, cavity_code = 65535;
/// Levels are counted in parts of a step, to this many steps off the boundary.
constexpr double level_reach = 2, level_unit = 32767;

/// Two bytes a number, the low one first, six bits a letter (RFC 4648).
std::string in_letters(const std::vector<std::uint16_t>& codes) {
  constexpr char letters[] = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  std::vector<std::uint8_t> bytes;
  for (const std::uint16_t code : codes) {
    bytes.push_back(static_cast<std::uint8_t>(code & 255U));
    bytes.push_back(static_cast<std::uint8_t>(code >> 8U));
  }
  std::string text;
  for (std::size_t k = 0; k < bytes.size(); k += 3) {
    std::uint32_t word = 0;
    for (std::size_t i = 0; i < 3; ++i) word = word << 8U | (k + i < bytes.size() ? bytes[k + i] : 0U);
    for (std::size_t i = 0; i < 4; ++i)
      text += k + i <= bytes.size() ? letters[word >> (18U - 6U * i) & 63U] : '=';
  }
  return text;
}

}  // namespace

void LiquidAnimation::add_failure(double value, std::string why) {
  Frame frame;
  frame.value = value;
  frame.failure = std::move(why);
  frames_.push_back(std::move(frame));
}

void LiquidAnimation::add(double value, const LiquidScene& scene, const LiquidSolution& found) {
  if (found.status == LiquidSolution::Status::infeasible)
    return add_failure(value, "no motion: the walls squeeze the liquid");
  Frame frame;
  frame.value = value;
  frame.coordinates = scene.coordinates;
  const mechanics::liquid::Domain& domain = scene.domain;
  const bool is_line = scene.dimension() == 1;
  frame.box = {domain.low[0], domain.high[0], is_line ? 0 : domain.low[1], is_line ? 0 : domain.high[1]};
  const double width = frame.box[1] - frame.box[0], height = frame.box[3] - frame.box[2];
  const double step = std::max(width, height) / (is_line ? points_of_line : points_of_side);
  frame.points = {1 + std::max(1, static_cast<int>(std::lround(width / step))),
                  is_line ? 1 : 1 + std::max(1, static_cast<int>(std::lround(height / step)))};
  if (scene.dimension() == 3) frame.height = 0.5 * (domain.low[2] + domain.high[2]);
  frame.largest = found.largest;
  frame.fraction = found.cavity_measure / found.volume;
  frame.parted_walls = found.parted_walls;
  // In steps; the level of inequalities is no distance.
  const auto distance = [&](const FramePoint& x) {
    const double level = domain.level(x);
    if (domain.shape != mechanics::liquid::Domain::Shape::inequalities) return level / step;
    const FramePoint foot = domain.foot(x);
    const double away = std::hypot(foot[0] - x[0], foot[1] - x[1], foot[2] - x[2]) / step;
    return std::copysign(std::isfinite(away) ? away : level_reach, level);
  };
  // Just outside, what the nearest point of the boundary has, so that pictures go up to it.
  const auto seen_from = [&](const FramePoint& x) {
    return domain.level(x) > 0 && distance(x) < level_reach ? domain.foot(x) : x;
  };
  const auto at = [&](double i, double j) {
    return FramePoint{frame.box[0] + width * i / (frame.points[0] - 1),
                      is_line ? 0 : frame.box[2] + height * j / (frame.points[1] - 1), frame.height};
  };
  for (int j = 0; j < frame.points[1]; ++j)
    for (int i = 0; i < frame.points[0]; ++i) {
      const FramePoint x = at(i, j);
      const double level = distance(x);
      frame.level.push_back(std::clamp(level, -level_reach, level_reach));
      const bool is_seen = level < level_reach, is_empty = is_seen && found.in_cavity(seen_from(x));
      frame.cavity.push_back(is_empty ? 1 : 0);
      frame.p.push_back(is_empty || !is_seen ? 0 : std::max(0.0, found.p(seen_from(x))));
    }
  const std::vector<double> flags = frame.cavity;
  const auto flag = [&](int i, int j) {
    return flags[static_cast<std::size_t>(std::clamp(j, 0, frame.points[1] - 1) * frame.points[0] +
                                          std::clamp(i, 0, frame.points[0] - 1))];
  };
  for (int j = 0; j < frame.points[1]; ++j)
    for (int i = 0; i < frame.points[0]; ++i) {
      double around = 0;
      for (int k = 0; k < 9; ++k) around += flag(i + k % 3 - 1, j + k / 3 - 1);
      if (around == 0 || around == 9) continue;
      constexpr int parts = 5;
      double covered = 0;
      for (int k = 0; k < parts * parts; ++k) {
        const FramePoint x = at(i + (k % parts + 0.5) / parts - 0.5, j + (k / parts + 0.5) / parts - 0.5);
        covered += found.in_cavity(seen_from(x)) ? 1 : 0;
      }
      frame.cavity[static_cast<std::size_t>(j * frame.points[0] + i)] = covered / (parts * parts);
    }
  if (!is_line) {
    for (const FramePoint& x : LiquidSection(scene, found).parted()) frame.parted.push_back({x[0], x[1]});
  } else {
    for (const double x : {frame.box[0], frame.box[1]}) {
      const mechanics::liquid::BoundaryPart* part = scene.part_at({x, 0, 0});
      const auto& names = found.parted_walls;
      if (part != nullptr && std::find(names.begin(), names.end(), part->name) != names.end())
        frame.parted.push_back({x, 0});
    }
  }
  frames_.push_back(std::move(frame));
}

std::string LiquidAnimation::data(const std::string& title) const {
  double largest = 0;
  for (const Frame& frame : frames_) largest = std::max(largest, frame.largest);
  JsonWriter json;
  json.begin_object().key("title").value(title).key("parameter").value(parameter_);
  json.key("largest").value(largest).key("most_code").value(most_code).key("cavity_code").value(cavity_code);
  json.key("onset");
  if (onset_)
    json.begin_object().key("value").value(onset_->value).key("error").value(onset_->error).end_object();
  else
    json.null();
  json.key("frames").begin_array();
  for (const Frame& frame : frames_) {
    json.begin_object().key("value").value(frame.value);
    if (!frame.failure.empty()) {
      json.key("failure").value(frame.failure).end_object();
      continue;
    }
    json.key("coordinates").begin_array();
    for (const std::string& name : frame.coordinates) json.value(name);
    json.end_array().key("box").begin_array();
    for (const double x : frame.box) json.value(x);
    json.end_array().key("points").begin_array().value(frame.points[0]).value(frame.points[1]).end_array();
    json.key("height").value(frame.height).key("largest").value(frame.largest);
    json.key("fraction").value(frame.fraction).key("parted_walls").begin_array();
    for (const std::string& name : frame.parted_walls) json.value(name);
    json.end_array().key("parted").begin_array();
    for (const auto& [x, y] : frame.parted) json.begin_array().value(x).value(y).end_array();
    std::vector<std::uint16_t> p, level;
    for (std::size_t k = 0; k < frame.p.size(); ++k)
      p.push_back(static_cast<std::uint16_t>(
          frame.cavity[k] > 0
              ? most_code + std::lround((cavity_code - most_code) * frame.cavity[k])
              : std::lround(most_code * std::min(1.0, largest > 0 ? frame.p[k] / largest : 0.0))));
    for (const double one : frame.level)
      level.push_back(static_cast<std::uint16_t>(32768 + std::lround(level_unit * one / level_reach)));
    json.end_array().key("p").value(in_letters(p)).key("level");
    // The domain seldom depends on the parameter.
    const Frame* before = &frame == &frames_.front() ? nullptr : &frame - 1;
    if (before != nullptr && before->level == frame.level)
      json.null();
    else
      json.value(in_letters(level));
    json.end_object();
  }
  return json.end_array().end_object().text();
}

std::string LiquidAnimation::page(const std::string& title) const { return liquid_page(title, data(title)); }

}  // namespace cli::inline drawings
