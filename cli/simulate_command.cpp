#include <chrono>
#include <csignal>

#include "cli/commands.hpp"
#include "cli/each_file.hpp"
#include "cli/motion_files.hpp"
#include "cli/motion_report.hpp"
#include "cli/numbers_by_constraint.hpp"
#include "cli/scene.hpp"
#include "mechanics/motion/motion.hpp"

namespace cli {
namespace {

using convex::InvalidInput;

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

/// The methods and laws of the contract, and which of them there are.
void require_available(const SimulateSettings& settings, const Options& options) {
  const std::string method = options.method.value_or(settings.method.value_or("event-driven"));
  const auto place = options.method ? std::nullopt : std::optional(settings.method_place);
  if (method == "time-stepping")
    throw InvalidInput("simulate.method: time-stepping is not available yet; take \"event-driven\"", place);
  if (method != "event-driven")
    throw InvalidInput("simulate.method: no method \"" + method + "\"; take \"event-driven\"", place);
  const std::string law = settings.impact_law.value_or("moreau");
  if (law == "poisson" || law == "sequential")
    throw InvalidInput("simulate.impact_law: \"" + law + "\" is not available yet; take \"moreau\"",
                       settings.impact_law_place);
  if (law != "moreau")
    throw InvalidInput("simulate.impact_law: no law \"" + law + "\"; take \"moreau\"",
                       settings.impact_law_place);
}

Answer simulate_file(const std::string& file, const Options& options) {
  const Problem problem = read_problem_file(file);
  const auto* text = std::get_if<SystemProblem>(&problem.content);
  if (text == nullptr) throw InvalidInput("nothing here moves; `moreau simulate` takes a file with [system]");
  const SimulateSettings& settings = problem.simulate;
  require_available(settings, options);
  if (!options.until && !settings.until)
    throw InvalidInput("simulate.until: missing; write until = 3.0 below [simulate], or give --until 3.0");
  const auto start = std::chrono::steady_clock::now();
  const auto system = mechanics::lagrangian_system(text->system);
  const mechanics::State state = system->state(text->state);
  const double until = options.until.value_or(settings.until.value_or(0));
  if (!(until >= state.t))
    throw InvalidInput("simulate.until: before the time of the state; the motion goes forward");
  const std::vector<std::string> constraints = constraint_names(*system);
  mechanics::MotionOptions chosen;
  chosen.tolerance = options.tolerance.value_or(settings.tolerance.value_or(chosen.tolerance));
  chosen.step_limit = options.step_limit.value_or(chosen.step_limit);
  chosen.contact_tolerance = contact_tolerances(problem.solve, constraints);
  std::vector<NamedNumber> restitutions = text->restitutions;  // those of [simulate] come later, and win
  restitutions.insert(restitutions.end(), settings.restitutions.begin(), settings.restitutions.end());
  chosen.restitution =
      numbers_by_constraint("simulate.restitution", settings.restitution, restitutions, constraints);
  std::optional<mechanics::Motion> begun;
  try {
    begun.emplace(*system, state, chosen);
  } catch (const InvalidInput& error) {
    throw InvalidInput(error.what(), error.place().value_or(text->system.kinetic.begin));
  }
  mechanics::Motion& motion = *begun;

  std::optional<TrajectoryFile> trajectory;
  std::optional<EventsFile> events;
  constexpr long usual_samples = 201;
  if (options.output)
    trajectory.emplace(*options.output, *system, state.t, until, settings.samples.value_or(usual_samples));
  if (options.events) events.emplace(*options.events, *system);
  FollowedMotion followed{file, problem.title, *system, motion, {}, until};
  const auto tell = [&] {
    for (const mechanics::MotionEvent& event : motion.events()) {
      if (events) events->write(event);
      if (followed.first_events.size() < events_in_text) followed.first_events.push_back(event);
    }
  };
  const InterruptWatch watch;
  tell();
  while (interrupted == 0 && motion.advance(until)) {
    if (trajectory) trajectory->follow(motion);
    tell();
  }
  followed.interrupted = interrupted != 0 && motion.state().t < until;
  if (trajectory) trajectory->finish(motion);
  if (events) events->finish();
  followed.seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  return {motion_exit(followed), options.json ? motion_json(followed) + "\n" : motion_text(followed)};
}

}  // namespace

Exit simulate_command(const Options& options) {
  if ((options.output || options.events) && options.files.size() > 1)
    return answered(options, {options.files[1], ""}, []() -> Exit {
      throw InvalidInput("--output and --events take one problem file; run the files one by one");
    });
  return print_for_each_file(options, [&](const std::string& file) { return simulate_file(file, options); });
}

}  // namespace cli
