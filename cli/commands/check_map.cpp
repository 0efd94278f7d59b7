#include "cli/commands/check_map.hpp"

#include <CLI/CLI.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <fstream>

#include "cli/each_file.hpp"
#include "cli/function_language/parse_metric.hpp"
#include "cli/problem_file/keys.hpp"
#include "cli/problem_file/problem.hpp"
#include "cli/problem_file/table_points.hpp"
#include "cli/report/map_report.hpp"
#include "mechanics/map_text.hpp"

namespace cli::inline commands {
namespace {

using convex::ExactVector;
using convex::Fraction;
using convex::Index;
using convex::InvalidInput;

/// "[a, b]" by its commas outside of brackets; a text without brackets around it is one component.
std::vector<mechanics::Text> components(const std::string& text) {
  const std::size_t first = text.find_first_not_of(' '), last = text.find_last_not_of(' ');
  if (first == std::string::npos) throw InvalidInput("--map: empty; write \"[x1/2, max(x2, 0)]\"");
  if (text[first] != '[') return {{text, {}}};
  if (text[last] != ']')
    throw InvalidInput("no ] closes the [; add it", convex::Place{1, static_cast<int>(first) + 1});
  std::vector<mechanics::Text> parts;
  std::size_t begin = first + 1;
  int depth = 0;
  for (std::size_t k = begin; k <= last; ++k) {
    if (text[k] == '(' || text[k] == '[') ++depth;
    if (text[k] == ')' || (text[k] == ']' && k < last)) --depth;
    if (k < last && (text[k] != ',' || depth > 0)) continue;
    parts.push_back({text.substr(begin, k - begin), {1, static_cast<int>(begin) + 1}});
    begin = k + 1;
  }
  return parts;
}

/// Rows z_1, …, z_n, T_1, …, T_n of decimals or fractions; a first row without a number is a heading.
struct MapTable {
  Index n = 0;
  std::vector<ExactVector> z, Tz;
};

MapTable read_map_table(const std::string& path) {
  MapTable table;
  std::istringstream lines(read_file(path));
  int number = 0;
  bool may_be_heading = true;
  for (std::string line; std::getline(lines, line);) {
    ++number;
    std::vector<Fraction> row;
    const std::vector<std::string> cells = table_cells(line);
    if (cells.empty()) continue;
    for (const std::string& cell : cells)
      if (const auto value = convex::read_fraction(cell)) row.push_back(*value);
    const bool is_row = row.size() == cells.size();
    if (may_be_heading && row.empty()) {
      may_be_heading = false;
      continue;
    }
    may_be_heading = false;
    const bool fits = is_row && row.size() >= 2 && row.size() % 2 == 0 &&
                      (table.n == 0 || static_cast<Index>(row.size()) == 2 * table.n);
    if (!fits)
      throw InvalidInput("no row of numbers z1, …, zn, T1, …, Tn; give every row as many",
                         convex::Place{number, 1});
    const auto half = static_cast<std::ptrdiff_t>(row.size() / 2);
    table.n = static_cast<Index>(half);
    table.z.push_back(convex::exact_vector(std::vector<Fraction>(row.begin(), row.begin() + half)));
    table.Tz.push_back(convex::exact_vector(std::vector<Fraction>(row.begin() + half, row.end())));
  }
  if (table.z.size() < 2) throw InvalidInput(path + ": fewer than two points; give a row each");
  return table;
}

convex::Map map_of_table(const MapTable& table) {
  return {table.n, [&table](const ExactVector& z) -> std::optional<convex::MapImage> {
            for (std::size_t k = 0; k < table.z.size(); ++k)
              if (table.z[k].numerators == z.numerators && table.z[k].denominator == z.denominator)
                return convex::MapImage{table.Tz[k], 0};
            return std::nullopt;
          }};
}

/// The function of one variable whose prox goes through the points of the table.
std::optional<convex::symbolic::ExactCurve> function_of_table(const MapTable& table) {
  std::vector<std::pair<Fraction, Fraction>> points;
  for (std::size_t k = 0; k < table.z.size(); ++k)
    points.emplace_back(entry(table.z[k], 0), entry(table.Tz[k], 0));
  std::sort(points.begin(), points.end(), [](const auto& a, const auto& b) { return a.first < b.first; });
  std::vector<Fraction> z, Tz;
  for (const auto& [at, value] : points) {
    if (!z.empty() && z.back() == at) continue;  // a second value would have been refuted
    z.push_back(at);
    Tz.push_back(value);
  }
  if (z.size() < 2) return std::nullopt;
  return function_of_prox(convex::joined_pieces(z, Tz));
}

void read_box(const MapOptions& options, convex::MapSamples& samples) {
  if (!options.box) return;
  const std::size_t colon = options.box->find(':');
  const auto low = convex::read_fraction(options.box->substr(0, colon));
  const auto high =
      colon == std::string::npos ? std::nullopt : convex::read_fraction(options.box->substr(colon + 1));
  if (!low || !high)
    throw InvalidInput("--box " + shown(*options.box) +
                       ": no range of numbers; write low:high, such as -4:4");
  samples.low = convex::nearest_double(*low);
  samples.high = convex::nearest_double(*high);
}

JudgedMap judged(const MapOptions& options, Source& source) {
  convex::MapSamples samples;
  source = {"--box", options.box.value_or("")};
  read_box(options, samples);
  JudgedMap answer;
  std::optional<MapTable> table;
  std::optional<convex::Map> T;
  if (options.table) {
    source = {*options.table, ""};
    table = read_map_table(*options.table);
    samples.given = table->z;
    T = map_of_table(*table);
    answer.is_table = true;
    answer.source = *options.table;
  } else {
    source = {"--map", *options.map};
    T = mechanics::map_of_text(components(*options.map));
    answer.source = *options.map;
  }
  convex::ExactMetric W = convex::identity_metric(T->n);
  if (options.metric) {
    source = {"--metric", *options.metric};
    W = convex::exact_metric(parse_metric(*options.metric));
  }
  answer.seen = convex::seen_range(*T, samples.low, samples.high);
  answer.verdict = laws(*T, W, samples);
  if (answer.verdict.points == 0)
    throw InvalidInput("the map has no value at any point tried; give another --box");
  if (answer.is_refuted()) return answer;
  if (table) {
    if (table->n == 1) answer.function = function_of_table(*table);
    return answer;
  }
  if (T->n == 1)
    if (const auto pieces = convex::seen_pieces(*T, samples.low, samples.high)) {
      answer.function = function_of_prox(*pieces);
      // In the product w x y the function is w times as large.
      if (answer.function)
        answer.function = convex::symbolic::scale(*answer.function, Fraction{W.gram[0][0], W.denominator});
    }
  constexpr Index along = 21, most_coordinates = 2;
  if (T->n <= most_coordinates) answer.grid = convex::potential(*T, W, samples.low, samples.high, along);
  return answer;
}

}  // namespace

const char* MapOptions::given_amiss() const {
  if (metric && !is_given())
    return "--metric goes with --map or --table, a file has its own; leave it out, or set it in the file";
  if (box && !map) return "--box goes with --map; leave it out";
  if (data && !map) return "--data goes with --map; leave it out";
  return nullptr;
}

void add_map(CLI::App& command, MapOptions& options) {
  command
      .add_option("--map", options.map,
                  "is this map a prox? Its components in x, or in x1, x2, …: \"[x1/2, max(x2, 0)]\"")
      ->type_name("T");
  command.add_option("--table", options.table, "is this one? Rows z1, …, zn, T1, …, Tn")->type_name("F.csv");
  command
      .add_option("--metric", options.metric,
                  "with --map or --table: the Gram matrix of the product; default identity")
      ->type_name("MATRIX");
  command.add_option("--box", options.box, "with --map: where to look, for every coordinate; default -4:4")
      ->type_name("LOW:HIGH");
  add_table(command, "--data", options.data,
            "with --map: where it is not refuted, z, T z and f(T z) on a grid");
}

Exit check_map(const MapOptions& options, const Printing& printing) {
  Source source;
  return answered(printing, source, [&] {
    const JudgedMap answer = judged(options, source);
    if (options.data && !answer.grid.empty()) {
      source = {"--data", *options.data};
      std::ofstream file(*options.data);
      file << potential_table(answer);
      if (!file.flush())
        throw InvalidInput("cannot write " + *options.data + "; check its folder and permissions");
    }
    if (printing.json)
      fmt::print("{}\n", map_json(answer));
    else if (!printing.quiet)
      fmt::print("{}", map_text(answer));
    return answer.is_refuted() ? Exit::no_solution : Exit::solved;
  });
}

}  // namespace cli::inline commands
