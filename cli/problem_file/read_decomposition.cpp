#include "cli/function_language/parse_call.hpp"
#include "cli/problem_file/keys.hpp"
#include "cli/problem_file/kinds.hpp"
#include "cli/problem_file/numbers.hpp"
#include "cli/problem_file/read_metric.hpp"
#include "cli/problem_file/tables.hpp"
#include "convex/mistakes.hpp"

namespace cli::inline problem_files {

using convex::InvalidInput;

namespace {

convex::Fractions fractions_of(const convex::ExactVector& x) {
  convex::Fractions made;
  for (std::size_t i = 0; i < x.numerators.size(); ++i) made.push_back(convex::entry(x, i));
  return made;
}

/// The metric as it is written; of a matrix file, its doubles.
convex::ExactGram exact_metric_of(const TomlValue& value, const convex::Metric& W) {
  std::vector<convex::Fractions> rows;
  if (value.kind != TomlValue::Kind::table) {
    for (const convex::ExactVector& row : read_exact_matrix(value, "metric", W.dimension(), ""))
      rows.push_back(fractions_of(row));
    return convex::exact_gram(rows);
  }
  const TomlValue* diagonal = value.find("diagonal");
  if (diagonal == nullptr) return convex::exact_gram(W);
  const convex::Fractions d = fractions_of(read_exact_vector(*diagonal, "metric.diagonal"));
  for (std::size_t i = 0; i < d.size(); ++i) {
    rows.emplace_back(d.size());
    rows.back()[i] = d[i];
  }
  return convex::exact_gram(rows);
}

}  // namespace

DecompositionProblem read_decomposition(const TomlValue& given, const std::string& directory) {
  convex::Mistakes mistakes;
  const MeantTable meant(given, "decomposition", decomposition_keys, mistakes);
  const TomlValue& table = meant.table();
  const TomlValue *z = table.find("z"), *f = table.find("f"), *metric = table.find("metric");
  if ((z == nullptr || f == nullptr) && meant.is_whole())
    mistakes.add(InvalidInput(std::string("decomposition: ") +
                                  (f != nullptr   ? "z is missing; give the point, z = [3, -1]"
                                   : z != nullptr ? "f is missing; give a function, f = \"norm1()\""
                                                  : "z and f are missing; give both, z = [3, -1] and f = "
                                                    "\"norm1()\""),
                              table.place));
  const convex::Index n = length_of(z);  // known where its numbers are wrong, too
  convex::Vector point;
  convex::Call call;
  std::optional<convex::Metric> gram_metric;
  if (z != nullptr)
    mistakes.gather([&] {
      point = read_vector(*z, "z");
      if (n == 0) throw InvalidInput("z: empty; give at least one number", z->place);
    });
  if (f != nullptr)
    mistakes.gather([&] { call = parse_known_call(require_string(*f, "f"), "f", f->content); });
  if (metric != nullptr && n > 0)
    mistakes.gather([&] {
      gram_metric = read_metric(*metric, {"decomposition", "metric", directory, n, "one per entry of z"});
    });
  mistakes.tell();
  convex::Metric W = gram_metric ? *std::move(gram_metric) : convex::Metric::identity(n);
  // The document outlives no reading: what proofs need of it is copied.
  const std::optional<TomlValue> gram = metric == nullptr ? std::nullopt : std::optional(*metric);
  auto exact = [call, z = *z, gram, W] {
    return convex::SplitQuestion{call, fractions_of(read_exact_vector(z, "z")),
                                 gram ? exact_metric_of(*gram, W) : convex::exact_gram(W)};
  };
  return {std::move(point), std::move(W), std::move(call), std::move(exact)};
}

}  // namespace cli::inline problem_files
