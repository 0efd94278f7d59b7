#include "convex/functions/sparse_norms.hpp"

#include <cmath>
#include <string>

#include "convex/composite/graph_algebra.hpp"
#include "convex/counted.hpp"
#include "convex/functions/convex_set.hpp"
#include "convex/functions/piecewise_functions.hpp"
#include "convex/functions/program_function.hpp"
#include "convex/gamma0/parameter.hpp"
#include "convex/linear_quadratic/functions.hpp"
#include "convex/linear_quadratic/operations.hpp"
#include "convex/prox_formulas/k_support.hpp"

namespace convex::inline named_functions {
namespace {

/// {norm of the k largest entries <= radius}.
class LargestEntriesBall : public ConvexSet {
 public:
  LargestEntriesBall(Index k, double radius) : k_(k), radius_(radius) {}
  Index dimension() const override { return 0; }
  void require_size(Index n, const std::string& name) const override {
    if (n < k_)
      throw InvalidInput(name + "(k): " + std::to_string(k_) + " of " + counted(n, "entry", "entries") +
                         "; give k from 1 to the number of entries");
  }
  Call call() const override { return named("largest_entries_ball", "radius"); }
  Call support_call() const override { return named("k_support", "weight"); }
  Facts facts() const override { return {}; }
  bool bounded() const override { return true; }
  double scale() const override { return radius_; }
  Vector project(const Vector& z, const Vector&) const override {
    return prox_formulas::proj_largest_ball(z, radius_, k_);
  }
  Jacobian project_jacobian(const Vector& z, const Vector&) const override {
    return Matrix::Identity(z.size(), z.size()) - prox_formulas::prox_k_support_jacobian(z, radius_, k_);
  }
  double support(const Vector& v) const override { return radius_ * prox_formulas::k_support_norm(v, k_); }
  std::optional<Vector> maximiser(const Vector& v) const override {
    return radius_ * prox_formulas::k_support_slope(v, k_);
  }
  Vector support_prox(const Vector& z, const Vector& d) const override {
    return prox_formulas::prox_k_support(z, radius_ / d[0], k_);
  }

 private:
  Call named(const char* name, const char* number) const {
    return {name, {argument("k", static_cast<double>(k_)), argument(number, radius_)}};
  }
  Index k_;
  double radius_;
};

std::shared_ptr<const ConvexSet> checked(const char* maker, double k, const char* parameter, double radius) {
  require_nonnegative(maker, parameter, radius);
  if (!(k >= 1 && k == std::floor(k) && k < 0x1p31))
    throw InvalidInput(std::string(maker) + "(k): not 1, 2, …; give a whole number of entries");
  return std::make_shared<LargestEntriesBall>(static_cast<Index>(k), radius);
}

/// The differences of neighbours of a matrix stacked by columns, down its columns and along its rows.
SparseMatrix neighbour_differences(Index rows, Index columns) {
  std::vector<Eigen::Triplet<double>> entries;
  Index edge = 0;
  const auto add = [&](Index from, Index to) {
    entries.emplace_back(static_cast<int>(edge), static_cast<int>(from), -1.0);
    entries.emplace_back(static_cast<int>(edge++), static_cast<int>(to), 1.0);
  };
  for (Index j = 0; j < columns; ++j)
    for (Index i = 0; i < rows; ++i) {
      if (i + 1 < rows) add(j * rows + i, j * rows + i + 1);
      if (j + 1 < columns) add(j * rows + i, (j + 1) * rows + i);
    }
  SparseMatrix D(edge, rows * columns);
  D.setFromTriplets(entries.begin(), entries.end());
  return D;
}

}  // namespace

Function k_support(double k, double weight) { return support_of(checked("k_support", k, "weight", weight)); }

Set largest_entries_ball(double k, double radius) {
  return set_of(checked("largest_entries_ball", k, "radius", radius));
}

Function total_variation_2d(double weight, Index rows, Index n) {
  require_nonnegative("total_variation_2d", "weight", weight);
  if (rows < 1 || n % rows != 0)
    throw InvalidInput("total_variation_2d(rows): no matrix of " + counted(rows, "row", "rows") + " has " +
                       counted(n, "entry", "entries") + "; give a divisor");
  const SparseMatrix D = neighbour_differences(rows, n / rows);
  const Vector none = Vector::Zero(D.rows());
  const LinearQuadratic form =
      linear_quadratic::precompose(linear_quadratic::norm1(D.rows(), weight), D, none);
  const Call call{"total_variation_2d",
                  {argument("weight", weight), argument("rows", static_cast<double>(rows))}};
  return program_function({.call = call,
                           .conjugate_call = {"conjugate", {argument(call)}},
                           .facts = {.support = true, .finite = true},
                           .conjugate_facts = {.indicator = true},
                           .form = form,
                           .conjugate_form = linear_quadratic::conjugate(form),
                           .graph = precompose(*norm1(weight).node().graph(D.rows()), D, none)});
}

}  // namespace convex::inline named_functions
