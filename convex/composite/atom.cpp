#include "convex/composite/atom.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "convex/composite/closed_form.hpp"
#include "convex/composite/composite_prox.hpp"
#include "convex/infinity.hpp"
#include "convex/linear_quadratic/prox.hpp"

namespace convex::inline composite {
namespace {

/// D when W is the diagonal matrix D; a dense or sparse matrix may be diagonal too. Empty otherwise.
Vector diagonal_of(const Metric& W) {
  switch (W.kind()) {
    case MetricKind::identity:
    case MetricKind::diagonal:
      return W.diagonal();
    case MetricKind::dense: {
      const Matrix& gram = W.dense_gram();
      for (Index j = 0; j < gram.cols(); ++j)
        for (Index i = 0; i < j; ++i)
          if (gram(i, j) != 0 || gram(j, i) != 0) return {};
      return W.diagonal();
    }
    case MetricKind::sparse: {
      const SparseMatrix& gram = W.sparse_gram();
      for (Index j = 0; j < gram.outerSize(); ++j)
        for (SparseMatrix::InnerIterator entry(gram, j); entry; ++entry)
          if (entry.row() != j && entry.value() != 0) return {};
      return W.diagonal();
    }
  }
  return {};
}

/// What a gap g = sigma(u) - u·s between a set's point s and a normal u says of their distance: s is g/||u||
/// short of the supporting plane, and no farther off than 2||u||, since with u = 0 in its place s would be
/// right. Two formulas that share a wrong level agree with each other, but not with the values: the gap shows
/// it, which is infinite where s is not in the set; with u = 0 nothing is known of it then.
double distance_in_gap(const Facts& facts, double gap, double size_of_x, double size_of_v) {
  const auto along = [&](double normal) {
    if (!std::isfinite(gap)) return 2 * normal;
    return normal > 0 ? std::min(std::abs(gap) / normal, 2 * normal) : 0;
  };
  if (facts.support) return along(size_of_x);
  if (!facts.indicator) return 0;
  return std::isfinite(gap) || size_of_v > 0 ? along(size_of_v) : infinity;
}

Prox in_diagonal_metric(const Atom& f, const Vector& z, const Vector& d, const Look& look) {
  Prox result;
  result.x = f.prox_diagonal(z, d);
  const Vector covector = d.cwiseProduct(z - result.x);
  const std::optional<Vector> v =
      look.by_steep_terms ? f.steep_covector(result.x, z, d) : f.prox_covector(result.x, z, d);
  result.v = v ? *v : covector;
  const Vector root = d.cwiseSqrt();
  result.values = {f.evaluate(result.x), f.conjugate().evaluate(result.v), 0};
  result.duality_gap = result.values->f_x.value + result.values->f_v.value - result.x.dot(result.v);
  const double size_of_x = root.cwiseProduct(result.x).stableNorm();
  result.error_bound =
      (result.v - covector).cwiseQuotient(root).stableNorm() + f.subgradient_miss(result.x, result.v, d) +
      distance_in_gap(f.facts(), result.duality_gap, size_of_x, result.v.cwiseQuotient(root).stableNorm()) +
      roundings_of_a_formula * unit_roundoff * (root.cwiseProduct(z).stableNorm() + size_of_x);
  constexpr double largest = std::numeric_limits<double>::max();  // no bound is within an infinite scale
  const double scale = std::max({1.0, root.cwiseProduct(z).stableNorm(), size_of_x});
  if (!(result.error_bound <= membership_tolerance * std::min(scale, largest)))
    result.status = Status::inaccurate;
  result.method = "closed form";
  result.by_conjugate = f.prox_by_conjugate();
  return result;
}

}  // namespace

std::optional<Vector> Atom::prox_covector(const Vector&, const Vector&, const Vector&) const {
  return std::nullopt;
}

std::optional<Vector> Atom::steep_covector(const Vector& x, const Vector& z, const Vector& d) const {
  return prox_covector(x, z, d);
}

std::optional<Prox> Atom::prox_general(const Vector&, const Metric&) const { return std::nullopt; }

Prox Atom::prox(const Vector& z, const Metric& W, const Look& look) const {
  const Vector d = diagonal_of(W);
  if (d.size() > 0 && (takes_any_diagonal() || d.maxCoeff() == d.minCoeff()))
    return in_diagonal_metric(*this, z, d, look);
  if (std::optional<Prox> own = prox_general(z, W)) return *own;
  const std::optional<LinearQuadratic> form = linear_quadratic(z.size());
  return without_rounding_at_zero(
      form ? linear_quadratic::prox(*form, z, W) : convex::prox(*graph(z.size()), z, W, look), facts(), z, W);
}

std::optional<GraphForm> Atom::graph(Index n, double) const {
  SparseMatrix identity(n, n);
  identity.setIdentity();
  return GraphForm{
      n, 0, {{std::static_pointer_cast<const Atom>(shared_from_this()), 1, identity, Vector::Zero(n)}}, 0};
}

}  // namespace convex::inline composite
