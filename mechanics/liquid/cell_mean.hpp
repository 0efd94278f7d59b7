#pragma once

#include <cstdint>
#include <vector>

#include "convex/infinity.hpp"
#include "mechanics/liquid/hidden_values.hpp"

namespace mechanics::liquid {

/// A field as the loads of cells see it: one that may jump, or vary between the nodes.
class CellMean {
 public:
  /// `pressure_scale`: below a small part of it what is hidden does not count.
  CellMean(const Field&, const Domain&, const CutCells&, double pressure_scale);

  /// The value at x; but where the field takes other branches at nodes around k, or where its range over the
  /// cell says that much may hide there, its mean over what of the cell around k lies in the domain. Cells
  /// are halved along all axes, to a depth; what then is left counts by its corners.
  double operator()(convex::Index k, const Point& x);

  /// The most, in p, that a field makes between two nodes beside its mean: ∫ |h - mean| |s - node| over a
  /// cell, by area of a face.
  double hidden() const { return hidden_; }

 private:
  struct Sum {
    double total = 0, volume = 0;
    expression::Range values{convex::infinity, -convex::infinity};
  };
  struct Leaf {
    Point middle{};
    double value = 0, spread = 0, volume = 0;
  };
  bool is_at_jump(convex::Index k) const;
  Region cell_of(convex::Index k) const;
  Region region_of(const Places& first, const Places& last) const;
  double largest_hidden(const expression::Range& values) const;
  bool tells(const Places& first, const Places& last);
  double mean_of_leaves(convex::Index k, const Point& x);
  void gather(const Point& low, const Point& high, int halvings, double quiet, std::vector<Leaf>&) const;
  void add(const Point& low, const Point& high, int halvings, Sum&) const;
  void offer(const Point&, double volume, Sum&) const;
  const Field& field_;
  const Domain& domain_;
  const CutCells& cells_;
  double least_counted_ = 0, hidden_ = 0, leaves_ = 0;
  std::vector<std::uint64_t> branches_;  // by point; empty where the field has none
  std::vector<bool> varies_;             // by point; empty where no cell hides anything
};

}  // namespace mechanics::liquid
