#include "convex/exact_program/exact_arguments.hpp"
#include "convex/exact_program/program_of_call.hpp"
#include "convex/exact_program/program_operations.hpp"

namespace convex::inline exact_programs {
namespace {

const Fraction unit_entry{1}, minus_entry{-1};

ExactProgram point(const Fractions& p) {
  ExactProgram form(p.size(), 0);
  for (std::size_t i = 0; i < p.size(); ++i) form.equation({{i, unit_entry}}, p[i]);
  return form;
}

ExactProgram box(const std::vector<ExtendedFraction>& lower, const std::vector<ExtendedFraction>& upper) {
  ExactProgram form(lower.size(), 0);
  for (std::size_t i = 0; i < lower.size(); ++i) {
    const bool low = lower[i].infinite == 0, high = upper[i].infinite == 0;
    if (low && high && lower[i].value == upper[i].value) {
      form.equation({{i, unit_entry}}, lower[i].value);
      continue;
    }
    if (low) form.bound({{i, unit_entry}}, lower[i].value);
    if (high) form.bound({{i, minus_entry}}, -upper[i].value);
  }
  return form;
}

ExactProgram box(std::size_t n, const ExtendedFraction& lower, const ExtendedFraction& upper) {
  return box(std::vector<ExtendedFraction>(n, lower), std::vector<ExtendedFraction>(n, upper));
}

ExactProgram ball1(std::size_t n, const Fraction& radius) {
  ExactProgram form(n, n);  // w_i >= |x_i|, their sum at most the radius
  ExactRow sum;
  for (std::size_t i = 0; i < n; ++i) {
    sum[n + i] = minus_entry;
    form.bound({{n + i, unit_entry}, {i, unit_entry}}, {});
    form.bound({{n + i, unit_entry}, {i, minus_entry}}, {});
  }
  form.bound(std::move(sum), -radius);
  return form;
}

/// lower <= x, x <= upper, Σ x_i = total.
ExactProgram with_total(ExactProgram form, const Fraction& total) {
  ExactRow sum;
  for (std::size_t i = 0; i < form.n; ++i) sum[i] = unit_entry;
  form.equation(std::move(sum), total);
  return form;
}

ExactProgram rows_of(const std::vector<ExactRow>& A, const std::vector<ExtendedFraction>& b, std::size_t n,
                     bool two_sided) {
  ExactProgram form(n, 0);
  for (std::size_t a = 0; a < A.size(); ++a) {
    if (b[a].infinite != 0) continue;
    ExactRow row;
    add(row, A[a], two_sided ? unit_entry : minus_entry);
    form.rows.push_back({std::move(row), two_sided ? b[a].value : -b[a].value, two_sided});
  }
  return form;
}

std::vector<ExtendedFraction> one_each(const ExactArguments& a, std::size_t rows) {
  return a.is_vector("b") ? a.extended("b") : std::vector<ExtendedFraction>(rows, a.extended("b").at(0));
}

ExactProgram generated(const std::vector<ExactRow>& generators, std::size_t n) {
  ExactProgram form(n, generators.size());
  std::vector<ExactRow> equations(n);  // x = Σ w_j generator_j
  for (std::size_t i = 0; i < n; ++i) equations[i][i] = unit_entry;
  for (std::size_t j = 0; j < generators.size(); ++j) {
    for (const auto& [i, value] : generators[j]) equations[i][n + j] = -value;
    form.bound({{n + j, unit_entry}}, {});
  }
  for (ExactRow& row : equations) form.equation(std::move(row), {});
  return form;
}

ExactProgram bounded_partial_sums(std::size_t n, const Fraction& bound) {
  ExactProgram form(n, 0);
  ExactRow sum, negative;
  for (std::size_t i = 0; i < n; ++i) {
    sum[i] = unit_entry;
    negative[i] = minus_entry;
    if (i + 1 == n) {
      form.equation(sum, {});
      continue;
    }
    form.bound(sum, -bound);
    form.bound(negative, -bound);
  }
  return form;
}

ExactProgram monotone_cone(std::size_t n) {
  ExactProgram form(n, 0);
  for (std::size_t i = 0; i + 1 < n; ++i) form.bound({{i, minus_entry}, {i + 1, unit_entry}}, {});
  return form;
}

}  // namespace

std::optional<ExactProgram> of_set(const Call& call, std::size_t n) {
  const ExactArguments a(call, n);
  const ExtendedFraction zero{}, none_above{{}, 1};
  if (call.name == "point") return point(a.vector("p"));
  if (call.name == "box") return box(a.extended("lower"), a.extended("upper"));
  if (call.name == "orthant") return box(n, zero, none_above);
  if (call.name == "ball1") return ball1(n, a.number("radius"));
  if (call.name == "ball_inf") return box(n, {-a.number("radius")}, {a.number("radius")});
  if (call.name == "simplex") return with_total(box(n, zero, none_above), a.number("total"));
  if (call.name == "capped_simplex") return with_total(box(n, zero, {a.number("cap")}), a.number("total"));
  if (call.name == "halfspace" || call.name == "hyperplane") {
    ExactRow row;
    const Fractions normal = a.vector("a");
    for (std::size_t i = 0; i < n; ++i) add(row, i, normal[i]);
    return rows_of({row}, {a.extended("b").at(0)}, n, call.name == "hyperplane");
  }
  if (call.name == "affine" || call.name == "polyhedron") {
    const std::vector<ExactRow> A = a.rows("A");
    return rows_of(A, one_each(a, A.size()), n, call.name == "affine");
  }
  if (call.name == "cone") return generated(a.rows("generators"), n);
  if (call.name == "bounded_partial_sums") return bounded_partial_sums(n, a.number("bound"));
  if (call.name == "monotone_cone") return monotone_cone(n);
  if (call.name == "ball2" && sign(a.number("radius")) == 0) return point(a.vector("center"));
  if (call.name == "signed_permutahedron") {
    if (const auto support = of_function({"sorted_norm1", call.arguments}, n)) return conjugate(*support);
  }
  return std::nullopt;
}

}  // namespace convex::inline exact_programs
