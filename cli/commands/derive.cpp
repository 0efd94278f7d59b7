#include <CLI/CLI.hpp>

#include <fmt/format.h>

#include <cstdio>

#include "cli/commands/command_line.hpp"
#include "cli/each_file.hpp"
#include "cli/json_writer.hpp"
#include "cli/problem_file/documents.hpp"
#include "cli/report/answer.hpp"
#include "cli/report/appell_function.hpp"
#include "cli/report/equation_code.hpp"
#include "cli/report/equation_latex.hpp"
#include "cli/report/singular_report.hpp"
#include "cli/report/text_table.hpp"
#include "cli/resolved_scene.hpp"
#include "convex/counted.hpp"
#include "mechanics/angles_in_degrees.hpp"

namespace cli::inline commands {
namespace {

using convex::Index;
using convex::MetricKind;

/// Above this many coordinates A is written as triplets.
constexpr Index largest_full = 2000;

/// Above this many coordinates a table is too wide for the screen, and a polynomial too long to read.
constexpr Index widest = 12;

std::string shortest_digits(double x) { return fmt::format("{}", x); }

convex::SparseMatrix gram(const convex::Metric& A) {
  if (A.kind() == MetricKind::dense) return A.dense_gram().sparseView(0, 0);
  if (A.kind() == MetricKind::sparse) return A.sparse_gram();
  convex::SparseMatrix diagonal(A.dimension(), A.dimension());
  diagonal.reserve(Eigen::VectorXi::Constant(A.dimension(), 1));
  for (Index i = 0; i < A.dimension(); ++i) diagonal.insert(i, i) = A.diagonal()[i];
  return diagonal;
}

void write_full(JsonWriter& json, const convex::Matrix& A) {
  json.begin_array();
  for (Index i = 0; i < A.rows(); ++i) {
    json.begin_array();
    for (Index j = 0; j < A.cols(); ++j) json.value(A(i, j));
    json.end_array();
  }
  json.end_array();
}

void write_triplets(JsonWriter& json, const convex::SparseMatrix& A) {
  json.begin_object().key("triplets").begin_array();
  for (Index j = 0; j < A.cols(); ++j)
    for (convex::SparseMatrix::InnerIterator it(A, j); it; ++it)
      json.begin_array().value(static_cast<Index>(it.row())).value(j).value(it.value()).end_array();
  json.end_array().end_object();
}

std::string derive_json(const Scene& scene, const Scene& resolved) {
  const auto& [A, z, U, s, two_sided, radii] = scene.problem;
  JsonWriter json;
  json.begin_object().key("file").value(scene.file).key("names").begin_array();
  for (const std::string& name : scene.coordinates) json.value(name);
  json.end_array().key("A");
  if (A.dimension() <= largest_full)
    write_full(json, convex::Matrix(gram(A)));
  else
    write_triplets(json, gram(A));
  json.key("z").numbers(scene.coordinates, z);
  json.key("U").begin_object();
  for (Index row = 0; row < U.count(); ++row) {
    json.key(scene.contact_name(row));
    if (A.dimension() <= largest_full) {
      json.numbers(scene.coordinates, U.row(row));
    } else {
      const convex::Vector u = U.row(row);
      json.begin_object();
      for (Index i = 0; i < u.size(); ++i)
        if (u[i] != 0) json.key(scene.coordinates[static_cast<std::size_t>(i)]).value(u[i]);
      json.end_object();
    }
  }
  json.end_object().key("s").numbers(scene.contact_names(), s);
  json.key("two_sided").begin_array();
  for (Index row : two_sided) json.value(scene.contact_name(row));
  json.end_array();
  write_added_rows(json, resolved);
  json.key("appell");
  if (A.dimension() <= widest)
    json.value(appell_function(scene, shortest_digits));
  else
    json.null();
  return json.end_object().text();
}

std::string derive_text(const Scene& scene) {
  const auto& [A, z, U, s, two_sided, radii] = scene.problem;
  const std::string text = heading(scene.title, scene.file);
  if (A.dimension() > widest)
    return text + fmt::format("{}, {}: too wide for the screen; --json gives A, z, U and s.\n",
                              convex::counted(A.dimension(), "coordinate", "coordinates"),
                              convex::counted(U.count(), "contact", "contacts"));
  std::vector<std::string> heading{"A q'' = z"};
  heading.insert(heading.end(), scene.coordinates.begin(), scene.coordinates.end());
  heading.emplace_back("z");
  TextTable motion(heading);
  const convex::Matrix full(gram(A));
  for (Index i = 0; i < A.dimension(); ++i) {
    std::vector<std::string> row{scene.coordinates[static_cast<std::size_t>(i)]};
    for (Index j = 0; j < A.dimension(); ++j) row.push_back(number_text(full(i, j)));
    row.push_back(number_text(z[i]));
    motion.add(std::move(row));
  }
  heading.front() = "u·q'' >= s";
  heading.back() = "s";
  TextTable contacts(heading);
  std::vector<bool> equal(static_cast<std::size_t>(U.count()), false);
  for (Index row : two_sided) equal[static_cast<std::size_t>(row)] = true;
  for (Index k = 0; k < U.count(); ++k) {
    std::vector<std::string> row{scene.contact_name(k) + (equal[static_cast<std::size_t>(k)] ? " (=)" : "")};
    const convex::Vector u = U.row(k);
    for (Index j = 0; j < u.size(); ++j) row.push_back(number_text(u[j]));
    row.push_back(number_text(s[k]));
    contacts.add(std::move(row));
  }
  return text + motion.text() + "\n" + (U.count() > 0 ? contacts.text() : "  no contacts\n") +
         "\nOf the accelerations that the contacts allow the true one makes Appell's function least:\n  " +
         appell_function(scene, number_text) + " + a number without accelerations\n";
}

/// The equations of a singular state, a paragraph each.
std::string rows_beside(const Scene& resolved) {
  std::string text;
  for (std::size_t k = 0; k < resolved.added.size(); ++k) text += "\n" + added_row_text(resolved, k) + ".\n";
  return text;
}

/// What `moreau derive` is told.
struct DeriveOptions : FileOptions {
  bool c = false, python = false, latex = false;
  std::optional<std::string> matrices;  ///< a folder to write
};

std::string derived_code(const Scene& scene, const DeriveOptions& options) {
  if (!scene.system)
    throw convex::InvalidInput(
        "--c, --python and --latex are for a [system]; the numbers of a [projection] are there already");
  const auto constants = options.latex ? mechanics::ConstantsAs::written : mechanics::ConstantsAs::numbers;
  const mechanics::SymbolicEquations equations =
      mechanics::symbolic_equations(scene.system->model(), scene.contacts, constants);
  const EquationTitle title{function_name(scene.file), scene.contact_names()};
  if (options.c) return equations_in_c(equations, title);
  if (options.python) return equations_in_python(equations, title);
  return equations_in_latex(equations, title);
}

/// What the numbers do not show: at a singular state of a mechanism, the equations that they lack.
std::vector<std::string> what_is_added(Scene& scene) {
  try {
    std::vector<std::string> lines = warning_lines(resolve_for_every_force(scene));
    for (std::size_t k = 0; k < scene.added.size(); ++k)
      lines.push_back("singular: " + added_row_text(scene, k) + "; it is no derivative of one contact, and " +
                      "stands beside U and s");
    if (scene.system)
      for (std::string& angle : mechanics::angles_in_degrees(*scene.system, scene.state))
        lines.push_back(std::move(angle));
    return lines;
  } catch (const convex::InvalidInput& refused) {
    return {std::string("singular: ") + refused.what()};
  }
}

Exit derive_files(const DeriveOptions& options) {
  if (options.files.size() > 1 && options.matrices)
    return answered(options, {options.files[1], ""}, []() -> Exit {
      throw convex::InvalidInput("--mtx takes one problem file; run the files one by one");
    });
  return for_each_file(options, [&](const std::string& file) {
    const Scene scene = read_scene(file, {}, options);
    Scene resolved = scene;
    for (const std::string& warning : what_is_added(resolved))
      fmt::print(stderr, "moreau: warning: {}: {}\n", file, warning);
    if (options.matrices) write_problem_folder(resolved.problem, *options.matrices);
    if (options.c || options.python || options.latex)
      fmt::print("{}", derived_code(scene, options));
    else if (options.matrices && !options.json)
      return Exit::solved;
    else if (options.json)
      fmt::print("{}\n", derive_json(scene, resolved));
    else if (!options.quiet)
      fmt::print("{}", derive_text(scene) + rows_beside(resolved));
    return Exit::solved;
  });
}

}  // namespace

void add_derive(CLI::App& program, Work& chosen) {
  const auto options = std::make_shared<DeriveOptions>();
  CLI::App& command = add_command(program, "derive", "A, z, U, s of a system at its state", chosen,
                                  [options] { return derive_files(*options); });
  add_files(command, *options);
  CLI::Option& c =
      *command.add_flag("--c", options->c, "a C99 function of q, q' and t, parameters as constants");
  CLI::Option& python = *command.add_flag("--python", options->python, "the same in Python, with numpy");
  CLI::Option& json = *command.get_option("--json");
  command.add_flag("--latex", options->latex, "the formulas, for LaTeX with amsmath")
      ->excludes(&c, &python, &json);
  python.excludes(&c, &json);
  c.excludes(&json);
  command
      .add_option("--mtx", options->matrices, "a folder for A.mtx, z.mtx, U.mtx, s.mtx: numbers at the state")
      ->type_name("DIR");
}

}  // namespace cli::inline commands
