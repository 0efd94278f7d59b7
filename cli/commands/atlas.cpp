#include "cli/commands/atlas.hpp"

#include <CLI/CLI.hpp>

#include <fmt/format.h>

#include <atomic>
#include <thread>

#include "cli/commands/command_line.hpp"
#include "cli/drawing/atlas_drawing.hpp"
#include "cli/each_file.hpp"
#include "cli/function_language/parse_call.hpp"
#include "cli/function_language/parse_metric.hpp"
#include "cli/report/atlas_report.hpp"
#include "cli/report/singular_report.hpp"
#include "cli/resolved_scene.hpp"
#include "cli/scene.hpp"
#include "convex/atlas/cell_probability.hpp"
#include "convex/exact/elimination.hpp"
#include "convex/nearest_point/proof/exact_method.hpp"
#include "mechanics/exact_text.hpp"

namespace cli::inline commands {
namespace {

using convex::InvalidInput;

/// Where an atlas is explored: enough to see what is near.
constexpr std::size_t default_cells = 50;

/// A message about a matrix that its reader calls the metric.
std::string about_covariance(std::string message) {
  const std::string name = "metric: ", entry = "metric[";
  if (message.rfind(name, 0) == 0) message = message.substr(name.size());
  for (std::size_t at = message.find(entry); at != std::string::npos; at = message.find(entry))
    message.replace(at, entry.size(), "covariance[");
  return "--covariance: " + message;
}

/// The distribution of z that was asked for, and what it is in words.
std::pair<convex::atlas::NormalLinearTerm, std::string> distribution(const AtlasOptions& options,
                                                                     const convex::ExactProblem& problem) {
  convex::atlas::NormalLinearTerm force{{convex::IntegerVector(problem.z.size(), 0), 1}};
  std::string words = "normal force of mean 0";
  if (options.mean) {
    const bool of_file = *options.mean == "file";
    force.mean = of_file ? convex::ExactVector{problem.z, problem.unit}
                         : convex::exact_vector(parse_vector(*options.mean, "--mean"));
    words = "normal force of mean " + (of_file ? "z of the file" : *options.mean);
  }
  words += " and covariance ";
  if (!options.covariance) return {std::move(force), words + "A"};
  try {
    const convex::Metric covariance = parse_metric(*options.covariance);
    convex::Matrix rows(covariance.dimension(), covariance.dimension());
    for (convex::Index i = 0; i < rows.cols(); ++i)
      rows.col(i) = covariance.multiply(convex::Vector::Unit(rows.rows(), i));
    force.covariance = convex::exact_rows(rows);
  } catch (const InvalidInput& error) {
    throw InvalidInput(about_covariance(error.what()));
  }
  return {std::move(force), words + *options.covariance};
}

/// Of every cell, shared out over all cores.
std::vector<convex::atlas::Probability> probabilities(const convex::atlas::Atlas& atlas,
                                                      const convex::atlas::CellProbability& probability,
                                                      double tolerance) {
  std::vector<convex::atlas::Probability> found(atlas.cells.size());
  std::atomic<std::size_t> next{0};
  const auto work = [&] {
    for (std::size_t c = next++; c < found.size(); c = next++)
      found[c] = probability.of(atlas.cells[c], tolerance);
  };
  constexpr std::size_t few = 32;
  std::vector<std::thread> threads;
  if (found.size() > few)
    for (unsigned k = 1; k < std::thread::hardware_concurrency(); ++k) threads.emplace_back(work);
  work();
  for (std::thread& thread : threads) thread.join();
  return found;
}

/// The problem in fractions: as the file has it where every number of it is one, else its doubles.
struct ExactScene {
  convex::ExactProblem problem;
  bool as_written = true;
};

ExactScene exact_scene(const Scene& scene) {
  if (scene.written) {
    if (!scene.added.empty()) return {scene.exact.make(), false};  // the rows added are in no text
    if (auto fractions =
            mechanics::fractions_from_text(*scene.written->system, scene.written->text, scene.contacts))
      return {std::move(*fractions), true};
    return {scene.exact.make(), false};
  }
  return {scene.exact.make(), true};
}

/// The ranges asked for; without any, of a picture of two coordinates, what lies around the file's force.
std::vector<ForceRange> force_ranges(const AtlasOptions& options, const Scene& scene) {
  std::vector<std::string> texts = options.over;
  if (texts.empty() && options.plot) {
    if (scene.coordinates.size() != 2)
      throw InvalidInput("--plot: a picture has two forces; give --over twice, such as --over \"force." +
                         scene.coordinates.front() + "=-5:5\"");
    const double largest = scene.problem.z.cwiseAbs().maxCoeff();
    const double size = largest > 0 ? 1.5 * largest : 1;
    for (const std::string& name : scene.coordinates)
      texts.push_back(fmt::format("force.{}={}:{}", name, -size, size));
  }
  std::vector<ForceRange> ranges;
  for (const std::string& text : texts) ranges.push_back(parse_force_range(text, scene.coordinates));
  if (ranges.size() > 2) throw InvalidInput("--over: a map has one or two forces; leave the others out");
  if (ranges.size() == 2 && ranges[0].coordinate == ranges[1].coordinate)
    throw InvalidInput("--over: one force twice; name two coordinates");
  if (options.plot && ranges.size() != 2)
    throw InvalidInput("--plot: a picture has two forces; give --over twice");
  return ranges;
}

AtlasMap map_of(const SolvedAtlas& solved, std::vector<ForceRange> ranges) {
  convex::atlas::Parameters parameters{solved.z, {}, {}, {}};
  for (const ForceRange& range : ranges) {
    parameters.directions.push_back({convex::IntegerVector(solved.coordinates.size(), 0), 1});
    parameters.directions.back().numerators[range.coordinate] = 1;
    parameters.low.push_back(range.low);
    parameters.high.push_back(range.high);
  }
  return {std::move(ranges), plane_map(solved.atlas, parameters)};
}

Exit exit_of(const SolvedAtlas& solved) {
  if (solved.atlas.cells.empty()) return Exit::no_solution;
  return solved.is_accurate() ? Exit::solved : Exit::inaccurate;
}

/// Of the rows of contacts.
convex::Index rank(const convex::ExactProblem& problem) {
  return static_cast<convex::Index>(convex::echelon(problem.U, problem.z.size()).rank());
}

/// Probabilities, and the map, of a whole atlas.
void measure(SolvedAtlas& solved, const AtlasOptions& options, const convex::ExactProblem& problem,
             const std::vector<ForceRange>& ranges) {
  solved.tolerance = options.tolerance;
  auto [force, words] = distribution(options, problem);
  solved.distribution = std::move(words);
  const convex::atlas::CellProbability probability(solved.atlas.space, force);
  solved.probabilities = probabilities(solved.atlas, probability, options.tolerance);
  if (rule_is_defined(solved.atlas))
    solved.rule = judge_rule(solved.atlas, probability, solved.probabilities, options.tolerance);
  if (!ranges.empty()) solved.map = map_of(solved, ranges);
}

void require_nothing_of_the_whole(const AtlasOptions& options) {
  if (options.plot || !options.over.empty() || options.mean || options.covariance)
    throw InvalidInput(
        "--over, --plot, --mean and --covariance need the whole atlas: contacts of rank 6 at most, and no "
        "--cells; leave them out");
}

/// Of an atlas that is not whole, the cell that it was explored from.
std::vector<std::size_t> here(const SolvedAtlas& solved) {
  if (solved.atlas.cells.empty()) return {};
  if (!solved.atlas.is_complete()) return {0};
  return cells_at(solved.atlas, solved.z);
}

/// Rows that exclude each other, in fractions, where there is no cell.
void find_culprits(SolvedAtlas& solved, const convex::ExactProblem& problem) {
  if (!solved.atlas.cells.empty()) return;
  solved.farkas = exact_active_set(problem, convex::likely_active_rows(rounded(problem))).farkas;
  solved.rounded_farkas = convex::rounded_weights(solved.farkas, problem.s);
}

}  // namespace

Answer atlas_of_problem(Problem problem, const std::string& file, const AtlasOptions& options) {
  if (options.plot) require_drawable(*options.plot);
  Scene scene = make_scene(std::move(problem), file, {});
  // The atlas is of all forces: what any of them needs at a singular state, its cells need.
  std::vector<std::string> warnings = warning_lines(resolve_for_every_force(scene));
  for (std::size_t k = 0; k < scene.added.size(); ++k)
    warnings.push_back("singular: " + added_row_text(scene, k));
  const std::vector<ForceRange> ranges = force_ranges(options, scene);
  ExactScene exact = exact_scene(scene);
  SolvedAtlas solved{file,
                     scene.title,
                     scene.coordinates,
                     scene.row_names(),
                     exact.as_written,
                     {exact.problem.z, exact.problem.unit},
                     options.cells || rank(exact.problem) > convex::atlas::most_variables
                         ? convex::atlas::explored(exact.problem, options.cells.value_or(default_cells))
                         : convex::atlas::atlas(exact.problem)};
  if (solved.atlas.space.cone.n > 0)
    measure(solved, options, exact.problem, ranges);
  else
    require_nothing_of_the_whole(options);
  solved.here = here(solved);
  find_culprits(solved, exact.problem);
  if (options.plot && !solved.atlas.cells.empty()) draw(*options.plot, atlas_drawing(solved, scene));
  return {exit_of(solved),
          options.json ? atlas_json(solved) + "\n" : heading(scene.title, file) + atlas_text(solved),
          std::move(warnings)};
}

namespace {

Exit atlas_of_files(const AtlasOptions& options) {
  if (options.plot && options.files.size() > 1)
    return answered(options, {options.files.back(), ""}, []() -> Exit {
      throw InvalidInput("--plot takes one problem file; run the files one by one");
    });
  return print_for_each_file(options, [&](const std::string& file) {
    return atlas_of_problem(read_problem_file(file, options), file, options);
  });
}

}  // namespace

void add_atlas(CLI::App& program, Work& chosen) {
  const auto options = std::make_shared<AtlasOptions>();
  CLI::App& command =
      add_command(program, "atlas", "the forces for which one set of contacts persists, as exact polyhedra",
                  chosen, [options] { return atlas_of_files(*options); });
  command
      .add_option("--mean", options->mean,
                  "of the normal force: a vector, or `file` for that of the file; default 0")
      ->type_name("VECTOR");
  command
      .add_option("--covariance", options->covariance,
                  "of the normal force; default A, that of equal energies")
      ->type_name("MATRIX");
  command.add_option("--tolerance", options->tolerance, "error of each probability; default 1e-6")
      ->type_name("X")
      ->check(positive_number);
  command
      .add_option("--over", options->over,
                  "a map over a force on one coordinate, or on two: force.x=-5:5, added to that of the file")
      ->type_name("FORCE=LOW:HIGH")
      ->allow_extra_args(false);
  command.add_option("--plot", options->plot, "the map as a picture: F.svg, F.png or F.pdf (by gnuplot)")
      ->type_name("FILE");
  command
      .add_option("--cells", options->cells,
                  "explore so many cells from that of the file's force on, nothing measured; default beyond "
                  "rank 6: 50")
      ->type_name("N")
      ->check(positive_number);
  add_files(command, *options);
}

}  // namespace cli::inline commands
