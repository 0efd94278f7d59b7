#pragma once

#include <cstdint>

#include "mechanics/liquid/cut_cells.hpp"

namespace mechanics::liquid {

/// A field that may jump, as loads of cells see it.
class CellMean {
 public:
  CellMean(const Field&, const Domain&, const CutCells&);

  /// The value at x; but where the field takes other branches at nodes around k, its mean over what of the
  /// cell around k lies in the domain. Cells that take more than one branch are halved along all axes, to a
  /// depth; what then is left counts by its corners.
  double operator()(convex::Index k, const Point& x) const;

 private:
  struct Sum {
    double total = 0, volume = 0;
  };
  bool is_at_jump(convex::Index k) const;
  void add(const Point& low, const Point& high, int halvings, Sum&) const;
  void offer(const Point&, double volume, Sum&) const;
  const Field& field_;
  const Domain& domain_;
  const CutCells& cells_;
  std::vector<std::uint64_t> branches_;  // by point; empty where the field has none
};

}  // namespace mechanics::liquid
