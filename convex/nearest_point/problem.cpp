#include "convex/nearest_point/problem.hpp"

#include <numeric>
#include <string>

#include "convex/counted.hpp"
#include "convex/dense/dense_kernels.hpp"
#include "convex/invalid_input.hpp"

namespace convex {
namespace {

void require_size(const char* name, Index size, Index expected, const char* unit) {
  if (size != expected)
    throw InvalidInput(std::string(name) + ": " + counted(size, "entry", "entries") + "; give " +
                       std::to_string(expected) + ", one per " + unit);
}

void require_finite(const char* name, const Vector& x) {
  if (dense_kernels().is_finite(x.size(), x.data())) return;
  for (Index i = 0; i < x.size(); ++i)
    if (!std::isfinite(x[i]))
      throw InvalidInput(std::string(name) + ": " + name + "[" + std::to_string(i) +
                         "] is not finite; give finite numbers");
}

}  // namespace

std::optional<DataRadii> select(const std::optional<DataRadii>& radii, const std::vector<Index>& rows) {
  if (!radii) return std::nullopt;
  return DataRadii{radii->row(rows), radii->s(rows)};
}

std::vector<bool> marked(Index count, const std::vector<Index>& chosen) {
  std::vector<bool> mark(at(count), false);
  for (Index a : chosen) mark[at(a)] = true;
  return mark;
}

std::vector<Index> indices_below(Index count) {
  std::vector<Index> all(at(count));
  std::iota(all.begin(), all.end(), Index{0});
  return all;
}

Vector unit_lengths(const Metric& A) {
  constexpr Index many = 500;  // beyond, an inverse takes longer than what needs it
  if (is_diagonal(A) || A.dimension() > many) return A.diagonal().cwiseSqrt().cwiseInverse();
  Matrix units = Matrix::Identity(A.dimension(), A.dimension());
  A.whiten_in_place(units);
  return units.colwise().norm();
}

Vector longest_within(const ConstraintRows& U, const Metric& A) {
  if (is_diagonal(A)) return U.lengths(A.diagonal().cwiseInverse());
  const Vector unit = unit_lengths(A);
  Vector longest(U.count());
  for (Index a = 0; a < U.count(); ++a) longest[a] = U.absolute_dot(a, unit);
  return longest;
}

DataRadii rounding_radii(const NearestPointProblem& problem, double roundings) {
  const double part = roundings * unit_roundoff;
  return {part * longest_within(problem.U, problem.A), part * problem.s.cwiseAbs()};
}

void validate(const NearestPointProblem& problem) {
  require_size("z", problem.z.size(), problem.dimension(), "coordinate");
  require_size("s", problem.s.size(), problem.rows(), "row of U");
  if (problem.rows() > 0 && problem.U.dimension() != problem.dimension())
    throw InvalidInput("U: rows of " + counted(problem.U.dimension(), "entry", "entries") + "; give " +
                       std::to_string(problem.dimension()) + ", one per coordinate");
  if (problem.radii) {
    require_size("radii of rows", problem.radii->row.size(), problem.rows(), "row of U");
    require_size("radii of s", problem.radii->s.size(), problem.rows(), "row of U");
    for (const Vector* radii : {&problem.radii->row, &problem.radii->s})
      if (!(radii->array() >= 0).all())
        throw InvalidInput("radii: one is negative or no number; give what the data are known to");
  }
  require_finite("z", problem.z);
  require_finite("s", problem.s);
  if (!problem.U.is_finite())
    for (Index a = 0; a < problem.rows(); ++a)
      if (!problem.U.row(a).allFinite())
        throw InvalidInput("U: row " + std::to_string(a) +
                           " has an entry that is not finite; give finite numbers");
  for (std::size_t k = 0; k < problem.two_sided.size(); ++k) {
    const Index a = problem.two_sided[k];
    if (a < 0 || a >= problem.rows())
      throw InvalidInput("two_sided: no row " + std::to_string(a) + "; rows run from 0 to " +
                         std::to_string(problem.rows() - 1));
    if (k > 0 && problem.two_sided[k - 1] >= a)
      throw InvalidInput("two_sided: row " + std::to_string(a) +
                         " out of order or twice; list each row once");
  }
}

void validate_guess(const NearestPointProblem& problem, const std::vector<Index>& guess) {
  for (const Index a : guess)
    if (a < 0 || a >= problem.rows())
      throw InvalidInput("guess: no row " + std::to_string(a) + "; rows run from 0 to " +
                         std::to_string(problem.rows() - 1));
}

}  // namespace convex
