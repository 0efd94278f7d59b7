#include "convex/laws/conjugate_laws.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "convex/laws/cutting_planes.hpp"
#include "convex/laws/nearest_by_support.hpp"
#include "convex/laws/worst_check.hpp"
#include "convex/operations/operations.hpp"

namespace convex::inline law_checks {
namespace {

/// y = prox_g z beside x = prox_f z, with what an error in them does to the values.
struct Decomposed {
  Split x, y;
  double inner = 0, size = 0, slack = 0;
};

Decomposed decomposed(const ConjugatePair& pair, const Vector& z, const Metric& W) {
  Decomposed d{split(pair.f, z, W), split(pair.g, z, W)};
  d.inner = W.inner(d.x.x, d.y.x);
  d.size = std::abs(d.x.f_x) + std::abs(d.y.f_x) + W.norm(d.x.x) * W.norm(d.y.x);
  d.slack = value_roundings * d.size * spectrum(W).condition() + d.x.bound * W.norm(d.y.x) +
            d.y.bound * W.norm(d.x.x) + variation(pair.f, d.x.x, d.x.bound) +
            variation(pair.g, d.y.x, d.y.bound);
  return d;
}

/// What f(u) + g(w) may miss: each may be the value at a point of the domain that is as far away as its
/// membership tolerance, relative to |u| and |w|, allows. There Fenchel's inequality holds, and a move e of u
/// changes (u|w) by at most |e| |Ww|.
double outside(const ConjugatePair& pair, const Vector& u, const Vector& w, const Metric& W) {
  return pair.f.membership * u.norm() * W.multiply(w).norm() +
         pair.g.membership * w.norm() * W.multiply(u).norm();
}

/// e_g(z) = g(y) + ½||z - y||².
double envelope(const Decomposed& d, const Metric& W) {
  const Vector rest = d.y.z - d.y.x;
  return d.y.f_x + W.inner(rest, rest) / 2;
}

/// z = x + y with each y that was found without x; none where there is no such y.
std::optional<Check> sum_law(const ConjugatePair& pair, const Decomposed& at, const Metric& W) {
  const Vector& z = at.x.z;
  const Prox x = pair.f.prox(z, W), y = pair.g.prox(z, W);
  WorstCheck worst("z = x + y by two routes");
  bool evidence = false;
  const auto take = [&](const Vector& other, double error) {
    evidence = true;
    worst.take(W.norm(z - x.x - other), at.x.bound + error);
  };
  if (are_two_routes(x, y)) take(y.x, at.y.bound);
  // At 0 a program's y is the rounding of its data, which no bound relative to z and x covers.
  if (pair.other_routes && W.norm(z) + W.norm(x.x) > 0)
    for (const Prox& other : pair.other_routes(z, W))
      take(other.x, other.error_bound + rounding_bound(W, z, other.x));
  if (!evidence) return std::nullopt;
  return worst.check();
}

Check uniqueness(const ConjugatePair& pair, const Decomposed& at, const Metric& W,
                 const std::vector<Vector>& others) {
  WorstCheck worst("no other split of z satisfies conjugacy");
  for (const Vector& other : others)
    for (double step : {1.0, 1e-3}) {
      const Vector d = step * (other - at.x.z);
      const double f = pair.f.value(at.x.x + d), g = pair.g.value(at.y.x - d);
      if (!std::isfinite(f) || !std::isfinite(g)) continue;
      const double gap = f + g - W.inner(at.x.x + d, at.y.x - d), least = W.inner(d, d);
      const double bound = at.slack +
                           value_roundings * (std::abs(f) + std::abs(g) + std::abs(f + g - gap) + least) *
                               spectrum(W).condition() +
                           outside(pair, at.x.x + d, at.y.x - d, W) + (at.x.bound + at.y.bound) * W.norm(d);
      worst.take(std::max(0.0, least - gap), bound);
    }
  return worst.check();
}

Check fenchel(const ConjugatePair& pair, const Metric& W, const std::vector<Vector>& others) {
  WorstCheck worst("Fenchel's inequality f(u) + g(w) >= (u|w)");
  std::vector<Vector> us, ws;
  for (const Vector& other : others) {
    us.push_back(pair.f.prox(other, W).x);
    ws.push_back(pair.g.prox(other, W).x);
    us.push_back(other);
    ws.push_back(other);
  }
  for (const Vector& u : us)
    for (const Vector& w : ws) {
      const double f = pair.f.value(u), g = pair.g.value(w);
      if (!std::isfinite(f) || !std::isfinite(g)) continue;
      const double inner = W.inner(u, w);
      const double bound =
          value_roundings * spectrum(W).condition() * (std::abs(f) + std::abs(g) + W.norm(u) * W.norm(w)) +
          outside(pair, u, w, W);
      worst.take(std::max(0.0, inner - f - g), bound);
    }
  return worst.check();
}

Check envelope_gradient(const ConjugatePair& pair, const Decomposed& at, const Metric& W,
                        const std::vector<Vector>& others) {
  WorstCheck worst("x is the gradient at z of the envelope of g");
  const double e = envelope(at, W);
  for (const Vector& other : others) {
    const Vector h = (other - at.x.z) / 8;
    const Decomposed moved = decomposed(pair, at.x.z + h, W);
    const double rise = envelope(moved, W) - e;
    const double low = W.inner(at.x.x, h), high = W.inner(moved.x.x, h);
    const double bound = at.slack + moved.slack +
                         value_roundings * spectrum(W).condition() * (std::abs(e) + std::abs(rise)) +
                         (at.x.bound + moved.x.bound) * W.norm(h) + at.y.bound * W.norm(at.x.x) +
                         moved.y.bound * W.norm(moved.x.x);
    worst.take(std::max({0.0, low - rise, rise - high}), bound);
  }
  return worst.check();
}

/// In more dimensions the hull of support points takes too many of them.
constexpr Index most_dimensions_of_hull = 16;

/// y = prox_g z, g the conjugate of f in V, from the support points of the set of which f or g is the support
/// function; none when neither is, or that set is not bounded.
std::optional<Prox> from_support_points(const Function& f, const Vector& z, const Metric& V) {
  if (z.size() > most_dimensions_of_hull) return std::nullopt;
  // A subgradient near a kink may be rounding alone, and no point of the set.
  const auto in_set = [](const Function& indicator, std::optional<Vector> s) {
    return s && std::isfinite(indicator(*s)) ? s : std::nullopt;
  };
  const Function plain = f.conjugate();
  if (f.facts().support && f.facts().finite)
    return nearest_by_support(
        [&](const Vector& c) {
          const std::optional<Vector> s = in_set(plain, f.subgradient(c));
          return s ? std::optional<Vector>(V.solve(*s)) : std::nullopt;
        },
        z, V);
  if (!f.facts().indicator || !plain.facts().finite) return std::nullopt;
  std::optional<Prox> x =
      nearest_by_support([&](const Vector& c) { return in_set(f, plain.subgradient(V.multiply(c))); }, z, V);
  if (x) x->x = z - x->x;
  return x;
}

bool is_evidence(const Prox& other, const Vector& z) {
  return !other.by_conjugate && other.x.size() == z.size() && std::isfinite(other.error_bound);
}

std::vector<Prox> other_routes(const Function& f, const Function& g, const Vector& z, const Metric& V) {
  std::vector<Prox> routes;
  const auto take = [&](std::optional<Prox> found) {
    if (found && is_evidence(*found, z)) routes.push_back(*std::move(found));
  };
  // The program of g holds V's matrix, rounded: that is condition(V) roundings of the entries of y, and an
  // error of the entries is up to sqrt(condition(V)) times as large a part of ||y||_V.
  std::optional<Prox> program = prox_by_program(g, z, V);
  if (program && program->x.size() == z.size())
    program->error_bound += rounding_bound(V, z, program->x) * std::sqrt(spectrum(V).condition());
  take(std::move(program));
  take(from_support_points(f, z, V));
  if (routes.empty() && z.size() <= most_dimensions_of_hull && f.facts().finite) {
    auto x = prox_by_cutting_planes(
        f, [&](const Vector& u) { return f.subgradient(u); }, z, V);
    if (x) x->x = z - x->x;
    take(std::move(x));
  }
  return routes;
}

}  // namespace

std::vector<Check> conjugate_laws(const ConjugatePair& pair, const Trial& trial,
                                  const std::vector<Vector>& others, std::vector<std::string>& no_evidence) {
  const Metric& W = trial.W;
  const Vector& z = trial.z;
  const Decomposed at = decomposed(pair, z, W);
  std::vector<Check> checks;
  checks.push_back(check_that("g is finite at y = prox_g z", std::isfinite(at.y.f_x) ? 0 : 1, 0));
  if (!std::isfinite(at.x.f_x) || !std::isfinite(at.y.f_x)) return checks;

  if (const auto sum = sum_law(pair, at, W)) {
    checks.push_back(*sum);
  } else if (W.norm(z) + W.norm(at.x.x) > 0) {  // 0 = 0 + 0 asks for no evidence
    const Prox x = pair.f.prox(z, W), y = pair.g.prox(z, W);
    checks.push_back(
        check_that("z = x + y by two routes", std::numeric_limits<double>::infinity(), at.x.bound));
    no_evidence.push_back("z = x + y (" + trial.metric_name + " metric): x by " + x.method + ", y by " +
                          y.method + "; one of them came from the other, which proves nothing");
  }
  checks.push_back(
      check_that("conjugacy f(x) + g(y) = (x|y)", std::abs(at.x.f_x + at.y.f_x - at.inner), at.slack));
  checks.push_back(fenchel(pair, W, others));
  checks.push_back(uniqueness(pair, at, W, others));
  checks.push_back(envelope_gradient(pair, at, W, others));
  const Vector rest = z - at.x.x;
  const double envelopes = at.x.f_x + W.inner(rest, rest) / 2 + envelope(at, W), half = W.inner(z, z) / 2;
  checks.push_back(check_that("the envelopes of f and g add up to ||z||²/2", std::abs(envelopes - half),
                              2 * at.slack + value_roundings * spectrum(W).condition() * half +
                                  (at.x.bound + at.y.bound) * W.norm(z)));
  if (pair.cone) {
    checks.push_back(check_that("x and y are orthogonal", std::abs(at.inner), at.slack));
    const Split twice = split(pair.f, 2 * z, W);
    checks.push_back(
        check_that("prox_f(2z) = 2 prox_f z", W.norm(twice.x - 2 * at.x.x), twice.bound + 2 * at.x.bound));
  }
  return checks;
}

ConjugatePair conjugate_pair(const Function& f, const Metric& W) {
  const auto subject = [](const Function& function) {
    return Subject{[function](const Vector& x) { return function(x); },
                   [function](const Vector& z, const Metric& V) { return function.prox(z, V); },
                   function.facts().finite ? 0 : membership_tolerance};
  };
  const Function g = f.conjugate(W);
  return {subject(f), subject(g), f.facts().cone,
          [f, g](const Vector& z, const Metric& V) { return other_routes(f, g, z, V); }};
}

std::vector<Check> function_laws(const Function& f, const Subject& subject, const Trial& trial,
                                 const std::vector<Vector>& others, std::vector<std::string>& no_evidence) {
  const Metric& W = trial.W;
  const Split at = split(subject, trial.z, W);
  std::vector<Check> checks;
  if (!std::isfinite(at.f_x)) return checks;

  const Function twice = f.conjugate().conjugate();
  if (&twice.node() == &f.node()) {
    no_evidence.push_back("f** = f (" + trial.metric_name +
                          " metric): the conjugate keeps f and gives it back; f itself proves nothing");
  } else {
    const Prox again = twice.prox(trial.z, W);
    const double change = variation(subject, at.x, at.bound + again.error_bound);
    checks.push_back(
        check_that("f** = f", std::abs(twice(at.x) - at.f_x), value_roundings * std::abs(at.f_x) + change));
    checks.push_back(check_that("prox of f** = prox of f", W.norm(again.x - at.x),
                                again.error_bound + at.bound + rounding_bound(W, trial.z, again.x)));
  }

  Matrix inverse(trial.z.size(), trial.z.size());
  for (Index i = 0; i < trial.z.size(); ++i) inverse.col(i) = W.solve(Vector::Unit(trial.z.size(), i));
  const Metric dual = Metric::dense((inverse + inverse.transpose()) / 2);
  const Vector covector = W.multiply(trial.z);
  const Prox plain = f.conjugate().prox(covector, dual);
  checks.push_back(check_that(
      "z = prox_f z + W^-1 prox of the plain conjugate at Wz in W^-1",
      W.dual_norm(covector - W.multiply(at.x) - plain.x),
      at.bound + plain.error_bound + 2 * rounding_bound(W, trial.z, at.x) * spectrum(W).condition()));

  if (const std::optional<Vector> v = f.subgradient(at.x)) {
    WorstCheck given("the subgradient that f gives at x is one");
    for (const Vector& other : others)
      for (const Vector& u : {other, subject.prox(other, W).x}) {
        const double f_u = subject.value(u);
        if (!std::isfinite(f_u)) continue;
        const double bound =
            value_roundings * (std::abs(f_u) + std::abs(at.f_x) + v->cwiseAbs().dot((u - at.x).cwiseAbs())) +
            subject.membership * v->norm() * (u.norm() + at.x.norm()) + variation(subject, at.x, at.bound) +
            variation(subject, u, unit_roundoff * u.norm());
        given.take(std::max(0.0, at.f_x + v->dot(u - at.x) - f_u), bound);
      }
    checks.push_back(given.check());
  }
  checks.push_back(
      check_that("W(z - x) counts as a subgradient at x", f.is_subgradient(at.v, at.x) ? 0 : 1, 0));
  return checks;
}

}  // namespace convex::inline law_checks
