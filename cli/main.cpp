#include <CLI/CLI.hpp>

#include <array>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <exception>
#include <functional>
#include <string>

#include "cli/commands.hpp"
#include "convex/nearest_name.hpp"

namespace {

using cli::Exit;
using cli::Options;

constexpr const char* version = "moreau " MOREAU_VERSION;

int wrong(const std::string& message) {
  std::fprintf(stderr, "moreau: %s\n", message.c_str());
  return static_cast<int>(Exit::wrong_input);
}

void add_common(CLI::App& command, Options& options) {
  command.add_flag("--json", options.json, "one JSON object per file, one per line, on standard output");
  command.add_flag("--quiet", options.quiet, "no text; the exit code tells");
}

std::string positive_number(const std::string& text) {
  char* end = nullptr;
  const double value = std::strtod(text.c_str(), &end);
  if (end != text.c_str() && *end == '\0' && std::isfinite(value) && value > 0) return "";
  return text + " is not a positive number; give one, such as 1e-9";
}

void add_files(CLI::App& command, Options& options) {
  command.add_option("FILE", options.files, "problem files; - is standard input")->required();
}

void add_accuracy(CLI::App& command, Options& options) {
  command.add_option("--method", options.method, "method of solution (see `moreau methods`)")
      ->type_name("NAME");
  command
      .add_option("--tolerance", options.tolerance,
                  "accept an error bound of X * max(1, ||q''||_A); default 1e-9")
      ->type_name("X")
      ->check(positive_number);
  command
      .add_option(
          "--limit", options.limit,
          "let fractions take N times their usual share (some seconds) where doubles cannot decide; 0: never")
      ->type_name("N")
      ->check(CLI::NonNegativeNumber);
}

void add_function(CLI::App& command, Options& options, bool needs_point) {
  command
      .add_option("f", options.expression,
                  "a function of the call language, such as \"norm1(weight=2)\" (see `moreau functions`)")
      ->required();
  command.add_option("--at", options.at, "a point, such as \"[3, -1, 1/2]\"")
      ->type_name("VECTOR")
      ->required(needs_point);
  command
      .add_option(
          "--metric", options.metric,
          "the Gram matrix W of (x|y) = x.Wy: \"[[2, 1], [1, 2]]\", or \"diagonal [1, 2]\"; default identity")
      ->type_name("MATRIX");
}

void add_output(CLI::App& command, Options& options, const char* columns) {
  command.add_option("--output", options.output, "the picture: F.svg or F.png (drawn by gnuplot)")
      ->type_name("FILE");
  command.add_option("--data", options.data, columns)->type_name("F.csv");
  command.add_flag("--quick", options.quick, "fewer and smaller problems, half a minute at most");
  command.add_flag("--quiet", options.quiet, "no text");
}

void add_chart(CLI::App& app, Options& options, std::function<Exit(const Options&)>& chosen) {
  CLI::App* chart =
      app.add_subcommand("chart", "speed against accuracy, every method, one diagram a problem");
  chart->add_option("FILE", options.files, "problem files; without one, a set from the gallery");
  chart->add_option("--method", options.method, "this method alone")->type_name("NAME");
  chart->add_option("--relative", options.relative_to, "times as multiples of this method's")
      ->type_name("NAME");
  chart
      ->add_option("--error", options.error,
                   "the error charted: that of the acceleration, or of the multipliers")
      ->check(CLI::IsMember({"acceleration", "multipliers"}));
  chart->add_flag("--profile", options.profile,
                  "performance profiles over the files, or over the whole gallery, small");
  add_output(*chart, options, "the table: problem, n, m, method, setting, seconds, error, status");
  chart->callback([&] { chosen = cli::chart_command; });
}

void add_stress(CLI::App& app, Options& options, std::function<Exit(const Options&)>& chosen) {
  CLI::App* stress = app.add_subcommand("stress", "where each method fails: method by difficulty");
  stress->add_option("FAMILY", options.families, "families; without one, all");
  stress->add_option("--method", options.method, "this method alone")->type_name("NAME");
  stress->add_option("--tolerance", options.tolerance, "asked of iterative methods; default 1e-9")
      ->type_name("X")
      ->check(positive_number);
  stress->add_flag("--polish", options.polish,
                   "answers after the refinement that `solve` ends with, instead of a method's own");
  stress->add_flag("--peers", options.peers,
                   "with the solvers of other packages that were found at build time");
  add_output(*stress, options, "the table: family, difficulty, n, m, method, seconds, error, status");
  stress->callback([&] { chosen = cli::stress_command; });
}

void add_simulate(CLI::App& app, Options& options, std::function<Exit(const Options&)>& chosen) {
  CLI::App* simulate = app.add_subcommand("simulate", "the motion: smooth arcs, impacts, rest on contacts");
  add_files(*simulate, options);
  simulate->add_option("--until", options.until, "the time at which the motion ends")->type_name("T");
  simulate->add_option("--tolerance", options.tolerance, "error of a step; default 1e-10")
      ->type_name("X")
      ->check(positive_number);
  simulate->add_option("--method", options.method, "event-driven, the default")->type_name("NAME");
  simulate->add_option("--output", options.output, "the trajectory as a table: t, q, q', q'', lambda, energy")
      ->type_name("F.csv");
  simulate->add_option("--events", options.events, "a line of JSON for each event")->type_name("F.jsonl");
  simulate
      ->add_option("--plot", options.plot,
                   "coordinates, gaps, multipliers and energy over time: F.svg or F.png (by gnuplot)")
      ->type_name("FILE");
  simulate->add_option("--limit", options.step_limit, "steps after which the motion is stopped; default 1e7")
      ->type_name("N");
  simulate->add_flag("--impact-laws", options.impact_laws,
                     "what each law of impact makes of the first impact, side by side");
  add_common(*simulate, options);
  simulate->callback([&] { chosen = cli::simulate_command; });
}

void add_orbit(CLI::App& app, Options& options, std::function<Exit(const Options&)>& chosen) {
  CLI::App* orbit =
      app.add_subcommand("orbit", "a motion that comes back to itself: its state and multipliers");
  add_files(*orbit, options);
  orbit
      ->add_option("--period", options.period,
                   "the forcing's period, an expression in the parameters, or free: unknown")
      ->type_name("P");
  orbit->add_option("--periods", options.periods, "it comes back after so many periods; default 1")
      ->type_name("K")
      ->check(CLI::PositiveNumber);
  orbit->add_option("--modulo", options.modulo, "a coordinate that comes back up to a multiple: \"a=2*pi\"")
      ->type_name("a=M");
  orbit->add_option("--over", options.over, "the orbit continued over a parameter: \"w=1:0.01:3\"")
      ->type_name("w=A:S:B");
  orbit->add_option("--output", options.output, "the branch of --over as a table")->type_name("F.csv");
  orbit->add_option("--tolerance", options.tolerance, "error of a step; default 1e-10")
      ->type_name("X")
      ->check(positive_number);
  add_common(*orbit, options);
  orbit->callback([&] { chosen = cli::orbit_command; });
}

/// A message about a first argument that is no command, with the nearest one; "" when it is one, or an
/// option.
std::string unknown_command(const CLI::App& app, const std::string& first) {
  if (first.rfind('-', 0) == 0) return "";
  std::vector<std::string> known;
  for (const CLI::App* command : app.get_subcommands([](const CLI::App*) { return true; })) {
    if (command->get_name() == first) return "";
    if (!command->get_group().empty()) known.push_back(command->get_name());
  }
  return "unknown command \"" + first + "\"; did you mean \"" + convex::nearest_name(first, known) + "\"?";
}

}  // namespace

int main(int argc, char** argv) {
  CLI::App app{"moreau: convex analysis and the mechanics of one-sided constraints (J. J. Moreau 1966)"};
  app.set_version_flag("--version", version);
  app.require_subcommand(1);
  app.failure_message(CLI::FailureMessage::simple);
  Options options;
  std::function<Exit(const Options&)> chosen;

  CLI::App* solve =
      app.add_subcommand("solve", "which contacts persist, with which acceleration and reactions");
  add_files(*solve, options);
  add_accuracy(*solve, options);
  add_common(*solve, options);
  solve->add_flag("--ranges", options.ranges,
                  "ranges of multipliers that are not unique, also beyond 1000 contacts");
  solve
      ->add_option_function<std::string>(
          "--model", [&](const std::string& model) { options.full_model = model == "full"; },
          "reduced (default): no more than the scene needs; full: the whole at once, and what that costs")
      ->type_name("NAME")
      ->check(CLI::IsMember({"reduced", "full"}));
  solve->add_flag("--null-space", options.null_space,
                  "a basis of the changes of multipliers that no motion feels, in --json");
  solve->add_flag("--sensitivity", options.sensitivity,
                  "with --json: derivatives by forces and bounds, and margins of the contacts");
  solve->add_flag("--certify", options.certify, "a proved error bound; exit 3 without proof");
  solve
      ->add_option("--plot", options.plot,
                   "the decomposition drawn, for two coordinates: F.svg or F.png (by gnuplot)")
      ->type_name("FILE");
  solve->callback([&] { chosen = cli::solve_command; });

  CLI::App* check = app.add_subcommand(
      "check", "the decomposition theorem, numerically: laws that the answer must obey, each with its bound");
  CLI::Option* checked_files = check->add_option("FILE", options.files, "problem files; - is standard input");
  check->add_flag("--catalogue", options.catalogue, "every set, function and operation, in four metrics")
      ->excludes(checked_files);
  add_accuracy(*check, options);
  add_common(*check, options);
  check->callback([&] {
    if (options.files.empty() && !options.catalogue) throw CLI::RequiredError("FILE or --catalogue");
    chosen = options.catalogue ? cli::check_catalogue : cli::check_command;
  });

  CLI::App* derive = app.add_subcommand("derive", "A, z, U, s of a system at its state");
  add_files(*derive, options);
  add_common(*derive, options);
  derive->callback([&] { chosen = cli::derive_command; });

  add_simulate(app, options, chosen);
  add_orbit(app, options, chosen);

  CLI::App* prox = app.add_subcommand(
      "prox", "splits a point: z = x + y, x = prox_f z, y = prox_g z, g the conjugate of f");
  add_function(*prox, options, true);
  add_accuracy(*prox, options);
  add_common(*prox, options);
  prox->callback([&] { chosen = cli::prox_command; });

  CLI::App* conjugate = app.add_subcommand(
      "conjugate",
      "the conjugate g of a function, as an expression; where it is finite; its value at a point");
  add_function(*conjugate, options, false);
  add_common(*conjugate, options);
  conjugate->callback([&] { chosen = cli::conjugate_command; });

  CLI::App* functions = app.add_subcommand(
      "functions",
      "the sets, functions and operations: name, arguments, formula, facts, how the prox is found");
  functions->add_option("NAME", options.function, "everything about one of them");
  functions->add_flag("--json", options.json, "one JSON object on standard output");
  functions->add_flag("--markdown", options.markdown, "the page docs/functions.md");
  functions->callback([&] { chosen = cli::functions_command; });

  CLI::App* methods = app.add_subcommand("methods", "the methods of solution that a file can name");
  add_common(*methods, options);
  methods->callback([&] { chosen = cli::methods_command; });

  CLI::App* gallery = app.add_subcommand(
      "gallery", "families of hard problems with known answers; writes one as a problem file");
  gallery->add_option("FAMILY", options.family,
                      "the family to take an instance of; without it, all are listed");
  gallery->add_option("--difficulty", options.difficulty, "setting of the family's knob")->type_name("X");
  gallery->add_option("--size", options.size, "coordinates, bodies, discs or points along a side")
      ->type_name("N");
  gallery->add_option("--seed", options.seed, "another seed gives another instance; default 1")
      ->type_name("K");
  gallery
      ->add_option("--output", options.output,
                   "file to write, such as F.toml (matrices of a sparse family go to F.A.mtx, F.U.mtx); "
                   "default standard output")
      ->type_name("FILE");
  gallery->add_flag("--json", options.json, "the list as one JSON object");
  gallery->callback([&] { chosen = cli::gallery_command; });

  add_chart(app, options, chosen);
  add_stress(app, options, chosen);

  if (argc > 1)
    if (const std::string unknown = unknown_command(app, argv[1]); !unknown.empty()) return wrong(unknown);
  try {
    app.parse(argc, argv);
  } catch (const CLI::CallForHelp&) {
    std::fputs(app.help().c_str(), stdout);
    return 0;
  } catch (const CLI::CallForVersion&) {
    std::puts(version);
    return 0;
  } catch (const CLI::ParseError& error) {
    if (argc < 2) std::fputs(app.help().c_str(), stderr);
    return wrong(std::string(error.what()) + "; see `moreau --help`");
  }
  try {
    return static_cast<int>(chosen(options));
  } catch (const std::exception& error) {
    return wrong(std::string("a defect of this program: ") + error.what() + "; please report it");
  }
}
