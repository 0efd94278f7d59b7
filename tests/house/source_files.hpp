#pragma once

#include <filesystem>
#include <string>
#include <vector>

namespace tests {

/// A source file of the project, by lines.
struct SourceFile {
  std::string path;  ///< from the root
  std::string room;
  std::vector<std::string> lines;
  bool is_header() const { return path.ends_with(".hpp"); }
};

/// What a line includes, without brackets or quotes; "" when it includes nothing.
std::string included(const std::string& line);

/// The folder of the project.
std::filesystem::path source_root();

/// Every header and source of the rooms, tests included.
std::vector<SourceFile> source_files();

}  // namespace tests
