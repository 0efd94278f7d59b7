#include <algorithm>
#include <cmath>
#include <string>

#include "convex/double_double.hpp"
#include "convex/functions/convex_set.hpp"
#include "convex/functions/norms.hpp"
#include "convex/functions/sets.hpp"
#include "convex/gamma0/parameter.hpp"
#include "convex/linear_quadratic/functions.hpp"
#include "convex/prox_formulas/isotonic.hpp"
#include "convex/prox_formulas/norm2.hpp"
#include "convex/prox_formulas/running_sums.hpp"
#include "convex/prox_formulas/total_variation.hpp"

namespace convex::inline named_functions {
namespace {

/// A bounded set whose support function is a norm with a Jacobian of its own.
class DualBall : public ConvexSet {
 public:
  bool bounded() const override { return true; }
  /// The derivative of z - D⁻¹ support_prox(Dz, D⁻¹).
  Jacobian project_jacobian(const Vector& z, const Vector& d) const override {
    const Vector inverse = d.cwiseInverse();
    const Matrix J = norm_jacobian(d.cwiseProduct(z), inverse);
    return Matrix::Identity(z.size(), z.size()) - inverse.asDiagonal() * J * d.asDiagonal();
  }
  virtual Matrix norm_jacobian(const Vector& z, const Vector& d) const = 0;
};

/// {|x_1 + … + x_i| <= bound for i < n, = 0 for i = n} = {Dᵀu : |u_i| <= bound}, D the differences.
class BoundedPartialSums : public DualBall {
 public:
  explicit BoundedPartialSums(double bound) : bound_(bound) {}
  Index dimension() const override { return 0; }
  Call call() const override { return {"bounded_partial_sums", {argument("bound", bound_)}}; }
  Call support_call() const override { return {"total_variation", {argument("weight", bound_)}}; }
  Facts facts() const override { return {.piecewise_quadratic = true}; }
  bool is_base_polytope() const override { return true; }
  bool takes_any_diagonal() const override { return true; }
  double scale() const override { return bound_; }
  /// The sum of all is 0 whatever the bound: it is measured by x alone.
  Value membership(const Vector& x) const override {
    return sum_of(indicated(std::abs(x.sum()), x.lpNorm<1>()), DualBall::membership(x));
  }
  double support(const Vector& v) const override {
    double sum = 0;
    for (Index i = 0; i + 1 < v.size(); ++i) sum += std::abs(v[i + 1] - v[i]);
    return bound_ * sum;
  }
  std::optional<Vector> maximiser(const Vector& v) const override {
    Vector x = Vector::Zero(v.size());
    for (Index i = 0; i + 1 < v.size(); ++i) {
      const double sign = v[i + 1] > v[i] ? bound_ : v[i + 1] < v[i] ? -bound_ : 0;
      x[i] -= sign;
      x[i + 1] += sign;
    }
    return x;
  }
  /// D(z - u) for u the prox of the support function; each run of it passes the bound on to its neighbours.
  Vector project(const Vector& z, const Vector& d) const override {
    const Vector covector = d.cwiseProduct(z), inverse = d.cwiseInverse();
    prox_formulas::Blocks runs = prox_formulas::prox_total_variation(covector, bound_, inverse);
    std::erase_if(runs.first, [&](Index i) { return i > 0 && runs.x[i] == runs.x[i - 1]; });
    Vector sums = Vector::Zero(z.size());
    for (std::size_t k = 1; k < runs.first.size(); ++k) {
      const Index first = runs.first[k], run = static_cast<Index>(k);
      const double passed = runs.x[first] > runs.x[first - 1] ? bound_ : -bound_;
      sums[run - 1] -= passed;
      sums[run] += passed;
    }
    return prox_formulas::blocks_covector(runs, covector, inverse, sums);
  }
  Vector support_prox(const Vector& z, const Vector& d) const override {
    return prox_formulas::prox_total_variation(z, bound_, d).x;
  }
  SplitRoute split_route() const override { return SplitRoute::projection_from_support_prox; }
  /// Running sums of s within the bound, and at it with the sign of its step where u has one.
  void make_conjugate(Vector& s, Vector& u) const override {
    prox_formulas::keep_running_sums(s, [&](Index i, double sum) {
      if (i + 1 == s.size()) return 0.0;
      if (u[i + 1] == u[i]) return std::clamp(sum, -bound_, bound_);
      return u[i + 1] > u[i] ? -bound_ : bound_;
    });
  }
  Matrix norm_jacobian(const Vector& z, const Vector& d) const override {
    return prox_formulas::blocks_jacobian(prox_formulas::prox_total_variation(z, bound_, d), d);
  }
  std::optional<LinearQuadratic> support_form(Index n) const override {
    return linear_quadratic::total_variation(n, bound_);
  }
  std::optional<LinearQuadratic> indicator_form(Index n) const override {
    LinearQuadraticBuilder form(n, 0);
    const auto running_sum = [&](Index last, double sign) {
      for (Index i = 0; i <= last; ++i) form.entry(i, sign);
    };
    for (Index i = 0; i + 1 < n; ++i)
      for (double sign : {1.0, -1.0}) {
        form.row(-bound_);
        running_sum(i, sign);
      }
    form.equation(0);
    running_sum(n - 1, 1);
    return form.finish();
  }

 private:
  double bound_;
};

/// Neighbours [first, end) on one edge of a least concave majorant.
struct Run {
  std::size_t first, end;
  DoubleDouble rise;
  double slope;
};

/// The edges of the least concave majorant of the running sums of n steps, from the left (the upper hull of
/// points in order; Andrew 1979).
template <class Step>
std::vector<Run> runs_of_majorant(std::size_t n, const Step& step) {
  std::vector<Run> hull;
  for (std::size_t k = 0; k < n; ++k) {
    Run last{k, k + 1, step(k), 0};
    last.slope = last.rise.value();
    while (!hull.empty() && hull.back().slope <= last.slope) {
      last.first = hull.back().first;
      last.rise = add(hull.back().rise, last.rise);
      last.slope = last.rise.value() / static_cast<double>(last.end - last.first);
      hull.pop_back();
    }
    hull.push_back(last);
  }
  return hull;
}

/// The convex hull of all signed permutations of w, w_1 >= w_2 >= … >= 0.
class SignedPermutahedron : public DualBall {
 public:
  explicit SignedPermutahedron(Vector weights) : weights_(std::move(weights)) {}
  Index dimension() const override { return weights_.size(); }
  Call call() const override { return {"signed_permutahedron", {argument("weights", weights_)}}; }
  Call support_call() const override { return {"sorted_norm1", {argument("weights", weights_)}}; }
  Facts facts() const override { return {}; }
  double scale() const override { return weights_.norm(); }
  double support(const Vector& v) const override { return maximiser(v)->dot(v); }
  std::optional<Vector> maximiser(const Vector& v) const override {
    Vector x(v.size());
    const std::vector<Index> order = by_size(v);
    for (std::size_t k = 0; k < order.size(); ++k)
      x[order[k]] = std::copysign(weights_[static_cast<Index>(k)], v[order[k]]);
    return x;
  }
  Vector support_prox(const Vector& z, const Vector& d) const override {
    return prox_formulas::prox_sorted_norm1(z, weights_ / d[0]);
  }
  /// With |z| in decreasing order a point is in the set when its running sums are at most those of the
  /// weights. The nearest one has its sums at this bound where the least concave majorant of the sums of
  /// |z| - w bends, and falls short of |z| by the slope there, as long as that is positive.
  Vector project(const Vector& z, const Vector&) const override {
    const std::vector<Index> order = by_size(z);
    const auto size = [&](std::size_t k) { return std::abs(z[order[k]]); };
    const auto weight = [&](std::size_t k) { return weights_[static_cast<Index>(k)]; };
    Vector x = z;
    for (const Run& run :
         runs_of_majorant(order.size(), [&](std::size_t k) { return two_sum(size(k), -weight(k)); })) {
      if (!(run.slope > 0)) break;
      const auto length = static_cast<double>(run.end - run.first);
      double differences = 0, weights = 0;
      for (std::size_t k = run.first; k < run.end; ++k) {
        differences += size(k) - size(run.first);
        weights += weight(k);
      }
      for (std::size_t k = run.first; k < run.end; ++k) {
        const double apart = (size(k) - size(run.first)) - differences / length;
        x[order[k]] = std::copysign(std::max(0.0, apart + weights / length), z[order[k]]);
      }
    }
    return x;
  }
  /// On each run of entries pooled to one |x| > 0 the mean with their signs; 0 where x = 0.
  Matrix norm_jacobian(const Vector& z, const Vector& d) const override {
    const Vector x = support_prox(z, d);
    const std::vector<Index> order = by_size(z);
    Matrix J = Matrix::Zero(z.size(), z.size());
    for (std::size_t first = 0, last = 0; first < order.size(); first = last) {
      bool pooled = false;  // entries that are equal by chance move by themselves
      last = first;
      for (; last < order.size() && std::abs(x[order[last]]) == std::abs(x[order[first]]); ++last) {
        const double size = std::abs(z[order[last]]), weight = weights_[static_cast<Index>(last)] / d[0];
        const double moved = std::abs(size - weight - std::abs(x[order[last]]));
        pooled = pooled || moved > 4 * unit_roundoff * (size + weight);
      }
      const double share = 1 / static_cast<double>(last - first);
      for (std::size_t k = first; k < last; ++k) {
        if (!pooled && (x[order[k]] != 0 || weights_[static_cast<Index>(k)] == 0)) J(order[k], order[k]) = 1;
        for (std::size_t l = first; pooled && x[order[k]] != 0 && l < last; ++l)
          J(order[k], order[l]) = std::copysign(share, x[order[k]] * x[order[l]]);
      }
    }
    return J;
  }

 private:
  static std::vector<Index> by_size(const Vector& v) {
    std::vector<Index> order(static_cast<std::size_t>(v.size()));
    for (std::size_t k = 0; k < order.size(); ++k) order[k] = static_cast<Index>(k);
    std::stable_sort(order.begin(), order.end(),
                     [&](Index i, Index j) { return std::abs(v[i]) > std::abs(v[j]); });
    return order;
  }
  Vector weights_;
};

}  // namespace

Set bounded_partial_sums(double bound) {
  require_nonnegative("bounded_partial_sums", "bound", bound);
  return set_of(std::make_shared<BoundedPartialSums>(bound));
}

Function total_variation(double weight) {
  require_nonnegative("total_variation", "weight", weight);
  return support_of(std::make_shared<BoundedPartialSums>(weight));
}

namespace {

std::shared_ptr<const ConvexSet> sorted(const char* maker, const Vector& weights) {
  require_entries(maker, "weights", weights);
  if (weights.minCoeff() < 0 || !std::is_sorted(weights.begin(), weights.end(), std::greater<>()))
    throw InvalidInput(std::string(maker) +
                       "(weights): not w_1 >= w_2 >= … >= 0; the function would not be convex, sort them");
  return std::make_shared<SignedPermutahedron>(weights);
}

}  // namespace

Set signed_permutahedron(const Vector& weights) { return set_of(sorted("signed_permutahedron", weights)); }

Function sorted_norm1(const Vector& weights) { return support_of(sorted("sorted_norm1", weights)); }

}  // namespace convex::inline named_functions
