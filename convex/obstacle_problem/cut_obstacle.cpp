#include "convex/obstacle_problem/cut_obstacle.hpp"

#include <algorithm>
#include <cmath>

#include "convex/obstacle_problem/cut_edge.hpp"
#include "convex/obstacle_problem/cut_multigrid.hpp"

namespace convex::inline obstacle_problem {
namespace {

constexpr int most_set_changes = 200;
/// After a change of the set its edge moves on by projected sweeps around it, a point or two each, for much
/// less than a solve costs; after so many changes the signs alone decide, for which an end is proved.
constexpr int first_sweeps = 4, sweeps_of_edge = 16, changes_with_sweeps = 20;
/// Of the correction, while the set still changes.
constexpr double rough = 1e-2;
/// Of the energy norm of q: what is left of a correction below it is rounding.
constexpr double least_part = 1e-13;
/// Values and multipliers this far below 0, relative to the largest, are 0 for all that the solve tells.
constexpr double digits = 1e-11;

class CutLevel {
 public:
  /// Of the grid chosen in the multigrid.
  CutLevel(const CutGrid& grid, CutMultigrid& multigrid, bool one_sided)
      : grid_(grid), equations_(grid), multigrid_(multigrid), one_sided_(one_sided) {
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
    double part = rough;
    rest_held();
    if (one_sided_ && !is_first) begin();
    for (int change = 0; change < most_set_changes; ++change) {
      equations_.set_taut(found.taut);
      multigrid_.set_free(found.held, found.taut);
      found.steps += multigrid_.correct(equations_, found.q, part, least_);
      if (change == 0) {
        least_ = least_part * equations_.energy(found.q);
        for (const double q : found.q) largest_ = std::max(largest_, std::abs(q));
      }
      if (one_sided_ && update()) {
        part = rough;
        if (change < changes_with_sweeps) move_edge();
        continue;
      }
      if (part < rough) {
        found.ended = true;
        break;
      }
      part = 0;
    }
    found.push.assign(at(grid_.size()), 0);
    for (Index k = 0; k < grid_.size(); ++k)
      if (found.held[at(k)] != 0) found.push[at(k)] = std::max(0.0, equations_.push(found.q, k));
  }

 private:
  /// From the values interpolated: what they have wrong from point to point is swept out first, or it would
  /// be all that a rough correction sees.
  void begin() {
    equations_.set_taut(found.taut);
    relax_all(equations_, first_sweeps, found.q);
    for (std::size_t k = 0; k < found.q.size(); ++k)
      found.held[k] = grid_.kind[k] == CutPoint::bounded && found.q[k] == 0;
    move_edge();
  }

  void rest_held() {
    for (std::size_t k = 0; k < found.q.size(); ++k)
      if (found.held[k] != 0) found.q[k] = 0;
  }

  /// The set as projected sweeps leave it.
  void move_edge() {
    equations_.set_taut(found.taut);
    relax_edge(equations_, sweeps_of_edge, found.held, found.q);
    for (std::size_t a = 0; a < grid_.pendants.size(); ++a)
      found.taut[a] = found.q[at(grid_.pendants[a].point)] + grid_.pendants[a].shift < 0;
  }

  /// Points below 0 are held, held ones that are pulled are let go.
  bool update() {
    const double least_push = -digits * equations_.largest_load(), least_value = -digits * largest_;
    bool changed = false;
    for (Index k = 0; k < grid_.size(); ++k) {
      std::uint8_t& held = found.held[at(k)];
      if (held != 0 ? equations_.push(found.q, k) >= least_push : found.q[at(k)] >= least_value) continue;
      if (grid_.kind[at(k)] != CutPoint::bounded) continue;
      held = held == 0;
      if (held != 0) found.q[at(k)] = 0;
      changed = true;
    }
    for (std::size_t a = 0; a < grid_.pendants.size(); ++a) {
      const double y = found.q[at(grid_.pendants[a].point)] + grid_.pendants[a].shift;
      if (found.taut[a] != 0 ? y > digits * largest_ : y < least_value) {
        found.taut[a] = found.taut[a] == 0;
        changed = true;
      }
    }
    return changed;
  }

  const CutGrid& grid_;
  CutEquations equations_;
  CutMultigrid& multigrid_;
  bool one_sided_;
  double largest_ = 0, least_ = 0;  ///< of q, and of corrections that are more than rounding
};

}  // namespace

std::vector<CutSolution> solve_cut_grids(const std::vector<const CutGrid*>& grids, bool one_sided) {
  std::vector<CutSolution> found(grids.size());
  CutMultigrid multigrid(grids);
  for (std::size_t l = grids.size(); l-- > 0;) {
    multigrid.choose(l);
    CutLevel level(*grids[l], multigrid, one_sided);
    const bool is_first = l + 1 == grids.size();
    if (!is_first) multigrid.interpolate(found[l + 1].q, level.found.q);
    level.guess(is_first);
    level.solve(is_first);
    found[l] = std::move(level.found);
  }
  return found;
}

}  // namespace convex::inline obstacle_problem
