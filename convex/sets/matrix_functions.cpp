#include <cmath>

#include "convex/exact/elimination.hpp"
#include "convex/exact_program/exact_arguments.hpp"
#include "convex/invalid_input.hpp"
#include "convex/linear_algebra/singular_values.hpp"
#include "convex/linear_algebra/symmetric_eigen.hpp"
#include "convex/proved_prox/proved_metric.hpp"
#include "convex/sets/multiple_eigenvalue.hpp"
#include "convex/sets/subdifferential_rules.hpp"

namespace convex::inline sets::subgradients {
namespace {

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

/// The skew matrices, k by k: what functions of symmetric matrices alone are blind to.
ExactPolyhedron skew_matrices(std::size_t k) {
  ExactPolyhedron skew = empty_polyhedron(k * k);
  skew.vertices.emplace_back(k * k);
  for (std::size_t i = 0; i < k; ++i)
    for (std::size_t j = 0; j <= i; ++j) {
      IntegerVector same(k * k), opposite(k * k);
      same[i + k * j] = same[j + k * i] = 1;
      skew.equations.push_back({same, 0});
      if (i == j) continue;
      opposite[i + k * j] = 1;
      opposite[j + k * i] = -1;
      skew.lines.push_back(std::move(opposite));
    }
  return skew;
}

/// D symmetric, as a set.
Call symmetric_matrices(std::size_t k) {
  const ExactPolyhedron skew = skew_matrices(k);
  Matrix rows(static_cast<Index>(skew.lines.size()), static_cast<Index>(k * k));
  for (std::size_t l = 0; l < skew.lines.size(); ++l)
    rows.row(static_cast<Index>(l)) = nearest(ExactVector{skew.lines[l], 1}) / std::sqrt(2.0);
  return {"affine", {argument("A", rows)}};
}

/// f of the symmetric part of VᵀDV: what rounding leaves of symmetry is made symmetric.
Call across(Call f, const Matrix& V) {
  Matrix rows = two_sided_product(V, V);
  const Index m = V.cols(), k = V.rows();
  // The rows of (i, j) and (j, i), and the columns of (a, b) and (b, a), are made equal.
  const Matrix of_rows = rows;
  for (Index i = 0; i < m; ++i)
    for (Index j = 0; j < m; ++j)
      rows.row(i + m * j) = 0.5 * (of_rows.row(i + m * j) + of_rows.row(j + m * i));
  const Matrix of_columns = rows;
  for (Index i = 0; i < k; ++i)
    for (Index j = 0; j < k; ++j)
      rows.col(i + k * j) = 0.5 * (of_columns.col(i + k * j) + of_columns.col(j + k * i));
  return {"precompose", {argument(std::move(f)), argument("A", rows)}};
}

/// Is X, of which `kernel` is the kernel, semidefinite? Exactly when it is definite across: X + Σ v vᵀ over a
/// basis.
bool is_semidefinite(const IntegerRows& X, const Echelon& kernel, const Integer& size) {
  IntegerRows filled = X;
  for (const IntegerVector& v : kernel.rows)
    for (std::size_t i = 0; i < X.size(); ++i)
      for (std::size_t j = 0; j < X.size(); ++j) filled[i][j] += v[i] * v[j] * size;
  return positive_definite_inverse(filled).has_value();
}

/// The cone of positive semidefinite matrices: normals -VSVᵀ, S semidefinite, V a basis of the kernel of X,
/// and all skew matrices.
Subdifferential of_psd_cone(const Fractions& x) {
  const std::size_t k = side_of(x.size());
  if (!is_symmetric(x, k)) return none(x.size());
  Integer denominator;
  const IntegerRows X = integer_matrix(x, k, k, denominator);
  const Echelon kernel = annihilator(echelon(X, k));
  if (!is_semidefinite(X, kernel, denominator)) return none(x.size());
  if (kernel.rank() == 0) return of_polyhedron(skew_matrices(k), true);
  // Directions D with VᵀDV semidefinite, D symmetric: its support function is their indicator.
  Call inside = indicator_call({"psd_cone"});
  if (kernel.rank() < k)
    inside = {"sum",
              {argument(across(std::move(inside), orthonormal_complement(X, k))),
               argument(indicator_call(symmetric_matrices(k)))}};
  return of_support(std::move(inside), x.size(), false);
}

/// {X : its symmetric part semidefinite of trace `total`}: normals mu 1 - VSVᵀ, V a basis of its kernel.
Subdifferential of_spectraplex(const ExactArguments& a, const Fractions& x) {
  const std::size_t k = side_of(x.size());
  Fractions symmetric = x;
  Fraction trace;
  for (std::size_t i = 0; i < k; ++i) {
    trace = trace + x[i + k * i];
    for (std::size_t j = 0; j < k; ++j) symmetric[i + k * j] = (x[i + k * j] + x[j + k * i]) * Fraction{1, 2};
  }
  if (!(trace == a.number("total"))) return none(x.size());
  Integer denominator;
  const IntegerRows X = integer_matrix(symmetric, k, k, denominator);
  const Echelon kernel = annihilator(echelon(X, k));
  if (!is_semidefinite(X, kernel, denominator)) return none(x.size());
  Vector unit = stacked(Matrix::Identity(static_cast<Index>(k), static_cast<Index>(k)));
  if (kernel.rank() == 0) {
    const Call level{"hyperplane", {argument("a", unit), argument("b", 0.0)}};
    return subdifferential(level, identity_gram(x.size()), Fractions(x.size()));
  }
  unit /= std::sqrt(static_cast<double>(k));
  Call inside = indicator_call({"psd_cone"});
  return of_support({"sum",
                     {argument(across(std::move(inside), orthonormal_complement(X, k))),
                      argument(indicator_call({"hyperplane", {argument("a", unit), argument("b", 0.0)}}))}},
                    x.size(), false);
}

/// weight {QSQᵀ : S semidefinite of trace 1}, the columns of Q a basis of the eigenspace of the largest
/// eigenvalue, and all skew matrices (Overton 1992). That it is multiple, fractions decide.
std::optional<Subdifferential> of_max_eigenvalue(const ExactArguments& a, const Fractions& x) {
  const std::size_t k = side_of(x.size());
  if (!is_symmetric(x, k)) return none(x.size());
  const double weight = nearest_double(a.number("weight"));
  ExactPolyhedron skew = skew_matrices(k);
  if (weight == 0) return of_polyhedron(std::move(skew), true);
  Integer denominator;
  IntegerRows X = integer_matrix(x, k, k, denominator);
  const Vector doubles = nearest(x);
  const auto side = static_cast<Index>(k);
  const linear_algebra::SymmetricEigen eigen(Matrix(Eigen::Map<const Matrix>(doubles.data(), side, side)));
  if (!eigen.found) return std::nullopt;
  const double largest = eigen.values[side - 1];
  // Eigenvalues are as far off as their sizes' rounding, a backward error (Parlett 1998).
  const double doubt = 64 * static_cast<double>(k) * unit_roundoff * eigen.values.cwiseAbs().maxCoeff();
  Index many = 1;
  while (many < side && largest - eigen.values[side - 1 - many] <= doubt) ++many;
  Matrix Q = eigen.vectors.rightCols(many);
  if (many > 1) {
    const Fraction d{denominator};
    const double lowest = eigen.values[side - many] - doubt, highest = largest + doubt;
    const bool is_apart = many == side || eigen.values[side - many - 1] + doubt < lowest;
    if (!is_apart || !is_multiple_eigenvalue(X, many, d * fraction(lowest), d * fraction(highest)))
      throw InvalidInput(
          "max_eigenvalue: no rule gives its subdifferential at this point as a set: its largest eigenvalues "
          "differ, by less than doubles tell; give another point");
    // Of integers it is a whole number where it is rational: then fractions have the eigenspace too.
    const double scaled = eigen.values.tail(many).mean() * nearest_double(d);
    if (std::abs(scaled) < 0x1p+52) {
      const Integer level = static_cast<std::int64_t>(std::llround(scaled));
      for (std::size_t i = 0; i < k; ++i) X[i][i] -= level;
      if (static_cast<Index>(k - echelon(X, k).rank()) == many) Q = orthonormal_complement(X, k);
    }
  }
  if (many > 1)
    return of_support({"sum",
                       {argument(across({"max_eigenvalue", {argument("weight", weight)}}, Q)),
                        argument(indicator_call(symmetric_matrices(k)))}},
                      x.size(), false);
  // One point, and the skew matrices.
  const Matrix gradient = weight * Q * Q.transpose();
  skew.vertices.front() = fractions(stacked(0.5 * (gradient + gradient.transpose())));
  for (ExactHalfspace& equation : skew.equations) {
    Fraction limit;
    for (std::size_t i = 0; i < x.size(); ++i)
      if (equation.normal[i].sign() != 0)
        limit = limit + Fraction{equation.normal[i]} * skew.vertices.front()[i];
    limit = lowest_terms(limit);
    for (Integer& entry : equation.normal) entry = entry * limit.denominator;
    equation.limit = limit.numerator;
  }
  return of_polyhedron(std::move(skew), false);
}

}  // namespace

std::optional<Subdifferential> of_matrix_function(const Call& f, const Fractions& x) {
  const ExactArguments a(f, x.size());
  if (f.name == "psd_cone") return of_psd_cone(x);
  if (f.name == "neg_log_det") return of_neg_log_det(x);
  if (f.name == "nuclear_norm") return of_nuclear_norm(a, x);
  if (f.name == "spectraplex") return of_spectraplex(a, x);
  if (f.name == "max_eigenvalue") return of_max_eigenvalue(a, x);
  return std::nullopt;
}

}  // namespace convex::inline sets::subgradients
