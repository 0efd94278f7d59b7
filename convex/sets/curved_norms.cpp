#include <cmath>
#include <numeric>

#include "convex/catalogue/catalogue.hpp"
#include "convex/exact/elimination.hpp"
#include "convex/exact_program/exact_arguments.hpp"
#include "convex/linear_algebra/singular_values.hpp"
#include "convex/proved_prox/pair_search.hpp"
#include "convex/proved_prox/proved_metric.hpp"
#include "convex/sets/subdifferential_rules.hpp"

namespace convex::subgradients {
namespace {

/// The root of a positive fraction, rounded, also of one that no double is near.
Fraction norm_rounded(Fraction square) {
  constexpr double step = 0x1p+400, least = 0x1p-900;
  const Fraction factor = fraction(step), inverse = Fraction{1} / factor;
  Fraction scale{1};
  for (; std::isinf(nearest_double(square)); scale = scale * factor) square = square * inverse * inverse;
  for (; nearest_double(square) < least; scale = scale * inverse) square = square * factor * factor;
  return fraction(std::sqrt(nearest_double(square))) * scale;
}

Subdifferential of_norm2(const Fraction& weight, const Fractions& x) {
  const Fraction square = pairs::square_of(x);
  if (sign(weight) == 0) return single(Fractions(x.size()), true);
  if (sign(square) == 0)
    return of_support({"norm2", {argument("weight", nearest_double(weight))}}, x.size(), true);
  return single(pairs::multiple_of(weight / norm_rounded(square), x), false);
}

Subdifferential of_ball2(const Fraction& radius, const Fractions& d) {
  const Fraction left = radius * radius - pairs::square_of(d);
  if (sign(left) < 0) return none(d.size());
  if (sign(left) > 0) return single(Fractions(d.size()), true);
  if (sign(radius) == 0) {  // a point
    ExactPolyhedron all = empty_polyhedron(d.size());
    all.vertices.emplace_back(d.size());
    for (std::size_t i = 0; i < d.size(); ++i) {
      all.lines.emplace_back(d.size());
      all.lines.back()[i] = 1;
    }
    return of_polyhedron(std::move(all), true);
  }
  return ray(d, true);
}

/// The entries of each group, by their sizes.
std::vector<Fractions> groups_of(const ExactArguments& a, const Fractions& x) {
  std::vector<std::size_t> sizes;
  if (a.is_vector("sizes"))
    for (const Fraction& size : a.vector("sizes"))
      sizes.push_back(static_cast<std::size_t>(nearest_double(size)));
  else
    sizes.assign(x.size(), static_cast<std::size_t>(nearest_double(a.number("sizes"))));
  std::vector<Fractions> groups;
  std::size_t first = 0;
  for (const std::size_t size : sizes) {
    if (first >= x.size()) break;
    const std::size_t last = std::min(first + size, x.size());
    groups.emplace_back(x.begin() + static_cast<std::ptrdiff_t>(first),
                        x.begin() + static_cast<std::ptrdiff_t>(last));
    first = last;
  }
  return groups;
}

template <class Rule>
Subdifferential of_groups(const ExactArguments& a, const Fractions& x, const Rule& rule) {
  std::vector<Subdifferential> parts;
  for (const Fractions& group : groups_of(a, x)) parts.push_back(rule(group));
  return product(parts);
}

/// {x : g(x) <= 0} at a point of a smooth edge, where g(x) = 0 and its gradient is not 0.
Subdifferential of_second_order_cone(const Fractions& x) {
  Fractions normal = x;
  normal.back() = -x.back();
  const Fraction left = x.back() * x.back() - pairs::square_of({x.begin(), x.end() - 1});
  if (sign(x.back()) < 0 || sign(left) < 0) return none(x.size());
  if (sign(left) > 0) return single(Fractions(x.size()), true);
  if (sign(x.back()) > 0) return ray(normal, true);
  return of_support(indicator_call({"second_order_cone"}), x.size(), false);
}

Subdifferential of_rotated_cone(const Fractions& x) {
  const std::size_t n = x.size();
  const Fraction u = x[n - 2], v = x[n - 1];
  const Fraction left = Fraction{2} * u * v - pairs::square_of({x.begin(), x.end() - 2});
  if (sign(u) < 0 || sign(v) < 0 || sign(left) < 0) return none(n);
  if (sign(left) > 0) return single(Fractions(n), true);
  if (sign(u) == 0 && sign(v) == 0)
    return of_support(indicator_call({"rotated_second_order_cone"}), n, false);
  Fractions normal = x;
  normal[n - 2] = -v;
  normal[n - 1] = -u;
  return ray(normal, true);
}

std::size_t side_of(std::size_t entries) {
  return static_cast<std::size_t>(std::lround(std::sqrt(static_cast<double>(entries))));
}

bool is_symmetric(const Fractions& x, std::size_t k) {
  for (std::size_t i = 0; i < k; ++i)
    for (std::size_t j = 0; j < i; ++j)
      if (!(x[i + k * j] == x[j + k * i])) return false;
  return true;
}

/// Rows of the matrix stacked by columns, over one denominator.
IntegerRows integer_matrix(const Fractions& x, std::size_t rows, std::size_t columns, Integer& denominator) {
  const ExactVector stacked = exact_vector(x);
  denominator = stacked.denominator;
  IntegerRows M(rows, IntegerVector(columns));
  for (std::size_t i = 0; i < rows; ++i)
    for (std::size_t j = 0; j < columns; ++j) M[i][j] = stacked.numerators[i + rows * j];
  return M;
}

/// -log det at X: -X⁻¹ among the symmetric matrices, and all skew ones, to which it is blind.
Subdifferential of_neg_log_det(const Fractions& x) {
  const std::size_t k = side_of(x.size());
  Integer denominator;
  const IntegerRows X = integer_matrix(x, k, k, denominator);
  const auto inverse = is_symmetric(x, k) ? positive_definite_inverse(X) : std::nullopt;
  if (!inverse) return none(x.size());
  ExactPolyhedron P = empty_polyhedron(x.size());
  P.vertices.emplace_back(x.size());
  for (std::size_t i = 0; i < k; ++i)
    for (std::size_t j = 0; j <= i; ++j) {
      const Fraction entry = lowest_terms({-(inverse->adjugate[i][j] * denominator), inverse->determinant});
      P.vertices.front()[i + k * j] = P.vertices.front()[j + k * i] = entry;
      IntegerVector same(x.size()), opposite(x.size());
      same[i + k * j] = entry.denominator;
      same[j + k * i] += i == j ? Integer{0} : entry.denominator;
      P.equations.push_back({same, (i == j ? Integer{1} : Integer{2}) * entry.numerator});
      if (i == j) continue;
      opposite[i + k * j] = 1;
      opposite[j + k * i] = -1;
      P.lines.push_back(std::move(opposite));
    }
  return of_polyhedron(std::move(P), true);
}

/// A basis of the annihilator of the rows, orthonormal in doubles: columns.
Matrix orthonormal_complement(const IntegerRows& rows, std::size_t columns) {
  const Echelon space = annihilator(echelon(rows, columns));
  Matrix Q(static_cast<Index>(columns), static_cast<Index>(space.rank()));
  for (std::size_t k = 0; k < space.rank(); ++k) {
    const auto column = static_cast<Index>(k);
    Q.col(column) = nearest(ExactVector{space.rows[k], 1});
    Q.col(column) /= Q.col(column).stableNorm();
    for (int again = 0; again < 2; ++again) {
      for (Index j = 0; j < column; ++j) Q.col(column) -= Q.col(j).dot(Q.col(column)) * Q.col(j);
      Q.col(column) /= Q.col(column).norm();
    }
  }
  return Q;
}

/// The map D -> PᵀDQ of matrices stacked by columns.
Matrix two_sided_product(const Matrix& P, const Matrix& Q) {
  Matrix made(P.cols() * Q.cols(), P.rows() * Q.rows());
  for (Index j = 0; j < Q.cols(); ++j)
    for (Index i = 0; i < P.cols(); ++i)
      for (Index b = 0; b < Q.rows(); ++b)
        for (Index a = 0; a < P.rows(); ++a) made(i + P.cols() * j, a + P.rows() * b) = P(a, i) * Q(b, j);
  return made;
}

Vector stacked(const Matrix& M) { return Eigen::Map<const Vector>(M.data(), M.size()); }

/// weight {UVᵀ + S : UᵀS = 0, SV = 0, ||S|| <= 1}, X = U Σ Vᵀ of its rank, which fractions decide (Watson
/// 1992).
Subdifferential of_nuclear_norm(const ExactArguments& a, const Fractions& x) {
  const auto rows = static_cast<std::size_t>(nearest_double(a.number("rows"))), columns = x.size() / rows;
  const double weight = nearest_double(a.number("weight"));
  Integer denominator;
  const IntegerRows X = integer_matrix(x, rows, columns, denominator);
  IntegerRows transposed(columns, IntegerVector(rows));
  for (std::size_t i = 0; i < rows; ++i)
    for (std::size_t j = 0; j < columns; ++j) transposed[j][i] = X[i][j];
  const Matrix left = orthonormal_complement(transposed, rows), right = orthonormal_complement(X, columns);
  const auto rank = static_cast<Index>(rows) - left.cols();
  const Vector doubles = nearest(x);
  const Matrix in_doubles =
      Eigen::Map<const Matrix>(doubles.data(), static_cast<Index>(rows), static_cast<Index>(columns));
  const linear_algebra::SingularValues parts(in_doubles);
  const Matrix polar = weight * parts.U.leftCols(rank) * parts.V.leftCols(rank).transpose();
  if (left.cols() == 0 || right.cols() == 0 || weight == 0) return single(fractions(stacked(polar)), false);
  Call rest{"nuclear_norm", {argument("weight", weight), argument("rows", static_cast<double>(left.cols()))}};
  rest = {"precompose", {argument(std::move(rest)), argument("A", two_sided_product(left, right))}};
  if (rank == 0)
    return of_support(
        {"nuclear_norm", {argument("weight", weight), argument("rows", static_cast<double>(rows))}}, x.size(),
        true);
  return of_support({"tilt", {argument(std::move(rest)), argument("c", stacked(polar))}}, x.size(), true);
}

/// The cone of positive semidefinite matrices: normals -VSVᵀ, S semidefinite, V a basis of the kernel of X,
/// and all skew matrices.
Subdifferential of_psd_cone(const Fractions& x) {
  const std::size_t k = side_of(x.size());
  if (!is_symmetric(x, k)) return none(x.size());
  Integer denominator;
  const IntegerRows X = integer_matrix(x, k, k, denominator);
  const Echelon kernel = annihilator(echelon(X, k));
  // Semidefinite exactly when definite across the kernel: X + Σ v vᵀ over a basis of it is definite.
  IntegerRows across = X;
  for (const IntegerVector& v : kernel.rows)
    for (std::size_t i = 0; i < k; ++i)
      for (std::size_t j = 0; j < k; ++j) across[i][j] += v[i] * v[j] * denominator;
  if (!positive_definite_inverse(across)) return none(x.size());
  ExactPolyhedron skew = empty_polyhedron(x.size());
  skew.vertices.emplace_back(x.size());
  for (std::size_t i = 0; i < k; ++i)
    for (std::size_t j = 0; j <= i; ++j) {
      IntegerVector same(x.size()), opposite(x.size());
      same[i + k * j] = same[j + k * i] = 1;
      skew.equations.push_back({same, 0});
      if (i == j) continue;
      opposite[i + k * j] = 1;
      opposite[j + k * i] = -1;
      skew.lines.push_back(std::move(opposite));
    }
  if (kernel.rank() == 0) return of_polyhedron(std::move(skew), true);
  // Directions D with VᵀDV semidefinite, D symmetric: its support function is their indicator.
  const Matrix V = orthonormal_complement(X, k);
  Call inside = indicator_call({"psd_cone"});
  if (kernel.rank() < k) {
    Matrix rows(static_cast<Index>(skew.lines.size()), static_cast<Index>(x.size()));
    for (std::size_t l = 0; l < skew.lines.size(); ++l)
      rows.row(static_cast<Index>(l)) = nearest(ExactVector{skew.lines[l], 1});
    // VᵀDV of what rounding leaves of symmetry is made symmetric.
    Matrix across_V = two_sided_product(V, V);
    const Index m = V.cols();
    for (Index i = 0; i < m; ++i)
      for (Index j = 0; j < i; ++j) {
        const Vector mean = 0.5 * (across_V.row(i + m * j) + across_V.row(j + m * i));
        across_V.row(i + m * j) = mean;
        across_V.row(j + m * i) = mean;
      }
    inside = {"sum",
              {argument(Call{"precompose", {argument(std::move(inside)), argument("A", across_V)}}),
               argument(indicator_call({"affine", {argument("A", rows)}}))}};
  }
  return of_support(std::move(inside), x.size(), false);
}

}  // namespace

std::optional<Subdifferential> of_curved_norm_or_set(const Call& f, const Fractions& x) {
  const ExactArguments a(f, x.size());
  if (f.name == "norm2") return of_norm2(a.number("weight"), x);
  if (f.name == "ball2") return of_ball2(a.number("radius"), difference(x, a.vector("center")));
  if (f.name == "group_norm")
    return of_groups(a, x, [&](const Fractions& group) { return of_norm2(a.number("weight"), group); });
  if (f.name == "group_ball")
    return of_groups(a, x, [&](const Fractions& group) { return of_ball2(a.number("radius"), group); });
  if (f.name == "second_order_cone") return of_second_order_cone(x);
  if (f.name == "rotated_second_order_cone") return of_rotated_cone(x);
  if (f.name == "psd_cone") return of_psd_cone(x);
  if (f.name == "neg_log_det") return of_neg_log_det(x);
  if (f.name == "nuclear_norm") return of_nuclear_norm(a, x);
  return std::nullopt;
}

}  // namespace convex::subgradients
