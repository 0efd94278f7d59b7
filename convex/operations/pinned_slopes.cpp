#include "convex/operations/pinned_slopes.hpp"

#include <algorithm>
#include <cmath>

#include "convex/exact_program/exact_minimum.hpp"
#include "convex/linear_quadratic/operations.hpp"
#include "convex/operations/operation.hpp"
#include "convex/operations/operations.hpp"
#include "convex/operations/quadratic_term.hpp"
#include "convex/operations/supremum.hpp"

namespace convex::inline operations {
namespace {

/// Programs beyond this many variables and rows are not looked at: a question of its construction should cost
/// no more than its proxes.
constexpr std::size_t most_variables = 64;

/// The conditions on ξ = (v, w) that v lies in the domain of g* and in the box, as a program of 0.
ExactProgram slopes_in_common(const std::optional<LinearQuadratic>& dual, const std::vector<Interval>& box) {
  const std::size_t n = box.size();
  ExactProgram domain(0, n);
  if (dual) {
    ExactProgram rows = exact(*dual);
    domain = ExactProgram(0, rows.variables());
    domain.rows = std::move(rows.rows);
  }
  for (std::size_t i = 0; i < n; ++i) {
    if (std::isfinite(box[i].low)) domain.bound({{i, fraction(1)}}, fraction(box[i].low));
    if (std::isfinite(box[i].high)) domain.bound({{i, fraction(-1)}}, fraction(-box[i].high));
  }
  return domain;
}

/// The one value of v_i, where there is only one, and a double.
std::optional<double> only_value(const ExactProgram& domain, std::size_t i) {
  const auto least = [&](double sign) -> std::optional<Fraction> {
    ExactProgram program = domain;
    program.c[i] = fraction(sign);
    const ExactValue found = exact_value(program, {});
    return found.end == ProgramEnd::minimum ? std::optional(found.value) : std::nullopt;
  };
  const auto low = least(1);
  if (!low) return std::nullopt;
  const double value = nearest_double(*low);
  if (!std::isfinite(value) || !(fraction(value) == *low)) return std::nullopt;
  const auto high = least(-1);
  return high && -*high == *low ? std::optional(value) : std::nullopt;
}

}  // namespace

std::optional<Function> with_pinned_slopes(const Function& f, const Function& g, Index n) {
  if ((n > 1 && !f.facts().separable) || f.facts().piecewise_quadratic) return std::nullopt;
  std::vector<Interval> box;
  bool bounded = false;
  for (Index i = 0; i < n; ++i) {
    const Vector axis = Vector::Unit(n, i);
    const auto reach = [&](double sign) {
      return std::min(f.node().recession(sign * axis), g.node().recession(sign * axis));
    };
    box.push_back({-reach(-1), reach(1)});
    if (std::isnan(box.back().low) || std::isnan(box.back().high)) return std::nullopt;
    bounded = bounded || std::isfinite(box.back().low) || std::isfinite(box.back().high);
  }
  if (!bounded) return std::nullopt;
  std::optional<LinearQuadratic> dual;
  if (const auto form = g.facts().piecewise_quadratic ? g.node().linear_quadratic(n) : std::nullopt)
    dual = linear_quadratic::conjugate(*form);
  const ExactProgram domain = slopes_in_common(dual, box);
  if (domain.variables() + domain.rows.size() > most_variables) return std::nullopt;
  std::vector<Function> entries;
  bool pinned = false;
  for (Index i = 0; i < n; ++i) {
    const auto entry = n == 1 ? std::optional(f) : f.node().entry(i);
    if (!entry) return std::nullopt;
    entries.push_back(*entry);
    if (entry->facts().piecewise_quadratic) continue;
    const auto slope = only_value(domain, static_cast<std::size_t>(i));
    if (!slope) continue;
    const Vector at = Vector::Constant(1, *slope);
    const Value end = entry->conjugate().evaluate(at);
    if (!std::isfinite(end.value) || !(end.error <= accuracy_of_prox * std::max(1.0, std::abs(end.value))))
      return std::nullopt;
    entries.back() = function_of({SparseMatrix(1, 1), at, -end.value});
    pinned = true;
  }
  if (!pinned) return std::nullopt;
  if (n == 1) return entries[0];
  const std::optional<Value> constant = f.node().constant_beside_entries();
  if (!constant || !is_of_rounding(*constant)) return std::nullopt;
  return raised(separable(entries, std::vector<Index>(static_cast<std::size_t>(n), 1)), constant->value);
}

}  // namespace convex::inline operations
