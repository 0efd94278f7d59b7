#include <doctest/doctest.h>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <map>
#include <regex>
#include <set>
#include <string>
#include <vector>

#include "tests/house/source_files.hpp"

namespace fs = std::filesystem;
using tests::SourceFile;

namespace {

const fs::path root = tests::source_root();

bool begins_with_any(const std::string& text, const std::vector<std::string>& prefixes) {
  for (const std::string& prefix : prefixes)
    if (text.rfind(prefix, 0) == 0) return true;
  return false;
}

}  // namespace

TEST_CASE("data flow from cli to mechanics to convex and never back") {
  for (const SourceFile& file : tests::source_files()) {
    std::vector<std::string> forbidden;
    if (file.room == "convex") forbidden = {"mechanics/", "cli/", "tests/"};
    if (file.room == "mechanics") forbidden = {"cli/", "tests/"};
    if (file.room == "cli") forbidden = {"tests/"};
    for (const std::string& line : file.lines) {
      CAPTURE(file.path);
      CAPTURE(line);
      CHECK_FALSE(begins_with_any(tests::included(line), forbidden));
    }
  }
}

TEST_CASE("what the nearest point stands on does not see it") {
  for (const SourceFile& file : tests::source_files()) {
    const std::vector<std::string> below{"convex/dense/", "convex/linear_algebra/", "convex/exact/",
                                         "convex/obstacle_problem/"};
    if (!begins_with_any(file.path, below)) continue;
    for (const std::string& line : file.lines) {
      CAPTURE(file.path);
      CAPTURE(line);
      CHECK_FALSE(begins_with_any(tests::included(line), {"convex/nearest_point/"}));
    }
  }
}

TEST_CASE("each room of solvers has a namespace of its own") {
  std::map<std::string, std::set<std::string>> spaces;  // of a room
  std::map<std::string, std::set<std::string>> rooms;   // of a namespace
  static const std::regex opened(R"(^namespace (convex::inline \w+|convex)(::\w+)? \{$)");
  for (const SourceFile& file : tests::source_files()) {
    const std::string room = fs::path(file.path).parent_path().string();
    if (!room.starts_with("convex/nearest_point/") && room != "convex/obstacle_problem") continue;
    for (const std::string& line : file.lines)
      if (std::smatch match; std::regex_match(line, match, opened)) {
        spaces[room].insert(match[1]);
        rooms[match[1]].insert(room);
      }
  }
  CHECK(spaces.size() >= 12);
  for (const auto& [room, names] : spaces) {
    CAPTURE(room);
    CHECK(names.size() == 1);
    for (const std::string& name : names) CHECK(rooms[name].size() == 1);
  }
}

TEST_CASE("heavy libraries stay behind the firewall: in no header of a room but the one for ceres::Jet") {
  const std::vector<std::string> heavy{"CGAL/",   "ceres/", "gmp",       "flint",     "arb",
                                       "toml++/", "CLI/",   "nlohmann/", "fmt/format"};
  for (const SourceFile& file : tests::source_files()) {
    if (file.room == "tests" || !file.is_header() || file.path == "mechanics/jet_system.hpp") continue;
    for (const std::string& line : file.lines) {
      CAPTURE(file.path);
      CAPTURE(line);
      CHECK_FALSE(begins_with_any(tests::included(line), heavy));
    }
  }
}

TEST_CASE("a decomposition of Eigen's is compiled in the room of linear algebra alone") {
  const std::vector<std::string> slow{"Eigen/Cholesky", "Eigen/Dense",       "Eigen/Eigen",
                                      "Eigen/LU",       "Eigen/Eigenvalues", "Eigen/Householder",
                                      "Eigen/QR",       "Eigen/SVD",         "Eigen/Sparse"};
  for (const SourceFile& file : tests::source_files()) {
    const bool is_home = file.path.rfind("convex/linear_algebra/", 0) == 0 && !file.is_header();
    if (file.room == "tests" || is_home) continue;
    for (const std::string& line : file.lines) {
      const std::string header = tests::included(line);
      CAPTURE(file.path);
      CAPTURE(line);
      CHECK((header == "Eigen/SparseCore" || !begins_with_any(header, slow)));
    }
  }
}

TEST_CASE("nothing but tests includes the header for ceres::Jet") {
  for (const SourceFile& file : tests::source_files())
    for (const std::string& line : file.lines)
      if (file.room != "tests") CHECK(tests::included(line) != "mechanics/jet_system.hpp");
}

TEST_CASE("no file is longer than 350 lines, and none has a name that says nothing") {
  const std::regex empty_name("(utils?|helpers?|manager|common|base|misc)\\.");
  for (const SourceFile& file : tests::source_files()) {
    CAPTURE(file.path);
    CHECK(file.lines.size() <= 350);
    CHECK_FALSE(std::regex_search(file.path, empty_name));
  }
}

TEST_CASE("the top level holds the rooms and nothing else") {
  const std::set<std::string> allowed{"CMakeLists.txt", "convex", "mechanics", "cli",
                                      "tests",          "docs",   "README.md", "LICENSE"};
  for (const auto& entry : fs::directory_iterator(root)) {
    const std::string name = entry.path().filename().string();
    if (name[0] == '.' || name.rfind("build", 0) == 0) continue;
    CAPTURE(name);
    CHECK(allowed.count(name) == 1);
  }
}
