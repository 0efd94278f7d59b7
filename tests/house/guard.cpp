#include <doctest/doctest.h>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <regex>
#include <set>
#include <string>
#include <vector>

#include "tests/house/source_files.hpp"

namespace fs = std::filesystem;
using tests::included;
using tests::SourceFile;

namespace {

const fs::path root = tests::source_root();

bool begins_with_any(const std::string& text, const std::vector<std::string>& prefixes) {
  for (const std::string& prefix : prefixes)
    if (text.rfind(prefix, 0) == 0) return true;
  return false;
}

}  // namespace

TEST_CASE("heavy libraries stay behind the firewall: in no header of a room but the one for ceres::Jet") {
  const std::vector<std::string> heavy{"CGAL/",   "ceres/", "gmp",       "flint",     "arb",
                                       "toml++/", "CLI/",   "nlohmann/", "fmt/format"};
  for (const SourceFile& file : tests::source_files()) {
    if (file.room == "tests" || !file.is_header() || file.path == "mechanics/jet_system.hpp") continue;
    for (const std::string& line : file.lines) {
      CAPTURE(file.path);
      CAPTURE(line);
      CHECK_FALSE(begins_with_any(included(line), heavy));
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
      const std::string header = included(line);
      CAPTURE(file.path);
      CAPTURE(line);
      CHECK((header == "Eigen/SparseCore" || !begins_with_any(header, slow)));
    }
  }
}

TEST_CASE("nothing but tests includes the header for ceres::Jet") {
  for (const SourceFile& file : tests::source_files())
    for (const std::string& line : file.lines)
      if (file.room != "tests") CHECK(included(line) != "mechanics/jet_system.hpp");
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
