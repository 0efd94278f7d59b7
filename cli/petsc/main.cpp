#include <mpi.h>
#include <petscsys.h>

#include <CLI/CLI.hpp>
#include <cstdio>
#include <exception>
#include <string>
#include <vector>

#include "cli/json_writer.hpp"
#include "cli/petsc/distributed_liquid.hpp"
#include "cli/scene.hpp"

namespace {

using cli::petsc::DistributedPressure;
using mechanics::liquid::LiquidScene;

constexpr int solved = 0, wrong_input = 2, inaccurate = 3;

/// What is set for PETSc before its own options are read.
constexpr const char* petsc_settings =
    "-snes_type vinewtonrsls -snes_rtol 1e-10 -snes_atol 1e-13 -snes_stol 0 -snes_max_it 200 "
    "-ksp_type cg -ksp_rtol 1e-8 -pc_type mg -pc_mg_galerkin both "
    "-mg_levels_ksp_type chebyshev -mg_levels_pc_type sor";

struct Request {
  std::string file;
  long cells = 0;
  bool json = false;
  cli::Overrides set;
  cli::petsc::DistributedFiles files;
};

/// As `moreau solve` has it: the bound is at most 1e-3 of the largest p.
bool is_solved(const DistributedPressure& found) {
  return found.has_converged && found.error_bound <= 1e-3 * found.largest;
}

void write_json(const Request& request, const LiquidScene& scene, const DistributedPressure& found, int ranks,
                double seconds) {
  cli::JsonWriter json;
  json.begin_object().key("file").value(request.file).key("kind").value("liquid");
  json.key("status").value(is_solved(found) ? "solved" : "inaccurate").key("method").value("petsc");
  json.key("unknowns").value(found.unknowns).key("cells").value(found.cells);
  json.key("cavity").begin_object().key("measure").value(found.cavity_measure);
  json.key("fraction").value(found.cavity_measure / found.volume).key("extent");
  if (found.cavity_extent) {
    json.begin_object();
    for (std::size_t i = 0; i < scene.coordinates.size(); ++i)
      json.key(scene.coordinates[i])
          .begin_array()
          .value(found.cavity_extent->first[i])
          .value(found.cavity_extent->second[i])
          .end_array();
    json.end_object();
  } else {
    json.null();
  }
  json.end_object();
  json.key("pressure").begin_object().key("max").value(found.largest).key("at").begin_object();
  for (std::size_t i = 0; i < scene.coordinates.size(); ++i)
    json.key(scene.coordinates[i]).value(found.largest_at[i]);
  json.end_object().end_object();
  json.key("parted_walls").begin_array();
  for (const std::string& name : found.parted_walls) json.value(name);
  json.end_array();
  json.key("certificate").begin_object().key("level").value("estimate");
  json.key("error_bound").value(found.error_bound).end_object();
  json.key("petsc").begin_object().key("ranks").value(ranks).key("reason").value(found.reason);
  json.key("newton_steps").value(static_cast<convex::Index>(found.newton_steps));
  json.key("bytes_of_a_rank").value(found.bytes_of_a_rank).end_object();
  json.key("seconds").value(seconds).end_object();
  std::printf("%s\n", json.text().c_str());
}

void write_text(const Request& request, const DistributedPressure& found, int ranks, double seconds) {
  std::printf("%s: %lld unknowns on %lld cells along the longest side, %d process%s\n\n",
              request.file.c_str(), static_cast<long long>(found.unknowns),
              static_cast<long long>(found.cells), ranks, ranks == 1 ? "" : "es");
  if (found.cavity_measure > 0)
    std::printf("Cavity: p = 0 and the liquid parts in %.4g %% of the domain (measure %.6g, by cells).\n",
                100 * found.cavity_measure / found.volume, found.cavity_measure);
  else
    std::printf("No cavity inside.\n");
  for (const std::string& name : found.parted_walls) std::printf("The liquid parts from %s.\n", name.c_str());
  std::printf("The largest pressure is %.12g.\n", found.largest);
  std::printf(
      "%s after %ld Newton steps on the finest grid, %.3g s, %.3g MB a process; p is known to %.1e.\n",
      found.has_converged ? "Solved" : ("Not solved (" + found.reason + ")").c_str(), found.newton_steps,
      seconds, found.bytes_of_a_rank * 1e-6, found.error_bound);
  if (found.has_converged && !is_solved(found))
    std::printf("That is more than 1e-3 of the largest p; give more cells.\n");
}

int rank_of_this() {
  int rank = 0;
  MPI_Comm_rank(PETSC_COMM_WORLD, &rank);
  return rank;
}

LiquidScene read(const Request& request) {
  const cli::Problem problem = cli::read_problem_file(request.file, request.set);
  const auto* liquid = std::get_if<cli::LiquidProblem>(&problem.content);
  if (liquid == nullptr) throw convex::InvalidInput("the file has no [liquid]; solve it by `moreau solve`");
  return mechanics::liquid::read_scene(liquid->text);
}

int solve(const Request& request, const LiquidScene& scene, double start) {
  int ranks = 1;
  MPI_Comm_size(PETSC_COMM_WORLD, &ranks);
  const long cells = request.cells > 0 ? request.cells : scene.cells.value_or(256);
  const DistributedPressure found = cli::petsc::solve_distributed(scene, cells, request.files);
  if (rank_of_this() == 0)
    request.json ? write_json(request, scene, found, ranks, MPI_Wtime() - start)
                 : write_text(request, found, ranks, MPI_Wtime() - start);
  return is_solved(found) ? solved : inaccurate;
}

void tell(const Request& request, const std::exception& error) {
  std::string place = request.file;
  if (const auto* input = dynamic_cast<const convex::InvalidInput*>(&error);
      input != nullptr && input->place())
    place += ":" + std::to_string(input->place()->line) + ":" + std::to_string(input->place()->column);
  std::fprintf(stderr, "moreau_petsc: %s: %s\n", place.c_str(), error.what());
}

/// What all processes read alike is told by the first. What one meets on its part of the grid it tells, and
/// ends the others, which may wait for it.
int answer(const Request& request) {
  const double start = MPI_Wtime();
  LiquidScene scene;
  try {
    scene = read(request);
  } catch (const std::exception& error) {
    if (rank_of_this() == 0) tell(request, error);
    return wrong_input;
  }
  try {
    return solve(request, scene, start);
  } catch (const std::exception& error) {
    tell(request, error);
    MPI_Abort(PETSC_COMM_WORLD, wrong_input);
  }
  return wrong_input;
}

/// The first argument that `moreau solve` alone takes.
std::string option_of_moreau(const std::vector<char*>& arguments) {
  for (const std::string given : arguments)
    for (const std::string name :
         {"--probe", "--onset", "--certify", "--plot", "--velocity", "--animate", "--over"})
      if (given == name || given.rfind(name + "=", 0) == 0) return name;
  return "";
}

}  // namespace

/// Arguments after --petsc are PETSc's own.
int main(int argc, char** argv) {
  std::vector<char*> own(argv, argv + argc), petsc{argv[0]};
  for (int i = 1; i < argc; ++i)
    if (std::string(argv[i]) == "--petsc") {
      own.assign(argv, argv + i);
      petsc.insert(petsc.end(), argv + i + 1, argv + argc);
      break;
    }
  if (const std::string name = option_of_moreau(own); !name.empty()) {
    std::fprintf(stderr, "moreau_petsc: %s: not on many processors; `moreau solve` takes it\n", name.c_str());
    return wrong_input;
  }
  Request request;
  CLI::App app("The pressure of a liquid that may part, on many processors, by PETSc", "moreau_petsc");
  app.require_subcommand(1);
  app.footer("Arguments after --petsc are PETSc's own, e.g. --petsc -snes_monitor -log_view.");
  CLI::App& command = *app.add_subcommand("solve", "the same rows as `moreau solve` makes on a grid");
  command.add_option("file", request.file, "a problem file with [liquid]")->required()->type_name("FILE");
  command.add_option("--cells", request.cells, "along the longest side; default: the file's, or 256")
      ->check(CLI::Range(4L, 1L << 30))
      ->type_name("N");
  command.add_option("--set", request.set.settings, "a parameter of the file, NAME=VALUE")
      ->type_name("NAME=VALUE");
  command
      .add_option("--data", request.files.table, "a table of the coordinates and p, gathered on one process")
      ->type_name("F.csv");
  command.add_option("--vtk", request.files.vtk, "p for ParaView, written by all processes")
      ->type_name("F.vts");
  command.add_flag("--json", request.json, "one JSON object");
  try {
    app.parse(static_cast<int>(own.size()), own.data());
  } catch (const CLI::ParseError& error) {
    return app.exit(error) == 0 ? solved : wrong_input;
  }

  int count = static_cast<int>(petsc.size());
  char** arguments = petsc.data();
  if (PetscInitializeNoArguments() != 0 || PetscOptionsInsertString(nullptr, petsc_settings) != 0 ||
      PetscOptionsInsert(nullptr, &count, &arguments, nullptr) != 0)
    return wrong_input;
  const int outcome = answer(request);
  PetscFinalize();
  return outcome;
}
