#pragma once

#include <vector>

#include "convex/nearest_point/complementarity_grid/cut_grid.hpp"

namespace convex::inline complementarity_grid {

/// Conjugate gradients on the free unknowns of the finest of some grids, each made of the even points of the
/// one before, with a V-cycle as preconditioner (Brandt 1977; truncated to free sets as by Kornhuber 1994):
/// each grid has its own equations of the same problem; a red-black sweep before and, in reverse, after;
/// linear interpolation, over what is known around a point (beyond a wall nothing is), and its transpose.
class CutMultigrid {
 public:
  /// `grids`: finest first; they must outlive this.
  explicit CutMultigrid(std::vector<const CutGrid*> grids);

  /// held: 1 on unknowns of the finest grid kept as they are; taut: by pendant, whether y = 0. On coarser
  /// grids a point is held when the fine one at its place is, a pendant taut when one of a neighbour is.
  void set_free(const std::vector<std::uint8_t>& held, const std::vector<std::uint8_t>& taut);
  /// The residual of q on the free points, 0 elsewhere; its largest entry over the diagonal's root.
  double residual(const std::vector<double>& q, std::vector<double>& r) const;
  /// q += the correction for the residual r, to `part` of its energy norm, or until what is left of it is
  /// about `least`. Steps taken.
  Index correct(std::vector<double>& q, std::vector<double>& r, double part, double least = 0);
  /// The root of Σ |load q| on the free points: the energy norm of a solution q; 0 beyond doubles.
  double energy(const std::vector<double>& q) const;
  /// Projected red-black sweeps on the finest grid, with the pendants that are taut: each point in turn to
  /// its own minimum, not below its bound. A bound is met exactly, by 0.
  void relax(std::vector<double>& q, int sweeps) const;
  /// Σ links (q_i - q_j) + pull q_i - load_i and what taut pendants add: what pushes a held point.
  double push(const std::vector<double>& q, Index point) const;
  static void interpolate(const CutGrid& coarse, const std::vector<double>& from, const CutGrid& fine,
                          std::vector<double>& to);

 private:
  struct Level {
    const CutGrid* grid;
    std::vector<double> diagonal, inverse, u, r, rest, scale;
    std::vector<std::uint8_t> free;
  };
  static void sweep(Level&, Index slab, bool red);
  static void first_sweep(Level&, Index slab);
  static void apply_row(const Level&, const double* u, Index first, double* out);
  static std::vector<double> interpolation_scale(const CutGrid& fine, const CutGrid& coarse);
  static void rest(Level&, Index slab);
  void restrict_rest(const Level& fine, Level& coarse, Index slab);
  void add_coarse(Level& fine, const Level& coarse, Index slab);
  void cycle(std::size_t level);
  std::vector<Level> levels_;
  std::vector<double> load_, pull_, p_, Ap_, sum_, row_;
};

}  // namespace convex::inline complementarity_grid
