#pragma once

#include <vector>

#include "convex/operations/operation.hpp"
#include "convex/operations/quadratic_term.hpp"

namespace convex::inline operations {

/// f_1 + f_2 + …, at least one; see `sum` in operations.hpp.
class Sum : public Operation {
 public:
  explicit Sum(std::vector<Function> parts) : parts_(std::move(parts)), n_(common_dimension(parts_, "sum")) {}
  const std::vector<Function>& parts() const { return parts_; }

  Index dimension() const override { return n_; }
  void require_size(Index n) const override {
    for (const Function& f : parts_) f.node().require_size(n);
  }
  Facts facts() const override;
  Call call() const override;
  Value evaluate(const Vector& x) const override;
  std::optional<Vector> subgradient(const Vector& x) const override;
  double error_of_slope(double x, double w) const override;
  std::optional<Value> evaluate_pair(const DoubleDoubleVector& x) const override;
  /// f* + … by the parts: quadratic terms smooth, linear ones translate, the rest convolves.
  Function conjugate() const override;
  double recession(const Vector& d) const override;
  /// Each part's domain holds the sum's.
  double domain_support(const Vector& v) const override;
  std::optional<Function> entry(Index i) const override;
  std::optional<Value> constant_beside_entries() const override;
  std::optional<LinearQuadratic> linear_quadratic(Index n) const override;
  std::optional<GraphForm> graph(Index n, double slope) const override;
  /// max(f, g) + h is the maximum of f + h and g + h.
  std::vector<Function> maximum_of() const override;

 protected:
  std::optional<Prox> reduced_prox(const Vector& z, const Metric& W, const Look& look) const override;

 private:
  std::vector<Function> parts_;
  Index n_;
};

/// f where its domain is one point of the line, which no prox of its parts tells: the indicator of the point,
/// raised. None where there is more of it.
std::optional<Function> at_its_only_point(const Function& f, Index n);

/// The terms on n entries, all quadratic ones in one.
struct SplitSum {
  std::optional<QuadraticTerm> quadratic;
  std::vector<Function> rest;
};
SplitSum split(std::span<const Function> parts, Index n);

}  // namespace convex::inline operations
