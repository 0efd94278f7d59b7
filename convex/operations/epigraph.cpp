#include <cmath>

#include "convex/composite/composite_prox.hpp"
#include "convex/composite/graph_algebra.hpp"
#include "convex/infinity.hpp"
#include "convex/linear_quadratic/linear_quadratic.hpp"
#include "convex/operations/operation.hpp"
#include "convex/operations/operations.hpp"
#include "convex/operations/two_function_max.hpp"
#include "convex/operations/value_near.hpp"

/// The epigraph of a function and its perspective: each other's conjugates, through f* and a change of sign.
namespace convex::inline operations {
namespace {

/// (v, r) -> h(v, -r) on n + 1 entries.
Function with_last_reversed(const Function& h, Index n) {
  Vector signs = Vector::Ones(n + 1);
  signs[n] = -1;
  return precompose(h, signs.asDiagonal(), Vector::Zero(n + 1));
}

/// h at v and -r, for any number of entries: both arguments reversed, and the first once more.
template <class Lift>
Function reversed_in_last(Lift lift, const Function& h) {
  return h.dimension() == 0 ? dilate(lift(dilate(h, -1)), -1) : with_last_reversed(lift(h), h.dimension());
}

Vector last_reversed(Vector v) {
  v[v.size() - 1] *= -1;
  return v;
}

/// Rows of f's program in (x, s, w): G (x, w) >= h s. The last entry of x is s, or t for the epigraph.
LinearQuadratic lifted(const LinearQuadratic& f, bool perspective) {
  const Index n = f.n, k = f.auxiliaries();
  LinearQuadraticBuilder form(n + 1, k);
  const auto place = [&](Index j) { return j < n ? j : j + 1; };
  std::vector<bool> equation(static_cast<std::size_t>(f.rows()), false);
  for (Index a : f.two_sided) equation[static_cast<std::size_t>(a)] = true;
  for (Index a = 0; a < f.rows(); ++a) {
    const double bound = perspective ? 0 : f.h[a];
    equation[static_cast<std::size_t>(a)] ? form.equation(bound) : form.row(bound);
    for (SparseRows::InnerIterator entry(f.G, a); entry; ++entry)
      form.entry(place(entry.col()), entry.value());
    if (perspective && f.h[a] != 0) form.entry(n, -f.h[a]);
  }
  if (perspective) {  // c·(x, w) + constant s, s >= 0
    for (Index j = 0; j < f.variables(); ++j) form.cost(place(j), f.c[j]);
    form.cost(n, f.constant);
    form.row(0);
    form.entry(n, 1);
  } else {  // t - c·(x, w) >= constant
    form.row(f.constant);
    for (Index j = 0; j < f.variables(); ++j)
      if (f.c[j] != 0) form.entry(place(j), -f.c[j]);
    form.entry(n, 1);
  }
  return form.finish();
}

/// The part common to both: a function of (x, s) made of f.
class Lifted : public Operation {
 public:
  explicit Lifted(Function f) : f_(std::move(f)) {
    const auto form = f_.node().linear_quadratic(telling_size({&f_, 1}, f_.dimension()));
    polyhedral_ = form && form->polyhedral();
  }
  Index dimension() const override { return f_.dimension() == 0 ? 0 : f_.dimension() + 1; }
  void require_size(Index n) const override {
    if (n < 2) throw InvalidInput(call().name + ": one entry; give one more than the function takes");
    f_.node().require_size(n - 1);
  }

 protected:
  std::optional<LinearQuadratic> lifted_program(Index n, bool perspective) const {
    if (!polyhedral_) return std::nullopt;
    return lifted(*f_.node().linear_quadratic(n - 1), perspective);
  }
  std::optional<GraphForm> part_graph(Index n, double slope) const { return f_.node().graph(n - 1, slope); }
  const Function f_;
  bool polyhedral_ = false;
};

/// f on all entries but the last, which is not negative: what an epigraph is where f is an indicator, and a
/// perspective where f is positively homogeneous.
Function with_last_not_negative(const Function& f, Index n) {
  const Function parts[] = {f, named("indicator", {argument(Call{"orthant", {}})}, 1)};
  return separable(parts, {n - 1, 1});
}

class Epigraph : public Lifted {
 public:
  using Lifted::Lifted;
  Facts facts() const override {
    const Facts f = f_.facts();
    return {.indicator = true,
            .cone = f.support || f.cone,
            .support = f.support || f.cone,
            .piecewise_quadratic = polyhedral_};
  }
  Call call() const override { return {"indicator", {argument(Call{"epigraph", {argument(f_.call())}})}}; }
  Value evaluate(const Vector& x) const override {
    const Index n = x.size() - 1;
    const Value height = value_near(f_, x.head(n), length_of(x));
    if (height.value == infinity) return height;
    const double scale = std::abs(height.value) + length_of(x);
    const Value below = indicated(height.value - x[n], scale);
    if (below.value == 0) return std::isfinite(height.error) ? below : Value{0, infinity};
    // On a steep part a rounded x may lift f(x) far above t: the nearest point decides.
    const Prox nearest = prox(x, Metric::identity(x.size()), Look{});
    if (nearest.x.size() != x.size()) return {infinity, 0};
    const Value found = indicated(length_of(nearest.x - x), length_of(x));
    // A search that gave up at x says nothing of it.
    return found.value == 0 && nearest.status != Status::solved ? Value{0, infinity} : found;
  }
  std::optional<Vector> subgradient(const Vector& x) const override {
    if (value(x) > 0) return std::nullopt;
    return Vector::Zero(x.size());
  }
  /// sup v·x + r t over t >= f(x) is the perspective of f* at (v, -r).
  Function conjugate() const override {
    return reversed_in_last([](const Function& h) { return perspective(h); }, f_.conjugate());
  }
  double recession(const Vector& d) const override {
    const Index n = d.size() - 1;
    return f_.node().recession(d.head(n)) <= d[n] ? 0 : infinity;
  }
  std::optional<Value> conjugate_value(const Vector& v) const override {
    return perspective(f_.conjugate()).evaluate(last_reversed(v));
  }
  std::optional<LinearQuadratic> linear_quadratic(Index n) const override { return lifted_program(n, false); }
  /// A normal is (λ∇f, -λ).
  double slope_of(const Vector& v) const override {
    const Index n = v.size() - 1;
    return v.head(n).norm() / std::abs(v[n]);
  }
  std::optional<GraphForm> graph(Index n, double slope) const override {
    if (f_.facts().indicator) return with_last_not_negative(f_, n).node().graph(n, slope);
    const auto form = part_graph(n, slope);
    if (!form) return std::nullopt;
    return convex::epigraph(*form, unit_of_slope(slope));
  }

 protected:
  std::optional<Prox> reduced_prox(const Vector& z, const Metric& W, const Look& look) const override {
    if (polyhedral_) return std::nullopt;
    if (f_.facts().indicator) return with_last_not_negative(f_, z.size()).prox(z, W, look);
    // With the unit 1 x and t come from the set itself, and v is proved to be normal to it.
    return prox_in_slopes(*this, 1, z, W, look);
  }
};

class Perspective : public Lifted {
 public:
  using Lifted::Lifted;
  Facts facts() const override {
    const Facts f = f_.facts();
    return {.indicator = f.cone, .cone = f.cone, .support = true, .piecewise_quadratic = polyhedral_};
  }
  Call call() const override { return {"perspective", {argument(f_.call())}}; }
  Value evaluate(const Vector& x) const override {
    const Index n = x.size() - 1;
    const double s = x[n];
    const double size = length_of(x);
    if (s < -membership_tolerance * size) return {infinity, 0};
    if (s > 0) {
      const Value inside = multiple_of(s, value_near(f_, quotient(x.head(n), s), size / s));
      if (std::isfinite(inside.value)) return inside;
      if (s > membership_tolerance * size) return inside;
    }
    Vector closed = x;
    closed[n] = 0;
    return Operation::evaluate(closed);
  }
  Function conjugate() const override {
    return reversed_in_last([](const Function& h) { return epigraph(h); }, f_.conjugate());
  }
  /// The domain is made of the rays through (x, 1), x in the domain of f.
  double domain_support(const Vector& v) const override {
    const Index n = v.size() - 1;
    return f_.node().domain_support(v.head(n)) + v[n] <= 0 ? 0 : infinity;
  }
  std::optional<Value> conjugate_value(const Vector& v) const override {
    return epigraph(f_.conjugate()).evaluate(last_reversed(v));
  }
  std::optional<LinearQuadratic> linear_quadratic(Index n) const override { return lifted_program(n, true); }
  std::optional<GraphForm> graph(Index n, double slope) const override {
    if (const auto simple = simpler(n)) return simple->node().graph(n, slope);
    const auto form = part_graph(n, slope);
    if (!form) return std::nullopt;
    return convex::perspective(*form);
  }
  std::optional<Vector> subgradient(const Vector& x) const override {
    const Index n = x.size() - 1;
    if (!(x[n] > 0)) return Operation::subgradient(x);
    const Vector inside = x.head(n) / x[n];
    const std::optional<Vector> v = f_.subgradient(inside);
    if (!v) return std::nullopt;
    Vector whole(n + 1);
    whole << *v, f_(inside) - v->dot(inside);
    return whole;
  }

 protected:
  std::optional<Prox> reduced_prox(const Vector& z, const Metric& W, const Look& look) const override {
    if (polyhedral_) return std::nullopt;
    if (const auto simple = simpler(z.size())) return simple->prox(z, W, look);
    return std::nullopt;
  }

 private:
  /// The same function without a perspective in a perspective, or the epigraph of a part in one.
  std::optional<Function> simpler(Index n) const {
    if (f_.facts().support) return with_last_not_negative(f_, n);
    std::vector<Function> lifted;
    for (const Function& part : parts_of_max(f_)) lifted.push_back(perspective(part));
    if (lifted.empty()) return std::nullopt;
    return proper_max(std::move(lifted));
  }
};

}  // namespace

Function perspective(const Function& f) { return Function(std::make_shared<Perspective>(f)); }

Function epigraph(const Function& f) { return Function(std::make_shared<Epigraph>(f)); }

}  // namespace convex::inline operations
