#include "cli/drawing/failure_map_drawing.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <iterator>

#include "cli/drawing/gnuplot.hpp"
#include "cli/drawing/method_style.hpp"

namespace cli {
namespace {

constexpr int columns = 3, row_height = 12, panel_frame = 82, map_title_height = 22, legend_height = 46;

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

/// 1e-06 is "1e-6".
std::string tic_text(double setting) {
  std::string text = fmt::format("{:g}", setting);
  for (const char* zero : {"e-0", "e+0", "e+"})
    if (const std::size_t at = text.find(zero); at != std::string::npos)
      text.replace(at, std::string(zero).size(), zero[1] == '-' ? "e-" : "e");
  return text;
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

template <typename T>
std::size_t place(const std::vector<T>& all, const T& one) {
  return static_cast<std::size_t>(std::find(all.begin(), all.end(), one) - all.begin());
}

void add_panel(std::string& script, const std::vector<StressTrial>& trials, const std::string& family,
               std::size_t index, const std::vector<std::string>& methods, bool named) {
  const auto out = std::back_inserter(script);
  std::vector<StressTrial> here;
  std::copy_if(trials.begin(), trials.end(), std::back_inserter(here),
               [&](const StressTrial& t) { return t.family == family; });
  const auto settings = in_order<double>(here, [](const StressTrial& t) { return t.difficulty; });
  // Neighbours of one colour are one box, for the size of the file.
  struct Box {
    double from, to, y;
    std::string fill;
  };
  std::vector<Box> boxes;
  std::array<std::string, marks.size()> points;
  for (const std::string& method : methods)
    for (const StressTrial& t : here) {
      if (t.trial.method != method) continue;
      const double x = static_cast<double>(place(settings, t.difficulty)),
                   y = static_cast<double>(methods.size() - 1 - place(methods, method));
      for (std::size_t k = 0; k < marks.size(); ++k)
        if (t.trial.verdict() == marks[k].verdict) points[k] += fmt::format("{} {}\n", x, y);
      if (!t.trial.is_right()) continue;
      const double error = t.trial.judgement.error;
      const std::string fill = colour(std::isfinite(error) ? error : 1).substr(1);
      if (!boxes.empty() && boxes.back().y == y && boxes.back().to == x - 0.5 && boxes.back().fill == fill)
        boxes.back().to = x + 0.5;
      else
        boxes.push_back({x - 0.5, x + 0.5, y, fill});
    }
  std::string filled;
  for (const Box& box : boxes)
    filled += fmt::format("{} {} {} {} {} {} 0x{}\n", (box.from + box.to) / 2, box.y, box.from, box.to,
                          box.y - 0.5, box.y + 0.5, box.fill);
  std::string plots;
  const auto add = [&](const std::string& name, const std::string& data, const std::string& how) {
    if (data.empty()) return;
    fmt::format_to(out, "${}{} << EOD\n{}EOD\n", name, index, data);
    plots += fmt::format("{}${}{} {}", plots.empty() ? "" : ", \\\n  ", name, index, how);
  };
  add("boxes", filled, "using 1:2:3:4:5:6:7 with boxxyerror fs solid 1 noborder lc rgb variable notitle");
  for (std::size_t k = 0; k < marks.size(); ++k)
    add(fmt::format("mark{}_", k), points[k],
        fmt::format("using 1:2 with points pt {} ps 0.55 lw 1.4 lc rgb \"{}\" notitle", marks[k].point,
                    marks[k].colour));
  std::string xtics, ytics;
  for (std::size_t k = 0; k < settings.size(); ++k)
    xtics += fmt::format("{}\"{}\" {}", k > 0 ? ", " : "", tic_text(settings[k]), k);
  for (std::size_t k = 0; k < methods.size(); ++k)
    ytics += fmt::format("{}{} {}", k > 0 ? ", " : "", named ? quoted(methods[k]) : "\"\"",
                         methods.size() - 1 - k);
  fmt::format_to(
      out,
      "set title {} offset 0,-0.8 font \",10\"\nset xrange [-0.5:{}]\nset yrange [-0.5:{}]\nset xtics ({}) "
      "rotate by 60 right font \",7\" scale 0 offset 0,0.2\nset ytics ({}) font \",8\" scale 0\nset xlabel "
      "{} font \",8\" "
      "offset 0,0.9\nplot {}\n",
      quoted(family), static_cast<double>(settings.size()) - 0.5, static_cast<double>(methods.size()) - 0.5,
      xtics, ytics, quoted(here.front().knob), plots.empty() ? "NaN notitle" : plots);
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
  fmt::format_to(out, "set label {} \"blank: refused\" at screen {},{} left font \",8\"\n", marks.size() + 3,
                 x, (top + below) / 2);
  return text;
}

}  // namespace

Drawing failure_map_drawing(const std::vector<StressTrial>& trials) {
  /// Families that the same methods met stand together, below each other's names.
  struct Block {
    std::vector<std::string> methods, families;
    int rows() const { return static_cast<int>((families.size() + columns - 1) / columns); }
    int panel() const { return row_height * static_cast<int>(methods.size()) + panel_frame; }
  };
  std::vector<Block> blocks;
  int height = legend_height;
  for (const auto& family : in_order<std::string>(trials, [](const StressTrial& t) { return t.family; })) {
    std::vector<StressTrial> here;
    std::copy_if(trials.begin(), trials.end(), std::back_inserter(here),
                 [&](const StressTrial& t) { return t.family == family; });
    const auto methods = in_order<std::string>(here, [](const StressTrial& t) { return t.trial.method; });
    if (blocks.empty() || blocks.back().methods != methods) blocks.push_back({methods, {}});
    blocks.back().families.push_back(family);
  }
  for (const Block& block : blocks) height += block.rows() * block.panel();
  Drawing drawing;
  drawing.height = height;
  drawing.script = legend(height) + "unset key\nset border lw 0.6 lc rgb \"#666666\"\nset multiplot\n";
  const double left = 0.19, width = (1 - left - 0.02) / columns;
  const auto out = std::back_inserter(drawing.script);
  std::size_t index = 0;
  int above = legend_height;
  for (const Block& block : blocks) {
    for (std::size_t k = 0; k < block.families.size(); ++k, ++index) {
      const double column = static_cast<double>(k % columns);
      const int from = above + static_cast<int>(k / columns) * block.panel();
      fmt::format_to(out,
                     "set lmargin at screen {}\nset rmargin at screen {}\nset tmargin at screen {}\nset "
                     "bmargin at screen "
                     "{}\n",
                     left + column * width, left + (column + 1) * width - 0.02,
                     1 - static_cast<double>(from + map_title_height) / height,
                     1 - static_cast<double>(from + block.panel() - panel_frame + map_title_height) / height);
      add_panel(drawing.script, trials, block.families[k], index, block.methods, k % columns == 0);
      if (index > 0) continue;
      for (std::size_t label = 1; label <= marks.size() + 3; ++label)
        fmt::format_to(out, "unset label {}\n", label);
      for (std::size_t object = 1; object <= scale.size(); ++object)
        fmt::format_to(out, "unset object {}\n", object);
    }
    above += block.rows() * block.panel();
  }
  drawing.script += "unset multiplot\n";
  return drawing;
}

}  // namespace cli
