#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "cli/commands.hpp"
#include "cli/drawing/failure_map_drawing.hpp"
#include "cli/drawing/gnuplot.hpp"
#include "cli/each_file.hpp"
#include "cli/measurement/exams.hpp"
#include "cli/measurement/progress.hpp"
#include "cli/measurement/trial_files.hpp"
#include "cli/text_table.hpp"
#include "convex/invalid_input.hpp"
#include "convex/nearest_name.hpp"

namespace cli {
namespace {

using convex::GalleryFamily;
using convex::Index;
using convex::InvalidInput;
using convex::Method;

/// One call is enough to see whether a method fails.
constexpr TrialLimits limits{1e-6, 3};

std::vector<const GalleryFamily*> asked_families(const Options& options) {
  std::vector<const GalleryFamily*> chosen;
  std::vector<std::string> names;
  for (const GalleryFamily& family : convex::gallery()) {
    names.emplace_back(family.name);
    if (options.families.empty()) chosen.push_back(&family);
  }
  for (const std::string& name : options.families) {
    const GalleryFamily* family = convex::find_family(name);
    if (family == nullptr)
      throw InvalidInput("there is no family \"" + name + "\" in the gallery; did you mean \"" +
                         convex::nearest_name(name, names) + "\"?");
    chosen.push_back(family);
  }
  return chosen;
}

/// Sizes at which every method can be expected to end.
Index stressed_size(const GalleryFamily& family) {
  if (family.name == "obstacle") return 12;
  return family.sparse ? 80 : std::min<Index>(family.size, 20);
}

std::vector<StressTrial> stressed(const Options& options) {
  const std::vector<const GalleryFamily*> families = asked_families(options);
  std::vector<const Method*> methods;
  for (const Method& method : convex::methods())
    if (!options.method || method.name == *options.method) methods.push_back(&method);
  if (methods.empty())
    throw InvalidInput("--method " + *options.method + ": there is no such method; see `moreau methods`");
  std::size_t steps = 0;
  for (const GalleryFamily* family : families) steps += family->ladder.size();
  Progress progress(static_cast<int>(steps));
  std::vector<StressTrial> trials;
  for (const GalleryFamily* family : families)
    for (const double difficulty : family->ladder) {
      const Exam exam = gallery_exam(*family, stressed_size(*family), difficulty);
      for (const Method* method : methods) {
        if (Progress::interrupted()) return trials;
        trials.push_back({std::string(family->name), difficulty,
                          trial(exam, *method, {.tolerance = options.tolerance.value_or(1e-9)}, limits)});
      }
      progress.step(fmt::format("{} {:g}", family->name, difficulty));
    }
  return trials;
}

/// Two characters a cell: digits, or how it failed.
std::string cell(const Trial& t) {
  switch (t.verdict) {
    case Verdict::ok:
      return t.error > 0 ? fmt::format("{:.0f}", std::clamp(-std::log10(t.error), 0.0, 16.0)) : "=";
    case Verdict::wrong:
      return "X";
    case Verdict::gave_up:
      return "o";
    case Verdict::too_slow:
      return "slow";
    case Verdict::refused:
      return ".";
    case Verdict::crashed:
      break;
  }
  return "!!";
}

std::string map_text(const std::vector<StressTrial>& trials) {
  std::string text =
      "digits right; = exact; X wrong without saying so; o gave up; slow; !! crashed; . does not apply\n\n";
  for (std::size_t begin = 0; begin < trials.size();) {
    std::size_t end = begin;
    while (end < trials.size() && trials[end].family == trials[begin].family) ++end;
    std::vector<std::string> heading{trials[begin].family}, methods;
    for (std::size_t k = begin; k < end; ++k) {
      const std::string setting = fmt::format("{:g}", trials[k].difficulty);
      if (trials[k].trial.method == trials[begin].trial.method) heading.push_back(setting);
      if (trials[k].difficulty == trials[begin].difficulty) methods.push_back(trials[k].trial.method);
    }
    TextTable table(heading);
    for (const std::string& method : methods) {
      std::vector<std::string> row{method};
      for (std::size_t k = begin; k < end; ++k)
        if (trials[k].trial.method == method) row.push_back(cell(trials[k].trial));
      table.add(row);
    }
    text += table.text() + "\n";
    begin = end;
  }
  return text;
}

/// For each method the settings at which it first fails, and how.
std::string threshold_text(const std::vector<StressTrial>& trials) {
  TextTable table({"method", "family", "first fails at", "how", "error"});
  std::vector<std::string> methods;
  for (const StressTrial& t : trials)
    if (std::find(methods.begin(), methods.end(), t.trial.method) == methods.end())
      methods.push_back(t.trial.method);
  for (const std::string& method : methods) {
    std::string last;
    for (const auto& [family, difficulty, t] : trials) {
      if (t.method != method || family == last || t.verdict == Verdict::ok || t.verdict == Verdict::refused)
        continue;
      last = family;
      table.add({method, family, fmt::format("{:g}", difficulty), verdict_text(t.verdict),
                 std::isfinite(t.error) ? fmt::format("{:.0e}", t.error) : "-"});
    }
    if (last.empty()) table.add({method, "none", "-", "-", "-"});
  }
  return table.text();
}

void write_stress(const Options& options, const std::vector<StressTrial>& trials) {
  if (options.data) {
    write_file(*options.data, stress_csv(trials));
    std::vector<Trial> plain;
    for (const StressTrial& t : trials) plain.push_back(t.trial);
    write_file(about_file(*options.data), measurement_json(plain, limits));
  }
  if (!options.output) return;
  const Drawing drawing = failure_map_drawing(trials);
  draw(*options.output, drawing);
}

}  // namespace

Exit stress_command(const Options& options) {
  const Source source{options.families.empty() ? "stress" : options.families.front(), ""};
  return answered(options, source, [&] {
    if (options.output)
      terminal_text(*options.output, 1, 1);  // a wrong name is told before the work, not after
    const std::vector<StressTrial> trials = stressed(options);
    write_stress(options, trials);
    if (options.quiet) return Exit::solved;
    if (!options.output) fmt::print("{}", map_text(trials));
    fmt::print("{}", threshold_text(trials));
    return Exit::solved;
  });
}

}  // namespace cli
