#include "convex/atlas/cell_probability.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "convex/cones/exact_metric.hpp"
#include "convex/counted.hpp"
#include "convex/exact/elimination.hpp"
#include "convex/invalid_input.hpp"

namespace convex::atlas {
namespace {

/// Bounds on truncation fall so fast that a rule which is sure of a coarse tolerance often keeps a fine one:
/// the coarse one is tried first.
template <class Measure>
Probability to_tolerance(const Measure& measured, double tolerance) {
  constexpr double coarse = 64;
  const Probability quick = measured(coarse * tolerance);
  return not_negative(quick.error <= tolerance ? quick : measured(tolerance));
}

/// M v for the rows of M.
IntegerVector applied(const IntegerRows& M, const IntegerVector& v) {
  IntegerVector products;
  for (const IntegerVector& row : M) products.push_back(dot(row, v));
  return products;
}

/// An inward normal of the polyhedron as what it presses c by: primitive.
IntegerVector pressed(const IntegerRows& inverse, const IntegerVector& halfspace) {
  IntegerVector direction = applied(inverse, IntegerVector(halfspace.begin(), halfspace.end() - 1));
  make_primitive(direction);
  return direction;
}

/// Sets of variables that depend on each other: connected by entries of the Gram matrix that are not 0.
std::vector<Places> dependent_sets(const IntegerRows& gram) {
  std::vector<Places> sets;
  std::vector<bool> seen(gram.size(), false);
  for (std::size_t first = 0; first < gram.size(); ++first) {
    if (seen[first]) continue;
    Places set{first};
    seen[first] = true;
    for (std::size_t k = 0; k < set.size(); ++k)
      for (std::size_t j = 0; j < gram.size(); ++j)
        if (!seen[j] && !gram[set[k]][j].is_zero()) {
          seen[j] = true;
          set.push_back(j);
        }
    std::sort(set.begin(), set.end());
    sets.push_back(std::move(set));
  }
  return sets;
}

/// The variables mu of the first `count` places, of mean V w / scale and covariance V: normal with
/// variance 1.
NormalVariables normalised(const ExactInverse& V, const Places& places, const IntegerVector& weights,
                           const Integer& weight_unit, const Fraction& precision, std::size_t count) {
  std::vector<std::size_t> kept;
  for (std::size_t k = 0; k < places.size(); ++k)
    if (places[k] < count) kept.push_back(k);
  const auto size = static_cast<Index>(kept.size());
  NormalVariables of{Vector(size), Matrix::Zero(size, size)};
  for (std::size_t i = 0; i < kept.size(); ++i) {
    const IntegerVector& row = V.adjugate[kept[i]];
    const Integer& variance = row[kept[i]];
    Integer mean = 0;
    for (std::size_t k = 0; k < places.size(); ++k) mean += row[k] * weights[places[k]];
    // mean² / variance, with the true scale of both.
    const Fraction square =
        Fraction{mean * mean, V.determinant * weight_unit * weight_unit * variance} * precision;
    of.mean[static_cast<Index>(i)] = mean.sign() * std::sqrt(nearest_double(square));
    for (std::size_t j = 0; j < i; ++j) {
      const Integer& covariance = row[kept[j]];
      const Integer product = variance * V.adjugate[kept[j]][kept[j]], square_of = covariance * covariance;
      const double sine = std::sqrt(nearest_quotient(product - square_of, product)),
                   cosine = covariance.sign() * std::sqrt(nearest_quotient(square_of, product));
      of.angles(static_cast<Index>(i), static_cast<Index>(j)) = std::atan2(sine, cosine);
      of.angles(static_cast<Index>(j), static_cast<Index>(i)) = std::atan2(sine, cosine);
    }
  }
  return of;
}

}  // namespace

CellProbability::CellProbability(const RowSpace& space, const NormalLinearTerm& linear)
    : space_(space), levels_(faces(space.cone)), has_metric_covariance_(!linear.covariance) {
  if (linear.mean.size() != space.n)
    throw InvalidInput("mean: " + counted(linear.mean.size(), "entry", "entries") + "; give " +
                       std::to_string(space.n) + ", one per coordinate");
  mean_ = {applied(space.free_rows, linear.mean.numerators),
           linear.mean.denominator * space.factor.denominator};
  for (Integer& entry : mean_.numerators) entry *= space.factor.numerator;
  if (has_metric_covariance_) {
    precision_ = space.metric;
    precision_scale_ = space.gauge;
  } else {
    if (static_cast<Index>(linear.covariance->size()) != space.n)
      throw InvalidInput("covariance: " + counted(linear.covariance->size(), "row", "rows") + "; give " +
                         std::to_string(space.n) + ", one per coordinate");
    const ExactMetric covariance = exact_metric(*linear.covariance);
    IntegerRows of_c;
    for (const IntegerVector& row : space.free_rows) {
      const IntegerVector image = applied(covariance.gram, row);
      of_c.push_back(applied(space.free_rows, image));
    }
    const auto inverse = positive_definite_inverse(of_c);
    precision_ = inverse->adjugate;
    precision_scale_ = Fraction{covariance.denominator, inverse->determinant} / (space.factor * space.factor);
  }
  for (const IntegerVector& e : space.cone.equations) lines_.push_back(pressed(space.inverse, e));
}

std::vector<IntegerRows> CellProbability::normal_pieces(const Cell& cell) const {
  Places generators;
  for (const Index h : cell.face.halfspaces) generators.push_back(at(h));
  std::vector<Places> facets;
  const auto above = static_cast<std::size_t>(cell.face.dimension + 1);
  if (above < levels_.size())
    for (const ConeFace& looser : levels_[above])
      if (std::includes(cell.face.halfspaces.begin(), cell.face.halfspaces.end(), looser.halfspaces.begin(),
                        looser.halfspaces.end())) {
        facets.emplace_back();
        for (const Index h : looser.halfspaces) facets.back().push_back(at(h));
      }
  const auto dimension = static_cast<std::size_t>(space_.cone.dimension() - cell.face.dimension);
  std::vector<IntegerRows> pieces;
  for (const Places& piece : simplicial_pieces(generators, facets, dimension)) {
    pieces.emplace_back();
    for (const std::size_t h : piece)
      pieces.back().push_back(pressed(space_.inverse, space_.cone.halfspaces[h]));
  }
  return pieces;
}

Probability CellProbability::of_cone(const SignedCone& cone, const IntegerRows& others,
                                     const IntegerRows& lines, double tolerance) const {
  IntegerRows columns = cone.directions;
  columns.insert(columns.end(), others.begin(), others.end());
  const std::size_t count = columns.size();
  columns.insert(columns.end(), lines.begin(), lines.end());
  IntegerVector apart;  // mean - apex, over the product of their denominators
  for (std::size_t i = 0; i < mean_.numerators.size(); ++i)
    apart.push_back(mean_.numerators[i] * cone.apex.denominator -
                    cone.apex.numerators[i] * mean_.denominator);
  const Integer unit = mean_.denominator * cone.apex.denominator;
  IntegerRows gram;
  IntegerVector weights;
  for (const IntegerVector& d : columns) {
    const IntegerVector image = applied(precision_, d);
    gram.push_back(applied(columns, image));
    weights.push_back(dot(image, apart));
  }
  Probability product{1, 0, true};
  for (const Places& set : dependent_sets(gram)) {
    if (set.front() >= count) continue;
    IntegerRows block;
    for (const std::size_t i : set) {
      block.emplace_back();
      for (const std::size_t j : set) block.back().push_back(gram[i][j]);
    }
    const auto V = positive_definite_inverse(block);
    product =
        product * orthant_probability(normalised(*V, set, weights, unit, precision_scale_, count), tolerance);
  }
  return product;
}

Probability CellProbability::of(const std::vector<SignedCone>& cones, const IntegerRows& others,
                                const IntegerRows& lines, double tolerance) const {
  Probability sum;
  for (const SignedCone& cone : cones)
    add(sum, cone.sign, of_cone(cone, others, lines, tolerance / static_cast<double>(cones.size())));
  return sum;
}

Probability CellProbability::of(const Cell& cell, double tolerance) const {
  return to_tolerance([&](double part) { return product_or_sum(cell, part); }, tolerance);
}

Probability CellProbability::product_or_sum(const Cell& cell, double tolerance) const {
  const std::vector<SignedCone> cones = signed_cones(space_.cone, levels_, cell.face);
  const std::vector<IntegerRows> pieces = normal_pieces(cell);
  const double share = tolerance / static_cast<double>(2 * pieces.size());
  if (!has_metric_covariance_) {
    Probability sum;
    for (const IntegerRows& piece : pieces) add(sum, 1, of(cones, piece, lines_, share));
    return sum;
  }
  Probability normal;
  SignedCone pressing{1, cones.front().apex, {}};
  for (const IntegerRows& piece : pieces) add(normal, 1, of_cone(pressing, piece, lines_, share));
  return of(cones, {}, {}, tolerance / 2) * normal;
}

Probability CellProbability::of(const IntegerRows& halfspaces, double tolerance) const {
  ExactRows outward;
  for (IntegerVector row : halfspaces) {
    for (Integer& entry : row) entry = -entry;
    outward.push_back({std::move(row), 1});
  }
  IntegerVector ahead(space_.rank + 1, 0);
  ahead.back() = -1;
  outward.push_back({std::move(ahead), 1});
  const PolyhedralCone cone = halfspace_cone(outward, {}, static_cast<Index>(space_.rank + 1));
  // A part without interior, or with none at all, has the probability 0.
  if (!cone.equations.empty()) return {};
  const std::vector<std::vector<ConeFace>> levels = faces(cone);
  IntegerRows lines = cone.lines;
  for (IntegerVector& line : lines) line.pop_back();
  const std::vector<SignedCone> cones = signed_cones(cone, levels, levels.back().front());
  return to_tolerance([&](double part) { return of(cones, {}, lines, part); }, tolerance);
}

}  // namespace convex::atlas
