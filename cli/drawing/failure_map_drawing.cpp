#include "cli/drawing/failure_map_drawing.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <iterator>

#include "cli/drawing/gnuplot.hpp"
#include "cli/drawing/label_placement.hpp"
#include "cli/drawing/method_style.hpp"

namespace cli::inline drawings {
namespace {

/// Pixels: of a page 700 wide, the names of methods, a row of cells, and of each diagram what is above its
/// cells (its title) and below them (settings, what they set, room).
constexpr int most_columns = 3, names_width = 136, page_width = 700, gap = 12, row_height = 14,
              title_height = 24, settings_height = 66, legend_height = 66;

/// Digits of accuracy on a scale whose lightness alone orders it (after viridis: van der Walt and Smith
/// 2015).
constexpr std::array scale{"#440154", "#472d7b", "#3b528b", "#2c728e", "#21918c",
                           "#28ae80", "#5ec962", "#addc30", "#fde725"};
constexpr double most_digits = 16;

/// Whole digits, which are printed too: cells with one number have one colour.
double digits_of(double error) {
  return error > 0 ? std::round(std::clamp(-std::log10(error), 0.0, most_digits)) + 0.0
                   : most_digits;  // no -0
}

std::string colour(double error) {
  const auto place =
      static_cast<std::size_t>(std::lround(digits_of(error) / most_digits * (scale.size() - 1)));
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
  const char* background;
  const char* words;
};

/// gnuplot's markers: 2 a cross, 6 a ring, 8 a triangle, 1 a plus, 0 a dot. Told apart by shape and by the
/// lightness behind them, in grey as in colours.
constexpr std::array marks{Mark{Verdict::wrong, 2, "#000000", "#ff9a8a", "wrong without saying so"},
                           Mark{Verdict::gave_up, 6, "#333333", "#ffffff", "gave up, and said so"},
                           Mark{Verdict::too_slow, 8, "#333333", "#ffffff", "too slow"},
                           Mark{Verdict::crashed, 1, "#000000", "#ff9a8a", "crashed"},
                           Mark{Verdict::refused, 0, "#999999", "#dddddd", "does not apply"}};

template <typename T>
std::size_t place(const std::vector<T>& all, const T& one) {
  return static_cast<std::size_t>(std::find(all.begin(), all.end(), one) - all.begin());
}

/// One family: a cell for each method and setting, with the digits that are right.
class FamilyPanel {
 public:
  FamilyPanel(const std::vector<StressTrial>& trials, const std::string& family, std::size_t index,
              const std::vector<std::string>& methods)
      : index_(index), methods_(methods) {
    std::copy_if(trials.begin(), trials.end(), std::back_inserter(here_),
                 [&](const StressTrial& t) { return t.family == family; });
    settings_ = in_order<double>(here_, [](const StressTrial& t) { return t.difficulty; });
  }

  std::string script(bool named) {
    for (const StressTrial& t : here_) add(t);
    std::string filled, borders;
    for (const Box& box : boxes_)
      filled += fmt::format("{} {} {} {} {} {} 0x{}\n", (box.from + box.to) / 2, box.y, box.from, box.to,
                            box.y - 0.5, box.y + 0.5, box.fill.substr(1));
    for (std::size_t k = 1; k < settings_.size(); ++k)
      borders += fmt::format("{0} -0.5\n{0} {1}\n\n", static_cast<double>(k) - 0.5,
                             static_cast<double>(methods_.size()) - 0.5);
    for (std::size_t k = 1; k < methods_.size(); ++k)
      borders += fmt::format("-0.5 {0}\n{1} {0}\n\n", static_cast<double>(k) - 0.5,
                             static_cast<double>(settings_.size()) - 0.5);
    add("boxes", filled, "using 1:2:3:4:5:6:7 with boxxyerror fs solid 1 noborder lc rgb variable notitle");
    add("borders", borders, "using 1:2 with lines lc rgb \"#ffffff\" lw 0.7 notitle");
    add("digits", digits_, "using 1:2:3:4 with labels font \",7\" tc rgb variable notitle");
    for (std::size_t k = 0; k < marks.size(); ++k)
      add(fmt::format("mark{}_", k), points_[k],
          fmt::format("using 1:2 with points pt {} ps 0.5 lw 1.3 lc rgb \"{}\" notitle", marks[k].point,
                      marks[k].colour));
    std::string xtics, ytics;
    for (std::size_t k = 0; k < settings_.size(); ++k)
      xtics += fmt::format("{}\"{}\" {}", k > 0 ? ", " : "", tic_text(settings_[k]), k);
    for (std::size_t k = 0; k < methods_.size(); ++k)
      ytics += fmt::format("{}{} {}", k > 0 ? ", " : "", named ? quoted(methods_[k]) : "\"\"",
                           methods_.size() - 1 - k);
    return data_ + fmt::format(
                       "set title {} offset 0,-0.7 font \",10\"\nset xrange [-0.5:{}]\nset yrange [-0.5:{}]\n"
                       "set xtics ({}) rotate by 60 right font \",7\" scale 0 offset 0,0.2\n"
                       "set ytics ({}) font \",8\" scale 0\nset label 1 {} at graph 0.5, graph 0 center "
                       "offset 0,-2.75 "
                       "font \",8\"\nplot {}\n",
                       quoted(here_.front().family), static_cast<double>(settings_.size()) - 0.5,
                       static_cast<double>(methods_.size()) - 0.5, xtics, ytics, quoted(here_.front().knob),
                       plots_.empty() ? "NaN notitle" : plots_);
  }

 private:
  void add(const StressTrial& t) {
    const double x = static_cast<double>(place(settings_, t.difficulty)),
                 y = static_cast<double>(methods_.size() - 1 - place(methods_, t.trial.method));
    std::string fill;
    for (std::size_t k = 0; k < marks.size(); ++k)
      if (t.trial.verdict() == marks[k].verdict) {
        points_[k] += fmt::format("{} {}\n", x, y);
        fill = marks[k].background;
      }
    if (fill.empty()) {
      const double error = std::isfinite(t.trial.judgement.error) ? t.trial.judgement.error : 1;
      fill = colour(error);
      const double right = digits_of(error);
      constexpr double light_from = 11;  // the scale's lightness is that of black on white
      digits_ += fmt::format("{} {} \"{}\" 0x{}\n", x, y, error > 0 ? fmt::format("{:.0f}", right) : "=",
                             right >= light_from ? "000000" : "ffffff");
    }
    if (!boxes_.empty() && boxes_.back().y == y && boxes_.back().to == x - 0.5 && boxes_.back().fill == fill)
      boxes_.back().to = x + 0.5;
    else
      boxes_.push_back({x - 0.5, x + 0.5, y, fill});
  }

  void add(const std::string& name, const std::string& data, const std::string& how) {
    if (data.empty()) return;
    data_ += fmt::format("${}{} << EOD\n{}EOD\n", name, index_, data);
    plots_ += fmt::format("{}${}{} {}", plots_.empty() ? "" : ", \\\n  ", name, index_, how);
  }

  std::size_t index_;
  const std::vector<std::string>& methods_;
  std::vector<StressTrial> here_;
  std::vector<double> settings_;
  /// Neighbours of one colour, for the size of the file.
  struct Box {
    double from, to, y;
    std::string fill;
  };
  std::vector<Box> boxes_;
  std::string digits_, data_, plots_;
  std::array<std::string, marks.size()> points_;
};

/// Objects and labels of the legend, which every diagram after the first would draw again.
constexpr int first_number = 100;

std::string legend(int height) {
  std::string text;
  int number = first_number;
  const auto at = [&](double x, double y) {
    return fmt::format("screen {},{}", x / page_width, 1 - y / height);
  };
  constexpr double cell = 26, top = 12, bottom = 28, from = 200;
  text += fmt::format("set label {} \"digits of accuracy\" at {} right font \",9\"\n", number++,
                      at(from - 12, (top + bottom) / 2));
  for (std::size_t k = 0; k < scale.size(); ++k) {
    const double left = from + cell * static_cast<double>(k);
    text += fmt::format("set object {} rect from {} to {} fs solid 1 noborder fc rgb \"{}\" front\n", number,
                        at(left, bottom), at(left + cell, top), scale[k]);
    text +=
        fmt::format("set label {} \"{}\" at {} center front font \",8\" tc rgb \"{}\"\n", number++, 2 * k,
                    at(left + cell / 2, (top + bottom) / 2), k > scale.size() / 2 ? "#000000" : "#ffffff");
  }
  text += fmt::format("set label {} \"= every digit\" at {} left font \",9\"\n", number++,
                      at(from + cell * static_cast<double>(scale.size()) + 12, (top + bottom) / 2));
  double x = 40;
  for (const Mark& mark : marks) {
    constexpr double upper = 38, lower = 54;
    text += fmt::format(
        "set object {} rect from {} to {} fs solid 1 border lc rgb \"#888888\" fc rgb \"{}\" front\n", number,
        at(x, lower), at(x + 16, upper), mark.background);
    text += fmt::format("set label {} \"\" at {} front point pt {} ps 0.6 lw 1.3 lc rgb \"{}\"\n", number++,
                        at(x + 8, (upper + lower) / 2), mark.point, mark.colour);
    text += fmt::format("set label {} \"{}\" at {} left font \",9\"\n", number++, mark.words,
                        at(x + 22, (upper + lower) / 2));
    x += 22 + text_width(mark.words, 9) + 14;
  }
  return text;
}

std::string without_legend() {
  const auto labels = 3 + scale.size() + 2 * marks.size();
  std::string text;
  for (std::size_t k = 0; k < labels; ++k)
    text += fmt::format("unset label {0}\nunset object {0}\n", static_cast<std::size_t>(first_number) + k);
  return text;
}

}  // namespace

Drawing failure_map_drawing(const std::vector<StressTrial>& trials) {
  /// Families that the same methods met stand together.
  struct Group {
    std::vector<std::string> methods, families;
    int rows() const { return static_cast<int>((families.size() + most_columns - 1) / most_columns); }
    int cells() const { return row_height * static_cast<int>(methods.size()); }
    int panel() const { return title_height + cells() + settings_height; }
    /// Of the families in this row; the diagrams of a row that is not full are wider.
    std::size_t columns(int row) const {
      return std::min(static_cast<std::size_t>(most_columns),
                      families.size() - static_cast<std::size_t>(row) * most_columns);
    }
  };
  std::vector<Group> groups;
  int height = legend_height;
  for (const auto& family : in_order<std::string>(trials, [](const StressTrial& t) { return t.family; })) {
    std::vector<StressTrial> here;
    std::copy_if(trials.begin(), trials.end(), std::back_inserter(here),
                 [&](const StressTrial& t) { return t.family == family; });
    const auto methods = in_order<std::string>(here, [](const StressTrial& t) { return t.trial.method; });
    if (groups.empty() || groups.back().methods != methods) groups.push_back({methods, {}});
    groups.back().families.push_back(family);
  }
  for (const Group& group : groups) height += group.rows() * group.panel();
  Drawing drawing;
  drawing.height = height;
  drawing.script = legend(height) + "unset key\nset border lw 0.6 lc rgb \"#666666\"\nset multiplot\n";
  std::size_t index = 0;
  int above = legend_height;
  for (const Group& group : groups)
    for (int row = 0; row < group.rows(); ++row, above += group.panel()) {
      const std::size_t columns = group.columns(row);
      const double wide = static_cast<double>(page_width - names_width) / static_cast<double>(columns);
      for (std::size_t column = 0; column < columns; ++column, ++index) {
        const double left = names_width + wide * static_cast<double>(column);
        const double top = above + title_height, bottom = top + group.cells();
        drawing.script += fmt::format(
            "set lmargin at screen {}\nset rmargin at screen {}\nset tmargin at screen {}\nset bmargin at "
            "screen {}\n",
            left / page_width, (left + wide - gap) / page_width, 1 - top / height, 1 - bottom / height);
        const std::string& family = group.families[static_cast<std::size_t>(row) * most_columns + column];
        drawing.script += FamilyPanel(trials, family, index, group.methods).script(column == 0);
        if (index == 0) drawing.script += without_legend();
      }
    }
  drawing.script += "unset multiplot\n";
  return drawing;
}

}  // namespace cli::inline drawings
