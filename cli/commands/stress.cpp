#include <CLI/CLI.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "cli/commands/command_line.hpp"
#include "cli/drawing/failure_map_drawing.hpp"
#include "cli/drawing/gnuplot.hpp"
#include "cli/each_file.hpp"
#include "cli/measurement/exams.hpp"
#include "cli/measurement/motion_exams.hpp"
#include "cli/measurement/peers.hpp"
#include "cli/measurement/progress.hpp"
#include "cli/measurement/stress_families.hpp"
#include "cli/measurement/trial_files.hpp"
#include "cli/problem_file/documents.hpp"
#include "cli/report/text_table.hpp"
#include "convex/invalid_input.hpp"
#include "convex/nearest_name.hpp"

namespace cli::inline commands {
namespace {

using convex::InvalidInput;

/// What `moreau stress` is told.
struct StressOptions : MeasurementOptions {
  std::vector<std::string> families;
  std::optional<double> tolerance;
  bool peers = false;   ///< with the solvers of other packages
  bool polish = false;  ///< answers after the judge's refinement
};

/// One call is enough to see whether a method fails.
TrialLimits stress_limits(const StressOptions& options) { return {1e-6, options.quick ? 0.5 : 3}; }

/// With --quick a ladder has so many settings, its ends among them.
constexpr std::size_t quick_settings = 3;
constexpr convex::Index usual_size = 20, quick_size = 8;

std::vector<StressFamily> asked_families(const StressOptions& options) {
  std::vector<StressFamily> all = stress_families(options.quick ? quick_size : usual_size, options.peers);
  if (options.families.empty()) return all;
  std::vector<StressFamily> chosen;
  std::vector<std::string> names;
  for (const StressFamily& family : all) names.push_back(family.name);
  for (const std::string& name : options.families) {
    const auto found = std::find(names.begin(), names.end(), name);
    if (found == names.end())
      throw InvalidInput("there is no family \"" + name + "\" to stress; " + convex::suggestion(name, names));
    chosen.push_back(all[static_cast<std::size_t>(found - names.begin())]);
  }
  return chosen;
}

std::vector<double> thinned(const std::vector<double>& ladder) {
  if (ladder.size() <= quick_settings) return ladder;
  std::vector<double> some;
  for (std::size_t k = 0; k < quick_settings; ++k)
    some.push_back(ladder[k * (ladder.size() - 1) / (quick_settings - 1)]);
  return some;
}

/// An iteration's own answer is what is stressed, not that of the rows it shows to be active.
convex::Accuracy asked_accuracy(const StressOptions& options) {
  return {.tolerance = options.tolerance.value_or(1e-9), .polish = options.polish};
}

std::vector<StressTrial> stressed(const StressOptions& options) {
  if (options.peers) require_peers();
  std::vector<StressFamily> families = asked_families(options);
  std::size_t steps = 0;
  for (StressFamily& family : families) {
    if (options.quick) family.ladder = thinned(family.ladder);
    steps += family.ladder.size();
  }
  std::vector<std::string> known = contestant_names();
  for (const std::string& name : integrator_names()) known.push_back(name);
  if (options.method && std::find(known.begin(), known.end(), *options.method) == known.end())
    throw InvalidInput("--method " + *options.method + ": there is no such method; " +
                       convex::suggestion(*options.method, known));
  Progress progress(static_cast<int>(steps));
  std::vector<StressTrial> trials;
  for (const StressFamily& family : families) {
    for (const double setting : family.ladder) {
      for (const Contest& contest : family.at(setting)) {
        if (options.method && contest.method != *options.method) continue;
        progress.now(fmt::format("{} {:g}: {}", family.name, setting, contest.method));
        Trial next = trial(contest, asked_accuracy(options), stress_limits(options));
        if (Progress::interrupted()) return trials;
        trials.push_back({family.name, family.knob, setting, std::move(next)});
      }
      progress.step();
    }
  }
  return trials;
}

/// Two characters a cell: digits, or how it failed.
std::string cell(const Trial& t) {
  switch (t.verdict()) {
    case Verdict::ok:
      return t.judgement.error > 0
                 ? fmt::format("{:.0f}", std::clamp(-std::log10(t.judgement.error), 0.0, 16.0) + 0.0)
                 : "=";
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

/// Did it come back right, with the digits that were asked for?
bool is_as_asked(const Trial& t, double tolerance) {
  return t.is_right() && (std::isnan(t.judgement.error) || !exceeds(t.judgement.error, tolerance));
}

/// For each method the settings at which it first fails, and how: what says of itself that it is not as near
/// as was asked has few digits.
std::string threshold_text(const std::vector<StressTrial>& trials, double tolerance) {
  TextTable table({"method", "family", "first fails at", "how", "error"});
  std::vector<std::string> methods;
  for (const StressTrial& t : trials)
    if (std::find(methods.begin(), methods.end(), t.trial.method) == methods.end())
      methods.push_back(t.trial.method);
  for (const std::string& method : methods) {
    std::string last;
    for (const auto& [family, knob, difficulty, t] : trials) {
      if (t.method != method || family == last || is_as_asked(t, tolerance) ||
          t.verdict() == Verdict::refused)
        continue;
      last = family;
      table.add({method, family, fmt::format("{:g}", difficulty),
                 t.is_right() ? "few-digits" : verdict_text(t.verdict()),
                 std::isfinite(t.judgement.error) ? fmt::format("{:.0e}", t.judgement.error) : "-"});
    }
    if (last.empty()) table.add({method, "none", "-", "-", "-"});
  }
  return table.text();
}

void write_stress(const StressOptions& options, const std::vector<StressTrial>& trials) {
  if (options.data) {
    write_file(*options.data, stress_csv(trials));
    std::vector<Trial> plain;
    for (const StressTrial& t : trials) plain.push_back(t.trial);
    write_file(about_file(*options.data), measurement_json(plain, stress_limits(options)));
  }
  if (!options.output) return;
  const Drawing drawing = failure_map_drawing(trials);
  draw(*options.output, drawing);
}

Exit make_stress(const StressOptions& options) {
  const Source source{options.families.empty() ? "stress" : options.families.front(), ""};
  return answered(options, source, [&] {
    if (options.output) require_drawable(*options.output);
    const std::vector<StressTrial> trials = stressed(options);
    write_stress(options, trials);
    if (options.quiet) return Exit::solved;
    if (!options.output) fmt::print("{}", map_text(trials));
    fmt::print("{}", threshold_text(trials, asked_accuracy(options).tolerance));
    return Exit::solved;
  });
}

}  // namespace

void add_stress(CLI::App& program, Work& chosen) {
  const auto options = std::make_shared<StressOptions>();
  CLI::App& command = add_command(program, "stress", "where each method fails: method by difficulty", chosen,
                                  [options] { return make_stress(*options); });
  command.add_option("FAMILY", options->families, "families; without one, all");
  command.add_option("--tolerance", options->tolerance, "asked of iterative methods; default 1e-9")
      ->type_name("X")
      ->check(positive_number);
  command.add_flag("--polish", options->polish,
                   "answers after the refinement that `solve` ends with, instead of a method's own");
  command.add_flag("--peers", options->peers,
                   "with the solvers of other packages that were found at build time");
  add_measurement(command, *options, "the table: family, difficulty, n, m, method, seconds, error, status");
}

}  // namespace cli::inline commands
