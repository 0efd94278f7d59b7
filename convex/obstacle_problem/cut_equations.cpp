#include "convex/obstacle_problem/cut_equations.hpp"

#include <algorithm>
#include <cmath>

namespace convex::inline obstacle_problem {

CutEquations::CutEquations(const CutGrid& grid) : grid_(grid), load_(&grid.load), pull_(&grid.pull) {
  for (const double load : grid.load) largest_load_ = std::max(largest_load_, std::abs(load));
  if (grid.pendants.empty()) return;
  loaded_ = grid.load;
  pulled_ = grid.pull;
  load_ = &loaded_;
  pull_ = &pulled_;
}

void CutEquations::set_taut(const std::vector<std::uint8_t>& taut) {
  for (const Pendant& pendant : grid_.pendants) {
    loaded_[at(pendant.point)] = grid_.load[at(pendant.point)];
    pulled_[at(pendant.point)] = grid_.pull[at(pendant.point)];
  }
  for (std::size_t a = 0; a < taut.size(); ++a) {
    if (!taut[a]) continue;
    const Pendant& pendant = grid_.pendants[a];
    pulled_[at(pendant.point)] += pendant.conductance;
    loaded_[at(pendant.point)] -= pendant.conductance * pendant.shift;
  }
}

CutRow<double> CutEquations::row(Index first) const {
  CutRow<double> made{grid_.points[0], grid_.dimension, {}, {}, pull_->data() + first};
  for (std::size_t axis = 0; axis < grid_.dimension; ++axis) {
    made.link[axis] = grid_.link[axis].data() + first;
    made.stride[axis] = grid_.stride(axis);
  }
  return made;
}

double CutEquations::diagonal(Index k) const {
  double sum = (*pull_)[at(k)];
  for (std::size_t axis = 0; axis < grid_.dimension; ++axis)
    sum += grid_.link[axis][at(k)] + grid_.link[axis][at(k - grid_.stride(axis))];
  return sum;
}

double CutEquations::push(const std::vector<double>& q, Index k) const {
  double sum = (*pull_)[at(k)] * q[at(k)] - (*load_)[at(k)];
  for (std::size_t axis = 0; axis < grid_.dimension; ++axis) {
    const Index s = grid_.stride(axis);
    sum += grid_.link[axis][at(k)] * (q[at(k)] - q[at(k + s)]) +
           grid_.link[axis][at(k - s)] * (q[at(k)] - q[at(k - s)]);
  }
  return sum;
}

double CutEquations::minimum(const std::vector<double>& q, Index k, double otherwise) const {
  double sum = (*load_)[at(k)], diagonal = (*pull_)[at(k)];
  for (std::size_t axis = 0; axis < grid_.dimension; ++axis) {
    const Index s = grid_.stride(axis);
    const double* link = grid_.link[axis].data() + k;
    sum += link[0] * q[at(k + s)] + link[-s] * q[at(k - s)];
    diagonal += link[0] + link[-s];
  }
  return diagonal > 0 ? sum / diagonal : otherwise;
}

double CutEquations::energy(const std::vector<double>& q) const {
  double sum = 0;
  for (std::size_t k = 0; k < q.size(); ++k) sum += std::abs((*load_)[k] * q[k]);
  return std::isfinite(sum) ? std::sqrt(sum) : 0;
}

}  // namespace convex::inline obstacle_problem
