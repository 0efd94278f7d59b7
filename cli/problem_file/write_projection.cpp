#include "cli/problem_file/write_projection.hpp"

#include <fmt/format.h>

namespace cli::inline problem_files {
namespace {

using convex::Index;

template <typename Entries>
std::string list_text(const Entries& entries) {
  std::string text = "[";
  for (Index i = 0; i < entries.size(); ++i) text += fmt::format("{}{}", i > 0 ? ", " : "", entries[i]);
  return text + "]";
}

template <typename Rows>
std::string rows_text(const Rows& M) {
  std::string text = "[";
  for (Index i = 0; i < M.rows(); ++i) text += (i > 0 ? ",\n     " : "") + list_text(M.row(i));
  return text + "]";
}

std::string metric_text(const convex::Metric& A, const std::string& stem) {
  switch (A.kind()) {
    case convex::MetricKind::identity:
    case convex::MetricKind::diagonal:
      return fmt::format("{{ diagonal = {} }}", list_text(A.diagonal()));
    case convex::MetricKind::dense:
      return rows_text(A.dense_gram());
    case convex::MetricKind::sparse:
      break;
  }
  return fmt::format("{{ matrix_market = \"{}.A.mtx\" }}", stem);
}

}  // namespace

std::string projection_text(const convex::NearestPointProblem& problem, const std::string& comment,
                            const std::string& stem) {
  const std::string U = problem.U.is_sparse() ? fmt::format("{{ matrix_market = \"{}.U.mtx\" }}", stem)
                                              : rows_text(problem.U.dense());
  std::string text = fmt::format("{}[projection]\nA = {}\nz = {}\nU = {}\ns = {}\n", comment,
                                 metric_text(problem.A, stem), list_text(problem.z), U, list_text(problem.s));
  if (!problem.two_sided.empty()) {
    const Eigen::Map<const Eigen::Matrix<Index, Eigen::Dynamic, 1>> rows(
        problem.two_sided.data(), static_cast<Index>(problem.two_sided.size()));
    text += fmt::format("two_sided = {}\n", list_text(rows));
  }
  return text;
}

std::string matrix_market_text(const convex::SparseRows& M) {
  std::string text = fmt::format("%%MatrixMarket matrix coordinate real general\n{} {} {}\n", M.rows(),
                                 M.cols(), M.nonZeros());
  for (Index i = 0; i < M.rows(); ++i)
    for (convex::SparseRows::InnerIterator entry(M, i); entry; ++entry)
      text += fmt::format("{} {} {}\n", i + 1, entry.col() + 1, entry.value());
  return text;
}

}  // namespace cli::inline problem_files
