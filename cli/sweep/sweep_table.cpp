#include "cli/sweep/sweep_table.hpp"

#include <fmt/format.h>

#include <cmath>
#include <fstream>

#include "cli/problem_file/keys.hpp"

namespace cli::inline sweeps {
namespace {

/// A cell of RFC 4180.
std::string csv_cell(const std::string& text) {
  if (text.find_first_of(",\"\n") == std::string::npos) return text;
  std::string cell = "\"";
  for (const char c : text) cell += c == '"' ? std::string("\"\"") : std::string(1, c);
  return cell + "\"";
}

std::string number_cell(double x) {
  if (std::isnan(x)) return "";
  return fmt::format("{}", x == 0 ? 0.0 : x);
}

}  // namespace

std::string SweepTable::header() const {
  std::string line;
  for (const std::string& key : keys_) line += csv_cell(key) + ",";
  line += has_changes_ ? "status,active,change" : "status,active";
  for (const Watched& one : watched_) line += "," + csv_cell(one.name);
  return line + ",error_bound\n";
}

std::string SweepTable::active(const SweepPoint& point) const {
  std::string names;
  for (const convex::Index a : point.active)
    names += (names.empty() ? "" : " ") + constraints_[static_cast<std::size_t>(a)];
  return names;
}

std::string SweepTable::row(const SweepPoint& point) const {
  std::string line;
  for (const double value : point.at) line += number_cell(value) + ",";
  line += point.status + "," + csv_cell(active(point));
  if (has_changes_) line += point.is_change ? ",1" : ",0";
  for (const double value : point.watched) line += "," + number_cell(value);
  return line + "," + number_cell(point.error_bound) + "\n";
}

std::pair<std::uintmax_t, std::size_t> SweepTable::resumed(
    const std::string& file, const std::function<std::vector<double>(std::size_t)>& point) const {
  std::ifstream in(file, std::ios::binary);
  std::string line;
  if (!in || !std::getline(in, line)) return {0, 0};
  if (line + "\n" != header())
    throw convex::InvalidInput("--resume: " + shown(file) +
                               " has other columns; give its --over and --watch, or another file");
  std::uintmax_t bytes = line.size() + 1, kept = bytes;
  std::size_t points = 0;
  while (std::getline(in, line) && !in.eof()) {
    std::string expected;
    for (const double value : point(points)) expected += number_cell(value) + ",";
    if (line.rfind(expected, 0) == 0) {
      kept = bytes;  // the last point is done again: changes may follow it
      ++points;
    } else if (points == 0) {
      throw convex::InvalidInput("--resume: " + shown(file) + " begins with another point; give its --over");
    }
    bytes += line.size() + 1;
  }
  return points == 0 ? std::pair{std::uintmax_t{0}, points} : std::pair{kept, points - 1};
}

}  // namespace cli::inline sweeps
