#include <algorithm>
#include <cmath>
#include <numeric>
#include <string>

#include "convex/counted.hpp"
#include "convex/double_double.hpp"
#include "convex/functions/convex_set.hpp"
#include "convex/functions/norms.hpp"
#include "convex/functions/sets.hpp"
#include "convex/gamma0/parameter.hpp"
#include "convex/linear_quadratic/functions.hpp"
#include "convex/linear_quadratic/operations.hpp"
#include "convex/linear_quadratic/sets.hpp"
#include "convex/prox_formulas/capped_simplex.hpp"
#include "convex/prox_formulas/simplex.hpp"

namespace convex::inline named_functions {
namespace {

bool equal(const Vector& d) { return d.maxCoeff() == d.minCoeff(); }

bool takes_thin_jacobian(const Vector& d) { return d.size() >= Jacobian::least_thin && equal(d); }

/// diag(s²) - s sᵀ/(s·s), the projection on {x : s·x = 0, x_i = 0 where s_i = 0}: to the face around a point
/// of a polytope. s: signs.
Jacobian jacobian_to_face(const Vector& s) {
  const double open = s.squaredNorm();
  if (!(open > 0)) return Jacobian(Vector(Vector::Zero(s.size())));
  return {Vector(s.cwiseAbs2()), s, Matrix::Constant(1, 1, -1 / open)};
}

/// A bounded polytope with kernels for every diagonal metric.
class Polytope : public ConvexSet {
 public:
  Index dimension() const override { return 0; }
  Facts facts() const override { return {.piecewise_quadratic = true}; }
  bool bounded() const override { return true; }
  bool takes_any_diagonal() const override { return true; }
};

/// {|x|₁ <= radius}, whose support function is norm_inf.
class Ball1 : public Polytope {
 public:
  explicit Ball1(double radius) : radius_(radius) {}
  Call call() const override { return {"ball1", {argument("radius", radius_)}}; }
  Call support_call() const override { return {"norm_inf", {argument("weight", radius_)}}; }
  double scale() const override { return radius_; }
  Vector project(const Vector& z, const Vector& d) const override {
    return equal(d) ? prox_formulas::proj_ball1(z, radius_) : prox_formulas::proj_ball1(z, radius_, d);
  }
  Jacobian project_jacobian(const Vector& z, const Vector& d) const override {
    if (!takes_thin_jacobian(d)) return prox_formulas::proj_ball1_jacobian(z, radius_, d);
    const Vector x = project(z, d);
    return x == z ? Jacobian::identity(z.size()) : jacobian_to_face(x.cwiseSign());
  }
  double support(const Vector& v) const override { return radius_ * v.lpNorm<Eigen::Infinity>(); }
  std::optional<Vector> maximiser(const Vector& v) const override {
    Vector x = Vector::Zero(v.size());
    Index largest = 0;
    if (v.cwiseAbs().maxCoeff(&largest) > 0) x[largest] = std::copysign(radius_, v[largest]);
    return x;
  }
  Vector support_prox(const Vector& z, const Vector& d) const override {
    return equal(d) ? prox_formulas::prox_norm_inf(z, radius_ / d[0])
                    : prox_formulas::prox_norm_inf(z, radius_, d);
  }
  std::optional<LinearQuadratic> indicator_form(Index n) const override {
    return linear_quadratic::ball1(n, radius_);
  }
  std::optional<LinearQuadratic> support_form(Index n) const override {
    return linear_quadratic::norm_inf(n, radius_);
  }

 private:
  double radius_;
};

/// {x >= 0, Σx = total}, whose support function is total·max.
class Simplex : public Polytope {
 public:
  explicit Simplex(double total) : total_(total) {}
  Call call() const override { return {"simplex", {argument("total", total_)}}; }
  Call support_call() const override { return total_ == 1 ? Call{"max"} : ConvexSet::support_call(); }
  bool is_base_polytope() const override { return true; }
  double scale() const override { return total_; }
  Vector project(const Vector& z, const Vector& d) const override {
    return equal(d) ? prox_formulas::proj_simplex(z, total_) : prox_formulas::proj_simplex(z, total_, d);
  }
  Jacobian project_jacobian(const Vector& z, const Vector& d) const override {
    if (!takes_thin_jacobian(d)) return prox_formulas::proj_simplex_jacobian(z, total_, d);
    return jacobian_to_face(project(z, d).cwiseSign());
  }
  double support(const Vector& v) const override { return total_ * v.maxCoeff(); }
  std::optional<Vector> maximiser(const Vector& v) const override {
    Vector x = Vector::Zero(v.size());
    Index largest = 0;
    v.maxCoeff(&largest);
    x[largest] = total_;
    return x;
  }
  Vector support_prox(const Vector& z, const Vector& d) const override {
    return equal(d) ? prox_formulas::prox_max(z, total_ / d[0]) : prox_formulas::prox_max(z, total_, d);
  }
  std::optional<LinearQuadratic> indicator_form(Index n) const override {
    return linear_quadratic::simplex(n, total_);
  }
  std::optional<LinearQuadratic> support_form(Index n) const override {
    if (total_ == 0) return linear_quadratic::zero(n);
    return linear_quadratic::scale(linear_quadratic::max(n), total_);
  }

 private:
  double total_;
};

/// {0 <= x <= cap, Σx = total}; with cap 1 and total k its support function is the sum of the k largest.
class CappedSimplex : public Polytope {
 public:
  CappedSimplex(double total, double cap) : total_(total), cap_(cap) {}
  void require_size(Index n, const std::string& name) const override {
    if (!(total_ > static_cast<double>(n) * cap_)) return;
    if (name == "sum_largest")
      throw InvalidInput(name + ": there are no " + to_text(total_) + " largest of " +
                         counted(n, "entry", "entries") + "; give a smaller k");
    throw InvalidInput(name + ": " + counted(n, "entry", "entries") + " of at most " + to_text(cap_) +
                       " cannot sum to " + to_text(total_) + ", so the set is empty; give a smaller sum");
  }
  Call call() const override {
    return {"capped_simplex", {argument("total", total_), argument("cap", cap_)}};
  }
  Call support_call() const override {
    return named_sum() ? Call{"sum_largest", {argument("k", total_)}} : ConvexSet::support_call();
  }
  bool is_base_polytope() const override { return true; }
  double scale() const override { return total_; }
  Vector project(const Vector& z, const Vector& d) const override {
    return equal(d) ? prox_formulas::proj_capped_simplex(z, cap_, total_)
                    : prox_formulas::proj_capped_simplex(z, cap_, total_, d);
  }
  Jacobian project_jacobian(const Vector& z, const Vector& d) const override {
    if (!takes_thin_jacobian(d)) return prox_formulas::proj_capped_simplex_jacobian(z, cap_, total_, d);
    const Vector x = project(z, d);
    return jacobian_to_face((x.array() > 0 && x.array() < cap_).cast<double>());
  }
  double support(const Vector& v) const override { return maximiser(v)->dot(v); }
  Value support_value(const Vector& v) const override {
    const Vector x = *maximiser(v);
    const double roundings = static_cast<double>(v.size());
    // What rounding took from the total, or added, is that of the last entry filled or of the next one.
    const std::vector<Index> filled = order(v);
    double rest = total_, lost = 0, at_rest = 0;
    for (std::size_t k = 0; k < filled.size() && at_rest == 0; ++k) {
      const DoubleDouble left = two_sum(rest, -x[filled[k]]);
      rest = left.hi;
      lost += std::abs(left.lo);
      if (x[filled[k]] < cap_)
        at_rest = std::max(std::abs(v[filled[k]]), std::abs(v[filled[std::min(k + 1, filled.size() - 1)]]));
    }
    Value found = sum_of_terms(x.dot(v), roundings * x.dot(v.cwiseAbs()));
    found.error += lost * at_rest;
    return found;
  }
  /// The largest entries filled up to cap, the last one with the rest.
  std::optional<Vector> maximiser(const Vector& v) const override {
    Vector x = Vector::Zero(v.size());
    double rest = total_;
    for (Index i : order(v)) {
      x[i] = std::min(cap_, rest);
      rest -= x[i];
    }
    return x;
  }
  Vector support_prox(const Vector& z, const Vector& d) const override {
    // cap times the sum of the total/cap largest entries.
    const double k = std::min(total_ / cap_, static_cast<double>(z.size()));
    return equal(d) ? prox_formulas::prox_sum_largest(z, k, cap_ / d[0])
                    : prox_formulas::prox_sum_largest(z, k, cap_, d);
  }
  std::optional<LinearQuadratic> indicator_form(Index n) const override {
    LinearQuadraticBuilder form(n, 0);
    for (Index i = 0; i < n; ++i) {
      form.row(0);
      form.entry(i, 1);
      form.row(-cap_);
      form.entry(i, -1);
    }
    form.equation(total_);
    for (Index i = 0; i < n; ++i) form.entry(i, 1);
    return form.finish();
  }
  std::optional<LinearQuadratic> support_form(Index n) const override {
    if (named_sum()) return linear_quadratic::sum_largest(n, static_cast<Index>(total_));
    return ConvexSet::support_form(n);
  }

 private:
  /// The entries from the largest on.
  static std::vector<Index> order(const Vector& v) {
    std::vector<Index> order(static_cast<std::size_t>(v.size()));
    std::iota(order.begin(), order.end(), Index{0});
    std::stable_sort(order.begin(), order.end(), [&](Index i, Index j) { return v[i] > v[j]; });
    return order;
  }
  bool named_sum() const { return cap_ == 1 && total_ >= 1 && total_ == std::floor(total_); }
  double total_, cap_;
};

}  // namespace

Set ball1(double radius) {
  require_nonnegative("ball1", "radius", radius);
  return set_of(std::make_shared<Ball1>(radius));
}

Function norm_inf(double weight) {
  require_nonnegative("norm_inf", "weight", weight);
  return support_of(std::make_shared<Ball1>(weight));
}

Set simplex(double total) {
  require_finite("simplex", "total", total);
  if (total < 0) throw InvalidInput("simplex(total): negative, so the set is empty; give 0 or more");
  return set_of(std::make_shared<Simplex>(total));
}

Function max() { return support_of(std::make_shared<Simplex>(1)); }

Set capped_simplex(double total, double cap) {
  require_finite("capped_simplex", "total", total);
  if (total < 0) throw InvalidInput("capped_simplex(total): negative, so the set is empty; give 0 or more");
  require_positive("capped_simplex", "cap", cap);
  return set_of(std::make_shared<CappedSimplex>(total, cap));
}

Function sum_largest(double k) {
  if (!(k >= 1) || k != std::floor(k))
    throw InvalidInput("sum_largest(k): not a number of entries; give 1, 2, …");
  return support_of(std::make_shared<CappedSimplex>(k, 1));
}

}  // namespace convex::inline named_functions
