#include <algorithm>
#include <cmath>

#include "convex/composite/composite_prox.hpp"
#include "convex/composite/graph_algebra.hpp"
#include "convex/infinity.hpp"
#include "convex/linear_quadratic/operations.hpp"
#include "convex/operations/one_at_a_time.hpp"
#include "convex/operations/operation.hpp"
#include "convex/operations/operations.hpp"
#include "convex/operations/sum.hpp"
#include "convex/operations/two_function_max.hpp"

namespace convex::inline operations {
namespace {

/// The maximum of piecewise linear-quadratic functions, when it is one: all with the same quadratic part.
std::optional<LinearQuadratic> program(const std::vector<Function>& parts, Index n) {
  const auto forms = programs(parts, n);
  if (!forms) return std::nullopt;
  try {
    return linear_quadratic::pointwise_max(*forms);
  } catch (const InvalidInput&) {
    return std::nullopt;
  }
}

class PointwiseMax : public Operation {
 public:
  explicit PointwiseMax(std::vector<Function> parts)
      : parts_(std::move(parts)), n_(common_dimension(parts_, "pointwise_max")) {
    piecewise_ = program(parts_, telling_size(parts_, n_)).has_value();
  }

  Index dimension() const override { return n_; }
  void require_size(Index n) const override {
    for (const Function& f : parts_) f.node().require_size(n);
  }
  Facts facts() const override {
    const auto all = [&](bool Facts::*fact) { return all_of(parts_, fact); };
    return {.indicator = all(&Facts::indicator),
            .cone = all(&Facts::cone),
            .support = all(&Facts::support),
            .piecewise_quadratic = piecewise_,
            .finite = all(&Facts::finite)};
  }
  Call call() const override {
    Call made{"pointwise_max", {}, {}};
    for (const Function& f : parts_) made.arguments.push_back(argument(f.call()));
    return made;
  }
  Value evaluate(const Vector& x) const override {
    // A part that lies below another by more than its error leaves nothing open.
    double largest = -infinity, least = -infinity, most = -infinity;
    for (const Function& f : parts_) {
      const Value part = f.evaluate(x);
      if (part.value == infinity && part.error == 0) return part;
      largest = std::max(largest, part.value);
      if (std::isfinite(part.error)) least = std::max(least, part.value - part.error);
      most = std::max(most, part.value + part.error);
    }
    return {largest, std::isfinite(most) ? std::max(most - largest, largest - least) : infinity};
  }
  /// That of the largest as rounded; `tied_parts.hpp` tells where this may be another.
  std::optional<Vector> subgradient(const Vector& x) const override {
    // A part whose error hides whether it is the largest may have the slope.
    constexpr double open_part = 1e-3;
    std::vector<Value> values;
    double largest = -infinity, most = -infinity;
    for (const Function& f : parts_) {
      values.push_back(f.evaluate(x));
      largest = std::max(largest, values.back().value);
      most = std::max(most, values.back().value + values.back().error);
    }
    if (!std::isfinite(largest) || !(most - largest <= open_part * std::max(1.0, std::abs(largest))))
      return std::nullopt;
    for (std::size_t k = 0; k < parts_.size(); ++k)
      if (values[k].value == largest)
        if (std::optional<Vector> v = parts_[k].subgradient(x)) return v;
    return std::nullopt;
  }
  /// That of every part that may be the largest.
  double error_of_slope(double x, double w) const override {
    const Vector at = Vector::Constant(1, x);
    std::vector<Value> values;
    double least = -infinity, error = 0;
    for (const Function& f : parts_) {
      values.push_back(f.evaluate(at));
      least = std::max(least, values.back().value - values.back().error);
    }
    for (std::size_t k = 0; k < parts_.size(); ++k)
      if (values[k].value + values[k].error >= least)
        error = std::max(error, parts_[k].node().error_of_slope(x, w));
    return error;
  }
  double recession(const Vector& d) const override {
    double largest = -infinity;
    for (const Function& f : parts_) largest = std::max(largest, f.node().recession(d));
    return largest;
  }
  /// Each part's domain holds the maximum's.
  double domain_support(const Vector& v) const override {
    double least = infinity;
    for (const Function& f : parts_) least = std::min(least, f.node().domain_support(v));
    return least;
  }
  std::optional<LinearQuadratic> linear_quadratic(Index n) const override {
    if (!piecewise_) return std::nullopt;
    return program(parts_, n);
  }
  std::optional<GraphForm> graph(Index n, double slope) const override {
    const auto forms = graphs(parts_, n, slope);
    if (!forms) return std::nullopt;
    return convex::pointwise_max(*forms, unit_of_slope(slope));
  }

  std::vector<Function> maximum_of() const override { return parts_; }
  const std::vector<Function>& parts() const { return parts_; }

 protected:
  /// Of one part alone, else by epigraphs in units of the slope at the solution, which is known when it has
  /// been found: units far above would hide a miss in the height.
  std::optional<Prox> reduced_prox(const Vector& z, const Metric& W, const Look& look) const override {
    if (piecewise_) return std::nullopt;
    if (auto alone = prox_of_part_above(parts_, z, W, look)) return alone;
    return prox_in_slopes(*this, first_slope(z, W), z, W, look);
  }

 private:
  /// ||v||_(W⁻¹) is at most that of a subgradient at z, and at most 2||z||_W and that of a subgradient at 0,
  /// the prox being nonexpansive.
  double first_slope(const Vector& z, const Metric& W) const {
    double slope = infinity;
    if (const auto here = subgradient(z)) slope = here->norm();
    if (const auto at_zero = subgradient(Vector::Zero(z.size())))
      slope = std::min(slope, std::sqrt(W.diagonal().maxCoeff()) * (2 * W.norm(z) + W.dual_norm(*at_zero)));
    return slope;
  }

  std::vector<Function> parts_;
  Index n_;
  bool piecewise_ = false;
};

}  // namespace

std::vector<Function> parts_of_max(const Function& f) {
  const auto* made = dynamic_cast<const Operation*>(&f.node());
  if (!made || f.facts().piecewise_quadratic) return {};
  return made->maximum_of();
}

Function proper_max(std::vector<Function> parts) {
  return Function(std::make_shared<PointwiseMax>(std::move(parts)));
}

namespace {

Function all_but_first(std::span<const Function> parts) {
  return parts.size() == 2 ? parts[1] : proper_max(std::vector<Function>(parts.begin() + 1, parts.end()));
}

}  // namespace

std::optional<Prox> prox_of_max(std::span<const Function> parts, const Vector& z, const Metric& W,
                                const Look& look) {
  const OneAtATime outer(OneAtATime::Kind::maximum);
  const auto inner =
      outer.first() ? nullptr : std::make_unique<OneAtATime>(OneAtATime::Kind::maximum_in_maximum);
  if (inner && !inner->first()) return std::nullopt;
  auto found = prox_of_two_function_max(parts[0], all_but_first(parts), z, W, look);
  if (found && !(found->error_bound <= accuracy_of_prox * (W.norm(z) + W.norm(found->x))))
    found->status = Status::inaccurate;
  return found;
}

std::optional<Value> conjugate_of_max(std::span<const Function> parts, const Vector& v) {
  const OneAtATime question(OneAtATime::Kind::maximum_conjugate);
  if (!question.first()) return std::nullopt;
  return conjugate_of_two_function_max(parts[0], all_but_first(parts), v);
}

Function pointwise_max(std::span<const Function> parts, Index n) {
  if (parts.empty()) throw InvalidInput("pointwise_max: no functions; give at least one");
  if (parts.size() == 1) return parts[0];
  if (const Index own = common_dimension(parts, "pointwise_max"); own != 0) n = own;
  std::vector<Function> all;  // a maximum in a maximum is one of all parts
  for (const Function& f : parts) {
    const auto* inner = dynamic_cast<const PointwiseMax*>(&f.node());
    if (inner)
      all.insert(all.end(), inner->parts().begin(), inner->parts().end());
    else
      all.push_back(f);
  }
  const Function made(std::make_shared<PointwiseMax>(std::move(all)));
  if (n != 0 && domains_may_miss(parts)) {
    require_proper(proper_sum(parts), n, "pointwise_max");
    if (auto point = at_its_only_point(made, n)) return *point;
  }
  return made;
}

}  // namespace convex::inline operations
