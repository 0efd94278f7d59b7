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

void SweepTable::write(JsonWriter& json, const SweepPoint& point) const {
  const auto number = [&](const std::string& name, double x) {
    json.key(name);
    std::isnan(x) ? json.null() : json.value(x == 0 ? 0.0 : x);
  };
  json.begin_object();
  for (std::size_t k = 0; k < keys_.size(); ++k) number(keys_[k], point.at[k]);
  json.key("status").value(point.status).key("active").begin_array();
  for (const convex::Index a : point.active) json.value(constraints_[static_cast<std::size_t>(a)]);
  json.end_array();
  if (has_changes_) json.key("change").value(point.is_change ? 1 : 0);
  for (std::size_t k = 0; k < watched_.size(); ++k)
    number(watched_[k].name, k < point.watched.size() ? point.watched[k] : NAN);
  number("error_bound", point.error_bound);
  if (!point.message.empty()) json.key("message").value(point.message);
  json.end_object();
}

std::string SweepTable::without_answer(const SweepPoint& point) const {
  std::string where;
  for (std::size_t k = 0; k < keys_.size(); ++k)
    where += (k > 0 ? ", " : "") + keys_[k] + " = " + number_cell(point.at[k]);
  return "at " + where + ": " + (point.message.empty() ? point.status : point.message);
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
