#include "cli/measurement/problem_library.hpp"

#include <fmt/format.h>

#include <filesystem>

#include "cli/motion_files.hpp"
#include "cli/motion_settings.hpp"
#include "cli/problem_file/documents.hpp"
#include "cli/scene.hpp"
#include "convex/nearest_point/gallery/gallery.hpp"
#include "mechanics/motion/motion.hpp"

namespace cli::inline measurement {
namespace {

using convex::Index;
using convex::NearestPointProblem;

/// Sizes at which fractions are a matter of milliseconds.
Index library_size(const convex::GalleryFamily& family) {
  constexpr Index coordinates = 10, bodies = 30, side = 6;
  if (family.name == "obstacle") return side;
  return family.sparse ? bodies : std::min(family.size, coordinates);
}

/// What is pressed, opens or is held at an instant: the contacts there and their problem.
LibraryProblem at_instant(const std::string& file, const mechanics::LagrangianSystem& system,
                          const mechanics::State& state, const convex::Vector& tolerance) {
  mechanics::GaussProblem gauss = mechanics::gauss_problem(system, state, tolerance);
  const std::string stem = std::filesystem::path(file).stem().string();
  LibraryProblem made{"motion",
                      stem,
                      "",
                      fmt::format("{} at t = {}", file, state.t),
                      in_full(gauss.problem),
                      system.coordinates(),
                      {}};
  const std::vector<std::string> names = constraint_names(system);
  for (const Index a : gauss.contacts.present) made.constraints.push_back(names[static_cast<std::size_t>(a)]);
  return made;
}

/// The states along the motion at which something is held: after each event, and amid each arc.
std::vector<mechanics::State> states_in_contact(mechanics::Motion& motion, double until) {
  constexpr std::size_t most_states = 10000;
  std::vector<mechanics::State> found;
  while (found.size() < most_states && motion.advance(until)) {
    const mechanics::Arc& arc = motion.arc();
    if (!arc.persist.empty()) found.push_back(arc.state(arc.length / 2));
    if (!motion.events().empty()) found.push_back(motion.state());
  }
  return found;
}

void add_motion(const std::string& file, const Problem& problem, std::vector<LibraryProblem>& all) {
  const auto& text = std::get<SystemProblem>(problem.content);
  const auto system = mechanics::lagrangian_system(text.system);
  const mechanics::MotionOptions options = motion_options(problem, *system, {});
  mechanics::Motion motion(*system, system->state(text.state), options);
  std::vector<LibraryProblem> along;
  for (const mechanics::State& state :
       states_in_contact(motion, end_of_motion(problem, *system, std::nullopt)))
    try {
      LibraryProblem next = at_instant(file, *system, state, options.contact_tolerance);
      if (next.problem.rows() > 0) along.push_back(std::move(next));
    } catch (const convex::InvalidInput&) {
      // A state amid an arc may miss a contact by more than a state of a file may.
    }
  const std::size_t count = std::min(most_instants, along.size());
  for (std::size_t k = 0; k < count; ++k) {
    LibraryProblem& chosen = along[count == 1 ? 0 : k * (along.size() - 1) / (count - 1)];
    chosen.name = fmt::format("{}-instant-{}", chosen.family, k + 1);
    all.push_back(std::move(chosen));
  }
}

}  // namespace

NearestPointProblem in_full(const NearestPointProblem& problem) {
  NearestPointProblem full = problem;
  if (problem.A.kind() == convex::MetricKind::sparse) full.A = convex::Metric::dense(full_gram(problem.A));
  if (problem.U.is_sparse()) full.U = convex::ConstraintRows(convex::RowMatrix(problem.U.sparse()));
  full.radii = {};
  return full;
}

std::vector<LibraryProblem> family_problems() {
  std::vector<LibraryProblem> all;
  for (const convex::GalleryFamily& family : convex::gallery())
    for (const double difficulty : family.ladder)
      for (const unsigned seed : {1U, 2U}) {
        const Index size = library_size(family);
        const std::string name(family.name);
        all.push_back({"family",
                       name,
                       fmt::format("{}-{:g}-seed-{}", name, difficulty, seed),
                       fmt::format("moreau gallery {} --difficulty {} --size {} --seed {}", name, difficulty,
                                   size, seed),
                       in_full(convex::gallery_instance(family, size, difficulty, seed).problem),
                       {},
                       {}});
      }
  return all;
}

std::vector<LibraryProblem> file_problems(const std::string& file,
                                          const std::function<void(const std::string& why)>& left_out) {
  std::vector<LibraryProblem> all;
  const Problem problem = read_problem_file(file, {});
  const bool is_system = std::holds_alternative<SystemProblem>(problem.content);
  if (!is_system && !std::holds_alternative<ProjectionProblem>(problem.content)) {
    left_out(file + ": no [system] and no [projection]");
    return all;
  }
  const std::string stem = std::filesystem::path(file).stem().string();
  bool is_told = false;
  try {
    Scene scene = make_scene(problem, file, {});
    if (scene.problem.rows() > 0)
      all.push_back(
          {"scene", stem, stem, file, in_full(scene.problem), scene.coordinates, scene.contact_names()});
  } catch (const convex::InvalidInput& error) {
    left_out(file + ": " + error.what());
    is_told = true;
  }
  if (is_system && problem.simulate.until) try {
      add_motion(file, problem, all);
    } catch (const convex::InvalidInput& error) {
      left_out(file + ": its motion: " + error.what());
      is_told = true;
    }
  if (all.empty() && !is_told) left_out(file + ": no contact at its state or along its motion");
  return all;
}

}  // namespace cli::inline measurement
