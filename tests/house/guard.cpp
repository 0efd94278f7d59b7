#include <doctest/doctest.h>
#include <unistd.h>

#include <algorithm>
#include <atomic>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <regex>
#include <set>
#include <string>
#include <thread>
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

TEST_CASE("every header of the library compiles alone") {
  // These include Ceres', PETSc's, DAQP's and Python's own.
  const auto needs_more = [](const std::string& path) {
    return path == "mechanics/jet_system.hpp" || path == "cli/measurement/peer_module/daqp_program.hpp" ||
           path == "cli/python/options.hpp" || path.starts_with("cli/petsc/");
  };
  std::vector<std::string> headers;
  for (const SourceFile& file : tests::source_files())
    if (file.is_header() && file.room != "tests" && !needs_more(file.path)) headers.push_back(file.path);
  // Eigen is precompiled: it is most of the time, and what lacks convex/vector.hpp shows all the same.
  const fs::path eigen = fs::temp_directory_path() / ("moreau_house_" + std::to_string(getpid()) + ".hpp");
  std::ofstream(eigen) << "#include <Eigen/Core>\n#include <Eigen/SparseCore>\n";
  const std::string compiler = std::string(MOREAU_COMPILER) + " -std=c++20 -isystem " + MOREAU_EIGEN + " ";
  const std::string precompiled = eigen.string() + ".gch";
  CHECK(std::system((compiler + "-x c++-header " + eigen.string() + " -o " + precompiled).c_str()) == 0);

  std::vector<int> outcomes(headers.size(), -1);
  std::atomic<std::size_t> next = 0;
  const auto work = [&] {
    for (std::size_t i; (i = next++) < headers.size();)
      outcomes[i] = std::system(("echo '#include \"" + headers[i] + "\"' | " + compiler + "-include " +
                                 eigen.string() + " -fsyntax-only -x c++ -I" + root.string() + " -")
                                    .c_str());
  };
  std::vector<std::thread> workers;
  for (unsigned k = 0; k < std::max(1U, std::thread::hardware_concurrency()); ++k) workers.emplace_back(work);
  for (std::thread& worker : workers) worker.join();
  for (std::size_t i = 0; i < headers.size(); ++i) {
    CAPTURE(headers[i]);
    CHECK(outcomes[i] == 0);
  }
  fs::remove(eigen);
  fs::remove(precompiled);
}
