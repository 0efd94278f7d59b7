#include "tests/house/source_files.hpp"
#include "tests/this_build.hpp"

#include <fstream>
#include <regex>

namespace fs = std::filesystem;

namespace tests {

fs::path source_root() { return tests::source_folder(); }

std::string included(const std::string& line) {
  static const std::regex pattern("^\\s*#\\s*include\\s*[<\"]([^>\"]+)[>\"]");
  std::smatch match;
  return std::regex_search(line, match, pattern) ? match[1].str() : "";
}

std::vector<SourceFile> source_files() {
  std::vector<SourceFile> found;
  for (const char* room : {"convex", "mechanics", "cli", "tests"})
    for (const auto& entry : fs::recursive_directory_iterator(source_root() / room)) {
      const std::string extension = entry.path().extension().string();
      if (extension != ".hpp" && extension != ".cpp") continue;
      SourceFile file{fs::relative(entry.path(), source_root()).string(), room, {}};
      std::ifstream stream(entry.path());
      for (std::string line; std::getline(stream, line);) file.lines.push_back(line);
      found.push_back(std::move(file));
    }
  return found;
}

}  // namespace tests
