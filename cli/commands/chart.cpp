#include <CLI/CLI.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "cli/commands/command_line.hpp"
#include "cli/drawing/gnuplot.hpp"
#include "cli/drawing/profile_drawing.hpp"
#include "cli/drawing/work_precision_drawing.hpp"
#include "cli/each_file.hpp"
#include "cli/measurement/charted_problems.hpp"
#include "cli/measurement/exams.hpp"
#include "cli/measurement/motion_exams.hpp"
#include "cli/measurement/peers.hpp"
#include "cli/measurement/progress.hpp"
#include "cli/measurement/rank_correlation.hpp"
#include "cli/measurement/trial_files.hpp"
#include "cli/problem_file/documents.hpp"
#include "cli/problem_file/problem.hpp"
#include "cli/report/text_table.hpp"
#include "convex/counted.hpp"
#include "convex/nearest_name.hpp"

namespace cli::inline commands {
namespace {

using convex::InvalidInput;
using convex::MethodKind;

/// What `moreau chart` is told.
struct ChartOptions : MeasurementOptions, Overrides {
  std::vector<std::string> files;
  std::optional<std::string> relative_to;  ///< the method whose times are the unit
  std::string error = "acceleration";      ///< what the error is of
  bool profile = false, motion = false;
  bool peers = false;  ///< with the solvers of other packages
};

/// A direct method has one accuracy; the others are asked for each of these, and no further once two in a row
/// were not reached.
constexpr double direct_setting = 1e-9;
constexpr std::array tolerances{1e-1, 1e-2,  1e-3,  1e-4,  1e-5,  1e-6,  1e-7, 1e-8,
                                1e-9, 1e-10, 1e-11, 1e-12, 1e-13, 1e-14, 1e-15};

/// With --quick only each third step.
constexpr std::size_t quick_step = 3;

TrialLimits chart_limits(const ChartOptions& options) {
  return options.quick ? TrialLimits{0.005, 0.5} : TrialLimits{};
}

/// Keeps the contests of the method asked for.
void keep_asked(std::vector<Contest>& contests, const std::string& only) {
  if (only.empty()) return;
  std::erase_if(contests, [&](const Contest& contest) { return contest.method != only; });
}

void require_method(const std::string& name, const std::vector<std::string>& known, const char* option) {
  if (name.empty() || std::find(known.begin(), known.end(), name) != known.end()) return;
  throw InvalidInput(std::string(option) + " " + name + ": there is no such method; " +
                     convex::suggestion(name, known));
}

void chart_one(const Contest& contest, const TrialLimits& limits, std::size_t step,
               std::vector<Trial>& trials) {
  const auto add = [&](const convex::Accuracy& accuracy) {
    Trial next = trial(contest, accuracy, limits);
    if (!Progress::interrupted()) trials.push_back(std::move(next));
    return !Progress::interrupted();
  };
  if (contest.kind == MethodKind::iterative) {
    int missed = 0;
    for (std::size_t k = 0; k < tolerances.size(); k += step) {
      if (!add({.tolerance = tolerances[k], .polish = false})) return;
      const Trial& last = trials.back();
      if (last.verdict() == Verdict::refused) return;
      const bool reached = last.is_right() && last.judgement.error <= 10 * tolerances[k];
      missed = reached ? 0 : missed + 1;
      if (missed == 2 || last.verdict() == Verdict::too_slow) break;
    }
    if (add({.tolerance = direct_setting}) && !trials.back().judgement.polished) trials.pop_back();
    return;
  }
  // A direct method whose digits come from the judge has a marker more: its answer as it stands.
  if (!add({.tolerance = direct_setting}) || !trials.back().judgement.polished) return;
  if (add({.tolerance = direct_setting, .polish = false})) std::iter_swap(trials.end() - 1, trials.end() - 2);
}

std::vector<Trial> charted(const std::vector<ChartedProblem>& problems, const ChartOptions& options) {
  const std::string only = options.method.value_or("");
  std::vector<Trial> trials;
  Progress progress(static_cast<int>(problems.size()));
  for (const ChartedProblem& problem : problems) {
    std::vector<Contest> contests = problem.contests();
    keep_asked(contests, only);
    for (const Contest& contest : contests) {
      progress.now(problem.name + ": " + contest.method);
      chart_one(contest, chart_limits(options), options.quick ? quick_step : 1, trials);
      if (Progress::interrupted()) return trials;
    }
    progress.step();
  }
  return trials;
}

std::string digits_text(double error) {
  if (!std::isfinite(error)) return "-";
  return error >= std::numeric_limits<double>::min()
             ? fmt::format("{:.1f}", std::max(0.0, -std::log10(error)))
             : "exact";
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
      if (t.problem == problem && t.verdict() != Verdict::refused) here.push_back(t);
    if (here.empty()) continue;
    TextTable table({"method", "time", "digits", "verdict"});
    std::vector<std::string> seen;
    for (const Trial& t : ranked(here)) {
      if (std::find(seen.begin(), seen.end(), t.method) != seen.end()) continue;
      seen.push_back(t.method);
      const double error = drawn.multipliers ? t.judgement.multiplier_error : t.judgement.error;
      table.add(
          {t.method, std::isfinite(t.seconds) ? fmt::format("{:.3g} s", t.seconds) : "-", digits_text(error),
           t.is_right() && !std::isnan(error) && exceeds(error, t.setting) ? "few-digits"
                                                                           : verdict_text(t.verdict())});
    }
    text +=
        fmt::format("{}: {}, {}\n{}\n", problem, convex::counted(here.front().n, "coordinate", "coordinates"),
                    convex::counted(here.front().m, "contact", "contacts"), table.text());
  }
  return text;
}

std::vector<ChartedProblem> asked_problems(const ChartOptions& options) {
  if (options.peers && options.motion)
    throw InvalidInput("--peers are solvers of contact problems; leave --motion out");
  if (options.peers) require_peers();
  if (options.motion) {
    if (!options.files.empty() || options.profile)
      throw InvalidInput("--motion has its own motions, with closed forms; leave FILE and --profile out");
    return charted_motions(options.quick);
  }
  if (options.files.empty())
    return options.profile ? profiled_problems(options.quick, options.peers)
                           : charted_problems(options.quick, options.peers);
  std::vector<ChartedProblem> problems;
  for (const std::string& file : options.files)
    problems.push_back(charted_file(file, options.settings, options.peers));
  return problems;
}

/// How alike this run and the committed data order the methods; "" where there is nothing to compare.
std::string correlation_text(const std::vector<Trial>& trials) {
  const std::optional<std::string> file = committed_data();
  if (!file) return "";
  std::vector<RankCorrelation> all = rank_correlations(trials, read_chart_csv(*file));
  if (all.empty()) return "";
  std::sort(all.begin(), all.end(), [](const auto& a, const auto& b) { return a.value < b.value; });
  return fmt::format(
      "Order of the methods beside docs/charts/speed_accuracy.csv: rank correlation {:.2f} in the median, "
      "{:.2f} at least ({}).\n",
      all[all.size() / 2].value, all.front().value, all.front().problem);
}

/// An error of a motion that is good enough to compare times at.
constexpr double compared_error = 0.1;

/// From how many contacts on time-stepping is the quicker way to an error that it reaches; a problem in which
/// neither gets there within its time tells nothing.
std::string crossover_text(const std::vector<Trial>& trials) {
  convex::Index from = 0, largest = 0;
  std::vector<std::string> problems;
  for (const Trial& t : trials) {
    if (t.m == 0 || std::find(problems.begin(), problems.end(), t.problem) != problems.end()) continue;
    problems.push_back(t.problem);
    const auto least = [&](const std::string& method) {
      double seconds = std::numeric_limits<double>::infinity();
      for (const Trial& other : trials)
        if (other.problem == t.problem && other.method == method && other.is_right() &&
            other.judgement.error <= compared_error)
          seconds = std::min(seconds, other.seconds);
      return seconds;
    };
    const double stepping = least("time-stepping"), following = least("event-driven");
    if (std::isinf(stepping) && std::isinf(following)) continue;
    largest = std::max(largest, t.m);
    if (stepping < following) {
      if (from == 0) from = t.m;
    } else {
      from = 0;
    }
  }
  if (largest == 0) return "";
  return from > 0 ? fmt::format("At an error of {:g} time-stepping is quicker from {} contacts on.\n",
                                compared_error, from)
                  : fmt::format("At an error of {:g} following each event is quicker up to {} contacts.\n",
                                compared_error, largest);
}

Drawing chart_drawing(const ChartOptions& options, const std::vector<Trial>& trials, const DrawnAs& drawn) {
  return options.profile ? profile_drawing(trials) : work_precision_drawing(trials, drawn);
}

/// What is written: the data and the picture.
void write_chart(const ChartOptions& options, const std::vector<Trial>& trials, const DrawnAs& drawn) {
  if (options.data) {
    write_file(*options.data, chart_csv(trials));
    write_file(about_file(*options.data), measurement_json(trials, chart_limits(options)));
  }
  if (options.output) draw(*options.output, chart_drawing(options, trials, drawn));
}

/// A table that --data wrote is drawn as it is.
bool is_table(const ChartOptions& options) {
  return options.files.size() == 1 && options.files.front().ends_with(".csv");
}

Exit make_chart(const ChartOptions& options) {
  const Source source{options.files.empty() ? "chart" : options.files.front(), ""};
  return answered(options, source, [&] {
    const DrawnAs drawn{options.error == "multipliers", options.relative_to.value_or(""), options.motion};
    if (options.output) require_drawable(*options.output);
    if (is_table(options)) {
      if (!options.output) throw InvalidInput("a table of numbers is drawn; add --output F.svg");
      read_file(options.files.front());  // says what is wrong with the path
      draw(*options.output, chart_drawing(options, read_chart_csv(options.files.front()), drawn));
      return Exit::solved;
    }
    if (options.files.empty() && !options.settings.empty())
      throw InvalidInput("--set goes with problem files; give one");
    const std::vector<ChartedProblem> problems = asked_problems(options);
    const std::vector<std::string> known = options.motion ? integrator_names() : contestant_names();
    require_method(options.method.value_or(""), known, "--method");
    require_method(drawn.relative_to, known, "--relative");
    const std::vector<Trial> trials = charted(problems, options);
    // Before the numbers kept are written over, as they may be.
    const std::string correlation = options.files.empty() && !options.profile && !options.motion
                                        ? correlation_text(trials)
                                        : std::string();
    write_chart(options, trials, drawn);
    if (options.quiet) return Exit::solved;
    if (!options.output) fmt::print("{}", table_text(trials, drawn));
    fmt::print("{}{}", correlation, options.motion ? crossover_text(trials) : "");
    return Exit::solved;
  });
}

}  // namespace

void add_chart(CLI::App& program, Work& chosen) {
  const auto options = std::make_shared<ChartOptions>();
  CLI::App& command =
      add_command(program, "chart", "speed against accuracy, every method, one diagram a problem", chosen,
                  [options] { return make_chart(*options); });
  command.add_option(
      "FILE", options->files,
      "problem files; without one, a set from the gallery; F.csv: a table of --data, drawn again");
  add_overrides(command, *options);
  command.add_option("--relative", options->relative_to, "times as multiples of this method's")
      ->type_name("NAME");
  command
      .add_option("--error", options->error,
                  "the error charted: that of the acceleration, or of the multipliers")
      ->check(CLI::IsMember({"acceleration", "multipliers"}));
  command.add_flag("--peers", options->peers,
                   "with the solvers of other packages that were found at build time");
  command.add_flag("--profile", options->profile,
                   "performance profiles over the files, or over the whole gallery, small");
  command.add_flag("--motion", options->motion,
                   "motions with closed forms: error at the end for each tolerance or step");
  add_measurement(command, *options, "the table: problem, n, m, method, setting, seconds, error, status");
}

}  // namespace cli::inline commands
