#include "cli/drawing/work_precision_drawing.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <iterator>
#include <map>
#include <tuple>

#include "cli/drawing/gnuplot.hpp"
#include "cli/drawing/method_style.hpp"

namespace cli {
namespace {

/// An error of 0 is drawn where no double's error lies; what failed, beyond all errors.
constexpr double least_error = 1e-18, most_error = 1, failed_at = 3e2;

/// An error up to here is a right answer to an engineer; the quickest such method is named above a diagram.
constexpr double good_error = 1e-9;

constexpr int panel_height = 290;

double error_of(const Trial& trial, const DrawnAs& drawn) {
  return drawn.multipliers ? trial.multiplier_error : trial.error;
}

template <typename Get>
std::vector<std::string> in_order(const std::vector<Trial>& trials, Get get) {
  std::vector<std::string> all;
  for (const Trial& trial : trials)
    if (std::find(all.begin(), all.end(), get(trial)) == all.end()) all.push_back(get(trial));
  return all;
}

bool is_right(const Trial& trial) { return trial.verdict == Verdict::ok; }

/// Seconds, or multiples of the seconds of the method that all are compared with.
double unit_of(const std::vector<Trial>& trials, const std::string& problem, const DrawnAs& drawn) {
  if (drawn.relative_to.empty()) return 1;
  double least = std::nan("");
  for (const Trial& trial : trials)
    if (trial.problem == problem && trial.method == drawn.relative_to && is_right(trial) &&
        !(trial.seconds >= least))
      least = trial.seconds;
  return least;
}

std::string best_text(const std::vector<Trial>& trials, const std::string& problem) {
  std::vector<Trial> here;
  for (const Trial& trial : trials)
    if (trial.problem == problem) here.push_back(trial);
  const std::vector<Trial> best = ranked(here);
  if (best.empty() || !is_right(best.front()) || !(best.front().error <= good_error))
    return "no method reaches 1e-9";
  return "quickest to 1e-9: " + best.front().method;
}

void add_panel(std::string& script, const std::vector<Trial>& trials, const std::string& problem,
               std::size_t index, const MethodStyles& styles, const DrawnAs& drawn) {
  const auto out = std::back_inserter(script);
  const auto first =
      std::find_if(trials.begin(), trials.end(), [&](const Trial& t) { return t.problem == problem; });
  const double unit = unit_of(trials, problem, drawn);
  std::string plots;
  for (std::size_t k = 0; k < styles.methods().size(); ++k) {
    const std::string& method = styles.methods()[k];
    std::string right, polished, failed;
    std::string word;
    for (const Trial& trial : trials) {
      if (trial.problem != problem || trial.method != method || !std::isfinite(trial.seconds)) continue;
      const double error = error_of(trial, drawn);
      if (is_right(trial) && std::isfinite(error)) {
        (trial.polished && trial.kind == convex::MethodKind::iterative ? polished : right) +=
            fmt::format("{} {}\n", std::clamp(error, least_error, most_error), trial.seconds / unit);
      } else if (!is_right(trial)) {
        failed = fmt::format("{} {} {}\n", failed_at, trial.seconds / unit,
                             quoted(method + " " + verdict_text(trial.verdict)));
      }
    }
    const std::string style = fmt::format("lc rgb \"{}\"", styles.colour(method));
    if (!right.empty()) {
      fmt::format_to(out, "$right{}_{} << EOD\n{}EOD\n", index, k, right);
      plots += fmt::format("{}$right{}_{} using 1:2 with linespoints {} lw 1.4 pt {} ps 0.7 notitle",
                           plots.empty() ? "" : ", \\\n  ", index, k, style, styles.filled(method));
    }
    if (!polished.empty()) {
      fmt::format_to(out, "$polished{}_{} << EOD\n{}EOD\n", index, k, polished);
      plots += fmt::format("{}$polished{}_{} using 1:2 with points {} lw 1.2 pt 3 ps 0.7 notitle",
                           plots.empty() ? "" : ", \\\n  ", index, k, style);
    }
    if (!failed.empty()) {
      fmt::format_to(out, "$failed{}_{} << EOD\n{}EOD\n", index, k, failed);
      plots += fmt::format(
          "{0}$failed{1}_{2} using 1:2 with points {3} lw 1.2 pt {4} ps 0.8 notitle, \\\n"
          "  $failed{1}_{2} using 1:2:3 with labels right offset -0.8,0 font \",7\" tc rgb \"{5}\" notitle",
          plots.empty() ? "" : ", \\\n  ", index, k, style, styles.hollow(method), styles.colour(method));
    }
  }
  fmt::format_to(
      out, "set title {} offset 0,-0.5 font \",10\"\n",
      quoted(fmt::format("{} (n {}, m {})\n{}", problem, first->n, first->m, best_text(trials, problem))));
  if (plots.empty()) plots = "NaN notitle";
  fmt::format_to(out, "plot {}\n", plots);
}

void add_key(std::string& script, const MethodStyles& styles) {
  std::string plots;
  for (const std::string& method : styles.methods())
    plots += fmt::format("{}NaN with linespoints lc rgb \"{}\" lw 1.4 pt {} ps 0.7 title {}",
                         plots.empty() ? "" : ", \\\n  ", styles.colour(method), styles.filled(method),
                         quoted(method));
  script +=
      "unset title\nunset xlabel\nunset ylabel\nunset tics\nunset border\nunset grid\nunset arrow\nunset "
      "logscale\nset xrange [0:1]\nset yrange [0:1]\nset key at screen KEYX,KEYY left top Left reverse "
      "maxrows 8 "
      "font \",9\" samplen 1.5 width 1\nset title \"star: then polished; hollow: "
      "failed\" "
      "font \",9\"\nplot " +
      plots + "\n";
}

}  // namespace

std::vector<Trial> ranked(std::vector<Trial> trials) {
  const auto worth = [](const Trial& trial) {
    const bool good = is_right(trial) && trial.error <= good_error;
    const double lost = std::isfinite(trial.error) ? trial.error : 1e300;
    return std::tuple(is_right(trial) ? (good ? 0 : 1) : 2, good ? trial.seconds : lost, trial.method);
  };
  std::stable_sort(trials.begin(), trials.end(),
                   [&](const Trial& a, const Trial& b) { return worth(a) < worth(b); });
  return trials;
}

Drawing work_precision_drawing(const std::vector<Trial>& trials, const DrawnAs& drawn) {
  std::vector<Trial> applied;
  std::copy_if(trials.begin(), trials.end(), std::back_inserter(applied),
               [](const Trial& trial) { return trial.verdict != Verdict::refused; });
  const std::vector<std::string> problems = in_order(applied, [](const Trial& t) { return t.problem; });
  const MethodStyles styles(in_order(applied, [](const Trial& t) { return t.method; }));
  const std::size_t panels = problems.size() + 1, rows = (panels + 1) / 2;
  Drawing drawing;
  drawing.height = static_cast<int>(rows) * panel_height;
  const auto out = std::back_inserter(drawing.script);
  fmt::format_to(out, "set multiplot layout {},2 rowsfirst\n", rows);
  fmt::format_to(
      out,
      "set logscale xy\nset xrange [{}:{}]\nset grid lc rgb \"#cccccc\" lw 0.7\nset tics font \",9\"\n"
      "set border lw 0.7 lc rgb \"#444444\"\nset format y \"10^{{%L}}\"\n"
      "set xtics (\"0\" {}, \"10^{{-16}}\" 1e-16, \"10^{{-12}}\" 1e-12, \"10^{{-8}}\" 1e-8, \"10^{{-4}}\" "
      "1e-4, "
      "\"1\" 1, \"failed\" {})\n"
      "set xlabel \"true error{}, relative\" font \",9\" offset 0,0.5\nset ylabel \"{}\" font \",9\" offset "
      "1,0\n"
      "set arrow from 20, graph 0 to 20, graph 1 nohead dt 2 lc rgb \"#888888\"\nunset key\n",
      least_error / 3, failed_at * 10, least_error, failed_at, drawn.multipliers ? " of the multipliers" : "",
      drawn.relative_to.empty() ? "time (s)" : "time / time of " + drawn.relative_to);
  for (std::size_t k = 0; k < problems.size(); ++k)
    add_panel(drawing.script, applied, problems[k], k, styles, drawn);
  std::string key;
  add_key(key, styles);
  const bool right_column = problems.size() % 2 == 1;
  const auto put = [&](const std::string& name, double value) {
    key.replace(key.find(name), name.size(), fmt::format("{}", value));
  };
  put("KEYX", right_column ? 0.53 : 0.08);
  put("KEYY", 1.0 / static_cast<double>(rows) - 40.0 / drawing.height);
  drawing.script += key + "unset multiplot\n";
  return drawing;
}

}  // namespace cli
