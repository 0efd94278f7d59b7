#include <algorithm>
#include <cmath>
#include <limits>

#include "convex/composite/graph_algebra.hpp"
#include "convex/infinity.hpp"
#include "convex/linear_quadratic/operations.hpp"
#include "convex/operations/composed_prox.hpp"
#include "convex/operations/exact_end.hpp"
#include "convex/operations/line_supremum.hpp"
#include "convex/operations/nearest_member.hpp"
#include "convex/operations/one_at_a_time.hpp"
#include "convex/operations/operation.hpp"
#include "convex/operations/operations.hpp"
#include "convex/operations/pinned_slopes.hpp"
#include "convex/operations/quadratic_term.hpp"
#include "convex/operations/supremum.hpp"
#include "convex/operations/value_near.hpp"

namespace convex::inline operations {
namespace {

class InfConvolution : public Operation {
 public:
  InfConvolution(Function f, Function g)
      : f_(std::move(f)), g_(std::move(g)), n_(common_dimension(std::vector{f_, g_}, "inf_convolution")) {}

  Index dimension() const override { return n_; }
  void require_size(Index n) const override {
    f_.node().require_size(n);
    g_.node().require_size(n);
  }
  Facts facts() const override {
    const Facts f = f_.facts(), g = g_.facts();
    return {.indicator = f.indicator && g.indicator,
            .cone = f.cone && g.cone,
            .support = f.support && g.support,
            .separable = f.separable && g.separable,
            .piecewise_quadratic = f.piecewise_quadratic && g.piecewise_quadratic,
            .smooth = f.smooth || g.smooth,
            .finite = f.finite || g.finite};
  }
  Call call() const override { return {"inf_convolution", {argument(f_.call()), argument(g_.call())}}; }
  Value evaluate(const Vector& x) const override {
    if (const auto split = smoothing(x.size()))
      if (const auto value = value_of_smoothing(*split, x)) return *value;
    if (const auto sum = value_by_entries(*this, x)) return *sum;
    ByProgram found = by_program(x);
    // Of cones that only near each other far out, a program takes points out there, where it is right to a
    // part of their size, for common ones.
    constexpr double far_out = 100;
    if (facts().support && found.least.size() >= x.size() && std::isfinite(found.value.value) &&
        length_of(found.least.head(x.size())) > far_out * length_of(x))
      found.value.error = infinity;
    if (found.least.size() >= x.size() && !is_of_rounding(found.value)) {
      const Value at_w = value_of_split(x, found.least.head(x.size()), found.slope);
      found.value = between_points(found.value, at_w, found.slope, conjugate(), x);
    }
    const OneAtATime question(OneAtATime::Kind::least_on_line);  // one in another would take its square
    if (x.size() == 1 && question.first() && !is_of_rounding(found.value)) {
      // The least over w is found from values of f and g alone.
      const double start = found.least.size() > 0 ? found.least[0] : x[0] / 2;
      const auto at = [&](double w) { return value_of_split(x, Vector::Constant(1, w), found.slope); };
      const Value least = least_on_line(at, start);
      if (least.error < found.value.error) found.value = least;
    }
    return settled_value(found.value, found.slope, conjugate(), x);
  }
  std::optional<Vector> subgradient(const Vector& x) const override {
    if (const auto split = smoothing(x.size()))
      if (auto slope = slope_of_smoothing(split->f, split->q, x)) return slope;
    if (auto slopes = subgradient_by_entries(*this, x)) return slopes;
    if (auto slope = maximiser(conjugate(), x)) return slope;
    return Operation::subgradient(x);
  }
  Function conjugate() const override {
    const Function terms[] = {f_.conjugate(), g_.conjugate()};
    return proper_sum(terms);
  }
  /// Either function may go all the way.
  double recession(const Vector& d) const override {
    return std::min(f_.node().recession(d), g_.node().recession(d));
  }
  double domain_support(const Vector& v) const override {
    return f_.node().domain_support(v) + g_.node().domain_support(v);
  }
  std::optional<Function> entry(Index i) const override {
    const auto f = f_.node().entry(i), g = g_.node().entry(i);
    return f && g ? std::optional(proper_inf_convolution(*f, *g)) : std::nullopt;
  }
  std::optional<Value> constant_beside_entries() const override {
    return sum_of_constants(std::vector{f_, g_});
  }
  std::optional<LinearQuadratic> linear_quadratic(Index n) const override {
    const auto forms = programs(std::vector{f_, g_}, n);
    if (!forms) return std::nullopt;
    try {
      return linear_quadratic::inf_convolution((*forms)[0], (*forms)[1]);
    } catch (const InvalidInput&) {  // numbers beyond doubles: no program
      return std::nullopt;
    }
  }
  std::optional<GraphForm> graph(Index n, double slope) const override {
    const auto f = f_.node().graph(n, slope), g = g_.node().graph(n, slope);
    if (!f || !g) return std::nullopt;
    return convex::inf_convolution(*f, *g);
  }

 protected:
  std::optional<Prox> reduced_prox(const Vector& z, const Metric& W, const Look& look) const override {
    const bool diagonal = W.kind() == MetricKind::identity || W.kind() == MetricKind::diagonal;
    if (facts().piecewise_quadratic && !diagonal) return std::nullopt;
    if (const auto split = smoothing(z.size())) return smoothed_prox(split->f, split->q, z, W, look);
    return std::nullopt;
  }

 private:
  /// f □ g with g the kernel q, a definite quadratic.
  struct Smoothing {
    Function f, g;
    Kernel q;
  };
  std::optional<Smoothing> smoothing(Index n) const {
    for (const auto& [f, g] : {std::pair{f_, g_}, std::pair{g_, f_}})
      if (const auto term = quadratic_term(g, n))
        if (auto kernel = kernel_of(*term)) return Smoothing{f, g, *std::move(kernel)};
    return std::nullopt;
  }
  /// f(x - w) + g(w) with one of the parts moved to the nearest point of its domain: where the other is steep
  /// there, even a point that counts as a member is too far.
  Value value_of_split(const Vector& x, const Vector& w, const std::optional<Vector>& slope) const {
    const double size = length_of(x) + length_of(w);
    const auto with = [&](const Function& one, const Member& in, const Function& other) {
      const DoubleDoubleVector rest = difference(x, in.at);
      const NearValue beside = near_value(other, rest, size);
      const double miss = in.miss + std::max(beside.moved, miss_of(other, rest.hi, size));
      return sum_of(sum_of(one.evaluate(in.at), beside.value), {0, cost_of_miss(miss, slope)});
    };
    const Value by_g = with(g_, nearest_member(g_, w, size), f_);
    if (f_.facts().finite) return by_g;
    const Value by_f = with(f_, nearest_member(f_, difference(x, w).hi, size), g_);
    return by_f.value > by_g.value ? by_f : by_g;
  }
  /// f(w) + g(x - w) by g's own formula: of a g moved far the terms of q are large, and cancel. It is above
  /// the minimum by no more than the square of what w is off by. None where the prox of f gave up,
  /// or w was rounded out of its domain: f □ q is finite.
  static std::optional<Value> value_of_smoothing(const Smoothing& of, const Vector& x) {
    const Smoothed split = smoothed(of.f, of.q, x);
    if (split.w.size() != x.size()) return std::nullopt;
    const double size = length_of(x) + length_of(split.w);
    const Value of_f = of.f.evaluate(split.w);
    if (!std::isfinite(of_f.value)) return std::nullopt;
    return sum_of(sum_of(of_f, value_near(of.g, difference(x, split.w), size)),
                  Value{0, std::max(split.above, split.off * split.off)});
  }

  Function f_, g_;
  Index n_;
};

[[noreturn]] void refuse_improper() {
  throw InvalidInput(
      "inf_convolution: it is -inf everywhere; give functions whose conjugates are finite at a common point");
}

/// Is f(w) + g(x - w) unbounded below in w? It is for one x with a finite value when it is for all. The
/// conjugates' domains may have closures that meet and no common point, as those of -log and of log(1 + e^x).
bool falls_without_end(const Function& f, const Function& g, Index n) {
  const Metric plain = Metric::identity(n);
  const Prox a = f.prox(Vector::Zero(n), plain), b = g.prox(Vector::Zero(n), plain);
  if (a.x.size() != n || b.x.size() != n) return false;
  const Function terms[] = {f, translate(dilate(g, -1), a.x + b.x)};
  return grows_without_end(proper_sum(terms), Vector::Zero(n));
}

/// Have two conjugates of one entry no slope in common? Closures that meet in one point decide by the values
/// there, as those of -sqrt(x) and e^x do at 0.
bool slopes_miss(const Function& f, const Function& g) {
  const auto a = domain_of_one(f), b = domain_of_one(g);
  if (!a || !b) return false;
  const double low = std::max(a->low, b->low), high = std::min(a->high, b->high);
  if (low != high) return low > high;
  const Vector common = Vector::Constant(1, low);
  const Value of_f = f.evaluate(common), of_g = g.evaluate(common);
  const auto proved = [](const Value& value) { return std::isinf(value.value) && value.error == 0; };
  return proved(of_f) || proved(of_g);
}

/// f □ (c·x + d) = c·x + d - f*(c), when g is affine and f*(c) is known.
std::optional<Function> with_affine(const Function& f, const Function& g, Index n) {
  const auto q = quadratic_term(g, n);
  const std::optional<double> mu = q ? multiple_of_identity(q->Q) : std::nullopt;
  if (!mu || *mu != 0) return std::nullopt;
  const Value conjugate = f.conjugate().evaluate(q->c);
  if (std::isinf(conjugate.value) && conjugate.error == 0) refuse_improper();
  if (!std::isfinite(conjugate.value)) return std::nullopt;
  if (!(conjugate.error <= accuracy_of_prox * std::max(1.0, std::abs(conjugate.value)))) return std::nullopt;
  return function_of({q->Q, q->c, q->constant - conjugate.value});
}

}  // namespace

Function proper_inf_convolution(const Function& f, const Function& g) {
  return Function(std::make_shared<InfConvolution>(f, g));
}

Function inf_convolution(const Function& f, const Function& g, Index n) {
  const Function parts[] = {f, g};
  if (const Index own = common_dimension(parts, "inf_convolution"); own != 0) n = own;
  if (n != 0) {
    if (auto affine = with_affine(f, g, n)) return *affine;
    if (auto affine = with_affine(g, f, n)) return *affine;
    const Function conjugates[] = {f.conjugate(), g.conjugate()};
    const bool by_entry = n == 1 || (all_of(parts, &Facts::separable) && common_dimension(parts, "") == 0);
    if (by_entry && slopes_miss(conjugates[0], conjugates[1])) refuse_improper();
    if (const auto other = with_pinned_slopes(f, g, n)) return inf_convolution(*other, g, n);
    if (const auto other = with_pinned_slopes(g, f, n)) return inf_convolution(f, *other, n);
    if (conjugates[0].facts().finite || conjugates[1].facts().finite) return proper_inf_convolution(f, g);
    try {
      require_proper(proper_sum(conjugates), n, "inf_convolution");
    } catch (const InvalidInput&) {
      // The conjugates are rounded; the functions themselves tell.
      if (!all_of(parts, &Facts::piecewise_quadratic) ||
          exact_end(proper_inf_convolution(f, g), n) != ProgramEnd::minimum)
        refuse_improper();
    }
    if (!all_of(parts, &Facts::piecewise_quadratic) && falls_without_end(f, g, n)) refuse_improper();
  }
  return proper_inf_convolution(f, g);
}

}  // namespace convex::inline operations
