#include <array>
#include <cstdint>
#include <filesystem>
#include <fstream>
#include <iostream>
#include <string_view>
#include <utility>

#include "cli/problem_file/problem.hpp"

namespace cli::inline problem_files {
namespace {

/// All there is, in large pieces.
std::string read_all(std::istream& in, std::uintmax_t expected) {
  std::string text;
  constexpr std::uintmax_t largest = std::uintmax_t{1} << 33;
  if (expected < largest) text.reserve(static_cast<std::size_t>(expected));
  std::array<char, 65536> piece;
  while (in.read(piece.data(), piece.size()), in.gcount() > 0)
    text.append(piece.data(), static_cast<std::size_t>(in.gcount()));
  return text;
}

/// The mark of UTF-8 that some programs put before a text is none of it.
std::string without_mark(std::string text) {
  constexpr std::string_view mark = "\xEF\xBB\xBF";
  if (text.starts_with(mark)) text.erase(0, mark.size());
  return text;
}

}  // namespace

std::string read_file(const std::string& path) {
  if (path == "-") return without_mark(read_all(std::cin, 0));
  std::error_code error;
  const auto status = std::filesystem::status(path, error);
  if (!std::filesystem::exists(status)) throw convex::InvalidInput("no such file; check the path");
  if (std::filesystem::is_directory(status))
    throw convex::InvalidInput("this is a directory; name the problem files in it");
  std::ifstream file(path, std::ios::binary);
  std::string text;
  if (file)
    text = read_all(file,
                    std::filesystem::is_regular_file(status) ? std::filesystem::file_size(path, error) : 0);
  if (!file.is_open() || file.bad()) throw convex::InvalidInput("cannot be read; check its permissions");
  return without_mark(std::move(text));
}

}  // namespace cli::inline problem_files
