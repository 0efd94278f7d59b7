#include "convex/nearest_point/proof/infeasibility_proof.hpp"

#include <algorithm>
#include <cmath>

#include "convex/exact/elimination.hpp"
#include "convex/exact/exact_sum.hpp"
#include "convex/exact/grid_sum.hpp"
#include "convex/exact/rounding_bounds.hpp"
#include "convex/linear_algebra/inverse.hpp"
#include "convex/nearest_point/proof/exact_dependence.hpp"
#include "convex/nearest_point/proof/exact_method.hpp"

namespace convex::inline proof {
namespace {

/// The rows with weights.
struct Support : RestrictedRows {
  std::vector<Index> rows;
  Vector w;
  std::vector<bool> two_sided;
};

Support support(const NearestPointProblem& problem, const Vector& w) {
  std::vector<Index> rows;
  for (Index a = 0; a < w.size(); ++a)
    if (w[a] != 0) rows.push_back(a);
  // The first one's weight is the unit of the others.
  for (Index& a : rows)
    if (w[a] > w[rows.front()]) std::swap(a, rows.front());
  Support found{restricted_rows(problem, rows), rows, w(rows), {}};
  for (Index a : rows) found.two_sided.push_back(problem.is_two_sided(a));
  return found;
}

/// Whether the weights, rounded to whole numbers times the smallest, are a contradiction without rounding:
/// most are plain sums of rows.
std::optional<InfeasibilityProof> by_whole_numbers(const Support& rows, Index m) {
  constexpr double most = 0x1p20;
  const double smallest = rows.w.cwiseAbs().minCoeff();
  const Vector w = (rows.w / smallest).array().round();
  if (!(w.cwiseAbs().maxCoeff() <= most)) return std::nullopt;
  InfeasibilityProof proof{ProofLevel::exact, Vector::Zero(m), IntegerVector(at(m), 0)};
  ExactSum gap;
  for (std::size_t r = 0; r < rows.rows.size(); ++r) {
    const Index k = static_cast<Index>(r);
    if (w[k] < 0 && !rows.two_sided[r]) return std::nullopt;
    gap.add_product(w[k], rows.s[k]);
    proof.weights[at(rows.rows[r])] = static_cast<std::int64_t>(w[k]);
  }
  if (gap.sign() <= 0) return std::nullopt;
  const GridSum on_grid(w);
  const Matrix columns = rows.U;
  for (Index i = 0; i < columns.cols(); ++i) {
    if (const auto sum = on_grid.value(columns.col(i).data(), 0)) {
      if (*sum != 0) return std::nullopt;
      continue;
    }
    ExactSum sum;
    for (Index k = 0; k < w.size(); ++k) sum.add_product(w[k], rows.U(k, i));
    if (sum.sign() != 0) return std::nullopt;
  }
  proof.farkas(rows.rows) = w;
  return proof;
}

std::optional<InfeasibilityProof> by_fractions(const Support& rows, Index m) {
  ExactProblem exact = as_integers(rows);
  for (std::size_t r = 0; r < rows.two_sided.size(); ++r)
    if (rows.two_sided[r]) exact.two_sided.push_back(static_cast<Index>(r));
  IntegerVector w = dependence_of(exact);
  if (w.empty()) return std::nullopt;
  if (rows.w[0] < 0)
    for (Integer& weight : w) weight = -weight;
  if (!proves_infeasibility(exact, w)) return std::nullopt;
  InfeasibilityProof proof{ProofLevel::exact, Vector::Zero(m), IntegerVector(at(m), 0)};
  proof.farkas(rows.rows) = rounded_weights(w, exact.s);
  for (std::size_t r = 0; r < rows.rows.size(); ++r) proof.weights[at(rows.rows[r])] = w[r];
  return proof;
}

/// r + 1 rows of r entries: with B all but the first, B regular, c = -B⁻ᵀu_0 makes u_0 + Σ c_k u_k = 0
/// exactly.
std::optional<InfeasibilityProof> by_enclosure(const Support& rows, Index m) {
  const Index r = rows.U.cols();
  if (rows.U.rows() != r + 1 || !(rows.w[0] > 0) || !is_ordinary(rows.U) || !is_ordinary(rows.s))
    return std::nullopt;
  const Matrix B = rows.U.bottomRows(r).transpose();
  Matrix X = linear_algebra::inverse(B);
  Vector c = rows.w.tail(r) / rows.w[0];
  if (!X.allFinite() || !c.allFinite()) return std::nullopt;
  keep_ordinary(X);
  for (double& entry : c)
    if (std::abs(entry) < smallest_ordinary) entry = 0;
  if (!is_ordinary(X) || !is_ordinary(c)) return std::nullopt;
  const Vector ones = Vector::Ones(r);
  const Matrix size = X.cwiseAbs();
  const Vector miss = (X * B - Matrix::Identity(r, r)).cwiseAbs() * ones +
                      gamma(r) * (size * (B.cwiseAbs() * ones)) + 2 * unit_roundoff * ones;
  const double delta = above(miss.maxCoeff());
  if (!(delta < 0.5)) return std::nullopt;
  Vector rest(r), rest_radius(r);
  for (Index i = 0; i < r; ++i) {
    CompensatedSum sum;
    sum.add(rows.U(0, i), 1);
    for (Index k = 0; k < r; ++k) sum.add(B(i, k), c[k]);
    rest[i] = sum.result().value;
    rest_radius[i] = sum.result().radius;
  }
  // |c* - c|_∞ <= |X rest|_∞ / (1 - delta).
  const Vector error = (X * rest).cwiseAbs() + size * (gamma(r) * rest.cwiseAbs() + rest_radius);
  const double radius = above(above(error.maxCoeff()) / below(1 - delta));
  CompensatedSum gap;
  gap.add(rows.s[0], 1);
  double hidden = 0;
  for (Index k = 0; k < r; ++k) {
    if (!rows.two_sided[at(k + 1)] && !(c[k] > radius)) return std::nullopt;
    gap.add(rows.s[k + 1], c[k]);
    hidden += radius * std::abs(rows.s[k + 1]);
  }
  if (!(below(gap.result().value) > above(gap.result().radius + above(hidden)))) return std::nullopt;
  InfeasibilityProof proof{ProofLevel::enclosure, Vector::Zero(m), {}};
  proof.farkas[rows.rows[0]] = 1;
  for (Index k = 0; k < r; ++k) proof.farkas[rows.rows[at(k + 1)]] = c[k];
  return proof;
}

}  // namespace

std::optional<InfeasibilityProof> infeasibility_proof(const NearestPointProblem& problem, const Vector& w,
                                                      bool in_fractions) {
  if (w.size() != problem.rows() || !w.allFinite()) return std::nullopt;
  const Support rows = support(problem, w);
  if (rows.rows.empty()) return std::nullopt;
  if (auto proof = by_whole_numbers(rows, w.size())) return proof;
  if (in_fractions && static_cast<Index>(rows.rows.size()) <= most_exact_rows)
    return by_fractions(rows, w.size());
  return by_enclosure(rows, w.size());
}

}  // namespace convex::inline proof
