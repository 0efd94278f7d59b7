#include <CLI/CLI.hpp>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <csignal>

#include "cli/commands/command_line.hpp"
#include "cli/drawing/animation.hpp"
#include "cli/drawing/motion_drawing.hpp"
#include "cli/drawing/phase_drawing.hpp"
#include "cli/each_file.hpp"
#include "cli/event_crowd.hpp"
#include "cli/motion_files.hpp"
#include "cli/motion_settings.hpp"
#include "cli/report/impact_laws_report.hpp"
#include "cli/report/motion_progress.hpp"
#include "cli/report/motion_report.hpp"
#include "cli/resumed_state.hpp"
#include "cli/scene.hpp"
#include "convex/nearest_name.hpp"
#include "mechanics/angles_in_degrees.hpp"
#include "mechanics/gauss_problem.hpp"
#include "mechanics/motion/motion.hpp"

namespace cli::inline commands {
namespace {

using convex::InvalidInput;

/// Of what is not finite at a state `solve` tells the place.
void require_finite(const mechanics::LagrangianSystem& system, const mechanics::State& state) {
  constexpr double any = 1e100;  // whatever contacts are present
  const auto m = static_cast<convex::Index>(system.constraints().size());
  static_cast<void>(mechanics::gauss_problem(system, state, mechanics::Vector::Constant(m, any)));
}

/// What `moreau simulate` is told.
struct SimulateOptions : FileOptions, MotionChoice {
  std::optional<std::string> until;
  std::optional<std::string> output, events, plot, animate;  ///< files to write
  std::optional<std::string> phase;                          ///< a coordinate: --plot draws q' over q
  std::optional<std::string> strobe;                         ///< a period: instants of --output and --phase
  std::vector<std::string> modulo;                           ///< "a=2*pi"
  std::optional<std::string> resume;                         ///< a file with the state to begin from
  bool impact_laws = false;                                  ///< all laws at the first impact
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

/// The files that a motion is written to, as it goes.
class MotionFiles {
 public:
  MotionFiles(const Problem& problem, const mechanics::LagrangianSystem& system, double begin, double end,
              const SimulateOptions& options)
      : options_(options), scene_(problem) {
    constexpr long usual_samples = 201;
    const Instants evenly = Instants::evenly(begin, end, problem.simulate.samples.value_or(usual_samples));
    Instants instants = evenly;
    if (options.strobe) {
      const double period = value_of(problem, system, *options.strobe, "--strobe");
      if (!(period > 0))
        throw InvalidInput("--strobe " + *options.strobe + ": not positive; give a time > 0");
      instants = Instants::strobe(begin, end, period);
      if (!options.output && !options.phase)
        throw InvalidInput(
            "--strobe says at which instants to look; add --output F.csv, or --plot F.svg --phase x");
    }
    if (!options.modulo.empty() && !options.output && !options.phase)
      throw InvalidInput(
          "--modulo says how a table or a picture writes a coordinate; add --output F.csv, or --plot F.svg "
          "--phase x");
    const convex::Vector modulo = multiples_of_turns(problem, system, options.modulo);
    if (options.plot) require_drawable(*options.plot);
    if (options.phase) {
      if (!options.plot) throw InvalidInput("--phase says what --plot draws; add --plot F.svg");
      const auto& names = system.coordinates();
      const auto found = std::find(names.begin(), names.end(), *options.phase);
      if (found == names.end())
        throw InvalidInput("--phase " + *options.phase + ": no such coordinate; " +
                           convex::suggestion(*options.phase, names));
      constexpr long curve_points = 4001;
      phase_.emplace(system, found - names.begin(),
                     options.strobe ? instants : Instants::evenly(begin, end, curve_points),
                     options.strobe.has_value(), modulo);
    } else if (options.plot) {
      drawing_.emplace(system, begin, end);
    }
    if (options.output) trajectory_.emplace(*options.output, system, instants, modulo);
    if (options.events) events_.emplace(*options.events, system);
    if (options.animate) {
      if (!options.animate->ends_with(".html") && !options.animate->ends_with(".htm"))
        throw InvalidInput("--animate " + *options.animate +
                           ": it is a page; give a name that ends with .html");
      page_.emplace(opened(*options.animate));
      animation_.emplace(system, scene_, evenly);
    }
  }

  void tell_events(const mechanics::Motion& motion) {
    if (!events_) return;
    for (const mechanics::MotionEvent& event : motion.events()) events_->write(event);
  }
  void follow(const mechanics::Motion& motion) {
    if (trajectory_) trajectory_->follow(motion);
    if (drawing_) drawing_->follow(motion);
    if (phase_) phase_->follow(motion);
    if (animation_) animation_->follow(motion);
    tell_events(motion);
  }
  void finish(const mechanics::Motion& motion, const std::string& title) {
    if (trajectory_) trajectory_->finish(motion);
    if (events_) events_->finish();
    if (animation_) {
      animation_->finish(motion);
      *page_ << animation_->page(title);
      require_written(*page_, *options_.animate);
    }
    if (phase_) {
      phase_->finish(motion);
      draw(*options_.plot, phase_->drawing(title));
    }
    if (drawing_) {
      drawing_->finish(motion);
      draw(*options_.plot, drawing_->drawing(title));
    }
  }

 private:
  const SimulateOptions& options_;
  DrawnScene scene_;
  std::optional<TrajectoryFile> trajectory_;
  std::optional<EventsFile> events_;
  std::optional<MotionDrawing> drawing_;
  std::optional<PhaseDrawing> phase_;
  std::optional<std::ofstream> page_;
  std::optional<Animation> animation_;
};

/// Steps, times the square of the numbers of a scene, that take a fraction of a second: other motions that
/// take no more are not noticed.
constexpr double unnoticed_work = 2e5;

/// How many other motions, which tell what a rounding grows to, are followed.
mechanics::Index motions_beside(const mechanics::LagrangianSystem& system, const mechanics::Motion& motion) {
  if (motion.method() != mechanics::MotionMethod::event_driven ||
      motion.status() != mechanics::MotionStatus::done)
    return 0;
  const auto size = static_cast<double>(system.coordinates().size() + system.constraints().size());
  const double work = static_cast<double>(std::max(1L, motion.record().steps)) * size * size;
  return static_cast<mechanics::Index>(std::min(unnoticed_work / work, unnoticed_work));
}

/// What is done where events crowd, and said: `auto` goes on in steps, if the motion has a hundred of them.
std::string meet_crowd(mechanics::Motion& motion, const EventCrowd& crowd, bool is_auto, double steps) {
  constexpr double fewest_steps = 100;
  if (!is_auto) return crowd.what() + "; method = \"auto\" goes on in steps where events crowd";
  if (steps < fewest_steps)
    return "auto: " + crowd.what() +
           "; [simulate] step is no hundredth of the motion, so that events are followed on";
  motion.go_on_in_steps();
  return "auto: " + crowd.what() +
         "; from there on it is followed in steps, whose error falls with [simulate] step";
}

Answer simulate_file(const std::string& file, const SimulateOptions& options) {
  const Problem problem = read_problem_file(file, options);
  const auto* text = std::get_if<SystemProblem>(&problem.content);
  if (text == nullptr) throw InvalidInput("nothing here moves; `moreau simulate` takes a file with [system]");
  const auto start = std::chrono::steady_clock::now();
  const auto system = mechanics::lagrangian_system(text->system, text->state);
  const mechanics::State state =
      options.resume ? resumed_state(*options.resume, *system) : system->state(text->state);
  const double until = end_of_motion(problem, *system, options.until);
  if (!(until >= state.t))
    throw InvalidInput("simulate.until: before the time of the state; the motion goes forward",
                       options.until ? std::nullopt : std::optional(problem.simulate.until->begin));
  const mechanics::MotionOptions chosen = motion_options(problem, *system, options);
  const MotionWay way = motion_way(problem.simulate, *system, options);
  std::optional<mechanics::Motion> begun;
  try {
    begun.emplace(*system, state, chosen);
  } catch (const InvalidInput& error) {
    if (options.resume) throw InvalidInput("--resume " + *options.resume + ": " + error.what());
    const bool is_of_values = std::string_view(error.what()).find("not finite") != std::string_view::npos;
    if (!error.place() && is_of_values) require_finite(*system, state);
    throw mechanics::refused_state(error, text->system.kinetic.begin, *system, state);
  }
  mechanics::Motion& motion = *begun;

  MotionFiles files(problem, *system, state.t, until, options);
  FollowedMotion followed{file, problem.title, *system, motion, {}, until, false, 0, {}, state, {}};
  if (way.is_open) followed.choice = way.why;
  const auto remember = [&] {
    for (const mechanics::MotionEvent& event : motion.events())
      if (followed.first_events.size() < events_in_text) followed.first_events.push_back(event);
  };
  const InterruptWatch watch;
  remember();
  files.tell_events(motion);
  EventCrowd crowd(state.t, until, chosen.step);
  std::string of_crowd;
  const auto goes_on = [&] { return !options.impact_laws || !motion.record().first_impact; };
  {
    MotionProgress progress(state.t, until);
    while (interrupted == 0 && goes_on() && motion.advance(until)) {
      files.follow(motion);
      remember();
      progress.tell(motion);
      if (motion.method() == mechanics::MotionMethod::event_driven && crowd.has_come(motion))
        of_crowd = meet_crowd(motion, crowd, way.is_open, (until - state.t) / chosen.step);
    }
  }
  if (options.impact_laws) return impact_laws_answer(followed, options.json);
  followed.interrupted = interrupted != 0 && motion.state().t < until;
  if (const mechanics::Index most = motions_beside(*system, motion); !followed.interrupted && most > 0)
    followed.growth = mechanics::rounding_growth(*system, state, chosen, motion, most);
  files.finish(motion, problem.title.empty() ? file : problem.title);
  followed.seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  Answer answer{motion_exit(followed), options.json ? motion_json(followed) + "\n" : motion_text(followed)};
  answer.warnings = unused_settings(problem.simulate, options);
  for (const std::string& said : {followed.choice.empty() ? way.why : "", of_crowd})
    if (!said.empty()) answer.warnings.push_back(said);
  const bool strikes_at_once = std::any_of(
      followed.first_events.begin(), followed.first_events.end(), [&](const mechanics::MotionEvent& event) {
        return event.kind == mechanics::EventKind::impact && event.t == state.t;
      });
  if (strikes_at_once && !options.resume && text->state.velocity.empty())
    answer.warnings.push_back(
        "[state] gives no velocity, so that all are 0, and the motion begins with an impact; give them, be "
        "it as "
        "velocity = { " +
        system->coordinates().front() + " = 0 }");
  for (std::string& said : mechanics::angles_in_degrees(*system, state))
    answer.warnings.push_back(std::move(said));
  return answer;
}

Exit simulate_files(const SimulateOptions& options) {
  const bool is_for_one =
      options.output || options.events || options.plot || options.animate || options.resume;
  if (is_for_one && options.files.size() > 1)
    return answered(options, {options.files[1], ""}, []() -> Exit {
      throw InvalidInput(
          "--output, --events, --plot, --animate and --resume take one problem file; run the files one by "
          "one");
    });
  return print_for_each_file(options, [&](const std::string& file) { return simulate_file(file, options); });
}

}  // namespace

void add_simulate(CLI::App& program, Work& chosen) {
  const auto options = std::make_shared<SimulateOptions>();
  CLI::App& command = add_command(program, "simulate", "the motion: smooth arcs, impacts, rest on contacts",
                                  chosen, [options] { return simulate_files(*options); });
  add_files(command, *options);
  command
      .add_option("--until", options->until,
                  "the time at which the motion ends: an expression in the parameters")
      ->type_name("T");
  add_step_tolerance(command, *options);
  command
      .add_option("--method", options->method,
                  "event-driven, the default, time-stepping, or auto: by the number of contacts and events")
      ->type_name("NAME");
  add_table(command, "--output", options->output, "the trajectory as a table: t, q, q', q'', lambda, energy");
  command.add_option("--events", options->events, "a line of JSON for each event")
      ->type_name("F.jsonl")
      ->check(name_of_numbers);
  command
      .add_option("--plot", options->plot,
                  "coordinates, gaps, multipliers and energy over time: F.svg, F.png or F.pdf (by gnuplot)")
      ->type_name("FILE");
  command.add_option("--animate", options->animate, "a page that plays the motion, as [draw] says")
      ->type_name("F.html");
  command.add_option("--phase", options->phase, "--plot draws the velocity of a coordinate over it")
      ->type_name("Q");
  command
      .add_option("--strobe", options->strobe,
                  "rows of --output, points of --phase, once a period: an expression in the parameters")
      ->type_name("P");
  command
      .add_option("--modulo", options->modulo,
                  "a coordinate that turns, written between 0 and its multiple: \"a=2*pi\"")
      ->type_name("a=M")
      ->allow_extra_args(false);
  command.add_option("--resume", options->resume, "go on from the state that --json printed")
      ->type_name("STATE.json");
  command.add_option("--limit", options->step_limit, "steps after which the motion is stopped; default 1e7")
      ->type_name("N")
      ->check(nonnegative_number);
  command.add_flag("--impact-laws", options->impact_laws,
                   "what each law of impact makes of the first impact, side by side");
}

}  // namespace cli::inline commands
