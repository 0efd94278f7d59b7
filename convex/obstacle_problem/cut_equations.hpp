#pragma once

#include <vector>

#include "convex/obstacle_problem/cut_grid.hpp"
#include "convex/obstacle_problem/cut_kernels.hpp"

namespace convex::inline obstacle_problem {

/// The equations of a grid in doubles, with some of its pendants taut: Σ links (q_i - q_j) + pull q_i =
/// load_i.
class CutEquations {
 public:
  /// No pendant is taut. The grid must outlive this.
  explicit CutEquations(const CutGrid&);
  CutEquations(const CutEquations&) = delete;
  CutEquations& operator=(const CutEquations&) = delete;
  /// taut: by pendant, whether y = 0.
  void set_taut(const std::vector<std::uint8_t>& taut);
  const CutGrid& grid() const { return grid_; }

  /// A row from its point 0 on.
  CutRow<double> row(Index first) const;
  const double* load(Index first) const { return load_->data() + first; }
  double diagonal(Index point) const;
  /// Σ links (q_i - q_j) + pull q_i - load_i: what pushes a held point.
  double push(const std::vector<double>& q, Index point) const;
  /// Where q_i is, the others given, at its minimum; `otherwise` where nothing holds it.
  double minimum(const std::vector<double>& q, Index point, double otherwise) const;
  /// The root of Σ |load q|: the energy norm of a solution q; 0 beyond doubles.
  double energy(const std::vector<double>& q) const;
  double largest_load() const { return largest_load_; }

 private:
  const CutGrid& grid_;
  std::vector<double> loaded_, pulled_;  ///< with the taut pendants; empty without any
  const std::vector<double>* load_;
  const std::vector<double>* pull_;
  double largest_load_ = 0;
};

}  // namespace convex::inline obstacle_problem
