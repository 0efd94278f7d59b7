#include "cli/problem_file/keys.hpp"
#include "cli/problem_file/kinds.hpp"
#include "cli/problem_file/numbers.hpp"
#include "cli/problem_file/read_metric.hpp"
#include "cli/problem_file/tables.hpp"
#include "convex/counted.hpp"

namespace cli::inline problem_files {
namespace {

using convex::Index;
using convex::InvalidInput;

/// Exact arithmetic on cones ends long before this; beyond it even {0} has too many equations.
constexpr Index largest_dimension = 1000;

/// Of how many entries the rows are, and where that is said.
struct Dimension {
  Index n = 0;
  std::string why;
};

Dimension stated_dimension(const TomlValue& value) {
  if (value.kind != TomlValue::Kind::integer || value.number < 1 ||
      value.number > static_cast<double>(largest_dimension))
    throw InvalidInput("dimension: " + shown(value.text) + " is not an integer from 1 to " +
                           std::to_string(largest_dimension) +
                           "; give that of the space, as in dimension = 3",
                       value.place);
  return {static_cast<Index>(value.number), "the dimension"};
}

/// The first vector among the rows and z tells; without one the file has to.
Dimension dimension_of(const TomlValue& table, const std::vector<std::string>& keys) {
  const auto from = [](const TomlValue& vector, const std::string& where) {
    const auto n = static_cast<Index>(require_array(vector, where).array.size());
    if (n < 1 || n > largest_dimension)
      throw InvalidInput(where + ": " + convex::counted(n, "entry", "entries") + "; give from 1 to " +
                             std::to_string(largest_dimension),
                         vector.place);
    return Dimension{n, "as many as " + where + " has"};
  };
  for (const std::string& key : keys)
    if (const TomlValue* rows = table.find(key))
      if (!require_array(*rows, key).array.empty()) return from(rows->array.front(), key + "[0]");
  if (const TomlValue* z = table.find("z")) return from(*z, "z");
  if (const TomlValue* stated = table.find("dimension")) return stated_dimension(*stated);
  throw InvalidInput("cone: no row and no z tells the dimension; give it, as in dimension = 3", table.place);
}

convex::ExactMetric cone_metric(const TomlValue* value, const std::string& directory,
                                const Dimension& dimension) {
  const auto& [n, why] = dimension;
  if (value == nullptr) return convex::identity_metric(n);
  const convex::Metric rounded = read_metric(*value, {"cone", "metric", directory, n, why});
  try {
    if (value->kind == TomlValue::Kind::array)
      return convex::exact_metric(read_exact_matrix(*value, "metric", n, why));
    if (const TomlValue* diagonal = value->find("diagonal")) {
      const convex::ExactVector d = read_exact_vector(*diagonal, "metric.diagonal");
      convex::ExactRows rows(static_cast<std::size_t>(n),
                             {convex::IntegerVector(static_cast<std::size_t>(n), 0), d.denominator});
      for (std::size_t i = 0; i < rows.size(); ++i) rows[i].numerators[i] = d.numerators[i];
      return convex::exact_metric(rows);
    }
    return convex::exact_metric(rounded);
  } catch (const InvalidInput& error) {
    throw InvalidInput(error.what(), error.place().value_or(value->place));
  }
}

}  // namespace

ConeProblem read_cone(const TomlValue& given, const std::string& directory) {
  convex::Mistakes mistakes;
  const MeantTable meant(given, "cone", cone_keys, mistakes);
  const TomlValue& table = meant.table();
  const TomlEntry *of_generators = nullptr, *of_halfspaces = nullptr;
  for (const TomlEntry& entry : table.table) {
    if (entry.key == "generators" || entry.key == "lines") of_generators = &entry;
    if (entry.key == "halfspaces" || entry.key == "equations") of_halfspaces = &entry;
  }
  if (of_generators != nullptr && of_halfspaces != nullptr)
    mistakes.add(InvalidInput("cone: both " + of_generators->key + " and " + of_halfspaces->key +
                                  "; a cone is given by generators and lines or by halfspaces and equations",
                              of_halfspaces->place));
  if (of_generators == nullptr && of_halfspaces == nullptr && meant.is_whole())
    mistakes.add(InvalidInput(
        "cone: no generators and no halfspaces; give one, as in generators = [[1, 0], [1, 1]]", table.place));
  ConeProblem cone;
  cone.by_halfspaces = of_halfspaces != nullptr;
  const std::string rows = cone.by_halfspaces ? "halfspaces" : "generators";
  const std::string two_way = cone.by_halfspaces ? "equations" : "lines";
  Dimension dimension;
  try {
    dimension = dimension_of(table, {rows, two_way});
  } catch (const InvalidInput& error) {
    if (meant.is_whole()) mistakes.add(error);  // otherwise a vector may stand under the wrong key
    mistakes.tell();
  }
  cone.n = dimension.n;
  const auto read = [&](const std::string& key, const auto& work) {
    if (const TomlValue* value = table.find(key)) mistakes.gather([&] { work(*value); });
  };
  read("dimension", [&](const TomlValue& stated) {
    if (const Index n = stated_dimension(stated).n; n != cone.n)
      throw InvalidInput("dimension: " + std::to_string(n) + "; give " + std::to_string(cone.n) + ", " +
                             dimension.why + ", or leave it out",
                         stated.place);
  });
  read(rows,
       [&](const TomlValue& value) { cone.rows = read_exact_matrix(value, rows, cone.n, dimension.why); });
  read(two_way, [&](const TomlValue& value) {
    cone.two_way = read_exact_matrix(value, two_way, cone.n, dimension.why);
  });
  read("z", [&](const TomlValue& z) {
    if (const Index n = entries_of(&z); n >= 0 && n != cone.n)
      mistakes.add(InvalidInput("z: " + convex::counted(n, "entry", "entries") + "; give " +
                                    std::to_string(cone.n) + ", " + dimension.why,
                                z.place));
    cone.z = read_exact_vector(z, "z");
  });
  mistakes.gather([&] { cone.W = cone_metric(table.find("metric"), directory, dimension); });
  mistakes.tell();
  return cone;
}

}  // namespace cli::inline problem_files
