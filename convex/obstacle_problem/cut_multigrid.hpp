#pragma once

#include <vector>

#include "convex/obstacle_problem/cut_equations.hpp"
#include "convex/obstacle_problem/cut_kernels.hpp"

namespace convex::inline obstacle_problem {

/// Conjugate gradients on the free unknowns of one of some grids, each made of the even points of the one
/// before, with a V-cycle as preconditioner (Brandt 1977; truncated to free sets as by Kornhuber 1994): each
/// grid has its own equations of the same problem; a red-black sweep before and, in reverse, after; linear
/// interpolation, over what is known around a point (beyond a wall nothing is), and its transpose. All of it
/// in single precision, corrections of a residual in doubles.
class CutMultigrid {
 public:
  /// `grids`: finest first; they must outlive this.
  explicit CutMultigrid(const std::vector<const CutGrid*>& grids);

  /// Which of the grids is solved for; at first the finest.
  void choose(std::size_t grid);
  /// held: 1 on unknowns kept as they are; taut: by pendant, whether y = 0. On coarser grids a point is held
  /// when the fine one at its place is, a pendant taut when one of a neighbour is; what is held begins
  /// between their points, to which those beside are tied by the shorter links that finite volumes have.
  void set_free(const std::vector<std::uint8_t>& held, std::vector<std::uint8_t> taut);

  /// q += the correction for its residual in these equations, the grid's, to `part` of its energy norm, or
  /// until what is left is about `least` or rounding. V-cycles taken.
  Index correct(const CutEquations&, std::vector<double>& q, double part, double least = 0);
  /// From the next coarser grid to the one chosen, over what is known around a point.
  void interpolate(const std::vector<double>& from, std::vector<double>& to) const;

 private:
  /// How far what is held begins before and behind a point along each axis, in steps of the grid; 1 where the
  /// neighbour is free.
  using Edges = std::array<float, 6>;
  struct Level {
    const CutGrid* grid;
    std::array<std::vector<float>, 3> link;
    std::vector<float> pull;           ///< with the taut pendants, and the ties to what is held
    std::vector<Edges> edges;          ///< of free points; empty on the grid solved for
    std::vector<Index> tied;           ///< where pull has a tie
    std::vector<float> diagonal;       ///< the same; 0 on points that are not unknown
    std::vector<float> inverse;        ///< of the diagonal; 0 where not free
    std::vector<float> scale, weight;  ///< of the interpolation; 0 where not free
    std::vector<float> u, r;
    std::vector<float> even, odd;  ///< 1 on every other point of a row, else 0
    std::vector<float> rest;       ///< of four slabs
    bool is_free(Index k) const { return inverse[static_cast<std::size_t>(k)] > 0; }
    CutRow<float> row(Index first) const;
    const float* colour(Index j, Index k, bool red) const {
      return ((j + k) % 2 == 0) == red ? even.data() : odd.data();
    }
    Index size_of_slab() const {
      return grid->dimension == 1 ? grid->size() : grid->stride(grid->dimension - 1);
    }
    /// Of a point, the sum of its links and pull.
    float sum_at(Index k) const;
  };
  Level level_of(const CutGrid&) const;
  void set_taut(Level&, const std::vector<std::uint8_t>& taut) const;
  static void tie_to_held(const Level& fine, Level& coarse);
  static void sweep(Level&, Index slab, bool red);
  static void first_sweep(Level&, Index slab);
  static void find_rest(Level&, Index slab);
  void restrict_rest(const Level& fine, Level& coarse, Index slab);
  void add_coarse(Level& fine, const Level& coarse, Index slab);
  void relax_coarsest(Level&);
  template <class SlabDone>
  void cycle(std::size_t level, SlabDone slab_done);
  struct Direction {
    double energy = 0, curvature = 0;  ///< r·z and p·Ap; 0 at the end
  };
  Direction step(Index count, double curvature);
  std::vector<Level> levels_;
  std::size_t top_ = 0;
  double unit_ = 1;  ///< of links and pull
  std::vector<float> p_, Ap_, x_, mean_;
  std::array<std::vector<float>, 4> sum_;
};

}  // namespace convex::inline obstacle_problem
