#include "convex/exact/positive_definite.hpp"
#include "convex/exact_program/exact_arguments.hpp"
#include "convex/exact_program/program_of_call.hpp"
#include "convex/exact_program/program_operations.hpp"

namespace convex::inline exact_programs {
namespace {

const Fraction zero{0}, one{1}, half{1, 2};

ExactProgram constant(std::size_t n, const Fraction& c) {
  ExactProgram form(n, 0);
  form.constant = c;
  return form;
}

/// p on the left of b, q on its right.
std::optional<ExactProgram> two_pieces(std::size_t n, const Fraction& b, ExactPiece left, ExactPiece right) {
  left.high = b;
  right.low = b;
  return of_pieces(n, {left, right});
}

ExactPiece piece(const Fraction& c2, const Fraction& c1, const Fraction& c0) { return {{}, {}, c2, c1, c0}; }

std::optional<ExactProgram> huber(std::size_t n, const Fraction& mu) {
  ExactPiece left = piece(zero, -one, -mu * half), middle = piece(one / mu, zero, zero),
             right = piece(zero, one, -mu * half);
  left.high = middle.low = -mu;
  middle.high = right.low = mu;
  return of_pieces(n, {left, middle, right});
}

/// weight_i |x_i|: w_i >= |x_i| at that price.
ExactProgram norm1(const Fractions& weights) {
  const std::size_t n = weights.size();
  ExactProgram form(n, n);
  for (std::size_t i = 0; i < n; ++i) {
    form.c[n + i] = weights[i];
    form.bound({{n + i, one}, {i, one}}, {});
    form.bound({{n + i, one}, {i, -one}}, {});
  }
  return form;
}

ExactProgram norm_inf(std::size_t n, const Fraction& weight) {
  ExactProgram form(n, 1);
  form.c[n] = weight;
  for (std::size_t i = 0; i < n; ++i)
    for (const Fraction& side : {one, -one}) form.bound({{n, one}, {i, side}}, {});
  return form;
}

ExactProgram max_affine(const std::vector<ExactRow>& A, const Fractions& b, std::size_t n) {
  ExactProgram form(n, 1);
  form.c[n] = one;
  for (std::size_t a = 0; a < A.size(); ++a) {
    ExactRow row{{n, one}};
    add(row, A[a], -one);
    form.bound(std::move(row), b[a]);
  }
  return form;
}

/// Adds weight times the sum of the k largest of the entries y_i that `entry` has as rows >= y_i: min over t
/// of k t + Σ max(0, y_i - t) (Rockafellar and Uryasev 2000).
ExactProgram sum_largest(std::size_t n, const Fraction& weight, std::size_t k, bool of_sizes) {
  ExactProgram form(n, n + 1);
  form.c[n] = weight * Fraction{static_cast<std::int64_t>(k)};
  for (std::size_t i = 0; i < n; ++i) {
    const std::size_t above = n + 1 + i;
    form.c[above] = weight;
    form.bound({{above, one}}, {});
    form.bound({{above, one}, {n, one}, {i, -one}}, {});
    if (of_sizes) form.bound({{above, one}, {n, one}, {i, one}}, {});
  }
  return form;
}

/// Σ_k (w_k - w_(k+1)) times the sum of the k largest sizes.
std::optional<ExactProgram> sorted_norm1(const Fractions& weights) {
  const std::size_t n = weights.size();
  std::vector<ExactProgram> terms = {constant(n, zero)};
  for (std::size_t k = 1; k <= n; ++k) {
    const Fraction step = weights[k - 1] - (k < n ? weights[k] : zero);
    if (sign(step) < 0) return std::nullopt;
    if (sign(step) > 0) terms.push_back(sum_largest(n, step, k, true));
  }
  return sum(terms);
}

ExactProgram total_variation(std::size_t n, const Fraction& weight) {
  if (n < 2) return constant(n, zero);
  std::vector<ExactRow> D(n - 1);
  for (std::size_t i = 0; i + 1 < n; ++i) D[i] = {{i, -one}, {i + 1, one}};
  return precompose(norm1(Fractions(n - 1, weight)), D, Fractions(n - 1), n);
}

/// Differences of neighbours, down and along, of the matrix stacked by columns.
ExactProgram total_variation_2d(std::size_t n, std::size_t rows, const Fraction& weight) {
  std::vector<ExactRow> D;
  for (std::size_t k = 0; k < n; ++k) {
    if ((k + 1) % rows != 0 && k + 1 < n) D.push_back({{k, -one}, {k + 1, one}});
    if (k + rows < n) D.push_back({{k, -one}, {k + rows, one}});
  }
  if (D.empty()) return constant(n, zero);
  return precompose(norm1(Fractions(D.size(), weight)), D, Fractions(D.size()), n);
}

std::optional<ExactProgram> quadratic(const ExactArguments& a) {
  std::vector<Fractions> rows;
  for (const auto& row : a.matrix("Q")) {
    rows.emplace_back();
    for (const ExtendedFraction& entry : row) rows.back().push_back(entry.value);
  }
  ExactProgram form(rows.size(), 0);
  form.H = exact_gram(rows).rows;
  if (!is_semidefinite(form.H)) return std::nullopt;
  form.c = a.vector("c");
  form.constant = a.number("constant");
  return form;
}

std::optional<ExactProgram> plq(const ExactArguments& a) {
  const Fractions breaks = a.is_vector("breaks") ? a.vector("breaks") : Fractions{a.number("breaks")};
  const auto rows = a.matrix("coefficients");
  std::vector<ExactPiece> pieces;
  for (std::size_t j = 0; j < rows.size(); ++j) {
    if (rows[j][0].infinite != 0) continue;
    ExactPiece made = piece(rows[j][0].value, rows[j][1].value, rows[j][2].value);
    if (j > 0) made.low = breaks[j - 1];
    if (j < breaks.size()) made.high = breaks[j];
    pieces.push_back(std::move(made));
  }
  return of_pieces(a.dimension(), pieces);
}

}  // namespace

namespace {

/// Of a full symmetric matrix in integers: all minors that elimination meets are positive, or belong to rows
/// that are 0 (Bareiss 1968).
bool is_semidefinite_in_integers(IntegerRows A) {
  Integer last = 1;
  for (std::size_t k = 0; k < A.size(); ++k) {
    const Integer pivot = A[k][k];
    if (pivot.sign() < 0) return false;
    if (pivot.is_zero()) {
      for (std::size_t j = k + 1; j < A.size(); ++j)
        if (!A[k][j].is_zero()) return false;
      continue;
    }
    for (std::size_t i = k + 1; i < A.size(); ++i)
      for (std::size_t j = i; j < A.size(); ++j)
        A[i][j] = exact_quotient(pivot * A[i][j] - A[k][i] * A[k][j], last);
    last = pivot;
  }
  return true;
}

/// Q times the denominator that its entries have in common.
IntegerRows in_integers(const std::vector<ExactRow>& Q) {
  const std::size_t n = Q.size();
  Fractions entries(n * n);
  for (std::size_t i = 0; i < n; ++i)
    for (const auto& [j, value] : Q[i]) entries[i * n + j] = value;
  const ExactVector made = exact_vector(entries);
  IntegerRows A;
  for (std::size_t i = 0; i < n; ++i) {
    const auto row = made.numerators.begin() + static_cast<std::ptrdiff_t>(i * n);
    A.emplace_back(row, row + static_cast<std::ptrdiff_t>(n));
  }
  return A;
}

}  // namespace

bool is_semidefinite(std::vector<ExactRow> Q) {
  std::size_t entries = 0;
  for (const ExactRow& row : Q) entries += row.size();
  constexpr std::size_t sparse_entries = 4;  // a row; fuller matrices are for integers
  if (entries > sparse_entries * Q.size()) {
    const IntegerRows A = in_integers(Q);
    return is_positive_definite(A) || is_semidefinite_in_integers(A);
  }
  for (std::size_t k = 0; k < Q.size(); ++k) {
    const auto pivot = Q[k].find(k);
    if (pivot == Q[k].end()) {
      if (!Q[k].empty()) return false;  // a 0 on the diagonal with something beside it
      continue;
    }
    const Fraction d = pivot->second;
    if (sign(d) < 0) return false;
    const ExactRow row = Q[k];
    Q[k].clear();
    for (const auto& [i, value] : row)
      if (i != k) {
        add(Q[i], row, -(value / d));
        Q[i].erase(k);
      }
  }
  return true;
}

std::optional<ExactProgram> of_function(const Call& call, std::size_t n) {
  const ExactArguments a(call, n);
  const std::string& name = call.name;
  if (name == "zero") return constant(n, zero);
  if (name == "constant") return constant(n, a.number("c") * Fraction{1});
  if (name == "linear") return tilt(constant(n, zero), a.vector("c"));
  if (name == "quadratic") return quadratic(a);
  if (name == "squared_norm2") return of_pieces(n, {piece(a.number("weight"), zero, zero)});
  if (name == "norm1") return norm1(a.vector("weight"));
  if (name == "huber") return huber(n, a.number("mu"));
  if (name == "hinge") return two_pieces(n, one, piece(zero, -one, one), piece(zero, zero, zero));
  if (name == "squared_hinge")
    return two_pieces(n, one, piece(Fraction{2}, Fraction{-2}, one), piece(zero, zero, zero));
  if (name == "elastic_net") {
    const Fraction l1 = a.number("l1"), l2 = a.number("l2");
    return two_pieces(n, zero, piece(l2, -l1, zero), piece(l2, l1, zero));
  }
  if (name == "plq") return plq(a);
  if (name == "norm_inf") return norm_inf(n, a.number("weight"));
  if (name == "max") {
    std::vector<ExactRow> entries(n);
    for (std::size_t i = 0; i < n; ++i) entries[i][i] = one;
    return max_affine(entries, Fractions(n), n);
  }
  if (name == "sum_largest")
    return sum_largest(n, one, static_cast<std::size_t>(nearest_double(a.number("k"))), false);
  if (name == "max_affine") {
    const std::vector<ExactRow> A = a.rows("A");
    return max_affine(A, a.is_vector("b") ? a.vector("b") : Fractions(A.size(), a.number("b")), n);
  }
  if (name == "total_variation") return total_variation(n, a.number("weight"));
  if (name == "total_variation_2d")
    return total_variation_2d(n, static_cast<std::size_t>(nearest_double(a.number("rows"))),
                              a.number("weight"));
  if (name == "pinball") {
    const Fraction tau = a.number("tau");
    return two_pieces(n, zero, piece(zero, tau - one, zero), piece(zero, tau, zero));
  }
  if (name == "k_support" && a.number("k") == one) return norm1(Fractions(n, a.number("weight")));
  if (name == "sorted_norm1") return sorted_norm1(a.vector("weights"));
  if (name == "norm2" && sign(a.number("weight")) == 0) return constant(n, zero);
  if (name == "power" && a.number("p") == one) return norm1(Fractions(n, one));
  if (name == "power" && a.number("p") == Fraction{2}) return of_pieces(n, {piece(Fraction{2}, zero, zero)});
  return std::nullopt;
}

}  // namespace convex::inline exact_programs
