#include "convex/nearest_point/reductions/joined_islands.hpp"

#include <algorithm>
#include <cmath>

#include "convex/nearest_point/optimality/kkt_residual.hpp"
#include "convex/nearest_point/optimality/residuals.hpp"

namespace convex::inline reductions {

JoinedIslands::JoinedIslands(const NearestPointProblem& whole) : whole_(whole) {
  solution_.method = "active-set";
  solution_.q = Vector::Zero(whole.dimension());
  solution_.lambda = Vector::Zero(whole.rows());
  solution_.slack = Vector::Zero(whole.rows());
}

void JoinedIslands::add(Solution part, const std::vector<Index>& coordinates,
                        const std::vector<Index>& rows) {
  for (std::size_t i = 0; i < coordinates.size(); ++i)
    solution_.q[coordinates[i]] = part.q[static_cast<Index>(i)];
  for (std::size_t k = 0; k < rows.size(); ++k) {
    solution_.lambda[rows[k]] = part.lambda[static_cast<Index>(k)];
    solution_.slack[rows[k]] = part.slack[static_cast<Index>(k)];
  }
  for (Index k : part.basis) solution_.basis.push_back(rows[at(k)]);
  error_ += part.error_bound * part.error_bound;
  rounding_ += part.rounding * part.rounding;
  acceleration_ += part.acceleration_norm * part.acceleration_norm;
  linear_ += part.force_norm * part.force_norm;
  solution_.steps += part.steps;
  for (Island island : part.model.islands) {
    if (!coordinates.empty()) island.first_coordinate = coordinates[at(island.first_coordinate)];
    solution_.model.islands.push_back(island);
  }
  for (LeftOutRow out : part.model.left_out) solution_.model.left_out.push_back({rows[at(out.row)], out.why});
  if (solution_.undecided.empty()) solution_.undecided = part.undecided;
  const double flops = part.model.flops();
  // The name of the whole is that of its hardest island.
  if (flops > most_flops_) {
    most_flops_ = flops;
    solution_.method = part.method;
  }
}

void JoinedIslands::fail(Solution part, const std::vector<Index>& rows) {
  failed_ = true;
  solution_ = Solution{};
  solution_.status = part.status;
  solution_.method = part.method;
  solution_.steps = part.steps;
  solution_.undecided = part.undecided;
  solution_.model = std::move(part.model);
  solution_.farkas = Vector::Zero(whole_.rows());
  if (part.farkas.size() == static_cast<Index>(rows.size()))
    for (std::size_t k = 0; k < rows.size(); ++k)
      solution_.farkas[rows[k]] = part.farkas[static_cast<Index>(k)];
}

void JoinedIslands::leave_out(Index row, LeftOutBecause why) {
  if (failed_) return;
  solution_.model.left_out.push_back({row, why});
  unsolved_.push_back(row);
}

Solution JoinedIslands::finish(const Accuracy& accuracy) {
  if (failed_) return std::move(solution_);
  if (!unsolved_.empty()) {
    const DoubleDoubleVector q(solution_.q);
    for (Index a : unsolved_) solution_.slack[a] = slack(whole_, a, q).value();
  }
  std::sort(solution_.model.islands.begin(), solution_.model.islands.end(),
            [](const Island& a, const Island& b) { return a.first_coordinate < b.first_coordinate; });
  std::sort(solution_.model.left_out.begin(), solution_.model.left_out.end(),
            [](const LeftOutRow& a, const LeftOutRow& b) { return a.row < b.row; });
  solution_.error_bound = std::sqrt(error_);
  solution_.rounding = std::sqrt(rounding_);
  solution_.acceleration_norm = std::sqrt(acceleration_);
  solution_.force_norm = std::sqrt(linear_);
  solution_.residuals = residuals(whole_, solution_);
  solution_.status = solution_.is_within(accuracy) && (whole_.radii || solution_.undecided.empty())
                         ? Status::solved
                         : Status::inaccurate;
  return std::move(solution_);
}

}  // namespace convex::inline reductions
