#include "cli/drawing/stacked_diagrams.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>

#include "cli/drawing/label_placement.hpp"

namespace cli::inline drawings {
namespace {

/// Okabe and Ito 2008, without yellow.
constexpr std::array colours_of_curves{"#0072b2", "#d55e00", "#009e73", "#cc79a7",
                                       "#e69f00", "#56b4e9", "#882255", "#222222"};
constexpr std::array dashes_of_curves{"1", "(12,5)", "(4,4)", "(12,4,2,4)"};

std::string left_out_words(std::size_t count) { return fmt::format("and {} more, not drawn", count); }

}  // namespace

double key_height(std::size_t lines) {
  constexpr double line = 13.5, around = 10;
  return line * static_cast<double>(lines) + around;
}

Drawing StackedDiagrams::page(const std::string& title) const {
  constexpr double below = 50, between = 20, least_height = 160, key_apart = 12;
  const double above = title.empty() ? 12 : 42;  // marks stand above a diagram
  double frame = least_height;
  std::vector<std::string> words;
  for (const std::vector<std::string>& key : keys) {
    frame = std::max(frame, key_height(key.size()));
    words.insert(words.end(), key.begin(), key.end());
  }
  const auto count = static_cast<double>(keys.size());
  Drawing made;
  made.width = width_with_key(right, words);
  made.height = static_cast<int>(above + count * frame + (count - 1) * between + below);
  made.script = fmt::format(
      "set multiplot layout {},1 title {} font \",11\" margins {},{},{},{} spacing {}\n"
      "set border 3 lc rgb \"#666666\" lw 0.7\nset tics nomirror font \",9\"\n"
      "set key at screen {}, graph 1 left top Left reverse font \",9\" samplen 2.5\n",
      keys.size(), quoted(heading_line(title, made.width)), left / made.width, right / made.width,
      below / made.height, 1 - above / made.height, between / made.height, (right + key_apart) / made.width);
  return made;
}

std::string axes_of_diagram(const Drawing& page, const std::string& y, const std::string& x, bool is_last,
                            const DrawnRange& along_x, const DrawnRange& along_y) {
  constexpr double from_edge = 11;
  const DrawnRange roomy = along_y.with_room();
  return fmt::format("set label 1 {} at screen {}, graph 0.5 center rotate by 90 font \",10\"\n", quoted(y),
                     from_edge / page.width) +
         (is_last ? fmt::format("set xlabel {} font \",10\"\n", quoted(x)) + tic_format("x", along_x)
                  : "unset xlabel\nset format x \"\"\n") +
         (along_y.is_constant() ? fmt::format("set yrange [{}:{}]\n", roomy.low, roomy.high)
                                : "set autoscale y\n") +
         tic_format("y", roomy);
}

const char* curve_colour(std::size_t k) { return colours_of_curves[k % colours_of_curves.size()]; }

std::string curve_style(std::size_t k) {
  return fmt::format("lc rgb \"{}\" dt {}", curve_colour(k), dashes_of_curves[k % dashes_of_curves.size()]);
}

std::vector<std::string> key_of_curves(std::vector<std::string> names, std::size_t left_out) {
  if (left_out > 0) names.push_back(left_out_words(left_out));
  return names;
}

std::string left_out_in_key(std::size_t count) {
  if (count == 0) return "";
  return ", \\\n  NaN with dots lc rgb \"#ffffff\" title " + quoted(left_out_words(count));
}

}  // namespace cli::inline drawings
