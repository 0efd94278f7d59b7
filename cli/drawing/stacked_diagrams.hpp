#pragma once

#include <string>
#include <vector>

#include "cli/drawing/drawn_range.hpp"
#include "cli/drawing/gnuplot.hpp"

namespace cli::inline drawings {

/// Diagrams one below the other over one axis, each with its key beside it on the right. The page has room
/// for every line of each key, and for its words: a longer one gnuplot breaks into columns over the curves,
/// and leaves out what does not fit.
struct StackedDiagrams {
  double left, right;                          ///< of the frames, in pixels
  std::vector<std::vector<std::string>> keys;  ///< the words of each, from the top

  /// The size of the page, and a script up to the first diagram.
  Drawing page(const std::string& title) const;
};

/// What is written at the axes of the k-th diagram of a page: the name of y on the edge of the page, clear of
/// its numbers however long, and below the last diagram x.
std::string axes_of_diagram(const Drawing& page, const std::string& y, const std::string& x, bool is_last,
                            const DrawnRange& along_x, const DrawnRange& along_y);

/// The height of a key of so many lines in small letters, in pixels.
double key_height(std::size_t lines);

/// Colours of curves, and with dashes, so that one shows through another on which it lies.
const char* curve_colour(std::size_t k);
std::string curve_style(std::size_t k);

/// The words of a key of curves, of which so many more are not drawn, which its last line says.
std::vector<std::string> key_of_curves(std::vector<std::string> names, std::size_t left_out);
/// That line, for gnuplot.
std::string left_out_in_key(std::size_t count);

}  // namespace cli::inline drawings
