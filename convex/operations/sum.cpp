#include "convex/operations/sum.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <numeric>
#include <typeinfo>

#include "convex/composite/graph_algebra.hpp"
#include "convex/exact/exact_sum.hpp"
#include "convex/linear_quadratic/functions.hpp"
#include "convex/linear_quadratic/operations.hpp"
#include "convex/operations/composed_prox.hpp"
#include "convex/operations/implied_bounds.hpp"
#include "convex/operations/metric_algebra.hpp"
#include "convex/operations/operations.hpp"
#include "convex/operations/reduction.hpp"
#include "convex/operations/two_function_max.hpp"
#include "convex/operations/value_near.hpp"

namespace convex::inline operations {

namespace {

/// Each number rounded once, however many terms there are and whatever cancels between them.
QuadraticTerm total_of(const std::vector<QuadraticTerm>& terms, Index n) {
  if (terms.size() == 1) return terms[0];
  QuadraticTerm total{SparseMatrix(n, n), Vector(n), 0};
  ExactSum constant;
  std::vector<ExactSum> c(static_cast<std::size_t>(n));
  std::map<std::pair<Index, Index>, ExactSum> Q;  // by column and row
  for (const QuadraticTerm& term : terms) {
    constant.add(term.constant);
    for (Index j = 0; j < n; ++j) {
      c[static_cast<std::size_t>(j)].add(term.c[j]);
      for (SparseMatrix::InnerIterator entry(term.Q, j); entry; ++entry)
        Q[{j, entry.row()}].add(entry.value());
    }
  }
  total.constant = constant.value();
  for (Index j = 0; j < n; ++j) total.c[j] = c[static_cast<std::size_t>(j)].value();
  std::vector<Eigen::Triplet<double>> entries;
  for (const auto& [place, sum] : Q)
    entries.emplace_back(static_cast<int>(place.second), static_cast<int>(place.first), sum.value());
  total.Q.setFromTriplets(entries.begin(), entries.end());
  return total;
}

}  // namespace

SplitSum split(std::span<const Function> parts, Index n) {
  SplitSum sorted;
  std::vector<QuadraticTerm> quadratics;
  for (const Function& f : parts) {
    if (auto q = quadratic_term(f, n))
      quadratics.push_back(*std::move(q));
    else
      sorted.rest.push_back(f);
  }
  if (!quadratics.empty()) sorted.quadratic = total_of(quadratics, n);
  return sorted;
}

Facts Sum::facts() const {
  const bool indicators = all_of(parts_, &Facts::indicator);
  return {.indicator = indicators,
          .cone = all_of(parts_, &Facts::cone),
          .support = all_of(parts_, &Facts::support),
          .separable = all_of(parts_, &Facts::separable),
          .piecewise_quadratic = all_of(parts_, &Facts::piecewise_quadratic),
          .smooth = all_of(parts_, &Facts::smooth),
          .finite = all_of(parts_, &Facts::finite),
          .radial = all_of(parts_, &Facts::radial),
          .by_order = all_of(parts_, &Facts::by_order)};
}

Call Sum::call() const {
  Call made{"sum", {}, {}};
  for (const Function& f : parts_) made.arguments.push_back(argument(f.call()));
  return made;
}

Value Sum::evaluate(const Vector& x) const {
  Value total;
  for (const Function& f : parts_) total = sum_of(total, f.evaluate(x));
  return total;
}

std::optional<Vector> Sum::subgradient(const Vector& x) const {
  Vector total = Vector::Zero(x.size());
  for (const Function& f : parts_) {
    const std::optional<Vector> v = f.subgradient(x);
    if (!v) return std::nullopt;
    total += *v;
  }
  return total;
}

std::optional<Value> Sum::evaluate_pair(const DoubleDoubleVector& x) const {
  Value total;
  for (const Function& f : parts_) total = sum_of(total, value_near(f, x, 0));
  return total;
}

double Sum::error_of_slope(double x, double w) const {
  double total = 0;
  for (const Function& f : parts_) total += f.node().error_of_slope(x, w);
  return total;
}

double Sum::recession(const Vector& d) const {
  double total = 0;
  for (const Function& f : parts_) total += f.node().recession(d);
  return total;
}

double Sum::domain_support(const Vector& v) const {
  double least = std::numeric_limits<double>::infinity();
  for (const Function& f : parts_) least = std::min(least, f.node().domain_support(v));
  return least;
}

std::optional<Function> Sum::entry(Index i) const {
  std::vector<Function> entries;
  for (const Function& f : parts_)
    if (auto one = f.node().entry(i)) entries.push_back(*std::move(one));
  if (entries.size() != parts_.size()) return std::nullopt;
  return proper_sum(entries);
}

std::optional<Value> Sum::constant_beside_entries() const { return sum_of_constants(parts_); }

std::optional<LinearQuadratic> Sum::linear_quadratic(Index n) const {
  const SplitSum sorted = split(parts_, n);
  auto forms = programs(sorted.rest, n);
  if (!forms) return std::nullopt;
  if (const auto& q = sorted.quadratic) {
    LinearQuadratic form = linear_quadratic::quadratic(q->Q, q->c);
    forms->push_back(linear_quadratic::raise(form, q->constant));
  }
  return linear_quadratic::sum(*forms);
}

std::optional<GraphForm> Sum::graph(Index n, double slope) const {
  const auto forms = graphs(without_implied_bounds(parts_, n), n, slope);
  if (!forms) return std::nullopt;
  return convex::sum(*forms);
}

namespace {

/// W + Q; none where W is a rounding beside a Q that is not definite.
std::optional<Metric> definite_sum(const Metric& W, const SparseMatrix& Q) {
  try {
    return plus(W, Q);
  } catch (const InvalidInput&) {
    return std::nullopt;
  }
}

}  // namespace

std::optional<Prox> Sum::reduced_prox(const Vector& z, const Metric& W, const Look& look) const {
  const SplitSum sorted = split(parts_, z.size());
  if (!sorted.quadratic) return composed_prox(parts_, z, W, look);
  const auto& [Q, c, constant] = *sorted.quadratic;
  const std::optional<Metric> metric = definite_sum(W, Q);
  if (!metric) return std::nullopt;
  const Metric& V = *metric;
  const Vector y = V.solve(W.multiply(z) - c);
  if (sorted.rest.empty()) {
    const Vector none = Vector::Zero(z.size());
    const Vector x = y - V.solve(stationarity(z, W, y, slope_at(*sorted.quadratic, y, none)));
    const Vector v = slope_at(*sorted.quadratic, x, none);
    return moved({.x = x, .v = {}, .method = "linear equations"}, x, v, 0, z, W, V);
  }
  // A program takes the quadratic as it is, without a rounded point in a rounded metric.
  if (facts().piecewise_quadratic && !is_diagonal_kind(V)) return std::nullopt;
  const Function rest = sorted.rest.size() == 1 ? sorted.rest[0] : proper_sum(sorted.rest);
  const auto from = [&](const Vector& point) {
    const Prox part = rest.prox(point, V, look);
    if (part.x.size() == 0) return part;
    // The quadratic q takes its own slope Qx + c, where q*(Qx + c) = ½ x·Qx - q(0).
    const Value square = multiple_of(0.5, product(part.x, Q * part.x));
    return with_values(
        moved(part, part.x, slope_at(*sorted.quadratic, part.x, part.v), part.error_bound, z, W, V),
        part.values, sum_of(sum_of(square, product(c, part.x)), {constant, 0}),
        sum_of(square, {-constant, 0}));
  };
  return reduced(y, z, W, from, [&](const Vector& r) { return V.solve(r); });
}

std::vector<Function> Sum::maximum_of() const {
  for (std::size_t k = 0; k < parts_.size(); ++k) {
    std::vector<Function> least = parts_of_max(parts_[k]);
    if (least.empty()) continue;
    for (Function& f : least) {
      std::vector<Function> terms = parts_;
      terms[k] = f;
      f = proper_sum(terms);
    }
    return least;
  }
  return {};
}

Function Sum::conjugate() const {
  // Quadratic terms of functions on any number of entries are multiples of the unit matrix: a few entries
  // show.
  const Index n = dimension();
  const SplitSum sorted = split(parts_, telling_size(parts_, n));
  std::vector<Function> rest;
  for (const Function& f : sorted.rest) rest.push_back(f.conjugate());
  if (!sorted.quadratic)
    return std::accumulate(rest.begin() + 1, rest.end(), rest[0], proper_inf_convolution);
  const QuadraticTerm& q = *sorted.quadratic;
  const std::optional<double> mu = multiple_of_identity(q.Q);
  if (n == 0 && (!mu || !q.c.isZero(0))) return Operation::conjugate();
  if (rest.empty()) {
    if (n == 0) return computed_conjugate(self());
    return raised(function_of({q.Q, q.c, 0}).conjugate(), -q.constant);
  }
  Function g = std::accumulate(rest.begin() + 1, rest.end(), rest[0], proper_inf_convolution);
  if (mu && *mu != 0) g = envelope(g, *mu);
  if (!mu) g = proper_inf_convolution(g, function_of({q.Q, Vector::Zero(n), 0}).conjugate());
  if (!q.c.isZero(0)) g = translate(g, q.c);
  return raised(g, -q.constant);
}

Function proper_sum(std::span<const Function> terms) {
  std::vector<Function> parts;
  for (const Function& f : terms) {
    const auto* inner = dynamic_cast<const Sum*>(&f.node());
    if (inner && typeid(*inner) == typeid(Sum))
      parts.insert(parts.end(), inner->parts().begin(), inner->parts().end());
    else
      parts.push_back(f);
  }
  if (parts.size() == 1) return parts[0];
  return Function(std::make_shared<Sum>(std::move(parts)));
}

std::optional<Function> at_its_only_point(const Function& f, Index n) {
  if (n != 1 || f.facts().piecewise_quadratic) return std::nullopt;
  const auto domain = domain_of_one(f);
  if (!domain || domain->low != domain->high) return std::nullopt;
  const Vector point = Vector::Constant(1, domain->low);
  const Value value = f.evaluate(point);
  if (!std::isfinite(value.value) || !std::isfinite(value.error)) return std::nullopt;
  return raised(indicator_of_point(point), value.value);
}

Function sum(std::span<const Function> terms, Index n) {
  if (terms.empty()) throw InvalidInput("sum: no functions; give at least one");
  if (const Index own = common_dimension(terms, "sum"); own != 0) n = own;
  const Function made = proper_sum(terms);
  if (n != 0 && domains_may_miss(terms)) {
    require_proper(made, n, "sum");
    if (auto point = at_its_only_point(made, n)) return *point;
  }
  return made;
}

Function raised(const Function& f, double constant) {
  if (constant == 0) return f;
  const Function terms[] = {f,
                            named("constant", {argument("c", constant)}, std::max<Index>(f.dimension(), 1))};
  return proper_sum(terms);
}

}  // namespace convex::inline operations
