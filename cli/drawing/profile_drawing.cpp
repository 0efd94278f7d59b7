#include "cli/drawing/profile_drawing.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <iterator>
#include <limits>
#include <map>

#include "cli/drawing/gnuplot.hpp"
#include "cli/drawing/method_style.hpp"

namespace cli {
namespace {

constexpr double infinity = std::numeric_limits<double>::infinity(), good_error = 1e-9, most_ratio = 1e5;

}  // namespace

Drawing profile_drawing(const std::vector<Trial>& trials) {
  std::map<std::string, double> quickest;                          // by problem
  std::map<std::string, std::map<std::string, double>> by_method;  // seconds, by method and problem
  for (const Trial& t : trials) {
    quickest.try_emplace(t.problem, infinity);
    if (!t.is_right() || !(t.judgement.error <= good_error)) continue;
    double& own = by_method[t.method].try_emplace(t.problem, infinity).first->second;
    own = std::min(own, t.seconds);
    quickest[t.problem] = std::min(quickest[t.problem], t.seconds);
  }
  const MethodStyles styles(trials);
  const std::vector<std::string>& methods = styles.methods();
  const auto problems = static_cast<double>(quickest.size());
  Drawing drawing;
  drawing.height = 480;
  std::string plots;
  for (std::size_t k = 0; k < methods.size(); ++k) {
    std::vector<double> ratios;
    for (const auto& [problem, seconds] : by_method[methods[k]])
      ratios.push_back(seconds / quickest[problem]);
    std::sort(ratios.begin(), ratios.end());
    std::string steps = "1 0\n";
    for (std::size_t i = 0; i < ratios.size(); ++i)
      steps += fmt::format("{} {}\n", ratios[i], static_cast<double>(i + 1) / problems);
    steps += fmt::format("{} {}\n", most_ratio, static_cast<double>(ratios.size()) / problems);
    fmt::format_to(std::back_inserter(drawing.script), "$m{} << EOD\n{}EOD\n", k, steps);
    plots +=
        fmt::format("{}$m{} using 1:2 with steps lc rgb \"{}\" lw 2 dt {} title {}", k > 0 ? ", \\\n  " : "",
                    k, styles.style(methods[k]).colour, styles.style(methods[k]).dashes,
                    quoted(fmt::format("{} ({} of {})", methods[k], ratios.size(), quickest.size())));
  }
  fmt::format_to(std::back_inserter(drawing.script),
                 "set logscale x\nset format x \"10^{{%L}}\"\nset xrange [1:{}]\nset yrange [0:1.02]\n"
                 "set grid lc rgb \"#dddddd\" lw 0.5\nset key outside right top Left reverse font \",9\"\n"
                 "set title {} font \",11\"\nset xlabel \"time / time of the quickest\"\n"
                 "set ylabel \"part of the problems solved to 1e-9\"\nplot {}\n",
                 most_ratio, quoted(fmt::format("Performance profiles over {} problems", quickest.size())),
                 plots);
  return drawing;
}

}  // namespace cli
