#include <CLI/CLI.hpp>

#include <chrono>
#include <csignal>

#include "cli/commands/command_line.hpp"
#include "cli/drawing/motion_drawing.hpp"
#include "cli/each_file.hpp"
#include "cli/motion_files.hpp"
#include "cli/motion_settings.hpp"
#include "cli/report/impact_laws_report.hpp"
#include "cli/report/motion_report.hpp"
#include "cli/scene.hpp"
#include "mechanics/motion/motion.hpp"

namespace cli {
namespace {

using convex::InvalidInput;

/// What `moreau simulate` is told.
struct SimulateOptions : FileOptions, MotionChoice {
  std::optional<double> until;
  std::optional<std::string> output, events, plot;  ///< files to write
  bool impact_laws = false;                         ///< all laws at the first impact
};

volatile std::sig_atomic_t interrupted = 0;
void interrupt(int) { interrupted = 1; }

/// Ctrl-C ends the motion where it is; what was computed is kept.
class InterruptWatch {
 public:
  InterruptWatch() : before_(std::signal(SIGINT, interrupt)) { interrupted = 0; }
  ~InterruptWatch() { std::signal(SIGINT, before_); }
  InterruptWatch(const InterruptWatch&) = delete;
  InterruptWatch& operator=(const InterruptWatch&) = delete;

 private:
  void (*before_)(int);
};

Answer simulate_file(const std::string& file, const SimulateOptions& options) {
  const Problem problem = read_problem_file(file);
  const auto* text = std::get_if<SystemProblem>(&problem.content);
  if (text == nullptr) throw InvalidInput("nothing here moves; `moreau simulate` takes a file with [system]");
  const SimulateSettings& settings = problem.simulate;
  if (!options.until && !settings.until)
    throw InvalidInput("simulate.until: missing; write until = 3.0 below [simulate], or give --until 3.0");
  const auto start = std::chrono::steady_clock::now();
  const auto system = mechanics::lagrangian_system(text->system);
  const mechanics::State state = system->state(text->state);
  const double until = options.until.value_or(settings.until.value_or(0));
  if (!(until >= state.t))
    throw InvalidInput("simulate.until: before the time of the state; the motion goes forward");
  const mechanics::MotionOptions chosen = motion_options(problem, *system, options);
  std::optional<mechanics::Motion> begun;
  try {
    begun.emplace(*system, state, chosen);
  } catch (const InvalidInput& error) {
    throw InvalidInput(error.what(), error.place().value_or(text->system.kinetic.begin));
  }
  mechanics::Motion& motion = *begun;

  std::optional<TrajectoryFile> trajectory;
  std::optional<EventsFile> events;
  std::optional<MotionDrawing> drawing;
  constexpr long usual_samples = 201;
  if (options.output)
    trajectory.emplace(*options.output, *system, state.t, until, settings.samples.value_or(usual_samples));
  if (options.events) events.emplace(*options.events, *system);
  if (options.plot) {
    require_drawable(*options.plot);
    drawing.emplace(*system, state.t, until);
  }
  FollowedMotion followed{file, problem.title, *system, motion, {}, until};
  const auto tell = [&] {
    for (const mechanics::MotionEvent& event : motion.events()) {
      if (events) events->write(event);
      if (followed.first_events.size() < events_in_text) followed.first_events.push_back(event);
    }
  };
  const InterruptWatch watch;
  tell();
  const auto goes_on = [&] { return !options.impact_laws || !motion.record().first_impact; };
  while (interrupted == 0 && goes_on() && motion.advance(until)) {
    if (trajectory) trajectory->follow(motion);
    if (drawing) drawing->follow(motion);
    tell();
  }
  if (options.impact_laws) {
    const std::string laws = options.json ? impact_laws_json(followed) + "\n" : impact_laws_text(followed);
    return {motion.record().first_impact ? Exit::solved : Exit::inaccurate, laws};
  }
  followed.interrupted = interrupted != 0 && motion.state().t < until;
  if (trajectory) trajectory->finish(motion);
  if (events) events->finish();
  if (drawing) {
    drawing->finish(motion);
    draw(*options.plot, drawing->drawing(problem.title.empty() ? file : problem.title));
  }
  followed.seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  return {motion_exit(followed), options.json ? motion_json(followed) + "\n" : motion_text(followed)};
}

Exit simulate_files(const SimulateOptions& options) {
  if ((options.output || options.events || options.plot) && options.files.size() > 1)
    return answered(options, {options.files[1], ""}, []() -> Exit {
      throw InvalidInput("--output, --events and --plot take one problem file; run the files one by one");
    });
  return print_for_each_file(options, [&](const std::string& file) { return simulate_file(file, options); });
}

}  // namespace

void add_simulate(CLI::App& program, Work& chosen) {
  const auto options = std::make_shared<SimulateOptions>();
  CLI::App& command = add_command(program, "simulate", "the motion: smooth arcs, impacts, rest on contacts",
                                  chosen, [options] { return simulate_files(*options); });
  add_files(command, *options);
  command.add_option("--until", options->until, "the time at which the motion ends")->type_name("T");
  add_step_tolerance(command, *options);
  command.add_option("--method", options->method, "event-driven, the default, or time-stepping")->type_name("NAME");
  command.add_option("--output", options->output, "the trajectory as a table: t, q, q', q'', lambda, energy")
      ->type_name("F.csv");
  command.add_option("--events", options->events, "a line of JSON for each event")->type_name("F.jsonl");
  command
      .add_option("--plot", options->plot,
                  "coordinates, gaps, multipliers and energy over time: F.svg, F.png or F.pdf (by gnuplot)")
      ->type_name("FILE");
  command.add_option("--limit", options->step_limit, "steps after which the motion is stopped; default 1e7")
      ->type_name("N");
  command.add_flag("--impact-laws", options->impact_laws,
                   "what each law of impact makes of the first impact, side by side");
}

}  // namespace cli
