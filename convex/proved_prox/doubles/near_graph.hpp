#pragma once

#include <optional>

#include "convex/gamma0/call.hpp"
#include "convex/interval.hpp"
#include "convex/metric.hpp"

/// Proofs in doubles: a point and a covector near the graph of the subdifferential, with bounds on how near.
namespace convex::near_graphs {

/// A point and a covector of real numbers that are known to some rounding only:
///   |x'_i - x_i| <= x_radius_i but for a part of norm |.|₂ <= x_ball, and the same of v',
///   f(x') + f*(v') - x'·v' <= gap, and f(x') lies in f_x.
/// x, v and the radii: n each.
struct NearGraph {
  Vector x, x_radius, v, v_radius;
  double x_ball = 0, v_ball = 0;
  double gap = 0;
  Interval f_x;

  explicit NearGraph(Index n)
      : x(Vector::Zero(n)), x_radius(Vector::Zero(n)), v(Vector::Zero(n)), v_radius(Vector::Zero(n)) {}
  NearGraph(const Vector& point, const Vector& covector)
      : x(point), x_radius(Vector::Zero(point.size())), v(covector), v_radius(x_radius) {}

  void set_x(Index i, const Interval& a);
  void set_v(Index i, const Interval& a);
  Interval x_at(Index i) const;
  Interval v_at(Index i) const;
};

/// All that x'·v' may be.
Interval inner_product(const NearGraph& pair);
/// The same of the conjugate: x and v change places; f(x') + f*(v') is x'·v' to the gap.
NearGraph turned_round(NearGraph pair);

/// A pair of the function that a call means in the product of W, near x and v; none where there is no
/// formula in doubles, or it does not succeed. Functions of the system's library are trusted to
/// `library_units`; a number that was read from text counts as it is written.
std::optional<NearGraph> near_graph(const Call& f, const Metric& W, const Vector& x, const Vector& v);

}  // namespace convex::near_graphs
