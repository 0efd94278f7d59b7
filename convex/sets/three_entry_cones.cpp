#include "convex/exact_program/exact_arguments.hpp"
#include "convex/proved_prox/ball_numbers.hpp"
#include "convex/sets/subdifferential_rules.hpp"

/// Normal cones of the exponential and the power cones by their faces. At a point other than 0 they are
/// polyhedra, in fractions: {0} inside, a ray on the curved part, the normals of a plane or an edge.
namespace convex::inline sets::subgradients {
namespace {

Fractions triple(Fraction a, Fraction b, Fraction c) { return {std::move(a), std::move(b), std::move(c)}; }
const Fraction zero_part{}, one_part{1};

/// The cone that the rays generate.
Subdifferential generated(const std::vector<Fractions>& rays) {
  ExactRows rows;
  for (const Fractions& one : rays) rows.push_back(exact_vector(one));
  return of_polyhedron(polyhedron_of(generated_cone(rows, {}, 3)), true);
}

Subdifferential at_apex(const Call& cone) { return of_support(indicator_call(cone), 3, false); }

bool is_zero(const Fractions& p) { return sign(p[0]) == 0 && sign(p[1]) == 0 && sign(p[2]) == 0; }

/// The sign of t - y e^(x/y), y > 0: e^q of a rational q other than 0 is no rational number (Lambert 1768),
/// so that balls decide. 2 where they do not.
int room_under(const Fraction& x, const Fraction& y, const Fraction& t) {
  if (sign(x) == 0) return sign(t - y);
  const int found = (ball(t) - ball(y) * exp(ball(x / y))).sign();
  return found == 0 ? 2 : found;
}

/// closure of {y > 0, y e^(x/y) <= t}.
std::optional<Subdifferential> of_exponential_cone(const Call& f, const Fractions& p) {
  const Fraction &x = p[0], &y = p[1], &t = p[2];
  if (is_zero(p)) return at_apex(f);
  if (sign(y) < 0) return none(3);
  const Fractions down_y = triple(zero_part, Fraction{-1}, zero_part),
                  down_t = triple(zero_part, zero_part, Fraction{-1});
  if (sign(y) == 0) {
    if (sign(x) > 0 || sign(t) < 0) return none(3);
    return sign(t) > 0 ? ray(down_y, true) : generated({down_y, down_t});
  }
  const int room = room_under(x, y, t);
  if (room == 2) return std::nullopt;
  if (room < 0) return none(3);
  if (room > 0) return single(Fractions(3), true);
  return ray(triple(one_part, one_part, Fraction{-1}), true);  // x = 0, t = y
}

/// closure of {u < 0, -u e^(v/u) <= e w}.
std::optional<Subdifferential> of_dual_exponential_cone(const Call& f, const Fractions& p) {
  const Fraction &u = p[0], &v = p[1], &w = p[2];
  if (is_zero(p)) return at_apex(f);
  const Fractions up_u = triple(one_part, zero_part, zero_part),
                  down_w = triple(zero_part, zero_part, Fraction{-1});
  if (sign(u) > 0) return none(3);
  if (sign(u) == 0) {
    if (sign(v) < 0 || sign(w) < 0) return none(3);
    return sign(w) > 0 ? ray(up_u, true) : generated({up_u, down_w});
  }
  // -u e^((v - u)/u) <= w.
  const int room = room_under(u - v, -u, w);
  if (room == 2) return std::nullopt;
  if (room < 0) return none(3);
  if (room > 0) return single(Fractions(3), true);
  return ray(triple(zero_part, Fraction{-1}, Fraction{-1}), true);  // v = u, w = -u
}

/// Powers with larger denominators are left to balls.
constexpr std::int64_t most_root = 64;

/// The sign of x^a y^(1-a) - |z| for x, y > 0, |z| > 0; 2 where balls do not tell.
int room_beside(const Fraction& a, const Fraction& x, const Fraction& y, const Fraction& size) {
  const Fraction exponent = lowest_terms(a);
  for (std::int64_t q = 1; q <= most_root; ++q) {
    if (!(exponent.denominator == Integer{q})) continue;
    // x^p y^(q-p) beside |z|^q.
    Fraction left{1}, right{1};
    for (std::int64_t i = 0; i < q; ++i) {
      left = left * (Integer{i} < exponent.numerator ? x : y);
      right = right * size;
    }
    return sign(left - right);
  }
  const int found = (pow(ball(x), ball(a)) * pow(ball(y), ball(one_part - a)) - ball(size)).sign();
  return found == 0 ? 2 : found;
}

/// {x^a y^(1-a) >= |z|, x, y >= 0} where (x, y) = (c u, d v) of a point (u, v, z).
std::optional<Subdifferential> of_power_cone(const Call& f, const Fractions& p, const Fraction& a,
                                             const Fraction& c, const Fraction& d) {
  if (is_zero(p)) return at_apex(f);
  const Fraction x = c * p[0], y = d * p[1], &z = p[2];
  if (sign(x) < 0 || sign(y) < 0) return none(3);
  const Fractions down_x = triple(Fraction{-1}, zero_part, zero_part),
                  down_y = triple(zero_part, Fraction{-1}, zero_part);
  if (sign(z) == 0) {
    if (sign(x) > 0 && sign(y) > 0) return single(Fractions(3), true);
    return ray(sign(x) == 0 ? down_x : down_y, true);
  }
  if (sign(x) == 0 || sign(y) == 0) return none(3);
  const Fraction size = sign(z) < 0 ? -z : z;
  const int room = room_beside(a, x, y, size);
  if (room == 2) return std::nullopt;
  if (room < 0) return none(3);
  if (room > 0) return single(Fractions(3), true);
  // The gradient of |z| - x^a y^(1-a), where that power is |z|.
  return ray(
      triple(-(a * size / x) * c, -((one_part - a) * size / y) * d, sign(z) < 0 ? Fraction{-1} : one_part),
      true);
}

}  // namespace

std::optional<Subdifferential> of_three_entry_cone(const Call& f, const Fractions& x) {
  if (x.size() != 3 || !Ball::why_none().empty()) return std::nullopt;
  if (f.name == "exponential_cone") return of_exponential_cone(f, x);
  if (f.name == "dual_exponential_cone") return of_dual_exponential_cone(f, x);
  if (f.name != "power_cone" && f.name != "dual_power_cone") return std::nullopt;
  const Fraction a = ExactArguments(f, x.size()).number("alpha");
  if (f.name == "power_cone") return of_power_cone(f, x, a, one_part, one_part);
  return of_power_cone(f, x, a, one_part / a, one_part / (one_part - a));
}

}  // namespace convex::inline sets::subgradients
