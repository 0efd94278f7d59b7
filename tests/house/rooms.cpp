#include <doctest/doctest.h>

#include <filesystem>
#include <map>
#include <optional>
#include <regex>
#include <set>
#include <sstream>
#include <string>
#include <utility>

#include "tests/house/source_files.hpp"

namespace fs = std::filesystem;
using tests::SourceFile;

namespace {

/// The rooms from bottom to top, each of which includes those before it alone: a folder, or files at the root
/// of one, which holds what its rooms stand on and what stands on them. What is on one line is one room.
constexpr const char* bottom_to_top[] = {
    "convex/processor convex/vector convex/double_double convex/infinity convex/invalid_input "
    "convex/invariant convex/loaded_module",
    "convex/dense/",
    "convex/linear_algebra/",
    "convex/exact/ball_module/",
    "convex/exact/",
    "convex/",
    "convex/obstacle_problem/",
    "convex/nearest_point/problem convex/nearest_point/model convex/nearest_point/entry_radii "
    "convex/nearest_point/solution convex/nearest_point/solve_watch",
    "convex/cones/",
    "convex/nearest_point/cone_projection",
    "convex/nearest_point/working_set/",
    "convex/nearest_point/optimality/",
    "convex/nearest_point/reductions/",
    "convex/nearest_point/proof/",
    "convex/nearest_point/pivoting/",
    "convex/nearest_point/active_set/",
    "convex/nearest_point/isotonic/",
    "convex/nearest_point/sparse/",
    "convex/nearest_point/obstacle/",
    "convex/nearest_point/methods/ceres_module/",
    "convex/nearest_point/methods/",
    "convex/nearest_point/",
    "convex/nearest_point/multipliers/",
    "convex/nearest_point/gallery/",
    "convex/prox_formulas/",
    "convex/piecewise/",
    "convex/grid/",
    "convex/gamma0/",
    "convex/catalogue/",
    "convex/symbolic/",
    "convex/linear_quadratic/",
    "convex/exact_program/",
    "convex/composite/",
    "convex/functions/",
    "convex/operations/",
    "convex/catalogue/entries/",
    "convex/proved_prox/doubles/",
    "convex/proved_prox/",
    "convex/decompositions/",
    "convex/laws/",
    "convex/sets/",
    "convex/atlas/",
    "mechanics/state mechanics/system mechanics/lagrangian_text mechanics/number_text",
    "mechanics/expression/",
    "mechanics/",
    "mechanics/singular/",
    "mechanics/motion/",
    "mechanics/liquid/",
    "cli/held_interrupt cli/options cli/json_writer",
    "cli/problem_file/",
    "cli/function_language/",
    "cli/measurement/peer_module/",
    "cli/scene cli/assembled_state cli/motion_files cli/motion_settings",
    "cli/measurement/",
    "cli/report/",
    "cli/resolved_scene",
    "cli/sweep/",
    "cli/drawing/",
    "cli/manual/",
    "cli/",
    "cli/commands/",
    "cli/petsc/",
    "cli/python/",
    "cli/main",
};

/// The arrows that run up all the same: file, and what it includes.
const std::set<std::pair<std::string, std::string>> arrows_up{
    // Fractions begin with the rows that doubles end on, and the active set asks fractions where in doubt.
    {"convex/nearest_point/proof/exact_method.cpp", "convex/nearest_point/active_set/active_set.hpp"},
    // A direction that opens rows is itself a nearest point.
    {"convex/nearest_point/proof/open_rows.cpp", "convex/nearest_point/automatic.hpp"},
    // A node has no program and no graph form unless it says so: there alone the two are complete types.
    {"convex/gamma0/node.cpp", "convex/linear_quadratic/linear_quadratic.hpp"},
    {"convex/gamma0/node.cpp", "convex/composite/graph_form.hpp"},
    // The one list is put together of its parts.
    {"convex/catalogue/catalogue.cpp", "convex/catalogue/entries/entries.hpp"},
    // The conjugate of a quadratic atom is a function of the catalogue.
    {"convex/composite/affine_atoms.cpp", "convex/functions/quadratic.hpp"},
    // A system keeps the equations of motion that are derived from it.
    {"mechanics/lagrangian_system.cpp", "mechanics/motion/lagrange_equations.hpp"},
    // A decomposition is told by a call of the language of functions, whose numbers are those of files.
    {"cli/problem_file/read_decomposition.cpp", "cli/function_language/parse_call.hpp"},
};

/// The height of a file among the rooms; none of a file of no room.
std::optional<int> height(const std::string& path) {
  static const std::map<std::string, int> heights = [] {
    std::map<std::string, int> made;
    int level = 0;
    for (const char* line : bottom_to_top) {
      std::istringstream names(line);
      for (std::string name; names >> name;) made[name] = level;
      ++level;
    }
    return made;
  }();
  const fs::path file(path);
  for (const std::string& name :
       {fs::path(file).replace_extension().string(), file.parent_path().string() + "/"})
    if (const auto found = heights.find(name); found != heights.end()) return found->second;
  return std::nullopt;
}

bool is_ours(const std::string& header) {
  for (const char* room : {"convex/", "mechanics/", "cli/", "tests/"})
    if (header.starts_with(room)) return true;
  return false;
}

/// The namespaces of the library that a file opens, but to declare a type of another room, or to give a name
/// that users know to `convex` itself.
std::set<std::string> namespaces(const SourceFile& file) {
  static const std::regex opened(R"(^namespace (convex(::(inline )?\w+)?)(::\w+)* \{$)"),
      declared(R"(^(struct|class|using) [\w:]+;$)");
  std::set<std::string> found;
  for (std::size_t i = 0; i < file.lines.size(); ++i) {
    std::smatch match;
    if (!std::regex_match(file.lines[i], match, opened)) continue;
    std::size_t k = i + 1;
    while (k < file.lines.size() && std::regex_match(file.lines[k], declared)) ++k;
    if (k == i + 1 || k == file.lines.size() || !file.lines[k].starts_with("}")) found.insert(match[1]);
  }
  return found;
}

}  // namespace

TEST_CASE("no arrow runs up: each room includes the rooms below it alone, and nothing sees tests") {
  std::set<std::pair<std::string, std::string>> up;
  for (const SourceFile& file : tests::source_files()) {
    if (file.room == "tests") continue;
    const std::optional<int> here = height(file.path);
    CAPTURE(file.path);
    REQUIRE(here);  // a new room has its place in `bottom_to_top`
    for (const std::string& line : file.lines) {
      const std::string header = tests::included(line);
      if (!is_ours(header)) continue;
      CAPTURE(header);
      const std::optional<int> there = height(header);
      REQUIRE(there);
      if (*there <= *here) continue;
      up.emplace(file.path, header);
      CHECK(arrows_up.contains({file.path, header}));
    }
  }
  CHECK(up == arrows_up);  // one that is gone is not named any more
}

TEST_CASE("each room of convex has a namespace of its own") {
  // The roots hold what users name first. `decompose` is declared beside its result, and made above it.
  const std::set<std::string> in_convex{"convex", "convex/nearest_point"};
  const std::string declares_above = "convex/functions/decomposition.hpp";
  std::map<std::string, std::set<std::string>> spaces;  // of a room
  std::map<std::string, std::set<std::string>> rooms;   // of a namespace
  for (const SourceFile& file : tests::source_files()) {
    if (file.room != "convex" || file.path == declares_above) continue;
    const std::string room = fs::path(file.path).parent_path().string();
    for (const std::string& name : namespaces(file)) {
      CAPTURE(file.path);
      CAPTURE(name);
      CHECK((name == "convex") == in_convex.contains(room));
      spaces[room].insert(name);
      rooms[name].insert(room);
    }
  }
  CHECK(spaces.size() >= 37);
  for (const auto& [room, names] : spaces) {
    CAPTURE(room);
    CHECK(names.size() == 1);
    for (const std::string& name : names) CHECK((name == "convex" || rooms[name].size() == 1));
  }
}
