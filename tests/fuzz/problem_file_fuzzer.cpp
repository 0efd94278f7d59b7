#include <cstddef>
#include <cstdint>
#include <string>

#include "cli/drawing/drawn_scene.hpp"
#include "cli/problem_file/parameter_values.hpp"
#include "cli/problem_file/problem.hpp"
#include "convex/catalogue/catalogue.hpp"
#include "convex/functions/decomposition.hpp"
#include "mechanics/contacts.hpp"
#include "mechanics/gauss_problem.hpp"
#include "mechanics/gauss_solution.hpp"
#include "mechanics/lagrangian_system.hpp"
#include "mechanics/liquid/liquid_solution.hpp"
#include "mechanics/motion/motion.hpp"

// The claim: whatever the bytes of a problem file, reading it, solving it and following its motion ends in an
// answer or in InvalidInput.
namespace {

/// Larger problems are right to be slow; they only cost the fuzzer its speed.
constexpr convex::Index most_coordinates = 60, most_contacts = 60, most_entries = 12;
constexpr convex::Index most_moving_coordinates = 8, most_moving_contacts = 12;
constexpr std::size_t most_digits_of_a_bound = 3;
constexpr long coarse_cells = 12;

/// A family, or a sum, of a thousand members or more.
bool is_large(const std::string& text) {
  if (text.find("..") == std::string::npos) return false;
  std::size_t digits = 0;
  for (const char c : text) {
    digits = c >= '0' && c <= '9' ? digits + 1 : 0;
    if (digits > most_digits_of_a_bound) return true;
  }
  return false;
}

/// Devices have no end.
bool reads_a_device(const std::string& text) {
  return text.find("matrix_market") != std::string::npos && text.find("/dev") != std::string::npos;
}

void solve(const convex::NearestPointProblem& problem) {
  if (problem.dimension() <= most_coordinates && problem.rows() <= most_contacts)
    mechanics::solve(problem, mechanics::GaussOptions());
}

void solve(const cli::SystemProblem& text) {
  const auto system = mechanics::lagrangian_system(text.system);
  const mechanics::State state = system->state(text.state);
  const auto constraints = static_cast<convex::Index>(system->constraints().size());
  const mechanics::GaussProblem gauss = mechanics::gauss_problem(
      *system, state, convex::Vector::Constant(constraints, mechanics::default_contact_tolerance));
  solve(gauss.problem);
}

/// Some steps of the motion that the file begins, by both ways, and the first picture of it.
void move(const cli::Problem& problem) {
  const auto& text = std::get<cli::SystemProblem>(problem.content);
  const auto system = mechanics::lagrangian_system(text.system);
  const cli::DrawnScene scene(problem);
  const mechanics::State state = system->state(text.state);
  scene.values(state);
  const auto n = static_cast<convex::Index>(system->coordinates().size());
  const auto m = static_cast<convex::Index>(system->constraints().size());
  if (n > most_moving_coordinates || m > most_moving_contacts) return;
  mechanics::MotionOptions options;
  options.restitution = cli::restitutions(problem, *system);
  options.step_limit = 30;
  options.step = problem.simulate.step.value_or(options.step);
  options.tolerance = problem.simulate.tolerance.value_or(options.tolerance);
  for (const auto method : {mechanics::MotionMethod::event_driven, mechanics::MotionMethod::time_stepping}) {
    options.method = method;
    mechanics::Motion motion(*system, state, options);
    while (motion.advance(state.t + 1)) motion.energy();
  }
}

void solve(const cli::DecompositionProblem& problem) {
  if (problem.z.size() > most_entries) return;
  const convex::Function f = convex::make_function(problem.f, {problem.W});
  convex::decompose(f, problem.z, problem.W);
}

void solve(const cli::LiquidProblem& problem) {
  mechanics::liquid::LiquidText text = problem.text;
  text.cells = coarse_cells;
  mechanics::liquid::LiquidAccuracy accuracy;
  accuracy.proved = true;
  mechanics::liquid::solve_liquid(mechanics::liquid::read_scene(text), accuracy);
}

void run(const std::string& text) {
  const cli::Problem problem = cli::read_problem(text, "/nowhere");
  if (const auto* system = std::get_if<cli::SystemProblem>(&problem.content)) {
    try {
      solve(*system);
    } catch (const convex::InvalidInput&) {  // an impact may be due, which only a motion can take
    }
    move(problem);
  }
  if (const auto* liquid = std::get_if<cli::LiquidProblem>(&problem.content)) solve(*liquid);
  if (const auto* numbers = std::get_if<cli::ProjectionProblem>(&problem.content)) solve(numbers->problem);
  if (const auto* split = std::get_if<cli::DecompositionProblem>(&problem.content)) solve(*split);
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const std::string text(reinterpret_cast<const char*>(data), size);
  if (is_large(text) || reads_a_device(text)) return 0;
  try {
    run(text);
  } catch (const convex::InvalidInput&) {  // nothing else may be thrown
  }
  return 0;
}
