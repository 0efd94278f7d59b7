#include <doctest/doctest.h>
#include <unistd.h>

#include <algorithm>
#include <atomic>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <map>
#include <regex>
#include <set>
#include <string>
#include <thread>
#include <vector>

#include "tests/house/source_files.hpp"

namespace fs = std::filesystem;
using tests::SourceFile;

namespace {

/// What is precompiled beside Eigen for all headers, since most of the time would go there; and by what names
/// a header shows that it needs one of these.
const std::map<std::string, std::regex> precompiled{
    {"array", std::regex("std::array\\b")},
    {"functional", std::regex("std::function\\b")},
    {"map", std::regex("std::(multi)?map\\b")},
    {"memory", std::regex("std::(unique_ptr|shared_ptr|weak_ptr|make_unique|make_shared)\\b")},
    {"optional", std::regex("std::(optional|nullopt|make_optional)\\b")},
    {"span", std::regex("std::span\\b")},
    {"string", std::regex("std::(string|to_string|getline)\\b")},
    {"variant", std::regex("std::(variant|visit|monostate|get_if|holds_alternative)\\b")},
    {"vector", std::regex("std::vector\\b")}};

/// What a file includes, itself and by what it includes of the project's.
std::set<std::string> included_by(const std::string& path,
                                  const std::map<std::string, const SourceFile*>& files) {
  std::set<std::string> found;
  std::vector<std::string> open{path};
  while (!open.empty()) {
    const auto file = files.find(open.back());
    open.pop_back();
    if (file == files.end()) continue;
    for (const std::string& line : file->second->lines)
      if (const std::string name = tests::included(line); !name.empty() && found.insert(name).second)
        open.push_back(name);
  }
  return found;
}

}  // namespace

TEST_CASE("what a header names of the standard library it includes, or what it includes does") {
  const std::vector<SourceFile> sources = tests::source_files();
  std::map<std::string, const SourceFile*> files;
  for (const SourceFile& file : sources) files[file.path] = &file;
  for (const SourceFile& file : sources) {
    if (!file.is_header() || file.room == "tests") continue;
    const std::set<std::string> seen = included_by(file.path, files);
    for (const auto& [header, names] : precompiled) {
      if (seen.contains(header)) continue;
      CAPTURE(file.path);
      CAPTURE(header);
      CHECK(std::ranges::none_of(file.lines,
                                 [&names](const auto& line) { return std::regex_search(line, names); }));
    }
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
  // Eigen is precompiled too: what lacks convex/vector.hpp shows all the same.
  const fs::path first = fs::temp_directory_path() / ("moreau_house_" + std::to_string(getpid()) + ".hpp");
  std::string texts = "#include <Eigen/Core>\n#include <Eigen/SparseCore>\n";
  for (const auto& [header, names] : precompiled) texts += "#include <" + header + ">\n";
  std::ofstream(first) << texts;
  const std::string compiler = std::string(MOREAU_COMPILER) + " -std=c++20 -isystem " + MOREAU_EIGEN + " ";
  const std::string compiled = first.string() + ".gch";
  CHECK(std::system((compiler + "-x c++-header " + first.string() + " -o " + compiled).c_str()) == 0);

  std::vector<int> outcomes(headers.size(), -1);
  std::atomic<std::size_t> next = 0;
  const auto work = [&] {
    for (std::size_t i; (i = next++) < headers.size();)
      outcomes[i] =
          std::system(("echo '#include \"" + headers[i] + "\"' | " + compiler + "-include " + first.string() +
                       " -fsyntax-only -x c++ -I" + tests::source_root().string() + " -")
                          .c_str());
  };
  std::vector<std::thread> workers;
  for (unsigned k = 0; k < std::max(1U, std::thread::hardware_concurrency()); ++k) workers.emplace_back(work);
  for (std::thread& worker : workers) worker.join();
  for (std::size_t i = 0; i < headers.size(); ++i) {
    CAPTURE(headers[i]);
    CHECK(outcomes[i] == 0);
  }
  fs::remove(first);
  fs::remove(compiled);
}
