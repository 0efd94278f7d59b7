#include "cli/drawing/profile_drawing.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <iterator>
#include <map>

#include "cli/drawing/gnuplot.hpp"
#include "cli/drawing/label_column.hpp"
#include "cli/drawing/method_style.hpp"
#include "convex/infinity.hpp"

namespace cli::inline drawings {
namespace {

using convex::infinity;

/// Across, in decades of the ratio: the curves, then their names. Up: parts of all problems.
constexpr double curves_end = 3, sample_at = 3.2, names_at = 3.4, x_end = 4.9, y_end = 1.03,
                 name_height = 0.042;

/// Curves cross, so here each method has a colour and dashes that no other has.
constexpr std::array method_colours{"#0072b2", "#009e73", "#cc79a7", "#e69f00",
                                    "#56b4e9", "#882255", "#222222"};

struct Curve {
  std::string method, steps;
  std::size_t solved = 0;
  double end = 0;  ///< its height at the right end
};

Curve curve(const std::string& method, const std::map<std::string, double>& times,
            const std::map<std::string, double>& quickest) {
  const auto problems = static_cast<double>(quickest.size());
  std::vector<double> ratios;
  for (const auto& [problem, seconds] : times) ratios.push_back(std::log10(seconds / quickest.at(problem)));
  std::sort(ratios.begin(), ratios.end());
  Curve result{method, "0 0\n", ratios.size(), 0};
  for (std::size_t i = 0; i < ratios.size() && ratios[i] <= curves_end; ++i) {
    result.end = static_cast<double>(i + 1) / problems;
    result.steps += fmt::format("{} {}\n", ratios[i], result.end);
  }
  result.steps += fmt::format("{} {}\n", curves_end, result.end);
  return result;
}

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
  std::vector<Curve> curves;
  std::vector<double> wanted;
  const MethodStyles styles(trials);
  for (const std::string& method : styles.methods()) {
    curves.push_back(curve(method, by_method[method], quickest));
    // What a curve reaches it should reach early: ties go to the one with more under it.
    wanted.push_back(curves.back().end + 1e-6 * static_cast<double>(styles.methods().size() - curves.size()));
  }
  const std::vector<double> placed = label_positions(wanted, name_height, 0.03, y_end - 0.03);
  Drawing drawing;
  drawing.height = 460;
  std::string plots;
  for (std::size_t k = 0; k < curves.size(); ++k) {
    const Curve& c = curves[k];
    const bool is_default = c.method == "auto";
    const std::string colour = is_default ? "#d55e00" : method_colours[k % method_colours.size()];
    drawing.script += fmt::format(
        "$m{} << EOD\n{}EOD\n$l{} << EOD\n{} {}\n{} {}\nEOD\n$s{} << EOD\n{} {}\n{} {}\nEOD\n$t{} "
        "<< EOD\n{} {} {}\nEOD\n",
        k, c.steps, k, curves_end, c.end, sample_at, placed[k], k, sample_at, placed[k], names_at, placed[k],
        k, names_at, placed[k], quoted(fmt::format("{} ({} of {})", c.method, c.solved, quickest.size())));
    plots += fmt::format(
        "{0}$m{1} using 1:2 with steps lc rgb \"{2}\" lw {3} dt {4} notitle, \\\n"
        "  $l{1} using 1:2 with lines lc rgb \"{2}\" lw 0.4 notitle, \\\n"
        "  $s{1} using 1:2 with lines lc rgb \"{2}\" lw {3} dt {4} notitle, \\\n"
        "  $t{1} using 1:2:3 with labels left offset 0.4,0 font \"{5},9\" tc rgb \"#222222\" notitle",
        k > 0 ? ", \\\n  " : "", k, colour, is_default ? 3 : 1.6, 1 + k / method_colours.size(),
        is_default ? "Helvetica:Bold" : "");
  }
  drawing.script += fmt::format(
      "set xrange [0:{}]\nset yrange [0:{}]\nset grid lc rgb \"#dddddd\" lw 0.5 dt 1\nunset key\n"
      "set border 3 lc rgb \"#666666\" lw 0.7\nset tics nomirror font \",9\"\n"
      "set xtics (\"1\" 0, \"10\" 1, \"100\" 2, \"1000\" 3)\n"
      "set title {} font \",11\"\n"
      "set xlabel \"at most so many times the time of the quickest\" font \",10\"\n"
      "set ylabel \"part of the problems solved to 1e-9\" font \",10\"\nplot {}\n",
      x_end, y_end,
      quoted(fmt::format("Performance profiles over {} problems: higher and further left is better",
                         quickest.size())),
      plots.empty() ? "NaN notitle" : plots);
  return drawing;
}

}  // namespace cli::inline drawings
