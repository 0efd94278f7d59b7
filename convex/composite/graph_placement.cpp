#include "convex/composite/graph_placement.hpp"

#include "convex/composite/affine_atoms.hpp"

namespace convex::inline composite {

SparseMatrix placed(Index columns, const SparseMatrix& x_part, Index w_start, Index k) {
  std::vector<Eigen::Triplet<double>> entries;
  for (Index c = 0; c < x_part.outerSize(); ++c)
    for (SparseMatrix::InnerIterator entry(x_part, c); entry; ++entry)
      entries.emplace_back(entry.row(), c, entry.value());
  for (Index i = 0; i < k; ++i) entries.emplace_back(x_part.rows() + i, w_start + i, 1);
  SparseMatrix place(x_part.rows() + k, columns);
  place.setFromTriplets(entries.begin(), entries.end());
  return place;
}

SparseMatrix selection(Index first, Index rows, Index columns, double factor) {
  SparseMatrix S(rows, columns);
  S.reserve(Eigen::VectorXi::Constant(static_cast<int>(columns), 1));
  for (Index i = 0; i < rows; ++i) S.insert(i, first + i) = factor;
  S.makeCompressed();
  return S;
}

void add_terms(GraphForm& sum, const GraphForm& f, const SparseMatrix& place, const Vector& b) {
  for (const GraphTerm& term : f.terms)
    sum.terms.push_back(
        {term.f, term.scale, SparseMatrix(term.M * place), term.b + term.M.leftCols(f.n) * b});
  sum.constant += f.constant;
  sum.by_slope = sum.by_slope || f.by_slope;
  sum.by_point = sum.by_point || f.by_point;
}

std::optional<QuadraticForm> linear_form(const Atom& f, Index n) {
  std::optional<QuadraticForm> form = f.quadratic_form(n);
  if (form && form->Q.nonZeros() > 0) form.reset();
  return form;
}

GraphTerm linear_term(const SparseMatrix& M, const Vector& a) {
  return {linear_atom(a), 1, M, Vector::Zero(a.size())};
}

}  // namespace convex::inline composite
