#include "convex/linear_quadratic/operations.hpp"

#include <algorithm>
#include <cmath>
#include <utility>
#include <vector>

#include "convex/double_double.hpp"
#include "convex/linear_quadratic/placement.hpp"

namespace convex::linear_quadratic {
namespace {

constexpr const char* sizes_differ = "the functions differ in size; give functions of one space";

Index total_auxiliaries(std::span<const LinearQuadratic> terms) {
  Index k = 0;
  for (const LinearQuadratic& f : terms) k += f.auxiliaries();
  return k;
}

LinearQuadratic nothing(Index n, Index k) { return LinearQuadraticBuilder(n, k).finish(); }

using SparseEntries = std::vector<std::pair<Index, double>>;

/// The entries of a row, or a column, in the first n variables.
template <typename Iterator>
SparseEntries entries_in_x(Iterator it, Index n) {
  SparseEntries found;
  for (; it; ++it)
    if (it.index() < n) found.emplace_back(it.index(), it.value());
  return found;
}

/// row·A, before rounding.
DoubleDoubleVector product(const SparseEntries& row, const SparseRows& A) {
  DoubleDoubleVector sum(A.cols());
  for (const auto& [k, value] : row)
    for (SparseRows::InnerIterator it(A, k); it; ++it) {
      const DoubleDouble more = add(sum[it.col()], two_product(value, it.value()));
      sum.hi[it.col()] = more.hi;
      sum.lo[it.col()] = more.lo;
    }
  return sum;
}

/// start + row·b, before rounding.
DoubleDouble plus_product(double start, const SparseEntries& row, const Vector& b) {
  DoubleDouble sum{start, 0};
  for (const auto& [k, value] : row) sum = add(sum, two_product(value, b[k]));
  return sum;
}

/// Do doubles hold the rows G(Ax + b) >= h as rows of x?
bool rows_are_exact(const LinearQuadratic& f, const SparseRows& A, const Vector& b) {
  for (Index row = 0; row < f.rows(); ++row) {
    const SparseEntries entries = entries_in_x(SparseRows::InnerIterator(f.G, row), f.n);
    if (plus_product(-f.h[row], entries, b).lo != 0 || !product(entries, A).lo.isZero(0)) return false;
  }
  return true;
}

/// Do doubles hold HA, AᵀHA, Hb + c and Aᵀ(Hb + c)?
bool curvature_is_exact(const LinearQuadratic& f, const SparseMatrix& A, const SparseRows& rows_of_A,
                        const Vector& b) {
  Vector slope(f.variables());
  std::vector<Eigen::Triplet<double>> entries_of_bent;
  for (Index i = 0; i < f.variables(); ++i) {
    const SparseEntries entries = entries_in_x(SparseMatrix::InnerIterator(f.H, i), f.n);
    const DoubleDouble pull = plus_product(f.c[i], entries, b);
    const DoubleDoubleVector image = product(entries, rows_of_A);
    if (pull.lo != 0 || !image.lo.isZero(0)) return false;
    slope[i] = pull.hi;
    for (Index j = 0; j < A.cols(); ++j)
      if (image.hi[j] != 0)
        entries_of_bent.emplace_back(static_cast<int>(i), static_cast<int>(j), image.hi[j]);
  }
  SparseRows bent(f.variables(), A.cols());
  bent.setFromTriplets(entries_of_bent.begin(), entries_of_bent.end());
  for (Index j = 0; j < A.cols(); ++j) {
    const SparseEntries column = entries_in_x(SparseMatrix::InnerIterator(A, j), f.n);
    if (plus_product(0, column, slope).lo != 0 || !product(column, bent).lo.isZero(0)) return false;
  }
  return true;
}

}  // namespace

LinearQuadratic sum(std::span<const LinearQuadratic> terms) {
  require(!terms.empty(), "sum", "there is no term; give at least one function");
  const Index n = terms[0].n, columns = n + total_auxiliaries(terms);
  LinearQuadratic total = nothing(n, columns - n);
  Index first = n;
  for (const LinearQuadratic& f : terms) {
    validate(f, "sum");
    require(f.n == n, "sum", sizes_differ);
    total = add_joint(total, placed(f, n, columns, first, identity_at(n, 0, 1)));
    first += f.auxiliaries();
  }
  return total;
}

LinearQuadratic inf_convolution(const LinearQuadratic& f, const LinearQuadratic& g) {
  validate(f, "inf_convolution");
  validate(g, "inf_convolution");
  require(f.n == g.n, "inf_convolution", sizes_differ);
  const Index n = f.n, columns = 2 * n + f.auxiliaries() + g.auxiliaries();
  Entries difference = identity_at(n, 0, 1);
  append(difference, identity_at(n, n, -1));
  return add_joint(placed(f, n, columns, 2 * n, difference),
                   placed(g, n, columns, 2 * n + f.auxiliaries(), identity_at(n, n, 1)));
}

LinearQuadratic precompose(const LinearQuadratic& f, const SparseMatrix& A, const Vector& b) {
  validate(f, "precompose");
  require(A.rows() == f.n && b.size() == f.n, "precompose",
          "A and b do not fit the function; give them one row for each of its variables");
  const SparseRows rows(A);
  /// u = Ax + b costs a program with as many variables more: of more rows than this, and than x has entries,
  /// a solution takes far longer, for digits beside the last one.
  constexpr Index few_rows = 96;
  const bool few = A.rows() <= std::max(A.cols(), few_rows);
  if (!rows_are_exact(f, rows, b) || (few && !curvature_is_exact(f, A, rows, b))) {
    // u stays a variable: rounded data would be those of another function.
    const Index n = A.cols(), m = A.rows(), columns = n + m + f.auxiliaries();
    LinearQuadraticBuilder equations(n, columns - n);
    for (Index i = 0; i < m; ++i) {
      equations.equation(-b[i]);
      for (SparseRows::InnerIterator it(rows, i); it; ++it) equations.entry(it.col(), it.value());
      equations.entry(n + i, -1);
    }
    return add_joint(equations.finish(), placed(f, n, columns, n + m, identity_at(m, n, 1)));
  }
  Entries entries;
  for (Index j = 0; j < A.outerSize(); ++j)
    for (SparseMatrix::InnerIterator it(A, j); it; ++it)
      entries.emplace_back(static_cast<int>(it.row()), static_cast<int>(j), it.value());
  Vector s = Vector::Zero(f.variables());
  s.head(f.n) = b;
  return substitute(f, A.cols(), placement(f, A.cols() + f.auxiliaries(), A.cols(), entries), s);
}

LinearQuadratic pointwise_max(std::span<const LinearQuadratic> terms) {
  require(!terms.empty(), "pointwise_max", "there is no function; give at least one");
  const Index n = terms[0].n, columns = n + 1 + total_auxiliaries(terms);
  validate(terms[0], "pointwise_max");
  const SparseMatrix common = terms[0].H.topLeftCorner(n, n);
  LinearQuadratic highest = nothing(n, columns - n);
  LinearQuadraticBuilder level(n, columns - n);
  level.cost(n, 1);
  for (Index j = 0; j < common.outerSize(); ++j)
    for (SparseMatrix::InnerIterator it(common, j); it; ++it)
      if (it.row() <= j) level.curve(it.row(), j, it.value());
  Index first = n + 1;
  for (const LinearQuadratic& f : terms) {
    validate(f, "pointwise_max");
    require(f.n == n, "pointwise_max", sizes_differ);
    const SparseMatrix own = f.H.topLeftCorner(n, n);
    require((own - common).norm() == 0 && own.nonZeros() == f.H.nonZeros(), "pointwise_max",
            "the functions curve differently, so that their maximum is not piecewise linear-quadratic; give "
            "polyhedral functions, or ones with the same quadratic part");
    LinearQuadratic rows = placed(f, n, columns, first, identity_at(n, 0, 1));
    level.row(rows.constant);  // level >= c·ξ + constant
    level.entry(n, 1);
    for (Index j = 0; j < columns; ++j)
      if (rows.c[j] != 0) level.entry(j, -rows.c[j]);
    rows.H.setZero();
    rows.c.setZero();
    rows.constant = 0;
    highest = add_joint(highest, rows);
    first += f.auxiliaries();
  }
  return add_joint(highest, level.finish());
}

LinearQuadratic scale(const LinearQuadratic& f, double alpha) {
  require(alpha > 0 && std::isfinite(alpha), "scale", "alpha is not positive and finite; give alpha > 0");
  LinearQuadratic g = f;
  g.H *= alpha;
  g.c *= alpha;
  g.constant *= alpha;
  return g;
}

LinearQuadratic dilate(const LinearQuadratic& f, double rho) {
  require(rho != 0 && std::isfinite(rho), "dilate", "rho is 0 or not finite; give another number");
  // With w measured in units of |rho| too, G keeps its numbers and h is rounded once.
  const double size = std::abs(rho), sign = rho > 0 ? 1 : -1;
  Vector side = Vector::Ones(f.variables());
  side.head(f.n).setConstant(sign);
  LinearQuadratic g = f;
  g.H = side.asDiagonal() * f.H * side.asDiagonal();
  g.H = g.H / size / size;
  g.c = side.cwiseProduct(f.c) / size;
  g.G = f.G * side.asDiagonal();
  g.h = size * f.h;
  return g;
}

LinearQuadratic translate(const LinearQuadratic& f, const Vector& by) {
  SparseMatrix identity(f.n, f.n);
  identity.setIdentity();
  return precompose(f, identity, -by);
}

LinearQuadratic tilt(const LinearQuadratic& f, const Vector& v) {
  require(v.size() == f.n && v.allFinite(), "tilt", "the slope does not fit the function; give f.n numbers");
  LinearQuadratic g = f;
  g.c.head(f.n) += v;
  return g;
}

LinearQuadratic raise(const LinearQuadratic& f, double constant) {
  LinearQuadratic g = f;
  g.constant += constant;
  return g;
}

LinearQuadratic separable(std::span<const LinearQuadratic> blocks) {
  Index n = 0;
  for (const LinearQuadratic& f : blocks) n += f.n;
  const Index columns = n + total_auxiliaries(blocks);
  LinearQuadratic total = nothing(n, columns - n);
  Index x = 0, first = n;
  for (const LinearQuadratic& f : blocks) {
    validate(f, "separable");
    total = add_joint(total, placed(f, n, columns, first, identity_at(f.n, x, 1)));
    x += f.n;
    first += f.auxiliaries();
  }
  return total;
}

}  // namespace convex::linear_quadratic
