#include "convex/linear_quadratic/value.hpp"

#include <cmath>
#include <limits>

#include "convex/gamma0/facts.hpp"
#include "convex/gamma0/value.hpp"
#include "convex/infinity.hpp"
#include "convex/invalid_input.hpp"
#include "convex/linear_quadratic/minimise.hpp"
#include "convex/linear_quadratic/prox.hpp"
#include "convex/linear_quadratic/stationarity.hpp"

namespace convex::linear_quadratic {
namespace {

constexpr double not_known = std::numeric_limits<double>::quiet_NaN();

/// Bounds are widened by so many roundings of their terms when a rounded point of the domain misses them.
constexpr double widening = 64 * unit_roundoff;

/// A slope is rounding within so much of its terms.
constexpr double rounding_of_slope = 4 * unit_roundoff;

/// A value is given when its duality gap is below this part of its terms.
constexpr double accurate_value = 1e-11;

void check_size(const LinearQuadratic& f, const Vector& x, const char* where) {
  validate(f, where);
  if (x.size() != f.n || !x.allFinite())
    throw InvalidInput(std::string(where) + ": the point is not finite or of another size; give f.n numbers");
}

/// f as a program in w alone, x held: its rows are those of `kept`.
struct Section {
  LinearQuadratic program;
  std::vector<Index> kept;  // rows of f with a part in w; the others say where f is finite
  double worst = 0;         // by what the others are missed, relative to x and bound
};

double size_of_part(const LinearQuadratic& f, Index a, const Vector& x) {
  double square = 0;
  for (SparseRows::InnerIterator it(f.G, a); it; ++it)
    if (it.col() < f.n) square += it.value() * it.value();
  return std::sqrt(square) * x.norm() + std::abs(f.h[a]);
}

Section section(const LinearQuadratic& f, const Vector& x, bool wide) {
  const Index k = f.auxiliaries();
  std::vector<bool> equal(static_cast<std::size_t>(f.rows()), false);
  for (Index a : f.two_sided) equal[static_cast<std::size_t>(a)] = true;
  Vector xi = Vector::Zero(f.variables());
  xi.head(f.n) = x;
  LinearQuadraticBuilder program(0, k);
  Section found;
  for (Index a = 0; a < f.rows(); ++a) {
    DoubleDouble rest{f.h[a], 0};
    bool has_part = false;
    for (SparseRows::InnerIterator it(f.G, a); it; ++it) {
      if (it.col() < f.n)
        rest = add(rest, two_product(-it.value(), x[it.col()]));
      else
        has_part = true;
    }
    const bool two_sided = equal[static_cast<std::size_t>(a)];
    const double size = size_of_part(f, a, x), bound = rest.value();
    if (!has_part) {
      const double miss = two_sided ? std::abs(bound) : std::max(0.0, bound);
      if (miss > 0) found.worst = std::max(found.worst, miss / size);
      continue;
    }
    const auto take = [&](double sign, double limit) {
      program.row(limit);
      for (SparseRows::InnerIterator it(f.G, a); it; ++it)
        if (it.col() >= f.n) program.entry(it.col() - f.n, sign * it.value());
      found.kept.push_back(sign > 0 ? a : -1 - a);
    };
    if (two_sided && !wide) {
      program.equation(bound);
      for (SparseRows::InnerIterator it(f.G, a); it; ++it)
        if (it.col() >= f.n) program.entry(it.col() - f.n, it.value());
      found.kept.push_back(a);
    } else {
      take(1, wide ? bound - widening * size : bound);
      if (two_sided) take(-1, -bound - widening * size);
    }
  }
  found.program = program.finish();
  found.program.H = f.H.bottomRightCorner(k, k);
  found.program.c = (f.c + f.H * xi).tail(k);
  return found;
}

/// The duality gap of a minimum without x, and the terms of the value that rounding is relative to.
struct Gap {
  double gap = 0, terms = 0;
};
Gap value_gap(const LinearQuadratic& f, const ProgramPoint& point) {
  const Vector defect =
      stationarity_defect(f, Metric::identity(0), Vector(0), point.xi, point.lambda).cwiseAbs();
  const Vector terms_of_defect = defect_terms(f, point.xi, point.lambda);
  const double size = point.xi.cwiseAbs().maxCoeff();
  // Down a slope that is left the minimum may lie as far as ξ is large, also where an entry is 0.
  const double slopes =
      (defect.array() > rounding_of_slope * terms_of_defect.array()).select(defect, 0).sum();
  const double gap = std::abs(complementarity(f, point.xi, point.lambda)) + defect.dot(point.xi.cwiseAbs()) +
                     slopes * point.xi.lpNorm<1>();
  const double bend = f.H.coeffs().size() > 0 ? f.H.coeffs().abs().maxCoeff() : 0;
  const double largest = (f.c.cwiseAbs().maxCoeff() + bend * size) * size;
  const double terms =
      largest + terms_of_defect.dot(point.xi.cwiseAbs()) + f.h.cwiseAbs().dot(point.lambda.cwiseAbs());
  return {gap, terms};
}

/// The value over one section; none when no w fits.
std::optional<Evaluation> over(const LinearQuadratic& f, const Vector& x, bool wide) {
  const Section cut = section(f, x, wide);
  Evaluation found;
  if (cut.worst > membership_tolerance) return std::nullopt;
  const ProgramPoint point = minimise(cut.program, Metric::identity(0), Vector(0));
  // Rows that contradict each other by rounding alone prove nothing: the nearest point of the domain will
  // tell.
  if (point.defect == Defect::empty_domain || point.status == Status::gave_up) return std::nullopt;
  if (point.defect == Defect::unbounded_below) {
    found.value = -infinity;
    return found;
  }
  found.status = Status::inaccurate;
  found.value = not_known;
  if (point.lambda.size() != cut.program.rows()) return found;
  found.xi.resize(f.variables());
  found.xi << x, point.xi;
  found.value = objective(f, found.xi);
  const bool free_of_cost = cut.program.polyhedral() && cut.program.c.cwiseAbs().sum() == 0;
  const Gap left = free_of_cost ? Gap{} : value_gap(cut.program, point);
  if (free_of_cost || (point.status == Status::solved && left.gap <= accurate_value * left.terms))
    found.status = Status::solved;
  // The objective itself is summed in twice the precision.
  found.error = cut.worst <= accuracy_of_prox ? left.gap : infinity;
  Vector lambda = Vector::Zero(f.rows());
  for (std::size_t i = 0; i < cut.kept.size() && !free_of_cost; ++i) {
    const Index a = cut.kept[i];
    lambda[a >= 0 ? a : -1 - a] += (a >= 0 ? 1 : -1) * point.lambda[static_cast<Index>(i)];
  }
  found.v = subgradient_of_multipliers(f, found.xi, lambda);
  return found;
}

/// The nearest point of the domain when x misses it by rounding, and whether x itself is in the domain.
struct NearestInDomain {
  Vector y;
  Value membership;
};
std::optional<NearestInDomain> nearest_in_domain(const LinearQuadratic& f, const Vector& x) {
  LinearQuadratic domain = f;
  domain.H.setZero();
  domain.c.setZero();
  const Metric plain = Metric::identity(f.n);
  const ProgramPoint point = minimise(domain, plain, x);
  if (point.lambda.size() != f.rows() || point.status == Status::infeasible) return std::nullopt;
  double scale = x.stableNorm();
  for (Index a = 0; a < f.rows(); ++a)
    if (point.lambda[a] != 0) scale = std::max(scale, std::abs(f.h[a]) / f.G.row(a).norm());
  const Vector y = point.xi.head(f.n);
  const Value membership = indicated((y - x).stableNorm(), scale);
  if (membership.value > 0) return std::nullopt;
  return NearestInDomain{y, membership};
}

}  // namespace

Evaluation evaluate(const LinearQuadratic& f, const Vector& x) {
  check_size(f, x, "value");
  if (std::optional<Evaluation> found = over(f, x, false)) return *found;
  Evaluation outside;
  outside.value = infinity;
  if (f.auxiliaries() == 0) return outside;
  const std::optional<NearestInDomain> nearest = nearest_in_domain(f, x);
  if (!nearest) return outside;
  for (bool wide : {false, true})
    if (std::optional<Evaluation> found = over(f, nearest->y, wide)) {
      found->error += nearest->membership.error;
      return *std::move(found);
    }
  outside.value = not_known;
  outside.status = Status::inaccurate;
  return outside;
}

double value(const LinearQuadratic& f, const Vector& x) {
  const Evaluation found = evaluate(f, x);
  return found.status == Status::solved ? found.value : not_known;
}

double supremum(const LinearQuadratic& f, const Vector& v) {
  check_size(f, v, "supremum");
  LinearQuadratic all = f;
  all.n = 0;
  all.c.head(f.n) -= v;
  const ProgramPoint point = minimise(all, Metric::identity(0), Vector(0));
  if (point.defect == Defect::unbounded_below) return infinity;
  if (point.status != Status::solved) return not_known;
  // By the dual, which stays where it is when v is outside by rounding and ξ runs away.
  DoubleDouble dual{-f.constant, 0};
  for (Index a = 0; a < f.rows(); ++a) dual = add(dual, two_product(-f.h[a], point.lambda[a]));
  const Vector bend = f.H * point.xi;
  return add(dual, {0.5 * point.xi.dot(bend), 0}).value();
}

double subgradient_defect(const LinearQuadratic& f, const Vector& v, const Vector& x) {
  check_size(f, x, "subgradient_defect");
  const Prox found = prox(f, x + v, Metric::identity(f.n));
  return found.x.size() == f.n ? (found.x - x).norm() : infinity;
}

}  // namespace convex::linear_quadratic
