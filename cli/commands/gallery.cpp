#include <CLI/CLI.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <cstdio>
#include <filesystem>

#include "cli/commands/command_line.hpp"
#include "cli/each_file.hpp"
#include "cli/json_writer.hpp"
#include "cli/measurement/problem_library.hpp"
#include "cli/measurement/progress.hpp"
#include "cli/problem_file/documents.hpp"
#include "cli/problem_file/write_projection.hpp"
#include "cli/report/library_files.hpp"
#include "cli/report/text_table.hpp"
#include "convex/counted.hpp"
#include "convex/invalid_input.hpp"
#include "convex/nearest_name.hpp"
#include "convex/nearest_point/gallery/gallery.hpp"

namespace cli::inline commands {
namespace {

using convex::GalleryFamily;
using convex::GalleryInstance;
using convex::Index;
using convex::InvalidInput;

/// What `moreau gallery` is told.
struct GalleryOptions : Printing {
  std::optional<std::string> family;
  std::optional<double> difficulty;  ///< the setting of the family's knob
  std::optional<long> size;
  unsigned seed = 1;
  std::optional<std::string> output;  ///< a file to write
  std::optional<std::string> write;   ///< a folder for the whole library
  std::vector<std::string> scenes;    ///< problem files that go into it
};

/// Up to that many numbers the answer stands in the file's comment.
constexpr Index longest_answer = 64;

const GalleryFamily& chosen_family(const std::string& name) {
  const GalleryFamily* family = convex::find_family(name);
  if (family != nullptr) return *family;
  std::vector<std::string> names;
  for (const GalleryFamily& known : convex::gallery()) names.emplace_back(known.name);
  throw InvalidInput("there is no family \"" + name + "\" in the gallery; " +
                     convex::suggestion(name, names));
}

std::string range_text(const GalleryFamily& family) {
  return fmt::format("{:g}..{:g}", family.ladder.front(), family.ladder.back());
}

void list_text() {
  TextTable table({"family", "difficulty", "from..to", "usual", "size"});
  for (const GalleryFamily& family : convex::gallery())
    table.add({std::string(family.name), std::string(family.knob), range_text(family),
               fmt::format("{:g}", family.usual), fmt::format("{} {}", family.size, family.size_meaning)});
  fmt::print("{}\n", table.text());
  for (const GalleryFamily& family : convex::gallery())
    fmt::print("{:<18} {}\n", family.name, family.summary);
  fmt::print("\n`moreau gallery FAMILY --difficulty X --size N --output F.toml` writes an instance.\n");
}

void list_json() {
  JsonWriter json;
  json.begin_object().key("families").begin_array();
  for (const GalleryFamily& family : convex::gallery()) {
    json.begin_object().key("name").value(family.name).key("summary").value(family.summary);
    json.key("difficulty").value(family.knob).key("ladder").begin_array();
    for (const double setting : family.ladder) json.value(setting);
    json.end_array().key("usual").value(family.usual).key("size").value(family.size);
    json.key("size_meaning").value(family.size_meaning).key("sparse").value(family.sparse).end_object();
  }
  json.end_array().end_object();
  fmt::print("{}\n", json.text());
}

std::string comment(const GalleryFamily& family, const GalleryInstance& instance, Index size,
                    double difficulty, unsigned seed) {
  std::string text = fmt::format("# {}: {}.\n# {} {}; {} {}; seed {}.\n", family.name, family.summary,
                                 family.knob, difficulty, size, family.size_meaning, seed);
  if (!instance.feasible) return text + "# No point satisfies all rows.\n";
  if (instance.solution.size() <= longest_answer) {
    text += "# The solution is q'' = [";
    for (Index i = 0; i < instance.solution.size(); ++i)
      text += fmt::format("{}{}", i > 0 ? ", " : "", instance.solution.hi[i]);
    text += "], exact or correctly rounded.\n";
  }
  return text;
}

convex::SparseRows rows_of(const convex::SparseMatrix& A) { return convex::SparseRows(A); }

void write_instance(const GalleryOptions& options) {
  const GalleryFamily& family = chosen_family(*options.family);
  const double difficulty = options.difficulty.value_or(family.usual);
  const Index size = options.size.value_or(family.size);
  const GalleryInstance instance = convex::gallery_instance(family, size, difficulty, options.seed);
  const std::string top = comment(family, instance, size, difficulty, options.seed);
  const convex::NearestPointProblem& problem = instance.problem;
  if (!options.output) {
    if (family.sparse)
      throw InvalidInput(options.family.value() +
                         " is sparse, its matrices go to files of their own; give --output F.toml");
    fmt::print("{}", projection_text(problem, top, ""));
    return;
  }
  const std::filesystem::path path(*options.output);
  const std::string stem = path.stem().string();
  if (problem.A.kind() == convex::MetricKind::sparse)
    write_file(path.parent_path() / (stem + ".A.mtx"), matrix_market_text(rows_of(problem.A.sparse_gram())));
  if (problem.U.is_sparse())
    write_file(path.parent_path() / (stem + ".U.mtx"), matrix_market_text(problem.U.sparse()));
  write_file(path, projection_text(problem, top, stem));
}

/// The library of problems with their truth, in a folder.
void write_all(const GalleryOptions& options) {
  if (options.family || options.output)
    throw InvalidInput("--write takes every family; leave FAMILY and --output out");
  const auto tell = [](const std::string& why) { fmt::print(stderr, "moreau: left out: {}\n", why); };
  std::vector<LibraryProblem> problems = family_problems();
  for (const std::string& file : options.scenes)
    for (LibraryProblem& problem : file_problems(file, tell)) problems.push_back(std::move(problem));
  Progress progress(static_cast<int>(problems.size()));
  const auto done = [&](const std::string& name) {
    progress.now(name);
    progress.step();
  };
  const std::size_t written = write_library(problems, *options.write, done, tell);
  if (options.json) {
    JsonWriter json;
    json.begin_object()
        .key("folder")
        .value(*options.write)
        .key("problems")
        .value(static_cast<Index>(written));
    for (const char* kind : {"family", "scene", "motion"})
      json.key(kind).value(
          std::count_if(problems.begin(), problems.end(),
                        [&](const LibraryProblem& problem) { return problem.kind == kind; }));
    json.end_object();
    fmt::print("{}\n", json.text());
  } else if (!options.quiet) {
    fmt::print("{} in {}; index.csv lists them\n",
               convex::counted(written, "problem with its truth", "problems with their truth"),
               *options.write);
  }
}

Exit show_gallery(const GalleryOptions& options) {
  return answered(options, {options.family.value_or("gallery"), ""}, [&] {
    if (!options.write && !options.scenes.empty())
      throw InvalidInput("--scenes says what else --write writes; give --write FOLDER");
    if (options.write)
      write_all(options);
    else if (options.family)
      write_instance(options);
    else if (options.json)
      list_json();
    else
      list_text();
    return Exit::solved;
  });
}

}  // namespace

void add_gallery(CLI::App& program, Work& chosen) {
  const auto options = std::make_shared<GalleryOptions>();
  CLI::App& command = add_command(
      program, "gallery", "families of hard problems with known answers; writes one as a problem file",
      chosen, [options] { return show_gallery(*options); });
  command.add_option("FAMILY", options->family,
                     "the family to take an instance of; without it, all are listed");
  command.add_option("--difficulty", options->difficulty, "setting of the family's knob")->type_name("X");
  command.add_option("--size", options->size, "coordinates, bodies, discs or points along a side")
      ->type_name("N");
  command.add_option("--seed", options->seed, "another seed gives another instance; default 1")
      ->type_name("K");
  command
      .add_option("--output", options->output,
                  "file to write, such as F.toml (matrices of a sparse family go to F.A.mtx, F.U.mtx); "
                  "default standard output")
      ->type_name("FILE");
  command
      .add_option(
          "--write", options->write,
          "folder for the whole library: every family at every difficulty, with the truth in fractions, as "
          "TOML, JSON and Matrix Market, and an index")
      ->type_name("FOLDER");
  command
      .add_option(
          "--scenes", options->scenes,
          "with --write: problem files whose contact problems, and those along their motions, go with them")
      ->type_name("FILE");
  command.add_flag("--json", options->json, "the list as one JSON object");
  command.add_flag("--quiet", options->quiet, "no text after --write; the exit code tells");
}

}  // namespace cli::inline commands
