#include "mechanics/rounded_data.hpp"

#include <algorithm>

#include "convex/infinity.hpp"
#include "convex/invalid_input.hpp"
#include "convex/nearest_point/entry_radii.hpp"
#include "convex/nearest_point/proof/decided_in_fractions.hpp"
#include "convex/nearest_point/proof/enclosure.hpp"
#include "convex/nearest_point/proof/exact_method.hpp"

namespace mechanics {
namespace {

using convex::EntryRadii;
using convex::ExactProblem;
using convex::ExactSolution;
using convex::NearestPointProblem;
using convex::Status;

convex::SparseMatrix entries(const convex::Metric& A) {
  switch (A.kind()) {
    case convex::MetricKind::sparse:
      return A.sparse_gram();
    case convex::MetricKind::dense:
      return A.dense_gram().sparseView();
    default:
      return convex::Matrix(A.diagonal().asDiagonal()).sparseView();
  }
}

EntryRadii one_rounding(const NearestPointProblem& problem) {
  const auto part = [](const auto& numbers) { return (convex::unit_roundoff * numbers.cwiseAbs()).eval(); };
  const convex::SparseRows rows =
      problem.U.is_sparse() ? problem.U.sparse() : convex::SparseRows(problem.U.dense().sparseView());
  return {part(entries(problem.A)), part(problem.z), part(rows), part(problem.s)};
}

/// The solution of the data, from the rows of the answer; none where they cannot be had or take too long.
std::optional<ExactSolution> in_fractions(const std::optional<ExactProblem>& exact,
                                          const convex::Solution& answer, const GaussOptions& options) {
  if (!exact) return std::nullopt;
  const double most = options.accuracy.limit * convex::most_word_operations;
  const auto held = static_cast<std::size_t>(std::min(exact->rows(), exact->dimension()));
  if (convex::word_operations(*exact, held) > most) return std::nullopt;
  ExactSolution found = convex::exact_active_set(*exact, answer.basis, most);
  if (found.status == Status::gave_up) return std::nullopt;
  return found;
}

}  // namespace

void count_rounding_of_data(GaussSolution& found, const NearestPointProblem& problem,
                            const GaussOptions& options,
                            const std::function<std::optional<ExactProblem>()>& data) {
  convex::Solution& answer = found.primal;
  const bool is_answer = answer.status == Status::solved || answer.status == Status::inaccurate;
  if (!is_answer && answer.status != Status::infeasible) return;
  const double most = options.accuracy.tolerance * std::max(1.0, answer.acceleration_norm);
  double error = convex::infinity;
  if (is_answer) error = convex::enclosed_error(problem, one_rounding(problem), answer).value_or(error);
  std::optional<ExactSolution> truth;
  if (!(error <= most)) {
    const std::optional<ExactProblem> exact = data();
    truth = in_fractions(exact, answer, options);
    if (truth && truth->status == Status::solved && is_answer)
      error = convex::distance_above(*exact, answer.q, truth->q);
  }
  if (is_answer) {
    answer.error_bound = std::max(answer.error_bound, error);
    if (!(answer.error_bound <= most)) answer.status = Status::inaccurate;
  } else if (!truth || truth->status != Status::infeasible) {
    answer.status = Status::gave_up;
    answer.farkas.resize(0);
  }
  if (answer.undecided.empty() && answer.status != Status::solved && answer.status != Status::infeasible)
    answer.undecided = is_answer ? convex::open_question::conditioning : convex::open_question::contradiction;
}

}  // namespace mechanics
