#include "cli/drawing/failure_map_drawing.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <iterator>

#include "cli/drawing/gnuplot.hpp"
#include "convex/nearest_point/gallery/gallery.hpp"

namespace cli {
namespace {

constexpr int columns = 3, row_height = 12, panel_frame = 86, legend_height = 46;

/// Digits of accuracy on a scale whose lightness alone orders it (after viridis: van der Walt and Smith
/// 2015).
constexpr std::array scale{"#440154", "#472d7b", "#3b528b", "#2c728e", "#21918c",
                           "#28ae80", "#5ec962", "#addc30", "#fde725"};
constexpr double most_digits = 16;

std::string colour(double error) {
  const double digits = error > 0 ? std::clamp(-std::log10(error), 0.0, most_digits) : most_digits;
  const auto place = static_cast<std::size_t>(std::lround(digits / most_digits * (scale.size() - 1)));
  return scale[place];
}

struct Mark {
  Verdict verdict;
  int point;
  const char* colour;
  const char* words;
};

/// gnuplot's markers: 2 a cross, 6 a ring, 8 a triangle, 1 a plus.
constexpr std::array marks{Mark{Verdict::wrong, 2, "#d00000", "wrong without saying so"},
                           Mark{Verdict::gave_up, 6, "#555555", "gave up"},
                           Mark{Verdict::too_slow, 8, "#b06000", "too slow"},
                           Mark{Verdict::crashed, 1, "#000000", "crashed"}};

template <typename T, typename Get>
std::vector<T> in_order(const std::vector<StressTrial>& trials, Get get) {
  std::vector<T> all;
  for (const StressTrial& trial : trials)
    if (std::find(all.begin(), all.end(), get(trial)) == all.end()) all.push_back(get(trial));
  return all;
}

template <typename T>
std::size_t place(const std::vector<T>& all, const T& one) {
  return static_cast<std::size_t>(std::find(all.begin(), all.end(), one) - all.begin());
}

void add_panel(std::string& script, const std::vector<StressTrial>& trials, const std::string& family,
               std::size_t index, const std::vector<std::string>& methods) {
  const auto out = std::back_inserter(script);
  std::vector<StressTrial> here;
  std::copy_if(trials.begin(), trials.end(), std::back_inserter(here),
               [&](const StressTrial& t) { return t.family == family; });
  const auto settings = in_order<double>(here, [](const StressTrial& t) { return t.difficulty; });
  std::string boxes;
  std::array<std::string, marks.size()> points;
  for (const StressTrial& t : here) {
    const double x = static_cast<double>(place(settings, t.difficulty)),
                 y = static_cast<double>(methods.size() - 1 - place(methods, t.trial.method));
    if (t.trial.verdict == Verdict::ok)
      boxes += fmt::format("{} {} {} {} {} {} 0x{}\n", x, y, x - 0.5, x + 0.5, y - 0.5, y + 0.5,
                           colour(std::isfinite(t.trial.error) ? t.trial.error : 1).substr(1));
    for (std::size_t k = 0; k < marks.size(); ++k)
      if (t.trial.verdict == marks[k].verdict) points[k] += fmt::format("{} {}\n", x, y);
  }
  std::string plots;
  const auto add = [&](const std::string& name, const std::string& data, const std::string& how) {
    if (data.empty()) return;
    fmt::format_to(out, "${}{} << EOD\n{}EOD\n", name, index, data);
    plots += fmt::format("{}${}{} {}", plots.empty() ? "" : ", \\\n  ", name, index, how);
  };
  add("boxes", boxes, "using 1:2:3:4:5:6:7 with boxxyerror fs solid 1 noborder lc rgb variable notitle");
  for (std::size_t k = 0; k < marks.size(); ++k)
    add(fmt::format("mark{}_", k), points[k],
        fmt::format("using 1:2 with points pt {} ps 0.55 lw 1.4 lc rgb \"{}\" notitle", marks[k].point,
                    marks[k].colour));
  std::string xtics, ytics;
  for (std::size_t k = 0; k < settings.size(); ++k)
    xtics += fmt::format("{}\"{:g}\" {}", k > 0 ? ", " : "", settings[k], k);
  for (std::size_t k = 0; k < methods.size(); ++k)
    ytics += fmt::format("{}{} {}", k > 0 ? ", " : "", index % columns == 0 ? quoted(methods[k]) : "\"\"",
                         methods.size() - 1 - k);
  const std::string knob(convex::find_family(family) != nullptr ? convex::find_family(family)->knob
                                                                : "difficulty");
  fmt::format_to(
      out,
      "set title {} offset 0,-0.8 font \",10\"\nset xrange [-0.5:{}]\nset yrange [-0.5:{}]\nset xtics ({}) "
      "rotate by 60 right font \",7\" scale 0 offset 0,0.2\nset ytics ({}) font \",8\" scale 0\nset xlabel "
      "{} font \",8\" "
      "offset 0,0.9\nplot {}\n",
      quoted(family), static_cast<double>(settings.size()) - 0.5, static_cast<double>(methods.size()) - 0.5,
      xtics, ytics, quoted(knob), plots.empty() ? "NaN notitle" : plots);
}

std::string legend(int height) {
  std::string text;
  const auto out = std::back_inserter(text);
  const double top = 1 - 14.0 / height, below = 1 - 32.0 / height;
  for (std::size_t k = 0; k < scale.size(); ++k)
    fmt::format_to(
        out, "set object {} rect from screen {},{} to screen {},{} fs solid 1 noborder fc rgb \"{}\" front\n",
        k + 1, 0.16 + 0.022 * static_cast<double>(k), below, 0.16 + 0.022 * static_cast<double>(k + 1), top,
        scale[k]);
  fmt::format_to(out,
                 "set label 1 \"0 digits\" at screen 0.15,{0} right font \",9\"\nset label 2 \"16\" at "
                 "screen {1},{0} left "
                 "font \",9\"\n",
                 (top + below) / 2, 0.165 + 0.022 * static_cast<double>(scale.size()));
  double x = 0.39;
  for (std::size_t k = 0; k < marks.size(); ++k) {
    fmt::format_to(out,
                   "set label {} \"{}\" at screen {},{} left point pt {} ps 0.8 lw 1.6 lc rgb \"{}\" offset "
                   "0.6,0 font \",8\"\n",
                   k + 3, marks[k].words, x, (top + below) / 2, marks[k].point, marks[k].colour);
    x += k == 0 ? 0.2 : 0.095;
  }
  fmt::format_to(out, "set label {} \"blank: refused\" at screen {},{} left font \",8\"\n",
                 marks.size() + 3, x, (top + below) / 2);
  return text;
}

}  // namespace

Drawing failure_map_drawing(const std::vector<StressTrial>& trials) {
  const auto families = in_order<std::string>(trials, [](const StressTrial& t) { return t.family; });
  const auto methods = in_order<std::string>(trials, [](const StressTrial& t) { return t.trial.method; });
  const auto rows = static_cast<int>((families.size() + columns - 1) / columns);
  const int panel = row_height * static_cast<int>(methods.size()) + panel_frame;
  Drawing drawing;
  drawing.height = legend_height + rows * panel;
  drawing.script = legend(drawing.height);
  drawing.script += "unset key\nset border lw 0.6 lc rgb \"#666666\"\nset multiplot\n";
  const double left = 0.19, width = (1 - left - 0.02) / columns;
  for (std::size_t k = 0; k < families.size(); ++k) {
    const double column = static_cast<double>(k % columns), row = static_cast<double>(k / columns);
    const double top = 1 - (legend_height + row * panel + 18) / drawing.height,
                 bottom = 1 - (legend_height + (row + 1) * panel - (panel_frame - 18)) / drawing.height;
    fmt::format_to(std::back_inserter(drawing.script),
                   "set lmargin at screen {}\nset rmargin at screen {}\nset tmargin at screen {}\nset "
                   "bmargin at screen {}\n",
                   left + column * width, left + (column + 1) * width - 0.02, top, bottom);
    add_panel(drawing.script, trials, families[k], k, methods);
    if (k == 0) {
      for (std::size_t label = 1; label <= marks.size() + 3; ++label)
        fmt::format_to(std::back_inserter(drawing.script), "unset label {}\n", label);
      for (std::size_t object = 1; object <= scale.size(); ++object)
        fmt::format_to(std::back_inserter(drawing.script), "unset object {}\n", object);
    }
  }
  drawing.script += "unset multiplot\n";
  return drawing;
}

}  // namespace cli
