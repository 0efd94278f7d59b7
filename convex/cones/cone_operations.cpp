#include "convex/cones/cone_operations.hpp"

#include <algorithm>

#include "convex/invalid_input.hpp"

namespace convex::inline cones {
namespace {

void require_dimension(Index found, Index wanted, const char* where) {
  if (found != wanted)
    throw InvalidInput(std::string(where) + ": " + std::to_string(found) + " dimensions; give " +
                       std::to_string(wanted));
}

IntegerRows multiplied(const IntegerRows& rows, const IntegerRows& A) {
  IntegerRows products;
  for (const IntegerVector& row : rows) {
    products.push_back(times(row, A));
    make_primitive(products.back());
  }
  return products;
}

IntegerRows basis(const IntegerRows& rows, Index n) {
  return echelon(rows, static_cast<std::size_t>(n)).rows;
}

IntegerRows negated(IntegerRows rows) {
  for (IntegerVector& row : rows)
    for (Integer& entry : row) entry = -entry;
  return rows;
}

ExactRows exact(const IntegerRows& rows) {
  ExactRows made;
  for (const IntegerVector& row : rows) made.push_back({row, 1});
  return made;
}

ExactRows exact_both(const IntegerRows& first, const IntegerRows& second) {
  ExactRows both = exact(first);
  for (const IntegerVector& row : second) both.push_back({row, 1});
  return both;
}

IntegerRows transposed(const IntegerRows& rows, std::size_t columns) {
  IntegerRows result(columns, IntegerVector(rows.size(), 0));
  for (std::size_t i = 0; i < rows.size(); ++i)
    for (std::size_t j = 0; j < columns; ++j) result[j][i] = rows[i][j];
  return result;
}

}  // namespace

PolyhedralCone polar(const PolyhedralCone& K, const ExactMetric& W) {
  require_dimension(W.dimension(), K.n, "metric");
  return {K.n, multiplied(K.halfspaces, W.inverse.adjugate),
          basis(multiplied(K.equations, W.inverse.adjugate), K.n), multiplied(K.generators, W.gram),
          basis(multiplied(K.lines, W.gram), K.n)};
}

PolyhedralCone polar(const PolyhedralCone& K) {
  return {K.n, K.halfspaces, K.equations, K.generators, K.lines};
}

PolyhedralCone dual(const PolyhedralCone& K, const ExactMetric& W) {
  PolyhedralCone result = polar(K, W);
  result.generators = negated(std::move(result.generators));
  result.halfspaces = negated(std::move(result.halfspaces));
  return result;
}

PolyhedralCone intersection(const PolyhedralCone& first, const PolyhedralCone& second) {
  require_dimension(second.n, first.n, "intersection");
  return halfspace_cone(exact_both(first.halfspaces, second.halfspaces),
                        exact_both(first.equations, second.equations), first.n);
}

PolyhedralCone sum(const PolyhedralCone& first, const PolyhedralCone& second) {
  require_dimension(second.n, first.n, "sum");
  return generated_cone(exact_both(first.generators, second.generators),
                        exact_both(first.lines, second.lines), first.n);
}

PolyhedralCone image(const PolyhedralCone& K, const ExactRows& M) {
  for (const ExactVector& row : M) require_dimension(row.size(), K.n, "image: a row of the matrix");
  const IntegerRows columns = transposed(over_one_denominator(M).rows, static_cast<std::size_t>(K.n));
  const auto mapped = [&](const IntegerRows& rows) { return exact(multiplied(rows, columns)); };
  return generated_cone(mapped(K.generators), mapped(K.lines), static_cast<Index>(M.size()));
}

PolyhedralCone preimage(const PolyhedralCone& K, const ExactRows& M) {
  require_dimension(static_cast<Index>(M.size()), K.n, "preimage: the rows of the matrix");
  for (const ExactVector& row : M)
    require_dimension(row.size(), M.front().size(), "preimage: a row of the matrix");
  const IntegerRows rows = over_one_denominator(M).rows;
  const auto mapped = [&](const IntegerRows& covectors) { return exact(multiplied(covectors, rows)); };
  return halfspace_cone(mapped(K.halfspaces), mapped(K.equations), M.front().size());
}

bool contains(const PolyhedralCone& K, const ExactVector& x) {
  require_dimension(x.size(), K.n, "point");
  const auto side = [&](const IntegerVector& a) { return dot(a, x.numerators).sign(); };
  return std::all_of(K.halfspaces.begin(), K.halfspaces.end(), [&](const auto& a) { return side(a) <= 0; }) &&
         std::all_of(K.equations.begin(), K.equations.end(), [&](const auto& e) { return side(e) == 0; });
}

bool contains(const PolyhedralCone& K, const Vector& x) { return contains(K, exact_vector(x)); }

bool includes(const PolyhedralCone& K, const PolyhedralCone& part) {
  require_dimension(part.n, K.n, "includes");
  const auto has = [&](const IntegerVector& v) { return contains(K, ExactVector{v, 1}); };
  const IntegerRows opposite = negated(part.lines);
  return std::all_of(part.generators.begin(), part.generators.end(), has) &&
         std::all_of(part.lines.begin(), part.lines.end(), has) &&
         std::all_of(opposite.begin(), opposite.end(), has);
}

bool are_equal(const PolyhedralCone& first, const PolyhedralCone& second) {
  return includes(first, second) && includes(second, first);
}

}  // namespace convex::inline cones
