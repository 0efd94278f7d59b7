#include "convex/composite/affine_atoms.hpp"
#include "convex/composite/epigraph.hpp"
#include "convex/composite/graph_algebra.hpp"
#include "convex/composite/graph_placement.hpp"
#include "convex/composite/perspective.hpp"
#include "convex/invariant.hpp"
#include "convex/linear_algebra/symmetric_eigen.hpp"

namespace convex::inline composite {
namespace {

/// The two matrices one above the other.
SparseMatrix stacked(const SparseMatrix& top, const SparseMatrix& bottom) {
  std::vector<Eigen::Triplet<double>> entries;
  for (Index c = 0; c < top.outerSize(); ++c)
    for (SparseMatrix::InnerIterator entry(top, c); entry; ++entry)
      entries.emplace_back(entry.row(), c, entry.value());
  for (Index c = 0; c < bottom.outerSize(); ++c)
    for (SparseMatrix::InnerIterator entry(bottom, c); entry; ++entry)
      entries.emplace_back(top.rows() + entry.row(), c, entry.value());
  SparseMatrix whole(top.rows() + bottom.rows(), top.cols());
  whole.setFromTriplets(entries.begin(), entries.end());
  return whole;
}

/// a · M as a row.
SparseMatrix row_of(const Vector& a, const SparseMatrix& M) {
  const Matrix row = a.transpose() * M;
  return row.sparseView();
}

Vector appended(const Vector& b, double last) {
  Vector whole(b.size() + 1);
  whole << b, last;
  return whole;
}

/// A quadratic term as ½|Lᵀu|² and what is linear in u, Q = L Lᵀ of full column rank. A singular Q bends only
/// along Lᵀ; along the rest a prox in a small metric runs away, and its Qu is rounding.
struct SplitQuadratic {
  SparseMatrix root;  ///< Lᵀ: rank × rows
  Vector c;
  double constant = 0;
};

std::optional<SplitQuadratic> split_quadratic(const Atom& f, Index rows) {
  constexpr double rank_tolerance = 8 * unit_roundoff;  // of an eigenvalue, times n and the largest
  const auto form = f.quadratic_form(rows);
  if (!form || form->Q.nonZeros() == 0) return std::nullopt;
  const linear_algebra::SymmetricEigen eigen{Matrix(form->Q)};
  const Vector& values = eigen.values;
  const Index rank =
      (values.array() > rank_tolerance * static_cast<double>(rows) * values.cwiseAbs().maxCoeff()).count();
  const Matrix L = eigen.vectors.rightCols(rank) * values.tail(rank).cwiseSqrt().asDiagonal();
  return SplitQuadratic{L.transpose().sparseView(), form->c, form->constant};
}

/// The form with each quadratic term as half a square of independent rows, and linear terms.
GraphForm with_half_squares(const GraphForm& f) {
  GraphForm made{f.n, f.k, {}, f.constant, f.by_slope, f.by_point};
  for (const GraphTerm& term : f.terms) {
    const auto parts = split_quadratic(*term.f, term.M.rows());
    if (!parts) {
      made.terms.push_back(term);
      continue;
    }
    made.terms.push_back(
        {half_square_atom(), term.scale, SparseMatrix(parts->root * term.M), Vector(parts->root * term.b)});
    made.constant += term.scale * parts->constant;
    if (!parts->c.isZero(0)) made.terms.push_back({linear_atom(parts->c), term.scale, term.M, term.b});
  }
  return made;
}

}  // namespace

GraphForm epigraph(const GraphForm& given, double slope) {
  const GraphForm f = with_half_squares(given);
  std::vector<const GraphTerm*> heights;  // terms with a height of their own
  for (const GraphTerm& term : f.terms)
    if (!linear_form(*term.f, term.M.rows()) && !term.f->facts().indicator) heights.push_back(&term);
  const Index n = f.n + 1, own = std::max<Index>(1, static_cast<Index>(heights.size())) - 1;
  const Index columns = n + f.k + own;
  // ξ = (x, t, w, heights of all such terms but the first).
  GraphForm set{n, f.k + own, {}, 0, true, f.by_point};
  const SparseMatrix place = placed(columns, selection(0, f.n, columns), n, f.k);
  // What is left of t for the first: t - constant - linear terms - the other heights.
  SparseMatrix rest = selection(f.n, 1, columns);
  double rest_shift = -f.constant;
  for (const GraphTerm& term : f.terms) {
    const SparseMatrix M = term.M * place;
    if (const auto linear = linear_form(*term.f, term.M.rows())) {
      rest = SparseMatrix(rest - term.scale * row_of(linear->c, M));
      rest_shift -= term.scale * (linear->c.dot(term.b) + linear->constant);
    } else if (term.f->facts().indicator) {
      set.terms.push_back({term.f, 1, M, term.b});
    }
  }
  for (std::size_t j = 1; j < heights.size(); ++j) {
    const GraphTerm& term = *heights[j];
    const SparseMatrix height = selection(n + f.k + static_cast<Index>(j) - 1, 1, columns);
    const double unit = slope / term.scale;
    set.terms.push_back({epigraph_atom(term.f, term.M.rows(), unit), 1,
                         stacked(SparseMatrix(term.M * place), SparseMatrix(height / unit)),
                         appended(term.b, 0)});
    rest = SparseMatrix(rest - term.scale * height);
  }
  if (heights.empty()) {
    set.terms.push_back({orthant_atom(), 1, rest, Vector::Constant(1, rest_shift)});
  } else {
    const GraphTerm& term = *heights[0];
    set.terms.push_back({epigraph_atom(term.f, term.M.rows(), slope / term.scale), 1,
                         stacked(SparseMatrix(term.M * place), SparseMatrix(rest / slope)),
                         appended(term.b, rest_shift / slope)});
  }
  return set;
}

GraphForm pointwise_max(std::span<const GraphForm> f, double slope) {
  invariant(!f.empty(), "a maximum of graph forms has a term");
  std::vector<GraphForm> sets;
  for (const GraphForm& part : f) sets.push_back(epigraph(part, slope));
  GraphForm least = sum(sets);
  // t, the last entry of the sets, is the first auxiliary variable of the maximum.
  --least.n;
  ++least.k;
  const SparseMatrix t = selection(least.n, 1, least.n + least.k);
  // Measured like the heights, it makes the equations of the conjugate of one size too.
  Vector units = Vector::Ones(least.n + least.k);
  units[least.n] = slope;
  for (GraphTerm& term : least.terms) term.M = SparseMatrix(term.M * units.asDiagonal());
  least.terms.push_back(linear_term(t, Vector::Constant(1, slope)));
  return least;
}

GraphForm perspective(const GraphForm& given) {
  const GraphForm f = with_half_squares(given);
  const Index n = f.n + 1, columns = n + f.k;
  GraphForm cone{n, f.k, {}, 0, f.by_slope, f.by_point};
  const SparseMatrix place = placed(columns, selection(0, f.n, columns), n, f.k);
  const SparseMatrix s = selection(f.n, 1, columns);
  SparseMatrix slope = f.constant * s;
  bool bounded = false;
  for (const GraphTerm& term : f.terms) {
    const SparseMatrix M = SparseMatrix(term.M * place) + SparseMatrix(term.b.sparseView()) * s;
    if (const auto linear = linear_form(*term.f, term.M.rows())) {
      slope = SparseMatrix(slope + term.scale * (row_of(linear->c, M) + linear->constant * s));
      continue;
    }
    bounded = true;
    cone.terms.push_back({perspective_atom(term.f, term.M.rows()), term.scale, stacked(M, s),
                          Vector::Zero(term.M.rows() + 1)});
  }
  if (slope.nonZeros() > 0) cone.terms.push_back(linear_term(slope, Vector::Ones(1)));
  if (!bounded) cone.terms.push_back({orthant_atom(), 1, s, Vector::Zero(1)});
  return cone;
}

}  // namespace convex::inline composite
