#include <algorithm>
#include <cmath>

#include "convex/obstacle_problem/line_obstacle.hpp"
#include "convex/obstacle_problem/line_quadrature.hpp"

namespace convex::inline obstacle_problem {

double LineSolution::between(const LineObstacle& problem, const std::vector<double>& r,
                             const std::vector<double>& p, const std::vector<double>& flux, std::size_t cell,
                             double at) {
  const LineWeight w{problem.power};
  if (cell == 0 && problem.at_low.kind == LineEnd::Kind::centre) {
    const double inside = at > 0 ? cell_load(problem.h, w, 0, at).load * w.resistance(at, r[1]) : 0;
    return p[1] + inside + cell_load(problem.h, w, at, r[1]).moment;
  }
  return p[cell] + flux[cell] * w.resistance(r[cell], at) - cell_load(problem.h, w, r[cell], at).moment;
}

double LineSolution::p(double at) const {
  const auto above = std::upper_bound(r_.begin() + 1, r_.end() - 1, at);
  const auto cell = static_cast<std::size_t>(above - r_.begin()) - 1;
  if (held_[cell] && held_[cell + 1]) return 0;
  return between(problem_, r_, p_, flux_, cell, at);
}

std::vector<LinePiece> LineSolution::pieces() const {
  std::vector<LinePiece> found;
  for (std::size_t k = 0; k + 1 < r_.size(); ++k) {
    const bool positive =
        !(held_[k] && held_[k + 1]) || !(cell_load(problem_.h, {problem_.power}, r_[k], r_[k + 1]).load < 0);
    if (found.empty() || found.back().positive != positive)
      found.push_back({r_[k], r_[k + 1], positive});
    else
      found.back().high = r_[k + 1];
  }
  return found;
}

LineSolution::Extreme LineSolution::extreme(double sign) const {
  const bool centre = problem_.at_low.kind == LineEnd::Kind::centre;
  Extreme best{centre ? between(problem_, r_, p_, flux_, 0, 0) : p_[0], r_[0]};
  const auto offer = [&](double value, double at) {
    if (sign * value > sign * best.value) best = {value, at};
  };
  const LineWeight w{problem_.power};
  for (std::size_t k = centre ? 1 : 0; k < r_.size(); ++k) {
    offer(p_[k], r_[k]);
    if (k + 1 == r_.size() || (held_[k] && held_[k + 1])) continue;
    const double end = flux_[k] - cell_load(problem_.h, w, r_[k], r_[k + 1]).load;
    if (!(sign * flux_[k] > 0 && sign * end < 0)) continue;
    double a = r_[k], b = r_[k + 1];  // the flux turns its sign between
    for (int halving = 0; halving < 60; ++halving) {
      const double middle = 0.5 * (a + b);
      (sign * (flux_[k] - cell_load(problem_.h, w, r_[k], middle).load) > 0 ? a : b) = middle;
    }
    offer(between(problem_, r_, p_, flux_, k, a), a);
  }
  return best;
}

LineSolution::Extreme LineSolution::largest() const { return extreme(1); }
LineSolution::Extreme LineSolution::least() const { return extreme(-1); }

}  // namespace convex::inline obstacle_problem
