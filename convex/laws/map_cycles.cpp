#include "convex/laws/map_cycles.hpp"

#include <cmath>
#include <numbers>

#include "convex/exact/fraction_arithmetic.hpp"

namespace convex::inline law_checks {
namespace {

ExactVector exact_difference(const ExactVector& a, const ExactVector& b) {
  ExactVector d{{}, a.denominator * b.denominator};
  for (std::size_t i = 0; i < a.numerators.size(); ++i)
    d.numerators.push_back(a.numerators[i] * b.denominator - b.numerators[i] * a.denominator);
  return d;
}

}  // namespace

Matrix rounded_gram(const ExactMetric& W) {
  const Index n = W.dimension();
  Matrix gram(n, n);
  for (Index i = 0; i < n; ++i) gram.row(i) = nearest({W.gram[static_cast<std::size_t>(i)], W.denominator});
  return gram;
}

namespace {

/// A few units of the last place of what the allowances for radii are made of.
constexpr double allowance = 1 + 0x1p-40;

}  // namespace

std::optional<MapCounterexample> pair_broken(const ExactMetric& W, std::vector<ExactVector> points,
                                             std::vector<MapImage> images) {
  const ExactVector there = exact_difference(images[0].value, images[1].value),
                    here = exact_difference(points[0], points[1]);
  const Fraction excess = inner(W, there, there) - inner(W, here, here);
  const double radius = images[0].radius + images[1].radius;
  const Matrix gram = rounded_gram(W).cwiseAbs();
  const Vector moved = nearest(there).cwiseAbs(), off = Vector::Constant(moved.size(), radius);
  const double bound = radius == 0 ? 0 : (2 * moved.dot(gram * off) + off.dot(gram * off)) * allowance;
  if (sign(excess) <= 0 || (bound > 0 && nearest_double(excess) <= bound)) return std::nullopt;
  return MapCounterexample{MapLaw::nonexpansive, std::move(points), std::move(images), excess};
}

std::optional<MapCounterexample> cycle_broken(const ExactMetric& W, std::vector<ExactVector> points,
                                              std::vector<MapImage> images) {
  Fraction sum{0, 1};
  double bound = 0;
  const Matrix gram = rounded_gram(W).cwiseAbs();
  for (std::size_t k = 0; k < points.size(); ++k) {
    const ExactVector step = exact_difference(points[k], points[(k + 1) % points.size()]);
    sum = sum + inner(W, images[k].value, step);
    if (images[k].radius > 0) bound += images[k].radius * (gram * nearest(step).cwiseAbs()).sum() * allowance;
  }
  if (sign(sum) >= 0 || (bound > 0 && -nearest_double(sum) <= bound)) return std::nullopt;
  return MapCounterexample{MapLaw::cyclically_monotone, std::move(points), std::move(images), -sum};
}

std::optional<MapCounterexample> broken(const Map& T, const ExactMetric& W, MapLaw law,
                                        const std::vector<ExactVector>& points) {
  std::vector<MapImage> images;
  for (const ExactVector& point : points) {
    auto image = T.at(point);
    if (!image) return std::nullopt;
    images.push_back(std::move(*image));
  }
  return law == MapLaw::nonexpansive ? pair_broken(W, points, std::move(images))
                                     : cycle_broken(W, points, std::move(images));
}

Vector image_in_doubles(const Map& T, const Vector& z) {
  if (T.in_doubles) return T.in_doubles(z);
  const auto image = T.at(exact_vector(z));
  return image ? nearest(image->value) : Vector::Constant(T.n, std::nan(""));
}

std::vector<Vector> regular_polygon(const Vector& centre, Index i, Index j, double radius, int corners) {
  constexpr double unit = 0x1p20;
  std::vector<Vector> points;
  for (int k = 0; k < corners; ++k) {
    const double angle = 2 * std::numbers::pi * k / corners;
    Vector corner = centre;
    corner[i] += std::round(radius * std::cos(angle) * unit) / unit;
    corner[j] += std::round(radius * std::sin(angle) * unit) / unit;
    points.push_back(std::move(corner));
  }
  return points;
}

std::vector<Vector> square(const Vector& corner, Index i, Index j, double side, int parts) {
  std::vector<Vector> points;
  Vector at = corner;
  for (const auto& [along, step] : {std::pair{i, side}, {j, side}, {i, -side}, {j, -side}})
    for (int k = 0; k < parts; ++k) {
      points.push_back(at);
      at[along] += step / parts;
    }
  return points;
}

bool may_go_down(const Map& T, const Matrix& gram, const std::vector<Vector>& corners) {
  double sum = 0, size = 0;
  for (std::size_t k = 0; k < corners.size(); ++k) {
    const Vector image = image_in_doubles(T, corners[k]);
    if (!image.allFinite()) return false;
    const Vector step = corners[k] - corners[(k + 1) % corners.size()];
    sum += image.dot(gram * step);
    size += image.cwiseAbs().dot(gram.cwiseAbs() * step.cwiseAbs());
  }
  return sum < size * 0x1p-40;
}

double SlopeOfMap::asymmetry() const {
  double size = 0, difference = 0;
  for (Index i = 0; i < n; ++i)
    for (Index j = 0; j < n; ++j) {
      size = std::max(size, std::abs(nearest_double(at(i, j))));
      difference = std::max(difference, std::abs(nearest_double(at(i, j) - at(j, i))));
    }
  return size > 0 ? difference / size : 0;
}

bool SlopeOfMap::is_symmetric() const {
  for (Index i = 0; i < n; ++i)
    for (Index j = 0; j < i; ++j) {
      const double bound =
          (radius[static_cast<std::size_t>(i)] + radius[static_cast<std::size_t>(j)]) * allowance;
      const Fraction difference = at(i, j) - at(j, i);
      if (bound == 0 ? sign(difference) != 0 : std::abs(nearest_double(difference)) > bound) return false;
    }
  return true;
}

std::pair<Index, Index> SlopeOfMap::most_turning_plane() const {
  std::pair<Index, Index> plane{0, 0};
  Fraction most{0, 1};
  for (Index i = 0; i < n; ++i)
    for (Index j = 0; j < n; ++j) {
      // Anticlockwise from i to j the circulation is S_ji - S_ij, and the sum is minus that.
      const Fraction turn = at(j, i) - at(i, j);
      if (most < turn) {
        most = turn;
        plane = {i, j};
      }
    }
  return plane;
}

std::optional<int> SlopeOfMap::parts_of_side(Index i, Index j) const {
  const double turn = nearest_double(at(j, i) - at(i, j)), stretch = nearest_double(at(i, i) + at(j, j));
  for (int parts = 1; 4 * parts <= most_corners; parts *= 2)
    if (parts * turn > stretch) return std::min(2 * parts, most_corners / 4);
  return std::nullopt;
}

std::optional<SlopeOfMap> slope_at(const Map& T, const ExactMetric& W, const Vector& point) {
  const auto n = static_cast<std::size_t>(T.n);
  std::optional<MapDerivative> J;
  if (T.derivative) J = T.derivative(exact_vector(point));
  SlopeOfMap slope{T.n, J.has_value(), {}, std::vector<double>(n)};
  if (!J) {
    if (T.derivative) return std::nullopt;
    constexpr double step = 0x1p-13;
    J.emplace().entries.resize(n * n);
    for (Index j = 0; j < T.n; ++j) {
      Vector right = point, left = point;
      right[j] += step;
      left[j] -= step;
      const Vector column = (image_in_doubles(T, right) - image_in_doubles(T, left)) / (2 * step);
      if (!column.allFinite()) return std::nullopt;
      for (std::size_t i = 0; i < n; ++i)
        J->entries[i * n + static_cast<std::size_t>(j)] = fraction(column[static_cast<Index>(i)]);
    }
  }
  const Fraction scale{1, W.denominator};
  for (std::size_t i = 0; i < n; ++i)
    for (std::size_t j = 0; j < n; ++j) {
      Fraction sum{0, 1};
      for (std::size_t k = 0; k < n; ++k) sum = sum + Fraction{W.gram[i][k], 1} * J->entries[k * n + j];
      slope.S.push_back(sum * scale);
    }
  const Vector rows = rounded_gram(W).cwiseAbs().rowwise().sum();
  for (std::size_t i = 0; i < n; ++i) slope.radius[i] = J->radius * rows[static_cast<Index>(i)];
  return slope;
}

std::optional<MapCounterexample> asymmetric(const Map& T, const SlopeOfMap& slope, const Vector& point) {
  if (!slope.is_derivative) return std::nullopt;
  const auto [i, j] = slope.most_turning_plane();
  const Fraction difference = slope.at(j, i) - slope.at(i, j);
  const double radius =
      (slope.radius[static_cast<std::size_t>(i)] + slope.radius[static_cast<std::size_t>(j)]) * allowance;
  if (sign(difference) <= 0 || (radius > 0 && nearest_double(difference) <= radius)) return std::nullopt;
  const auto image = T.at(exact_vector(point));
  if (!image) return std::nullopt;
  return MapCounterexample{MapLaw::symmetric,
                           {exact_vector(point)},
                           {*image},
                           difference,
                           UnequalEntries{j, i, slope.at(j, i), slope.at(i, j), radius}};
}

}  // namespace convex::inline law_checks
