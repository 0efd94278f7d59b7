#include "cli/motion_settings.hpp"

#include <algorithm>
#include <cmath>

#include "cli/motion_files.hpp"
#include "cli/problem_file/keys.hpp"
#include "cli/scene.hpp"
#include "mechanics/number_text.hpp"

namespace cli {
namespace {

using convex::InvalidInput;

mechanics::ImpactLaw impact_law(const SimulateSettings& settings) {
  const std::string law = settings.impact_law.value_or("moreau");
  if (const auto found = mechanics::impact_law_named(law)) return *found;
  throw InvalidInput(
      "simulate.impact_law: no law \"" + law + "\"; take \"moreau\", \"poisson\" or \"sequential\"",
      settings.impact_law_place);
}

/// From about here on steps are quicker than events at an error of 1e-2 (`moreau chart --motion`).
constexpr std::ptrdiff_t fewest_for_steps = 300;

}  // namespace

MotionWay motion_way(const SimulateSettings& settings, const mechanics::System& system,
                     const MotionChoice& options) {
  using enum mechanics::MotionMethod;
  const std::string method = options.method.value_or(settings.method.value_or("event-driven"));
  if (method == "time-stepping") return {time_stepping, ""};
  if (method == "event-driven") return {event_driven, ""};
  if (method != "auto")
    throw InvalidInput(
        "simulate.method: no method \"" + method + "\"; take \"event-driven\", \"time-stepping\" or \"auto\"",
        options.method ? std::nullopt : std::optional(settings.method_place));
  const auto one_sided =
      std::count_if(system.constraints().begin(), system.constraints().end(),
                    [](const mechanics::Constraint& constraint) { return !constraint.two_sided; });
  const std::string found = "auto: " + std::to_string(one_sided) + " one-sided constraints";
  if (impact_law(settings) != mechanics::ImpactLaw::moreau)
    return {event_driven, found + ", and a law of impact that time-stepping does not have: event-driven"};
  if (one_sided < fewest_for_steps)
    return {event_driven,
            found + ", fewer than " + std::to_string(fewest_for_steps) +
                ": event-driven, which is right to rounding",
            true};
  return {time_stepping, found + ", " + std::to_string(fewest_for_steps) +
                             " or more: time-stepping, since following each event may not end; its error "
                             "falls with [simulate] step"};
}

mechanics::MotionOptions motion_options(const Problem& problem, const mechanics::LagrangianSystem& system,
                                        const MotionChoice& options) {
  const SimulateSettings& settings = problem.simulate;
  mechanics::MotionOptions chosen;
  chosen.method = motion_way(settings, system, options).method;
  chosen.step = settings.step.value_or(chosen.step);
  if (options.tolerance)
    require_step_tolerance(*options.tolerance, mechanics::number_text(*options.tolerance), "tolerance",
                           std::nullopt);
  chosen.tolerance = options.tolerance.value_or(settings.tolerance.value_or(chosen.tolerance));
  chosen.step_limit = options.step_limit.value_or(chosen.step_limit);
  chosen.impact_law = impact_law(settings);
  if (chosen.method == mechanics::MotionMethod::time_stepping &&
      chosen.impact_law != mechanics::ImpactLaw::moreau)
    throw InvalidInput("simulate.impact_law: time-stepping has Moreau's law alone, not " +
                           *settings.impact_law + "; take method = \"event-driven\" for it",
                       settings.impact_law_place);
  chosen.contact_tolerance = contact_tolerances(problem.solve, constraint_names(system));
  chosen.restitution = restitutions(problem, system);
  return chosen;
}

double end_of_motion(const Problem& problem, const mechanics::LagrangianSystem& system,
                     const std::optional<std::string>& told) {
  const std::optional<mechanics::Text>& written = problem.simulate.until;
  if (!told && !written)
    throw InvalidInput("simulate.until: missing; write until = 3.0 below [simulate], or give --until 3.0");
  const double until = told ? value_of(problem, system, *told, "--until", std::nullopt)
                            : value_of(problem, system, written->text, "simulate.until", written->begin);
  if (!std::isfinite(until))
    throw InvalidInput(
        "simulate.until: " + (told ? *told : written->text) + " is not finite; give a time to end at",
        told ? std::nullopt : std::optional<convex::Place>(written->begin));
  return until;
}

std::vector<std::string> unused_settings(const SimulateSettings& settings, const MotionChoice& options) {
  if (options.method) return {};  // the file may have been written for another
  const std::string method = settings.method.value_or("event-driven");
  std::vector<std::string> said;
  const auto at_line = [](convex::Place place) { return "line " + std::to_string(place.line) + ": "; };
  if (settings.step && method == "event-driven")
    said.push_back(at_line(settings.step_place) + "simulate.step is not used by event-driven" +
                   (settings.method ? "" : ", the default") +
                   "; write method = \"time-stepping\" to go in such steps, or take it out");
  if (settings.tolerance && method == "time-stepping")
    said.push_back(
        at_line(settings.tolerance_place) +
        "simulate.tolerance is not used by time-stepping, whose error falls with step; take it out");
  return said;
}

convex::Vector multiples_of_turns(const Problem& problem, const mechanics::LagrangianSystem& system,
                                  const std::vector<std::string>& modulo) {
  const std::vector<std::string>& coordinates = system.coordinates();
  convex::Vector found = convex::Vector::Zero(static_cast<convex::Index>(coordinates.size()));
  for (const std::string& text : modulo) {
    const std::size_t equals = text.find('=');
    const auto place = std::find(coordinates.begin(), coordinates.end(), text.substr(0, equals));
    if (equals == std::string::npos)
      throw InvalidInput("--modulo " + text + ": no coordinate and multiple; write --modulo \"a=2*pi\"");
    if (place == coordinates.end())
      throw InvalidInput("--modulo " + text + ": no coordinate is named " + text.substr(0, equals) +
                         "; take one of the file, as " + coordinates.front());
    const double multiple = value_of(problem, system, text.substr(equals + 1), "--modulo");
    if (!(multiple > 0))
      throw InvalidInput("--modulo " + text + ": the multiple is not positive; give one > 0");
    found[place - coordinates.begin()] = multiple;
  }
  return found;
}

}  // namespace cli
