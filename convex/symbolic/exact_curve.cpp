#include "convex/symbolic/exact_curve.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "convex/invalid_input.hpp"

namespace convex::symbolic {
namespace {

const Surd exact_zero{Fraction{0, 1}}, exact_one{Fraction{1, 1}}, exact_half{Fraction{1, 2}};

bool is_zero(const Surd& a) { return sign(a) == 0; }

/// Whether (a, b) and (c, d) have one direction, both >= 0.
bool same_direction(const Surd& a, const Surd& b, const Surd& c, const Surd& d) { return a * d == b * c; }

/// The directions of what leads to corner k and away from it.
std::pair<Surd, Surd> before(const ExactCurve& f, std::size_t k) {
  if (k == 0) return {f.left_run, f.left_rise};
  return {f.x[k] - f.x[k - 1], f.y[k] - f.y[k - 1]};
}
std::pair<Surd, Surd> after(const ExactCurve& f, std::size_t k) {
  if (k + 1 == f.corners()) return {f.right_run, f.right_rise};
  return {f.x[k + 1] - f.x[k], f.y[k + 1] - f.y[k]};
}

/// f at corner k: trapezoids under the curve.
Surd value_at_corner(const ExactCurve& f, std::size_t k) {
  Surd value = f.value;
  for (std::size_t j = 0; j < k; ++j)
    value = value + exact_half * (f.y[j] + f.y[j + 1]) * (f.x[j + 1] - f.x[j]);
  return value;
}

/// Without corners that are none, and equal ones.
ExactCurve simplified(ExactCurve f) {
  for (std::size_t k = 0; k < f.corners() && f.corners() > 1;) {
    const bool repeated = k > 0 && f.x[k] == f.x[k - 1] && f.y[k] == f.y[k - 1];
    const auto [run, rise] = before(f, k);
    const auto [next_run, next_rise] = after(f, k);
    if (!repeated && !same_direction(run, rise, next_run, next_rise)) {
      ++k;
      continue;
    }
    if (k == 0) f.value = value_at_corner(f, 1);
    f.x.erase(f.x.begin() + static_cast<std::ptrdiff_t>(k));
    f.y.erase(f.y.begin() + static_cast<std::ptrdiff_t>(k));
    k = k > 0 ? k - 1 : 0;
  }
  return f;
}

std::optional<Surd> domain_low(const ExactCurve& f) {
  return is_zero(f.left_run) ? std::optional(f.x.front()) : std::nullopt;
}
std::optional<Surd> domain_high(const ExactCurve& f) {
  return is_zero(f.right_run) ? std::optional(f.x.back()) : std::nullopt;
}

/// The subdifferential at a point of the domain: none for an end at infinity.
struct Slopes {
  std::optional<Surd> low, high;
};
Slopes slopes_at(const ExactCurve& f, const Surd& x) {
  std::optional<std::size_t> first, last;
  for (std::size_t k = 0; k < f.corners(); ++k)
    if (f.x[k] == x) {
      if (!first) first = k;
      last = k;
    }
  if (first) {
    Slopes found{f.y[*first], f.y[*last]};
    if (*first == 0 && is_zero(f.left_run)) found.low.reset();
    if (*last + 1 == f.corners() && is_zero(f.right_run)) found.high.reset();
    return found;
  }
  Surd y;
  if (x < f.x.front())
    y = f.y.front() - f.left_rise / f.left_run * (f.x.front() - x);
  else if (f.x.back() < x)
    y = f.y.back() + f.right_rise / f.right_run * (x - f.x.back());
  else {
    std::size_t k = 0;
    while (f.x[k + 1] < x) ++k;
    y = f.y[k] + (f.y[k + 1] - f.y[k]) / (f.x[k + 1] - f.x[k]) * (x - f.x[k]);
  }
  return {y, y};
}

}  // namespace

std::optional<Surd> value(const ExactCurve& f, const Surd& x) {
  const auto low = domain_low(f), high = domain_high(f);
  if ((low && x < *low) || (high && *high < x)) return std::nullopt;
  for (const ExactPiece& piece : pieces(f))
    if ((!piece.low || !(x < *piece.low)) && (!piece.high || !(*piece.high < x)))
      return exact_half * piece.c2 * x * x + piece.c1 * x + piece.c0;
  return std::nullopt;
}

std::vector<ExactPiece> pieces(const ExactCurve& f) {
  std::vector<ExactPiece> found;
  const auto add = [&](std::optional<Surd> low, std::optional<Surd> high, const Surd& slope, const Surd& x,
                       const Surd& y, const Surd& at_x) {
    const Surd c1 = y - slope * x;
    found.push_back({std::move(low), std::move(high), slope, c1, at_x - exact_half * slope * x * x - c1 * x});
  };
  if (!is_zero(f.left_run))
    add(std::nullopt, f.x.front(), f.left_rise / f.left_run, f.x.front(), f.y.front(), f.value);
  for (std::size_t k = 0; k + 1 < f.corners(); ++k)
    if (f.x[k] < f.x[k + 1])
      add(f.x[k], f.x[k + 1], (f.y[k + 1] - f.y[k]) / (f.x[k + 1] - f.x[k]), f.x[k], f.y[k],
          value_at_corner(f, k));
  if (!is_zero(f.right_run))
    add(f.x.back(), std::nullopt, f.right_rise / f.right_run, f.x.back(), f.y.back(),
        value_at_corner(f, f.corners() - 1));
  if (found.empty()) found.push_back({f.x.front(), f.x.front(), exact_zero, exact_zero, f.value});
  // One quadratic on both sides of what was a corner of a whole line.
  std::vector<ExactPiece> joined;
  for (ExactPiece& piece : found) {
    if (!joined.empty() && joined.back().c2 == piece.c2 && joined.back().c1 == piece.c1 &&
        joined.back().c0 == piece.c0)
      joined.back().high = piece.high;
    else
      joined.push_back(std::move(piece));
  }
  return joined;
}

ExactCurve exact_curve(const std::vector<ExactPiece>& given) {
  if (given.empty()) throw InvalidInput("a function without a piece is +inf everywhere");
  const auto refuse = [](const char* what) { throw InvalidInput(std::string("pieces: ") + what); };
  const auto at = [](const ExactPiece& p, const Surd& x) {
    return exact_half * p.c2 * x * x + p.c1 * x + p.c0;
  };
  ExactCurve f{{}, {}, exact_zero, exact_one, exact_zero, exact_one, exact_zero};
  for (std::size_t k = 0; k < given.size(); ++k) {
    const ExactPiece& piece = given[k];
    if (sign(piece.c2) < 0) refuse("one has a negative square; a convex function has none");
    if (piece.low && piece.high && *piece.high < *piece.low) refuse("the bounds of one do not increase");
    if (k > 0) {
      if (!piece.low || !given[k - 1].high || !(*piece.low == *given[k - 1].high))
        refuse("two do not adjoin");
      if (!(at(piece, *piece.low) == at(given[k - 1], *piece.low))) refuse("the value jumps between two");
      if (piece.c2 * *piece.low + piece.c1 < f.y.back()) refuse("the slope falls between two");
    }
    const bool is_point = piece.low && piece.high && *piece.low == *piece.high;
    const auto corner = [&](const Surd& x) {
      f.x.push_back(x);
      f.y.push_back(piece.c2 * x + piece.c1);
    };
    if (piece.low) corner(*piece.low);
    if (piece.high && !is_point) corner(*piece.high);
    if (!piece.low && !piece.high) corner(exact_zero);
    if (k == 0) f.value = at(piece, f.x.front());
    if (!piece.low) f.left_run = exact_one, f.left_rise = piece.c2;
    if (!piece.high) f.right_run = exact_one, f.right_rise = piece.c2;
  }
  return simplified(std::move(f));
}

ExactCurve conjugate(const ExactCurve& f) {
  return {f.y, f.x, f.left_rise, f.left_run, f.right_rise, f.right_run, f.x.front() * f.y.front() - f.value};
}

ExactCurve envelope(const ExactCurve& f, const Fraction& gamma) {
  ExactCurve e = f;
  for (std::size_t k = 0; k < f.corners(); ++k) e.x[k] = f.x[k] + gamma * f.y[k];
  e.left_run = f.left_run + gamma * f.left_rise;
  e.right_run = f.right_run + gamma * f.right_rise;
  e.value = f.value + exact_half * gamma * f.y.front() * f.y.front();
  return simplified(std::move(e));
}

ExactCurve scale(const ExactCurve& f, const Fraction& alpha) {
  ExactCurve g = f;
  for (Surd& y : g.y) y = alpha * y;
  g.left_rise = alpha * f.left_rise;
  g.right_rise = alpha * f.right_rise;
  g.value = alpha * f.value;
  return g;
}

ExactCurve dilate(const ExactCurve& f, const Fraction& rho) {
  ExactCurve g = f;
  for (std::size_t k = 0; k < f.corners(); ++k) {
    g.x[k] = rho * f.x[k];
    g.y[k] = f.y[k] / rho;
  }
  const Surd size = sign(rho) < 0 ? -rho : rho;
  g.left_run = size * f.left_run;
  g.right_run = size * f.right_run;
  g.left_rise = f.left_rise / size;
  g.right_rise = f.right_rise / size;
  if (sign(rho) > 0) return g;
  g.value = value_at_corner(f, f.corners() - 1);
  std::reverse(g.x.begin(), g.x.end());
  std::reverse(g.y.begin(), g.y.end());
  std::swap(g.left_run, g.right_run);
  std::swap(g.left_rise, g.right_rise);
  return g;
}

ExactCurve translate(const ExactCurve& f, const Fraction& by) {
  ExactCurve g = f;
  for (Surd& x : g.x) x = x + by;
  return g;
}

ExactCurve tilt(const ExactCurve& f, const Fraction& c) {
  ExactCurve g = f;
  for (Surd& y : g.y) y = y + c;
  g.value = f.value + c * f.x.front();
  return g;
}

ExactCurve add_constant(const ExactCurve& f, const Fraction& c) {
  ExactCurve g = f;
  g.value = f.value + c;
  return g;
}

ExactCurve sum(const ExactCurve& f, const ExactCurve& g) {
  std::optional<Surd> low = domain_low(f), high = domain_high(f);
  if (const auto other = domain_low(g); other && (!low || *low < *other)) low = other;
  if (const auto other = domain_high(g); other && (!high || *other < *high)) high = other;
  if (low && high && *high < *low) throw InvalidInput("sum: the domains do not meet; it is +inf everywhere");
  std::vector<Surd> at;
  for (const ExactCurve* curve : {&f, &g})
    for (const Surd& x : curve->x)
      if ((!low || !(x < *low)) && (!high || !(*high < x))) at.push_back(x);
  if (low) at.push_back(*low);
  if (high) at.push_back(*high);
  if (at.empty()) at.push_back(f.x.front());
  std::sort(at.begin(), at.end());
  at.erase(std::unique(at.begin(), at.end()), at.end());
  ExactCurve s{
      {}, {}, exact_zero, exact_one, exact_zero, exact_one, *value(f, at.front()) + *value(g, at.front())};
  for (const Surd& x : at) {
    const Slopes p = slopes_at(f, x), q = slopes_at(g, x);
    const bool has_low = p.low && q.low, has_high = p.high && q.high;
    if (has_low) s.x.push_back(x), s.y.push_back(*p.low + *q.low);
    if (has_high) s.x.push_back(x), s.y.push_back(*p.high + *q.high);
    if (!has_low && !has_high) s.x.push_back(x), s.y.push_back(exact_zero);
  }
  if (!low) s.left_run = exact_one, s.left_rise = f.left_rise / f.left_run + g.left_rise / g.left_run;
  if (!high) s.right_run = exact_one, s.right_rise = f.right_rise / f.right_run + g.right_rise / g.right_run;
  return simplified(std::move(s));
}

ExactCurve inf_convolution(const ExactCurve& f, const ExactCurve& g) {
  try {
    return conjugate(sum(conjugate(f), conjugate(g)));
  } catch (const InvalidInput&) {
    throw InvalidInput("inf_convolution: no slope is common to both; it is -inf everywhere");
  }
}

Fraction simplest_fraction(double given) {
  const Fraction exact = lowest_terms(fraction(given));
  if (exact.denominator == 1) return exact;
  const bool negative = exact.numerator.sign() < 0;
  const Fraction target = negative ? -exact : exact;
  // Convergents of the continued fraction, and the last one's semiconvergents, least denominators
  // first.
  Integer p0 = 0, q0 = 1, p1 = 1, q1 = 0, a = target.numerator, b = target.denominator;
  const double wanted = std::abs(given);
  while (true) {
    const Integer whole = truncated_quotient(a, b);
    const auto rounds = [&](const Integer& k) {
      return nearest_double(Fraction{k * p1 + p0, k * q1 + q0}) == wanted;
    };
    if (!q1.is_zero() && rounds(whole)) {
      Integer least = 1, most = whole;  // rounding is monotone in k beyond the first that fits
      while (least < most) {
        const Integer middle = truncated_quotient(least + most, 2);
        if (rounds(middle))
          most = middle;
        else
          least = middle + 1;
      }
      const Fraction found{least * p1 + p0, least * q1 + q0};
      return negative ? -found : found;
    }
    const Integer p = whole * p1 + p0, q = whole * q1 + q0, rest = a - whole * b;
    p0 = p1, q0 = q1, p1 = p, q1 = q;
    a = b, b = rest;
  }
}

}  // namespace convex::symbolic
