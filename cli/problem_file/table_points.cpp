#include "cli/problem_file/table_points.hpp"

#include <cmath>
#include <cstdlib>
#include <sstream>

#include "cli/problem_file/problem.hpp"

namespace cli::inline problem_files {
namespace {

bool is_number(const std::string& text, double& value) {
  char* end = nullptr;
  value = std::strtod(text.c_str(), &end);
  return !text.empty() && *end == '\0' && std::isfinite(value) &&
         text.find_first_of("xXpP") == std::string::npos;
}

}  // namespace

std::vector<std::string> table_cells(const std::string& line) {
  constexpr const char* blanks = " \t\r";
  const auto trimmed = [&](const std::string& text) {
    const std::size_t first = text.find_first_not_of(blanks);
    return first == std::string::npos ? "" : text.substr(first, text.find_last_not_of(blanks) - first + 1);
  };
  const std::string all = trimmed(line);
  std::vector<std::string> found;
  if (all.empty()) return found;
  const char mark = all.find(';') != std::string::npos ? ';' : all.find(',') != std::string::npos ? ',' : ' ';
  std::istringstream words(all);
  std::string word;
  if (mark == ' ')
    while (words >> word) found.push_back(word);
  else
    while (std::getline(words, word, mark)) found.push_back(trimmed(word));
  if (all.back() == mark) found.emplace_back();
  return found;
}

mechanics::TablePoints read_table_points(const std::string& file) {
  std::string text;
  try {
    text = read_file(file);
  } catch (const convex::InvalidInput& error) {
    throw convex::InvalidInput("the table " + file + ": " + error.what());
  }
  mechanics::TablePoints points;
  std::istringstream lines(text);
  int number = 0;
  bool may_be_heading = true;
  for (std::string line; std::getline(lines, line);) {
    ++number;
    const std::vector<std::string> row = table_cells(line);
    if (row.empty() || row[0].rfind('#', 0) == 0) continue;
    double x = 0, y = 0;
    if (row.size() == 2 && is_number(row[0], x) && is_number(row[1], y)) {
      points.x.push_back(x);
      points.y.push_back(y);
      points.x_text.push_back(row[0]);
      points.y_text.push_back(row[1]);
    } else if (!may_be_heading || row.size() != 2 || is_number(row[0], x) || is_number(row[1], y)) {
      throw convex::InvalidInput("the table " + file + ", line " + std::to_string(number) +
                                 ": not two numbers; give x and y on each line");
    }
    may_be_heading = false;
  }
  return points;
}

}  // namespace cli::inline problem_files
