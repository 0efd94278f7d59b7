#include "convex/proved_prox/pair_search.hpp"
#include "convex/proved_prox/proved_metric.hpp"

namespace convex::inline proved_prox::pairs {
namespace {

const Fraction cone_zero{0}, cone_one{1};

/// A pair of a cone, once x is known to be in it and v in its polar.
MaybePair in_cones(bool x_inside, bool v_inside, Fractions x, Fractions v, bool is_rational) {
  if (!x_inside || !v_inside) return std::nullopt;
  return ProofPair{std::move(x), std::move(v), only(cone_zero), only(cone_zero), is_rational};
}

Fractions head(const Fractions& x) { return {x.begin(), x.end() - 1}; }
Fractions with_last(Fractions x, const Fraction& last) {
  x.push_back(last);
  return x;
}

bool is_in_second_order_cone(const Fractions& x) {
  return sign(x.back()) >= 0 && !(x.back() * x.back() < square_of(head(x)));
}

Fractions negative(Fractions x) { return multiple_of(-cone_one, std::move(x)); }

/// (x, t) with t raised to |x| and a little where it is less.
Fractions raised(const Fractions& x) {
  if (is_in_second_order_cone(x)) return x;
  const Fraction square = square_of(head(x));
  return with_last(head(x), sign(square) == 0 ? cone_zero : a_little_above(sqrt(ball(square))));
}

bool is_in_rotated_cone(const Fractions& x) {
  const std::size_t n = x.size();
  const Fraction &u = x[n - 2], &v = x[n - 1];
  return sign(u) >= 0 && sign(v) >= 0 &&
         !(u * v * Fraction{2} < square_of(Fractions(x.begin(), x.end() - 2)));
}

/// x with the smaller of u and v raised where u v is too small.
std::optional<Fractions> raised_rotated(Fractions x) {
  if (is_in_rotated_cone(x)) return x;
  const std::size_t n = x.size();
  const bool by_u = x[n - 1] < x[n - 2];
  const Fraction& larger = x[by_u ? n - 2 : n - 1];
  if (sign(larger) <= 0) return std::nullopt;
  x[by_u ? n - 1 : n - 2] = square_of(Fractions(x.begin(), x.end() - 2)) / (larger * Fraction{2});
  return x;
}

/// y > 0, y e^(x/y) <= t; or y = 0, x <= 0, t >= 0.
bool is_in_exponential_cone(const Fractions& p) {
  if (sign(p[1]) == 0) return sign(p[0]) <= 0 && sign(p[2]) >= 0;
  if (sign(p[1]) < 0) return false;
  return (ball(p[2]) - ball(p[1]) * exp(ball(p[0] / p[1]))).sign() > 0;
}

/// u < 0, -u e^(v/u) <= e w; or u = 0, v, w >= 0.
bool is_in_dual_exponential_cone(const Fractions& p) {
  if (sign(p[0]) == 0) return sign(p[1]) >= 0 && sign(p[2]) >= 0;
  if (sign(p[0]) > 0) return false;
  return (ball(p[2]) + ball(p[0]) * exp(ball(p[1] / p[0] - cone_one))).sign() > 0;
}

/// x^alpha y^(1 - alpha); x, y >= 0.
Ball geometric_mean(const Fraction& alpha, const Fraction& x, const Fraction& y) {
  if (sign(x) == 0 || sign(y) == 0) return ball(cone_zero);
  return pow(ball(x), ball(alpha)) * pow(ball(y), ball(cone_one - alpha));
}

Fraction size_of_entry(const Fraction& a) { return sign(a) < 0 ? -a : a; }

bool is_in_power_cone(const Fraction& alpha, const Fractions& p) {
  if (sign(p[0]) < 0 || sign(p[1]) < 0) return false;
  if (sign(p[2]) == 0) return true;
  return (geometric_mean(alpha, p[0], p[1]) - ball(size_of_entry(p[2]))).sign() > 0;
}

bool is_in_dual_power_cone(const Fraction& alpha, const Fractions& p) {
  return is_in_power_cone(alpha, {p[0] / alpha, p[1] / (cone_one - alpha), p[2]});
}

Fractions clamped_above_zero(Fractions x, std::size_t entries) {
  for (std::size_t i = 0; i < entries; ++i)
    if (sign(x[i]) < 0) x[i] = cone_zero;
  return x;
}

}  // namespace

MaybePair of_second_order_cone(const Fractions& x, const Fractions& v) {
  const std::size_t n = x.size();
  const auto judged = [](Fractions point, Fractions covector) {
    const bool inside = is_in_second_order_cone(point), polar = is_in_second_order_cone(negative(covector));
    return in_cones(inside, polar, std::move(point), std::move(covector), true);
  };
  std::vector<MaybePair> candidates = {judged(raised(x), Fractions(n)),
                                       judged(Fractions(n), negative(raised(negative(v))))};
  // Both on the boundary: (d, |d|) and (d, -|d|), each times something.
  for (const bool of_v : {true, false}) {
    const Fractions d = head(of_v ? v : x);
    const Fraction square = square_of(d);
    if (sign(square) == 0) continue;
    const Fraction length = a_little_above(sqrt(ball(square)));
    const Fraction along = x.back() / length, against = -v.back() / length;
    if (sign(along) < 0 || sign(against) < 0) continue;
    candidates.push_back(
        judged(multiple_of(along, with_last(d, length)), multiple_of(against, with_last(d, -length))));
  }
  return best_of(std::move(candidates), x, v);
}

MaybePair of_rotated_cone(const Fractions& x, const Fractions& v) {
  const std::size_t n = x.size();
  const auto judged = [](const Fractions& point, const Fractions& covector) {
    return in_cones(is_in_rotated_cone(point), is_in_rotated_cone(negative(covector)), point, covector, true);
  };
  std::vector<MaybePair> candidates;
  if (const auto point = raised_rotated(x)) candidates.push_back(judged(*point, Fractions(n)));
  if (const auto polar = raised_rotated(negative(v)))
    candidates.push_back(judged(Fractions(n), negative(*polar)));
  // The point (p, u, w) of the boundary with 2uw = |p|² has the normal (p, -w, -u).
  if (auto point = raised_rotated(x)) {
    Fractions p(point->begin(), point->end() - 2);
    Fraction& u = (*point)[n - 2];
    Fraction& w = (*point)[n - 1];
    if (sign(u) > 0 && sign(w) > 0) (u < w ? u : w) = square_of(p) / ((u < w ? w : u) * Fraction{2});
    const Fraction factor = -(v[n - 2] + v[n - 1]);
    if (sign(u + w) > 0 && sign(factor) > 0) {
      Fractions normal = p;
      normal.push_back(-w);
      normal.push_back(-u);
      candidates.push_back(judged(*point, multiple_of(factor / (u + w), normal)));
    }
  }
  return best_of(std::move(candidates), x, v);
}

MaybePair of_exponential_cone(const Fractions& x, const Fractions& v) {
  const auto judged = [](const Fractions& point, const Fractions& covector) {
    return in_cones(is_in_exponential_cone(point), is_in_dual_exponential_cone(negative(covector)), point,
                    covector, false);
  };
  const Fractions none(3);
  std::vector<MaybePair> candidates = {judged(x, none), judged(none, v), judged(none, none)};
  // The face y = 0: (x, 0, t) with x <= 0 <= t, and polar to it.
  for (const Fraction& a : {x[0], cone_zero})
    for (const Fraction& t : {x[2], cone_zero})
      for (const Fraction& b : {v[0], cone_zero})
        for (const Fraction& s : {v[2], cone_zero})
          candidates.push_back(judged({a, cone_zero, t}, {b, v[1], s}));
  // The point (ρy, y, y e^ρ) has the normal (e^ρ, e^ρ(1 - ρ), -1); ρ from x, or from v.
  Fractions ratios;
  if (sign(x[1]) > 0) ratios.push_back(x[0] / x[1]);
  if (sign(v[0]) > 0) ratios.push_back(cone_one - v[1] / v[0]);
  for (const Fraction& ratio : ratios) {
    const Ball E = exp(ball(ratio));
    if (!E.is_finite()) continue;
    const Fraction above = a_little_above(E), below = a_little_below(E);
    for (const Fraction& y : {x[1], x[2] / above})
      for (const Fraction& factor : {-v[2], v[0] / below})
        if (sign(y) > 0 && sign(factor) > 0) {
          candidates.push_back(judged({ratio * y, y, y * above},
                                      {factor * below, factor * below * (cone_one - ratio), -factor}));
        }
  }
  return best_of(std::move(candidates), x, v);
}

MaybePair of_power_cone(const Fraction& alpha, const Fractions& x, const Fractions& v) {
  const auto judged = [&](const Fractions& point, const Fractions& covector) {
    return in_cones(is_in_power_cone(alpha, point), is_in_dual_power_cone(alpha, negative(covector)), point,
                    covector, false);
  };
  const Fractions none(3), inside = clamped_above_zero(x, 2),
                           polar = negative(clamped_above_zero(negative(v), 2));
  std::vector<MaybePair> candidates = {judged(inside, none), judged(none, polar)};
  candidates.push_back(judged({inside[0], cone_zero, cone_zero}, {cone_zero, polar[1], cone_zero}));
  candidates.push_back(judged({cone_zero, inside[1], cone_zero}, {polar[0], cone_zero, cone_zero}));
  if (sign(inside[0]) > 0 && sign(inside[1]) > 0) {
    // (x, y, ±G), G = x^alpha y^(1-alpha), has the normal (-alpha G/x, -(1-alpha) G/y, ±1).
    const Ball G = geometric_mean(alpha, inside[0], inside[1]);
    if (G.is_finite()) {
      const Fraction above = a_little_above(G), below = a_little_below(G);
      const Fraction side = sign(x[2]) < 0 ? -cone_one : cone_one, factor = v[2] * side;
      const Fractions point = {inside[0], inside[1], below * side};
      if (sign(factor) > 0)
        candidates.push_back(
            judged(point, {-(factor * alpha * above / inside[0]),
                           -(factor * (cone_one - alpha) * above / inside[1]), factor * side}));
      candidates.push_back(judged(point, none));
    }
  }
  return best_of(std::move(candidates), x, v);
}

}  // namespace convex::inline proved_prox::pairs
