#include "convex/nearest_point/complementarity_grid/cut_obstacle.hpp"

#include <algorithm>
#include <cmath>

#include "convex/nearest_point/complementarity_grid/cut_multigrid.hpp"

namespace convex::inline complementarity_grid {
namespace {

constexpr int most_set_changes = 200;
/// After a change of the set its edge moves on by projected sweeps, a point each, for much less than a solve
/// costs; after so many changes the signs alone decide, for which an end is proved.
constexpr int sweeps_of_edge = 4, changes_with_sweeps = 20;
/// Of the correction, while the set still changes, and at the end.
constexpr double rough = 1e-3, fine_part = 1e-7;
/// Of the energy norm of q: what is left of a correction below it is rounding.
constexpr double least_part = 1e-13;
/// Values and multipliers this far below 0, relative to the largest, are 0 for all that the solve tells.
constexpr double digits = 1e-11;

class CutLevel {
 public:
  CutLevel(std::vector<const CutGrid*> grids, bool one_sided)
      : grid_(*grids.front()), multigrid_(std::move(grids)), one_sided_(one_sided) {
    found.held.assign(at(grid_.size()), 0);
    found.taut.assign(grid_.pendants.size(), 0);
    found.q.assign(at(grid_.size()), 0);
  }

  CutSolution found;

  /// The set of points where q = 0 and nothing lifts them; of the start all where the load is not above 0.
  void guess(bool is_first) {
    if (!one_sided_) return;
    for (Index k = 0; k < grid_.size(); ++k)
      found.held[at(k)] = grid_.kind[at(k)] == CutPoint::bounded && !(found.q[at(k)] > 0) &&
                          (!is_first || grid_.load[at(k)] <= 0);
    for (std::size_t a = 0; a < grid_.pendants.size(); ++a)
      found.taut[a] = found.q[at(grid_.pendants[a].point)] + grid_.pendants[a].shift < 0;
  }

  void solve(bool is_first) {
    std::vector<double> r;
    double part = rough;
    if (one_sided_ && !is_first) move_edge();
    for (int change = 0; change < most_set_changes; ++change) {
      for (std::size_t k = 0; k < found.q.size(); ++k)
        if (found.held[k] != 0) found.q[k] = 0;
      multigrid_.set_free(found.held, found.taut);
      multigrid_.residual(found.q, r);
      found.steps += multigrid_.correct(found.q, r, part, least_part * multigrid_.energy(found.q));
      if (one_sided_ && update()) {
        part = rough;
        if (change < changes_with_sweeps) move_edge();
        continue;
      }
      if (part == fine_part) {
        found.ended = true;
        break;
      }
      part = fine_part;
    }
    found.push.assign(at(grid_.size()), 0);
    for (Index k = 0; k < grid_.size(); ++k)
      if (found.held[at(k)] != 0) found.push[at(k)] = std::max(0.0, multigrid_.push(found.q, k));
  }

 private:
  /// The set as projected sweeps leave it.
  void move_edge() {
    for (std::size_t k = 0; k < found.q.size(); ++k)
      if (found.held[k] != 0) found.q[k] = 0;
    multigrid_.set_free(found.held, found.taut);
    multigrid_.relax(found.q, sweeps_of_edge);
    for (std::size_t k = 0; k < found.q.size(); ++k)
      found.held[k] = grid_.kind[k] == CutPoint::bounded && found.q[k] == 0;
    for (std::size_t a = 0; a < grid_.pendants.size(); ++a)
      found.taut[a] = found.q[at(grid_.pendants[a].point)] + grid_.pendants[a].shift < 0;
  }

  /// Points below 0 are held, held ones that are pulled are let go.
  bool update() {
    double largest = 0, push_scale = 0;
    for (Index k = 0; k < grid_.size(); ++k)
      if (grid_.is_unknown(k)) {
        largest = std::max(largest, std::abs(found.q[at(k)]));
        push_scale = std::max(push_scale, std::abs(grid_.load[at(k)]));
      }
    bool changed = false;
    for (Index k = 0; k < grid_.size(); ++k) {
      if (grid_.kind[at(k)] != CutPoint::bounded) continue;
      std::uint8_t& held = found.held[at(k)];
      if (held != 0 ? multigrid_.push(found.q, k) < -digits * push_scale
                    : found.q[at(k)] < -digits * largest) {
        held = held == 0;
        changed = true;
      }
    }
    for (std::size_t a = 0; a < grid_.pendants.size(); ++a) {
      const double y = found.q[at(grid_.pendants[a].point)] + grid_.pendants[a].shift;
      if (found.taut[a] != 0 ? y > digits * largest : y < -digits * largest) {
        found.taut[a] = found.taut[a] == 0;
        changed = true;
      }
    }
    return changed;
  }

  const CutGrid& grid_;
  CutMultigrid multigrid_;
  bool one_sided_;
};

}  // namespace

std::vector<CutSolution> solve_cut_grids(const std::vector<const CutGrid*>& grids, bool one_sided) {
  std::vector<CutSolution> found(grids.size());
  for (std::size_t l = grids.size(); l-- > 0;) {
    CutLevel level({grids.begin() + static_cast<std::ptrdiff_t>(l), grids.end()}, one_sided);
    const bool is_first = l + 1 == grids.size();
    if (!is_first) CutMultigrid::interpolate(*grids[l + 1], found[l + 1].q, *grids[l], level.found.q);
    level.guess(is_first);
    level.solve(is_first);
    found[l] = std::move(level.found);
  }
  return found;
}

}  // namespace convex::inline complementarity_grid
