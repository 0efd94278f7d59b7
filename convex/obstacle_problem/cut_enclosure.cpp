#include "convex/obstacle_problem/cut_enclosure.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "convex/obstacle_problem/cut_multigrid.hpp"

namespace convex::inline obstacle_problem {
namespace {

constexpr double nothing_proved = std::numeric_limits<double>::infinity();

/// A sum of products, and how far it may be from the exact one: each term is rounded when it is made (a
/// difference, a product) and once by every addition that follows (Higham 2002, section 3.1).
class RoundedSum {
 public:
  void add(double term) { add(term, std::abs(term)); }
  /// A term known to some roundings of `size`.
  void add(double term, double size) {
    value_ += term;
    size_ += size;
    ++terms_;
  }
  double low() const { return value_ - radius(); }
  double high() const { return value_ + radius(); }

 private:
  double radius() const {
    constexpr double unit = 0x1p-53, smallest = 0x1p-1000, of_a_term = 8;
    return (of_a_term + terms_) * unit * size_ + smallest;
  }
  double value_ = 0, size_ = 0, terms_ = 0;
};

/// (L q)_k.
RoundedSum linear_part(const CutGrid& grid, const std::vector<double>& q, Index k) {
  RoundedSum sum;
  sum.add(grid.pull[at(k)] * q[at(k)]);
  for (std::size_t axis = 0; axis < grid.dimension; ++axis) {
    const Index s = grid.stride(axis);
    sum.add(grid.link[axis][at(k)] * (q[at(k)] - q[at(k + s)]));
    sum.add(grid.link[axis][at(k - s)] * (q[at(k)] - q[at(k - s)]));
  }
  return sum;
}

/// The sums of the links of each unknown: what L w is to be, near the scale of its rounding at any cell.
std::vector<double> link_sums(const CutGrid& grid) {
  std::vector<double> sums(at(grid.size()));
  for (Index k = 0; k < grid.size(); ++k)
    if (grid.is_unknown(k))
      for (std::size_t axis = 0; axis < grid.dimension; ++axis)
        sums[at(k)] += grid.link[axis][at(k)] + grid.link[axis][at(k - grid.stride(axis))];
  return sums;
}

/// w with L w near the sums of links plus a multiple of the pull.
std::vector<double> barrier(const std::vector<const CutGrid*>& grids) {
  std::vector<CutGrid> copies;
  for (const CutGrid* grid : grids) {
    copies.push_back(*grid);
    copies.back().load = link_sums(*grid);
    copies.back().pendants.clear();
  }
  std::vector<const CutGrid*> loaded;
  for (const CutGrid& grid : copies) loaded.push_back(&grid);
  std::vector<double> w = std::move(solve_cut_grids(loaded, false).front().q);
  double largest = 0;
  for (Index k = 0; k < grids.front()->size(); ++k)
    if (grids.front()->is_unknown(k)) largest = std::max(largest, w[at(k)]);
  for (Index k = 0; k < grids.front()->size(); ++k)
    w[at(k)] = grids.front()->is_unknown(k) ? w[at(k)] + largest : 0;
  return w;
}

/// The equations of the same sets solved to rounding, what is below a bound put on it: rough residuals would
/// count as if they all had one sign.
std::vector<double> polished(const std::vector<const CutGrid*>& grids, const CutSolution& found) {
  const CutGrid& grid = *grids.front();
  std::vector<double> q = found.q;
  CutEquations equations(grid);
  equations.set_taut(found.taut);
  CutMultigrid multigrid(grids);
  multigrid.set_free(found.held, found.taut);
  multigrid.correct(equations, q, 0);
  for (Index k = 0; k < grid.size(); ++k)
    if (!grid.is_unknown(k))
      q[at(k)] = 0;
    else if (grid.kind[at(k)] == CutPoint::bounded)
      q[at(k)] = std::max(0.0, q[at(k)]);
  return q;
}

}  // namespace

double enclosed_error(const std::vector<const CutGrid*>& grids, const CutSolution& found) {
  const CutGrid& grid = *grids.front();
  if (!std::any_of(grid.pull.begin(), grid.pull.end(), [](double pull) { return pull > 0; }))
    return nothing_proved;
  const std::vector<double> q = polished(grids, found);
  double moved = 0;
  for (Index k = 0; k < grid.size(); ++k) {
    if (!grid.is_unknown(k)) continue;
    const double difference = std::abs(q[at(k)] - found.q[at(k)]);
    if (!std::isfinite(difference)) return nothing_proved;
    moved = std::max(moved, difference);
  }
  const std::vector<double> w = barrier(grids);
  std::vector<RoundedSum> pendants(at(grid.pendants.empty() ? 0 : grid.size()));
  for (const Pendant& pendant : grid.pendants) {
    const double here = q[at(pendant.point)], y = here + pendant.shift;
    if (y < 0)
      pendants[at(pendant.point)].add(pendant.conductance * y,
                                      pendant.conductance * (std::abs(here) + std::abs(pendant.shift)));
  }
  double delta = 0, highest = 0;
  for (Index k = 0; k < grid.size(); ++k) {
    if (!grid.is_unknown(k)) continue;
    RoundedSum slope = linear_part(grid, q, k);
    slope.add(-grid.load[at(k)]);
    double low = slope.low(), high = slope.high();
    if (!pendants.empty()) {
      low += pendants[at(k)].low();
      high += pendants[at(k)].high();
    }
    const double lift = linear_part(grid, w, k).low();
    if (!(lift > 0) || !(w[at(k)] > 0) || !std::isfinite(low) || !std::isfinite(high)) return nothing_proved;
    const bool is_at_bound = grid.kind[at(k)] == CutPoint::bounded && q[at(k)] == 0;
    delta = std::max({delta, -low / lift, is_at_bound ? 0 : high / lift});
    highest = std::max(highest, w[at(k)]);
  }
  constexpr double upwards = 1 + 0x1p-48;  // the few roundings of the bound itself
  return (delta * highest + moved) * upwards;
}

}  // namespace convex::inline obstacle_problem
