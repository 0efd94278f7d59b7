#include "convex/exact_program/exact_gram.hpp"

namespace convex::inline exact_programs {

ExactGram exact_gram(const Metric& W) {
  ExactGram made;
  made.rows.resize(static_cast<std::size_t>(W.dimension()));
  const auto set = [&](Index i, Index j, double value) {
    if (value == 0) return;
    made.rows[static_cast<std::size_t>(i)][static_cast<std::size_t>(j)] = fraction(value);
    made.is_diagonal = made.is_diagonal && i == j;
  };
  switch (W.kind()) {
    case MetricKind::dense:
      for (Index i = 0; i < W.dimension(); ++i)
        for (Index j = 0; j < W.dimension(); ++j) set(i, j, W.dense_gram()(i, j));
      break;
    case MetricKind::sparse:
      for (Index j = 0; j < W.sparse_gram().outerSize(); ++j)
        for (SparseMatrix::InnerIterator it(W.sparse_gram(), j); it; ++it) set(it.row(), j, it.value());
      break;
    default:
      for (Index i = 0; i < W.dimension(); ++i) set(i, i, W.diagonal()[i]);
  }
  return made;
}

ExactGram identity_gram(std::size_t n) {
  ExactGram made;
  made.rows.resize(n);
  for (std::size_t i = 0; i < n; ++i) made.rows[i][i] = Fraction{1};
  return made;
}

ExactGram exact_gram(const std::vector<Fractions>& rows) {
  ExactGram made;
  made.rows.resize(rows.size());
  for (std::size_t i = 0; i < rows.size(); ++i)
    for (std::size_t j = 0; j < rows.size(); ++j) {
      const Fraction mean =
          rows[i][j] == rows[j][i] ? rows[i][j] : (rows[i][j] + rows[j][i]) * Fraction{1, 2};
      add(made.rows[i], j, mean);
      made.is_diagonal = made.is_diagonal && (i == j || sign(mean) == 0);
    }
  return made;
}

ExactGram block(const ExactGram& W, std::size_t first, std::size_t n) {
  ExactGram made;
  made.rows.resize(n);
  for (std::size_t i = 0; i < n; ++i)
    for (const auto& [j, value] : W.rows[first + i])
      if (j >= first && j < first + n) {
        made.rows[i][j - first] = value;
        made.is_diagonal = made.is_diagonal && j == first + i;
      }
  return made;
}

Metric rounded(const ExactGram& W) {
  const auto n = static_cast<Index>(W.dimension());
  Matrix gram = Matrix::Zero(n, n);
  bool is_identity = W.is_diagonal;
  for (std::size_t i = 0; i < W.dimension(); ++i)
    for (const auto& [j, value] : W.rows[i]) {
      gram(static_cast<Index>(i), static_cast<Index>(j)) = nearest_double(value);
      is_identity = is_identity && value == Fraction{1};
    }
  if (is_identity && (gram.diagonal().array() == 1).all()) return Metric::identity(n);
  return W.is_diagonal ? Metric::diagonal(gram.diagonal()) : Metric::dense(gram);
}

Fractions multiply(const ExactGram& W, const Fractions& x) {
  // Over one denominator x costs no common factors in each of the products.
  const ExactVector whole = exact_vector(x);
  Fractions numerators, product;
  for (const Integer& entry : whole.numerators) numerators.push_back({entry, 1});
  for (const ExactRow& row : W.rows) product.push_back(dot(row, numerators) * Fraction{1, whole.denominator});
  return product;
}

Fraction squared_norm(const ExactGram& W, const Fractions& x) { return dot(x, multiply(W, x)); }

}  // namespace convex::inline exact_programs
