#include "cli/motion_settings.hpp"

#include "cli/motion_files.hpp"
#include "cli/problem_file/numbers_by_constraint.hpp"
#include "cli/scene.hpp"

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

}  // namespace

void require_event_driven(const SimulateSettings& settings, const MotionChoice& options) {
  const std::string method = options.method.value_or(settings.method.value_or("event-driven"));
  const auto place = options.method ? std::nullopt : std::optional(settings.method_place);
  if (method == "time-stepping")
    throw InvalidInput("simulate.method: time-stepping is not available yet; take \"event-driven\"", place);
  if (method != "event-driven")
    throw InvalidInput("simulate.method: no method \"" + method + "\"; take \"event-driven\"", place);
}

mechanics::MotionOptions motion_options(const Problem& problem, const mechanics::System& system,
                                        const MotionChoice& options) {
  const SimulateSettings& settings = problem.simulate;
  const std::vector<std::string> constraints = constraint_names(system);
  mechanics::MotionOptions chosen;
  chosen.tolerance = options.tolerance.value_or(settings.tolerance.value_or(chosen.tolerance));
  chosen.step_limit = options.step_limit.value_or(chosen.step_limit);
  chosen.impact_law = impact_law(settings);
  chosen.contact_tolerance = contact_tolerances(problem.solve, constraints);
  std::vector<NamedNumber> restitutions = std::get<SystemProblem>(problem.content).restitutions;
  // Those of [simulate] come later, and win.
  restitutions.insert(restitutions.end(), settings.restitutions.begin(), settings.restitutions.end());
  chosen.restitution =
      numbers_by_constraint("simulate.restitution", settings.restitution, restitutions, constraints);
  return chosen;
}

}  // namespace cli
