#pragma once

#include <vector>

#include "mechanics/liquid/cut_cells.hpp"

namespace mechanics::liquid {

/// A pressure known at nodes and where the boundary cuts links, evaluated between them.
class GridPressure {
 public:
  GridPressure(CutCells cells, std::vector<double> q);

  /// By a polynomial of degree 2 fitted to what is known within some two steps, weights falling off from the
  /// point; on a node, what is known there. NaN where the domain is so thin that nothing is known near.
  double operator()(const Point&) const;
  /// At a node of the grid inside or on the boundary; NaN elsewhere.
  double at_node(convex::Index k) const;
  const CutCells& cells() const { return cells_; }

 private:
  struct Known {
    Point at;
    double p, weight;
  };
  std::vector<Known> around(const Point&, double reach) const;
  CutCells cells_;
  std::vector<double> q_;
};

}  // namespace mechanics::liquid
