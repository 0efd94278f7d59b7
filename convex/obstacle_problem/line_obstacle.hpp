#pragma once

#include <functional>
#include <vector>

#include "convex/vector.hpp"

namespace convex::inline obstacle_problem {

/// What holds at an end of a line: p = value; or p >= 0 and ∂p/∂n >= value with equality where p > 0 (n
/// outward); or nothing, the end being the centre r = 0 of a weight that vanishes there.
struct LineEnd {
  enum class Kind { value, flux, centre };
  Kind kind = Kind::value;
  double value = 0;
};

/// The obstacle problem on low <= r <= high with the weight w = r^power: the least p >= 0 with -(w p')' >= w
/// h and the conditions at its ends. power: 0 on a line; 1, 2 for what is radial in two and three dimensions.
/// An end of the kind `centre` is low = 0, with power > 0.
struct LineObstacle {
  int power = 0;
  double low = 0, high = 1;
  LineEnd at_low, at_high;
  std::function<double(double)> h;
  /// At most how far h is from a polynomial of degree 11 between two points, so that nothing hides between
  /// those at which h is evaluated; empty: not known.
  std::function<double(double, double)> departure = {};
  /// At most |∫ h| over parts of what is between two points, for an h without bound there, with the power 0;
  /// empty: not known.
  std::function<double(double, double)> mass = {};
  /// An h that varies faster than so many cells resolve is given up; the error bound says so where departures
  /// are known.
  Index most_cells = 20000;
};

/// A maximal interval where p > 0 (liquid) or p = 0 (not).
struct LinePiece {
  double low = 0, high = 0;
  bool positive = true;
};

/// p by its values and fluxes w p' at nodes that are dense where p ends; between them by quadrature.
class LineSolution {
 public:
  enum class Status { solved, infeasible };
  Status status = Status::solved;
  /// Σ of the loads where no end has a given value; infeasible where it is positive.
  double surplus = 0;
  /// At most so far from p, rounding and edges included, as long as the quadrature resolves h.
  double error_bound = 0;
  bool low_parts = false, high_parts = false;  ///< the inequality at an end of the kind flux is strict
  Index nodes = 0;

  double p(double r) const;
  /// The nodes, and where p = 0 is held by the obstacle or given.
  const std::vector<double>& places() const { return r_; }
  bool is_held(std::size_t node) const { return held_[node]; }
  std::vector<LinePiece> pieces() const;
  struct Extreme {
    double value, at;
  };
  Extreme largest() const;
  Extreme least() const;

  /// p in a cell from the values and fluxes at its ends; the first cell may be that of the centre.
  static double between(const LineObstacle&, const std::vector<double>& r, const std::vector<double>& p,
                        const std::vector<double>& flux, std::size_t cell, double at);

 private:
  friend LineSolution solve_line(const LineObstacle&, bool);
  Extreme extreme(double sign) const;
  LineObstacle problem_;
  std::vector<double> r_, p_, flux_;  // flux just right of a node; of the centre's cell just left of its end
  std::vector<bool> held_;            // p = 0 there, pushed
};

/// `one_sided` false: equality everywhere, p of any sign; for the least value that tells whether the
/// inequalities matter. Without a given value at an end the sum of the loads must then be 0, and the p is the
/// one whose least value is 0. Exact three-point equations on cells that are halved until the quadrature of h
/// is exact to rounding and the edges of p > 0 are known to rounding; primal-dual active sets on them.
LineSolution solve_line(const LineObstacle&, bool one_sided = true);

}  // namespace convex::inline obstacle_problem
