#include <filesystem>
#include <fstream>
#include <iostream>
#include <iterator>

#include "cli/problem_file/problem.hpp"

namespace cli {

std::string read_file(const std::string& path) {
  if (path == "-") return {std::istreambuf_iterator<char>(std::cin), {}};
  std::error_code error;
  const auto status = std::filesystem::status(path, error);
  if (!std::filesystem::exists(status)) throw convex::InvalidInput("no such file; check the path");
  if (std::filesystem::is_directory(status))
    throw convex::InvalidInput("this is a directory; name the problem files in it");
  std::ifstream file(path, std::ios::binary);
  std::string text{std::istreambuf_iterator<char>(file), {}};
  if (!file) throw convex::InvalidInput("cannot be read; check its permissions");
  return text;
}

}  // namespace cli
