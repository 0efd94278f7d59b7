#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "cli/commands.hpp"
#include "cli/drawing/gnuplot.hpp"
#include "cli/drawing/profile_drawing.hpp"
#include "cli/drawing/work_precision_drawing.hpp"
#include "cli/each_file.hpp"
#include "cli/measurement/exams.hpp"
#include "cli/measurement/progress.hpp"
#include "cli/measurement/trial_files.hpp"
#include "cli/text_table.hpp"
#include "convex/nearest_name.hpp"

namespace cli {
namespace {

using convex::InvalidInput;
using convex::Method;
using convex::MethodKind;

/// A direct method has one accuracy; the others are asked for each of these, and no further once two in a row
/// were not reached.
constexpr double direct_setting = 1e-9;
constexpr std::array ladder{1e-1, 1e-2,  1e-3,  1e-4,  1e-5,  1e-6,  1e-7, 1e-8,
                            1e-9, 1e-10, 1e-11, 1e-12, 1e-13, 1e-14, 1e-15};

std::vector<const Method*> charted_methods(const std::string& only) {
  std::vector<const Method*> chosen;
  std::vector<std::string> names;
  for (const Method& method : convex::methods()) {
    names.emplace_back(method.name);
    if (only.empty() || method.name == only) chosen.push_back(&method);
  }
  if (chosen.empty())
    throw InvalidInput("--method " + only + ": there is no such method; did you mean \"" +
                       convex::nearest_name(only, names) + "\"?");
  return chosen;
}

void chart_one(const Exam& exam, const Method& method, const TrialLimits& limits,
               std::vector<Trial>& trials) {
  if (method.kind != MethodKind::iterative) {
    trials.push_back(trial(exam, method, {.tolerance = direct_setting}, limits));
    return;
  }
  int missed = 0;
  for (const double setting : ladder) {
    trials.push_back(trial(exam, method, {.tolerance = setting, .polish = false}, limits));
    const Trial& last = trials.back();
    if (last.verdict == Verdict::refused || Progress::interrupted()) return;
    const bool reached = last.verdict == Verdict::ok && last.error <= 10 * setting;
    missed = reached ? 0 : missed + 1;
    if (missed == 2 || last.verdict == Verdict::too_slow) break;
  }
  trials.push_back(trial(exam, method, {.tolerance = direct_setting}, limits));
}

std::vector<Trial> charted(const std::vector<Exam>& exams, const std::vector<const Method*>& methods,
                           const TrialLimits& limits) {
  std::vector<Trial> trials;
  Progress progress(static_cast<int>(exams.size() * methods.size()));
  for (const Exam& exam : exams)
    for (const Method* method : methods) {
      if (Progress::interrupted()) return trials;
      chart_one(exam, *method, limits, trials);
      progress.step(exam.name + ": " + std::string(method->name));
    }
  return trials;
}

std::string digits_text(double error) {
  if (!std::isfinite(error)) return "-";
  return error > 0 ? fmt::format("{:.1f}", std::max(0.0, -std::log10(error))) : "exact";
}

/// Best on top: for each method its quickest right answer, or else its best.
std::string table_text(const std::vector<Trial>& trials, const DrawnAs& drawn) {
  std::string text;
  std::vector<std::string> problems;
  for (const Trial& t : trials)
    if (problems.empty() || problems.back() != t.problem) problems.push_back(t.problem);
  for (const std::string& problem : problems) {
    std::vector<Trial> here;
    for (const Trial& t : trials)
      if (t.problem == problem && t.verdict != Verdict::refused) here.push_back(t);
    if (here.empty()) continue;
    TextTable table({"method", "time", "digits", "verdict"});
    std::vector<std::string> seen;
    for (const Trial& t : ranked(here)) {
      if (std::find(seen.begin(), seen.end(), t.method) != seen.end()) continue;
      seen.push_back(t.method);
      table.add({t.method, std::isfinite(t.seconds) ? fmt::format("{:.3g} s", t.seconds) : "-",
                 digits_text(drawn.multipliers ? t.multiplier_error : t.error), verdict_text(t.verdict)});
    }
    text += fmt::format("{}: {} coordinates, {} contacts\n{}\n", problem, here.front().n, here.front().m,
                        table.text());
  }
  return text;
}

std::vector<Exam> asked_exams(const Options& options) {
  if (options.files.empty()) return charted_exams();
  std::vector<Exam> exams;
  for (const std::string& file : options.files) exams.push_back(file_exam(read_scene(file, {})));
  return exams;
}

/// What is written: the data and the picture.
void write_chart(const Options& options, const std::vector<Trial>& trials, const DrawnAs& drawn,
                 const TrialLimits& limits) {
  if (options.data) {
    write_file(*options.data, chart_csv(trials));
    write_file(about_file(*options.data), measurement_json(trials, limits));
  }
  if (!options.output) return;
  draw(*options.output, options.profile ? profile_drawing(trials) : work_precision_drawing(trials, drawn));
}

}  // namespace

Exit chart_command(const Options& options) {
  const Source source{options.files.empty() ? "chart" : options.files.front(), ""};
  return answered(options, source, [&] {
    const DrawnAs drawn{options.error == "multipliers", options.relative_to.value_or("")};
    if (!drawn.relative_to.empty()) charted_methods(drawn.relative_to);
    if (options.output)
      terminal_text(*options.output, 1, 1);  // a wrong name is told before the work, not after
    const TrialLimits limits;
    const std::vector<Exam> exams =
        options.profile && options.files.empty() ? profile_exams() : asked_exams(options);
    const std::vector<Trial> trials = charted(exams, charted_methods(options.method.value_or("")), limits);
    write_chart(options, trials, drawn, limits);
    if (!options.output && !options.quiet) fmt::print("{}", table_text(trials, drawn));
    return Exit::solved;
  });
}

}  // namespace cli
