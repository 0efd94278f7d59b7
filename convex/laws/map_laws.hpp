#pragma once

#include <functional>
#include <optional>
#include <vector>

#include "convex/cones/exact_metric.hpp"

namespace convex::inline law_checks {

/// T z: a fraction for each entry, within `radius` of the number that is meant; 0: it is that number.
struct MapImage {
  ExactVector value;
  double radius = 0;
};

/// ∂T_i/∂x_j: n·n fractions by rows, each within `radius` of the derivative.
struct MapDerivative {
  std::vector<Fraction> entries;
  double radius = 0;
};

/// A map of R^n into itself, at points in fractions; none where it has no value for all that is known.
struct Map {
  Index n = 0;
  std::function<std::optional<MapImage>(const ExactVector&)> at;
  /// T z in doubles, not finite where it has no value; empty: `at` tells.
  std::function<Vector(const Vector&)> in_doubles = {};
  /// Where T is known to be continuously differentiable; empty: unknown.
  std::function<std::optional<MapDerivative>(const ExactVector&)> derivative = {};
  /// Of one variable: points at or next to which its formula changes, increasing, those found between two
  /// bounds and beyond; empty: unknown.
  std::function<std::vector<Fraction>(double low, double high)> kinks = {};
};

/// A map in doubles, as C++ has it. `relative_error`: of its values, at most; a few roundings unless told.
Map map_of(std::function<Vector(const Vector&)> T, Index n, double relative_error = 64 * unit_roundoff);

/// Two laws that a prox obeys, and that make a map of R^n one (Moreau 1965, corollary 10.c): in the metric
///   nonexpansive: ||Tx - Ty|| <= ||x - y||;
///   cyclically monotone (Rockafellar 1966), that is a subgradient of a convex function: on every cycle of
///   points Σ (T x_i | x_i - x_(i+1)) >= 0.
/// And one that follows from the second where T is differentiable, second derivatives being symmetric:
///   symmetric: S = W T' has S_ij = S_ji.
enum class MapLaw { nonexpansive, cyclically_monotone, symmetric };

/// S_ij and S_ji of S = W T', whose difference is known to within `radius`.
struct UnequalEntries {
  Index i = 0, j = 0;
  Fraction S_ij, S_ji;
  double radius = 0;
};

/// Points at which a law fails, in their order, with their images, and by how much: ||Tx - Ty||² - ||x -
/// y||², -Σ (T x_i | x_i - x_(i+1)), or |S_ij - S_ji|, a positive fraction. Where images or entries have a
/// radius, all numbers within it fail.
struct MapCounterexample {
  MapLaw law = MapLaw::nonexpansive;
  std::vector<ExactVector> points;
  std::vector<MapImage> images;
  Fraction excess;
  std::optional<UnequalEntries> entries = {};  ///< where the law is symmetric
};

/// Where to look.
struct MapSamples {
  double low = -4, high = 4;  ///< of every coordinate
  Index points = 90;          ///< in the box, beside close pairs and polygons
  Index longest_cycle = 6;    ///< through the points
  unsigned seed = 1;
  std::vector<ExactVector> given = {};  ///< these points alone, when there are any
};

/// What sampling came to. It can refute; without a counterexample nothing is proved.
struct MapVerdict {
  std::optional<MapCounterexample> counterexample;
  Index points = 0;     ///< at which the map had a value
  Index undefined = 0;  ///< at which it had none
  Index polygons = 0;
  Index symmetric_at = 0;  ///< points at which derivatives show W T' to be symmetric
  /// The largest |S_ij - S_ji| over the largest |S_ij|, S = W T' by derivatives, or where there are none by
  /// central differences, which decide nothing.
  double asymmetry = 0;
};

/// Looks for the shortest cycle. Throws InvalidInput when the metric does not fit.
MapVerdict laws(const Map& T, const ExactMetric& W, const MapSamples& samples = {});

/// Whether the points break the law, in fractions: the counterexample, or none.
std::optional<MapCounterexample> broken(const Map& T, const ExactMetric& W, MapLaw law,
                                        const std::vector<ExactVector>& points);

}  // namespace convex::inline law_checks
