#include "cli/function_language/parse_call.hpp"
#include "cli/problem_file/keys.hpp"
#include "cli/problem_file/numbers.hpp"
#include "cli/problem_file/read_metric.hpp"
#include "cli/problem_file/tables.hpp"

namespace cli {

using convex::InvalidInput;

DecompositionProblem read_decomposition(const TomlValue& table, const std::string& directory) {
  require_known_keys(table, "decomposition", {"z", "f", "metric"});
  const TomlValue *z = table.find("z"), *f = table.find("f"), *metric = table.find("metric");
  if (z == nullptr || f == nullptr)
    throw InvalidInput("decomposition: z and f are needed; give both, z = [3, -1] and f = \"norm1()\"",
                       table.place);
  convex::Vector point = read_vector(*z, "z");
  if (point.size() == 0) throw InvalidInput("z: empty; give at least one number", z->place);
  const convex::Index n = point.size();
  convex::Metric W =
      metric == nullptr
          ? convex::Metric::identity(n)
          : read_metric(*metric, {"decomposition", "metric", directory, n, "one per entry of z"});
  return {std::move(point), std::move(W), parse_call(require_string(*f, "f"), "f", f->content)};
}

}  // namespace cli
