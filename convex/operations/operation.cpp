#include "convex/operations/operation.hpp"

#include <cmath>
#include <limits>

#include "convex/composite/composite_prox.hpp"
#include "convex/functions/closed_form.hpp"
#include "convex/linear_quadratic/properness.hpp"
#include "convex/linear_quadratic/prox.hpp"
#include "convex/linear_quadratic/value.hpp"
#include "convex/operations/operations.hpp"

namespace convex {
namespace {

/// Moving a point or covector from a part to the whole costs a few roundings of each of its terms.
constexpr double roundings_of_a_move = 4;

/// So much of the scale squared weighs more than any function: the prox is then the nearest point of the
/// domain.
constexpr double nearest_point_weight = 1e12;

[[noreturn]] void refuse(const FunctionNode& f, const char* what) {
  throw InvalidInput(
      f.call().name + ": its " + what +
      " needs the parts as programs, and one is known by value and prox alone; use functions of "
      "`moreau functions`");
}

}  // namespace

double Operation::value(const Vector& x) const {
  double found = std::numeric_limits<double>::quiet_NaN();
  if (const auto form = linear_quadratic(x.size())) found = convex::value(*form, x);
  if (!std::isnan(found)) return found;
  if (const auto form = graph(x.size())) return evaluate(*form, x).value;
  refuse(*this, "value");
}

Prox Operation::prox(const Vector& z, const Metric& W) const {
  if (std::optional<Prox> reduced = reduced_prox(z, W)) return *std::move(reduced);
  if (const auto form = linear_quadratic(z.size())) return convex::prox(*form, z, W);
  if (const auto form = graph(z.size())) return convex::prox(*form, z, W);
  refuse(*this, "prox in this metric");
}

std::optional<Vector> Operation::subgradient(const Vector& x) const {
  if (const auto form = linear_quadratic(x.size())) return evaluate(*form, x).v;
  if (const auto form = graph(x.size())) return evaluate(*form, x).v;
  refuse(*this, "subgradient");
}

Function Operation::conjugate() const { return computed_conjugate(self()); }

Prox moved(Prox part, Vector x, Vector v, double bound, const Vector& z, const Metric& W) {
  if (part.status == Status::infeasible || part.x.size() == 0) return part;
  const double rounding = roundings_of_a_move * unit_roundoff * (W.norm(z) + W.norm(x) + W.dual_norm(v));
  part.error_bound = bound + W.dual_norm(stationarity(z, W, x, v)) + rounding;
  part.x = std::move(x);
  part.v = std::move(v);
  return part;
}

double value_near(const Function& f, const Vector& y, double size) {
  const double value = f(y);
  if (!(value == std::numeric_limits<double>::infinity()) || !(size > 0)) return value;
  const double weight = f.facts().indicator ? 1 : nearest_point_weight / (size * size);
  if (!std::isfinite(weight) || !(weight > 0)) return value;
  const Prox nearest = f.prox(y, Metric::diagonal(Vector::Constant(y.size(), weight)));
  if (nearest.x.size() != y.size() || !((nearest.x - y).norm() <= membership_tolerance * size)) return value;
  return f(nearest.x);
}

void require_fit(const Function& f, const Vector& c, const char* where, const char* name) {
  const std::string start = std::string(where) + "(" + name + "): ";
  if (c.size() == 0) throw InvalidInput(start + "no entries; give at least one");
  if (f.dimension() != 0 && c.size() != f.dimension())
    throw InvalidInput(start + std::to_string(c.size()) + " entries, the function takes " +
                       std::to_string(f.dimension()) + "; give as many");
  f.node().require_size(c.size());
  if (!c.allFinite()) throw InvalidInput(start + "an entry is not finite; give finite numbers");
}

void require_positive(double number, const char* where, const char* name) {
  if (!(number > 0) || !std::isfinite(number))
    throw InvalidInput(std::string(where) + "(" + name +
                       "): not positive and finite; give a finite number above 0");
}

void require_proper(const Function& f, Index n, const char* where) {
  const auto refuse_empty = [&] {
    throw InvalidInput(std::string(where) +
                       ": no point has all its functions finite; give functions whose domains meet");
  };
  if (f.facts().finite) return;
  if (const auto form = f.node().linear_quadratic(n)) {
    if (properness(*form) == Defect::empty_domain) refuse_empty();
  } else if (auto graph = f.node().graph(n)) {
    // Terms that are finite everywhere leave the domain as it is, and would only pull at the gap.
    std::erase_if(graph->terms, [](const GraphTerm& term) { return term.f->facts().finite; });
    if (prox(*graph, Vector::Zero(n), Metric::identity(n)).status == Status::infeasible) refuse_empty();
  }
}

}  // namespace convex
