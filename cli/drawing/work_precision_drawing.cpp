#include "cli/drawing/work_precision_drawing.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <iterator>
#include <limits>
#include <tuple>

#include "cli/drawing/gnuplot.hpp"
#include "cli/drawing/label_column.hpp"
#include "cli/drawing/label_placement.hpp"
#include "cli/drawing/method_style.hpp"

namespace cli::inline drawings {
namespace {

/// Pixels. A diagram's box lies between `left` and its width less `right`.
constexpr double left = 50, right = 8, heading = 62, box_height = 218, title_height = 44, foot = 40,
                 label_height = 11.5;

/// Along x, in decades of the error: names of methods, answers from exact ones (at -18.6) to 1, failures.
constexpr double names_end = -19.5, exact_at = -18.6, errors_end = 0.6, failed_at = 1.3, failed_name = 1.9;

/// Diagrams side by side on a page: their width in pixels, and what their x goes through. Names need as many
/// pixels in a narrow one.
struct PageLayout {
  int columns;
  double failures_width, width;
  double decade, names_from, x_end;

  /// `failure_words`: the width of the longest, in pixels.
  PageLayout(std::size_t diagrams, const DrawnAs& drawn, double failure_words)
      : columns(static_cast<int>(std::clamp<std::size_t>(diagrams, 1, drawn.motions ? 2 : 3))),
        failures_width(std::max(usual_failures, failure_words + before_words)),
        width((columns == 1 ? alone : beside_others) + failures_width - usual_failures),
        decade((width - left - right - names_width - failures_width) / (errors_end - names_end)),
        names_from(names_end - names_width / decade),
        x_end(errors_end + failures_width / decade) {}

  double page_width() const { return width * columns; }

 private:
  static constexpr double alone = 700, beside_others = 490, names_width = 116, usual_failures = 148,
                          before_words = 26;
};

double error_of(const Trial& trial, const DrawnAs& drawn) {
  return drawn.multipliers ? trial.judgement.multiplier_error : trial.judgement.error;
}

double decades(double error) {
  return error > 0 ? std::clamp(std::log10(error), exact_at + 0.6, 0.0) : exact_at;
}

/// Seconds, or multiples of the seconds of the method that all are compared with.
double unit_of(const std::vector<Trial>& here, const DrawnAs& drawn) {
  if (drawn.relative_to.empty()) return 1;
  double least = unknown;
  for (const Trial& trial : here)
    if (trial.method == drawn.relative_to && trial.is_right() && !(trial.seconds >= least))
      least = trial.seconds;
  return least;
}

/// 1e-6 is "1 us", or "1e-06x" of another method's time.
std::string time_text(int decade, bool is_relative) {
  if (is_relative)
    return decade >= -1 && decade <= 4 ? fmt::format("{:g}x", std::pow(10, decade))
                                       : fmt::format("1e{}x", decade);
  const int third = decade >= 0 ? 0 : (decade - 2) / 3;
  constexpr const char* units[] = {"s", "ms", "us", "ns"};
  const int place = std::min(3, -third);
  return fmt::format("{:g} {}", std::pow(10, decade + 3 * place), units[place]);
}

std::string seconds_text(double seconds) {
  const double digits = std::pow(10, std::floor(std::log10(seconds)) - 1);
  const double rounded = std::round(seconds / digits) * digits;
  if (rounded < 1e-3) return fmt::format("{:.3g} us", rounded * 1e6);
  return rounded < 1 ? fmt::format("{:.3g} ms", rounded * 1e3) : fmt::format("{:.3g} s", rounded);
}

constexpr double failure_letters = 8;

/// "too-slow: lemke", with the setting of an iterative method.
std::string failure_words(const Trial& trial) {
  return fmt::format(
      "{}{}{}", trial.verdict() == Verdict::gave_up ? "" : std::string(verdict_text(trial.verdict())) + ": ",
      trial.method,
      trial.kind == convex::MethodKind::iterative
          ? fmt::format(", 1e{}", std::lround(std::log10(trial.setting)))
          : "");
}

double widest_failure(const std::vector<Trial>& trials) {
  double widest = 0;
  for (const Trial& trial : trials)
    if (!trial.is_right()) widest = std::max(widest, text_width(failure_words(trial), failure_letters));
  return widest;
}

std::string best_text(const std::vector<Trial>& here, const DrawnAs& drawn) {
  const std::vector<Trial> best = ranked(here);
  if (best.empty() || !best.front().is_right() || !(best.front().judgement.error <= good_error))
    return "no method reaches 1e-9";
  return "quickest to 1e-9: " + best.front().method +
         (drawn.relative_to.empty() ? ", " + seconds_text(best.front().seconds) : "");
}

/// A method in a diagram: its marks, and where its name points to.
struct Mark {
  std::string method, words;
  double x = 0, y = 0, label = 0;
};

class Panel {
 public:
  Panel(const std::vector<Trial>& trials, const std::string& problem, std::size_t index,
        const MethodStyles& styles, const DrawnAs& drawn, const PageLayout& layout)
      : index_(index), styles_(styles), drawn_(drawn), layout_(layout) {
    for (const Trial& trial : trials)
      if (trial.problem == problem) here_.push_back(trial);
    unit_ = unit_of(here_, drawn);
    low_ = std::numeric_limits<double>::infinity();
    high_ = -low_;
    for (const Trial& trial : here_) {
      if (!std::isfinite(trial.seconds)) continue;
      low_ = std::min(low_, std::log10(trial.seconds / unit_));
      high_ = std::max(high_, std::log10(trial.seconds / unit_));
    }
    if (!(low_ < high_)) low_ = -6, high_ = 0;
    low_ = std::floor(low_ - 0.1);
    high_ = std::ceil(high_ + 0.1);
  }

  /// With its upper left corner there on a page of that height, in pixels.
  std::string script(double from_left, double from_top, double height) {
    const double page = layout_.page_width(), top = from_top + title_height;
    for (const std::string& method : styles_.methods()) add(method);
    add_names(names_, names_end, -1, "right");
    add_names(failures_, failed_name, 1, "left");
    std::string tics;
    for (int decade = static_cast<int>(low_); decade <= static_cast<int>(high_); ++decade)
      tics += fmt::format("{}{} {}", tics.empty() ? "" : ", ",
                          quoted(time_text(decade, !drawn_.relative_to.empty())), decade);
    const Trial& first = here_.front();
    const std::string size =
        first.m > 0 ? fmt::format("n = {}, m = {}", first.n, first.m) : fmt::format("n = {}", first.n);
    return data_ +
           fmt::format(
               "set lmargin at screen {}\nset rmargin at screen {}\nset tmargin at screen {}\n"
               "set bmargin at screen {}\nset yrange [{}:{}]\nset ytics ({})\n"
               "set label 1 {} at graph 0, 1 left offset 0,1.9 font \",11\" tc rgb \"#111111\"\n"
               "set label 2 {} at graph 0, 1 left offset 0,0.7 font \",9\" tc rgb \"#111111\"\nplot {}\n",
               (from_left + left) / page, (from_left + layout_.width - right) / page, 1 - top / height,
               1 - (top + box_height) / height, low_, high_, tics, quoted(first.problem + " (" + size + ")"),
               quoted(best_text(here_, drawn_)), plots_.empty() ? "NaN notitle" : plots_);
  }

 private:
  void plot(const std::string& name, const std::string& block, const std::string& how) {
    if (block.empty()) return;
    data_ += fmt::format("${}{} << EOD\n{}EOD\n", name, index_, block);
    plots_ += fmt::format("{}${}{} {} notitle", plots_.empty() ? "" : ", \\\n  ", name, index_, how);
  }

  void add(const std::string& method) {
    const MethodStyle& style = styles_.style(method);
    std::string own, polished;
    constexpr double far = std::numeric_limits<double>::infinity();
    Mark best{method, method, far, 0, 0}, refined = best, failed{method, "", failed_at, 0, 0};
    for (const Trial& trial : here_) {
      if (trial.method != method) continue;
      const double error = error_of(trial, drawn_);
      const double y = std::isfinite(trial.seconds) ? std::log10(trial.seconds / unit_) : high_;
      if (trial.is_right() && std::isfinite(error)) {
        const double x = decades(error);
        (trial.judgement.polished ? polished : own) += fmt::format("{} {}\n", x, y);
        Mark& mark = trial.judgement.polished ? refined : best;
        if (x < mark.x - 1e-9) mark.x = x, mark.y = y;
      } else if (!trial.is_right()) {
        failed.words = failure_words(trial);
        failed.y = y;
      }
    }
    const std::string number = std::to_string(places_++) + "_";
    if (std::isfinite(best.x) && std::isfinite(refined.x))
      plot("gain" + number, fmt::format("{} {}\n{} {}\n", best.x, best.y, refined.x, refined.y),
           fmt::format("using 1:2 with lines lc rgb \"{}\" lw 0.5 dt 3", style.colour));
    plot("own" + number, own,
         fmt::format("using 1:2 with linespoints lc rgb \"{}\" lw 1.5 dt {} pt {} ps {}", style.colour,
                     style.dashes, style.marker, style.size));
    plot("polished" + number, polished,
         fmt::format("using 1:2 with points lc rgb \"{}\" lw 1.3 pt 3 ps 0.7", style.colour));
    if (std::isfinite(best.x))
      names_.push_back(best);
    else if (std::isfinite(refined.x))
      names_.push_back(refined);
    if (!failed.words.empty()) failures_.push_back(failed);
  }

  /// Names in a column, each with its marker and a line to where it points.
  void add_names(std::vector<Mark>& marks, double x, int side, const char* aligned) {
    std::vector<double> wanted;
    for (const Mark& mark : marks) wanted.push_back(mark.y);
    const double pixel = (high_ - low_) / box_height;
    const std::vector<double> placed =
        label_positions(wanted, label_height * pixel, low_ + 7 * pixel, high_ - 7 * pixel);
    for (std::size_t k = 0; k < marks.size(); ++k) {
      const Mark& mark = marks[k];
      const MethodStyle& style = styles_.style(mark.method);
      const std::string name = fmt::format("{}{}_", side < 0 ? "name" : "failed", k);
      plot(name + "line", fmt::format("{} {}\n{} {}\n", x, placed[k], mark.x, mark.y),
           fmt::format("using 1:2 with lines lc rgb \"{}\" lw 0.4", style.colour));
      plot(name + "text", fmt::format("{} {} {}\n", x, placed[k], quoted(mark.words)),
           fmt::format("using 1:2:3 with labels {} offset {},0 font \"{},{}\" tc rgb \"{}\"", aligned,
                       0.9 * side, mark.method == "auto" ? "Helvetica:Bold" : "",
                       side < 0 ? 9 : failure_letters, style.text_colour()));
      plot(name + "mark", fmt::format("{} {}\n", side < 0 ? x : mark.x, side < 0 ? placed[k] : mark.y),
           fmt::format("using 1:2 with points lc rgb \"{}\" lw 1.2 pt {} ps {}", style.colour,
                       side < 0 ? style.marker : style.hollow(), side < 0 ? 0.6 : 0.8));
    }
  }

  std::size_t index_;
  const MethodStyles& styles_;
  const DrawnAs& drawn_;
  const PageLayout& layout_;
  std::vector<Trial> here_;
  double unit_ = 1, low_ = 0, high_ = 0;
  std::vector<Mark> names_, failures_;
  int places_ = 0;
  std::string data_, plots_;
};

/// What the marks that are drawn mean, above the diagrams.
std::string key(double width, double height, const std::vector<Trial>& trials, const DrawnAs& drawn) {
  const auto y = [&](double pixel) { return 1 - pixel / height; };
  std::string text;
  int number = 10;
  const auto add = [&](double x, double pixel, const std::string& words, const std::string& point) {
    text += fmt::format("set label {} {} at screen {},{} left font \",9\" tc rgb \"#111111\" {}\n", number++,
                        quoted(words), x / width, y(pixel), point);
  };
  add(14, 14,
      fmt::format("{} against true error{}: lower and further left is better.",
                  drawn.relative_to.empty() ? "Time" : "Time over that of " + drawn.relative_to,
                  drawn.multipliers ? " of the multipliers" : ""),
      "");
  struct Sign {
    const char *words, *point;
    double width;
    bool is_drawn;
  };
  const auto any = [&](const auto& has) { return std::any_of(trials.begin(), trials.end(), has); };
  const auto own = [&](convex::MethodKind kind) {
    return any([&](const Trial& t) { return !drawn.motions && t.kind == kind && t.method != "auto"; });
  };
  const Sign signs[] = {
      {"auto, the default", "pt 7 ps 1.1 lc rgb \"#d55e00\"", 120,
       any([](const Trial& t) { return t.method == "auto"; })},
      {"direct: one mark", "pt 5 ps 0.75 lc rgb \"#222222\"", 110, own(convex::MethodKind::direct)},
      {"iterative: a mark a setting, 1e-1 to 1e-15", "pt 9 ps 0.7 lc rgb \"#0072b2\"", 230,
       own(convex::MethodKind::iterative)},
      {"event-driven: a mark a tolerance, 1e-1 to 1e-15", "pt 5 ps 0.75 lc rgb \"#0072b2\"", 262,
       drawn.motions},
      {"time-stepping: a mark a step, from 0.1 down", "pt 9 ps 0.7 lc rgb \"#009e73\"", 242, drawn.motions},
      {"after refinement", "pt 3 ps 0.7 lw 1.3 lc rgb \"#222222\"", 108,
       any([](const Trial& t) { return t.judgement.polished; })},
      {"gave up", "pt 6 ps 0.8 lw 1.2 lc rgb \"#222222\"", 70,
       any([](const Trial& t) { return t.verdict() == Verdict::gave_up; })},
  };
  double x = 22;
  for (const Sign& sign : signs) {
    if (!sign.is_drawn) continue;
    add(x, 34, sign.words, fmt::format("point {} offset 0.8,-0.3", sign.point));
    x += sign.width;
  }
  return text;
}

}  // namespace

std::vector<Trial> ranked(std::vector<Trial> trials) {
  const auto worth = [](const Trial& trial) {
    const double error = trial.judgement.error;
    const bool good = trial.is_right() && error <= good_error;
    const double lost = std::isfinite(error) ? error : 1e300;
    return std::tuple(trial.is_right() ? (good ? 0 : 1) : 2, good ? trial.seconds : lost, trial.method);
  };
  std::stable_sort(trials.begin(), trials.end(),
                   [&](const Trial& a, const Trial& b) { return worth(a) < worth(b); });
  return trials;
}

Drawing work_precision_drawing(const std::vector<Trial>& trials, const DrawnAs& drawn) {
  std::vector<Trial> applied;
  std::copy_if(trials.begin(), trials.end(), std::back_inserter(applied),
               [](const Trial& trial) { return trial.verdict() != Verdict::refused; });
  const auto problems = in_order<std::string>(applied, [](const Trial& t) { return t.problem; });
  const MethodStyles styles(applied);
  const PageLayout layout(problems.size(), drawn, widest_failure(applied));
  const auto columns = static_cast<std::size_t>(layout.columns);
  const std::size_t rows = (problems.size() + columns - 1) / columns;
  const double panel = title_height + box_height + foot;
  Drawing drawing;
  drawing.width = static_cast<int>(layout.page_width());
  drawing.height = static_cast<int>(heading + panel * static_cast<double>(rows));
  const double height = drawing.height;
  drawing.script += fmt::format("{}set multiplot\n", key(layout.page_width(), height, applied, drawn));
  drawing.script += fmt::format(
      "set xrange [{}:{}]\nset grid lc rgb \"#dddddd\" lw 0.6 dt 1\nset tics font \",9\" nomirror scale 0.5\n"
      "set border lw 0.7 lc rgb \"#666666\"\nunset key\n"
      "set xtics (\"exact\" {}, \"1e-12\" -12, \"1e-8\" -8, \"1e-4\" -4, \"1\" 0)\n"
      "set object 1 rect from {},graph 0 to {},graph 1 fs solid noborder fc rgb \"#f5f5f5\" behind\n"
      "set object 2 rect from {},graph 0 to {},graph 1 fs solid noborder fc rgb \"#f5f5f5\" behind\n"
      "set label 3 \"relative error{}\" at -9,graph 0 center offset 0,-2.1 font \",9\"\n"
      "set label 5 \"time\" at graph 0,graph 0 right offset -0.9,-1.1 font \",9\"\n"
      "set label 4 \"not solved\" at {},graph 0 center offset 0,-1.1 font \",9\"\n",
      layout.names_from, layout.x_end, exact_at, layout.names_from, exact_at - 0.6, errors_end, layout.x_end,
      drawn.multipliers ? " of the multipliers" : "", (errors_end + layout.x_end) / 2);
  for (std::size_t k = 0; k < problems.size(); ++k) {
    const double across = layout.width * static_cast<double>(k % columns),
                 down = heading + panel * static_cast<double>(k / columns);
    drawing.script += Panel(applied, problems[k], k, styles, drawn, layout).script(across, down, height);
    if (k > 0) continue;
    for (int label = 10; label < 16; ++label) drawing.script += fmt::format("unset label {}\n", label);
  }
  drawing.script += "unset multiplot\n";
  return drawing;
}

}  // namespace cli::inline drawings
