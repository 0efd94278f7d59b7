#include "convex/composite/affine_atoms.hpp"
#include "convex/composite/conjugate_atom.hpp"
#include "convex/composite/graph_algebra.hpp"
#include "convex/composite/graph_placement.hpp"

namespace convex::inline composite {
namespace {

/// Is M the map ξ -> x?
bool is_x(const SparseMatrix& M, Index n) {
  if (M.rows() != n || M.nonZeros() != n) return false;
  for (Index i = 0; i < n; ++i)
    if (M.coeff(i, i) != 1) return false;
  return true;
}

}  // namespace

GraphForm conjugate(const GraphForm& f) {
  // Linear terms shift the equation sum M_jᵀ p_j = (y, 0) by `shift`.
  Vector shift = Vector::Zero(f.n + f.k);
  double constant = -f.constant;
  std::vector<const GraphTerm*> terms;
  const GraphTerm* eliminated = nullptr;
  Index size = 0;
  for (const GraphTerm& term : f.terms) {
    if (const auto linear = linear_form(*term.f, term.M.rows())) {
      shift += term.scale * (term.M.transpose() * linear->c);
      constant -= term.scale * (linear->c.dot(term.b) + linear->constant);
    } else if (!eliminated && is_x(term.M, f.n)) {
      eliminated = &term;
    } else {
      terms.push_back(&term);
      size += term.M.rows();
    }
  }
  // ξ = (y, p). The left sides of the equation, (y, 0) - sum M_jᵀ p_j = shift.
  const Index columns = f.n + size;
  GraphForm dual{f.n, size, {}, constant, f.by_point, f.by_slope};
  SparseMatrix left(f.n + f.k, columns);
  {
    std::vector<Eigen::Triplet<double>> entries;
    for (Index i = 0; i < f.n; ++i) entries.emplace_back(i, i, 1);
    Index start = f.n;
    for (const GraphTerm* term : terms) {
      for (Index c = 0; c < term->M.outerSize(); ++c)
        for (SparseMatrix::InnerIterator entry(term->M, c); entry; ++entry)
          entries.emplace_back(c, start + entry.row(), -entry.value());
      start += term->M.rows();
    }
    left.setFromTriplets(entries.begin(), entries.end());
  }
  const auto add = [&](const GraphTerm& term, const SparseMatrix& p, const Vector& p_shift) {
    const Index rows = term.M.rows();
    dual.terms.push_back(
        {conjugate_atom(term.f, rows), term.scale, SparseMatrix(p / term.scale), p_shift / term.scale});
    if (term.b.isZero(0)) return;
    dual.terms.push_back(linear_term(p, -term.b));
    dual.constant -= term.b.dot(p_shift);
  };
  const SparseRows rows = left;
  if (eliminated) add(*eliminated, rows.topRows(f.n), -shift.head(f.n));
  Index start = f.n;
  for (const GraphTerm* term : terms) {
    add(*term, selection(start, term->M.rows(), columns), Vector::Zero(term->M.rows()));
    start += term->M.rows();
  }
  const Index equations = eliminated ? f.k : f.n + f.k;
  if (equations > 0)
    dual.terms.push_back(
        {point_atom(Vector::Zero(equations)), 1, rows.bottomRows(equations), -shift.tail(equations)});
  return dual;
}

}  // namespace convex::inline composite
