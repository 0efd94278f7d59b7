#include "tests/convex/piecewise/rational_pieces.hpp"

#include <cmath>
#include <functional>
#include <limits>

namespace oracles {
namespace {

using Row = std::vector<Rational>;

Rational on(const Row& row, const Rational& x) { return row[0] / 2 * x * x + row[1] * x + row[2]; }

/// Whether the sum of slopes of a row far to the right (side = 1) or left (side = -1) has the sign of `side`
/// or is 0, that is, the row grows or stays that way.
bool falls(const Row& row, int side) {
  if (row[0] != 0) return row[0] < 0;
  return side * row[1] < 0;
}

/// The least value of a convex function, given candidates for its minimiser.
std::optional<Rational> least(const std::vector<Rational>& candidates,
                              const std::function<std::optional<Rational>(const Rational&)>& value) {
  std::optional<Rational> best;
  for (const Rational& u : candidates) {
    const std::optional<Rational> here = value(u);
    if (here && (!best || *here < *best)) best = *here;
  }
  return best;
}

}  // namespace

RationalPieces::RationalPieces(const convex::Pieces& pieces) {
  for (convex::Index i = 0; i < pieces.breaks.size(); ++i) breaks.emplace_back(pieces.breaks[i]);
  for (convex::Index i = 0; i < pieces.coefficients.rows(); ++i) {
    const auto& C = pieces.coefficients;
    if (std::isinf(C(i, 0)))
      rows.push_back(std::nullopt);
    else
      rows.push_back(Row{Rational(C(i, 0)), Rational(C(i, 1)), Rational(C(i, 2))});
  }
}

std::optional<Rational> RationalPieces::value(const Rational& x) const {
  std::optional<Rational> best;
  for (std::size_t i = 0; i < rows.size(); ++i) {
    const bool inside = (i == 0 || breaks[i - 1] <= x) && (i == breaks.size() || x <= breaks[i]);
    if (inside && rows[i] && !best) best = on(*rows[i], x);
  }
  return best;
}

std::optional<Rational> conjugate_value(const RationalPieces& f, const Rational& y) {
  std::vector<Rational> candidates = f.breaks;
  candidates.push_back(0);
  for (const auto& row : f.rows)
    if (row && (*row)[0] != 0) candidates.push_back((y - (*row)[1]) / (*row)[0]);
  const auto tilted = [&](const Row& row) { return Row{row[0], row[1] - y, row[2]}; };
  if (f.rows.front() && falls(tilted(*f.rows.front()), -1)) return std::nullopt;
  if (f.rows.back() && falls(tilted(*f.rows.back()), 1)) return std::nullopt;
  const auto best = least(candidates, [&](const Rational& u) -> std::optional<Rational> {
    const auto v = f.value(u);
    if (!v) return std::nullopt;
    return *v - u * y;
  });
  return -*best;
}

std::optional<Rational> inf_convolution_value(const RationalPieces& f, const RationalPieces& g,
                                              const Rational& x) {
  std::vector<Rational> candidates = f.breaks;
  candidates.push_back(0);
  candidates.push_back(x);
  for (const Rational& b : g.breaks) candidates.push_back(x - b);
  for (const auto& a : f.rows)
    for (const auto& b : g.rows)
      if (a && b && (*a)[0] + (*b)[0] != 0)  // a2 u + a1 = b2 (x - u) + b1
        candidates.push_back(((*b)[0] * x + (*b)[1] - (*a)[1]) / ((*a)[0] + (*b)[0]));
  return least(candidates, [&](const Rational& u) -> std::optional<Rational> {
    const auto v = f.value(u), w = g.value(x - u);
    if (!v || !w) return std::nullopt;
    return *v + *w;
  });
}

namespace {

convex::Pieces random_pieces(std::mt19937& generator, int count, Ends ends, double (*number)(std::mt19937&),
                             double (*curvature)(std::mt19937&)) {
  const double infinity = std::numeric_limits<double>::infinity();
  if (ends == Ends::point) {
    const double p = number(generator);
    convex::Pieces point{convex::Vector(2), convex::Matrix::Zero(3, 3)};
    point.breaks << p, p;
    point.coefficients(0, 0) = point.coefficients(2, 0) = infinity;
    point.coefficients(1, 2) = number(generator);
    return point;
  }
  const bool low = ends == Ends::left || ends == Ends::bounded;
  const bool high = ends == Ends::right || ends == Ends::bounded;
  const int inner = count - 1, total = inner + low + high;
  convex::Pieces made{convex::Vector(total), convex::Matrix::Zero(total + 1, 3)};
  if (low) made.coefficients(0, 0) = infinity;
  if (high) made.coefficients(total, 0) = infinity;
  Rational x(number(generator)), slope(number(generator)), value(number(generator));
  Rational last = -1;
  if (total > 0) made.breaks[0] = x.get_d();
  for (int i = 0; i < count; ++i) {
    const int piece = i + low;
    Rational c2(curvature(generator));
    while (c2 == last) c2 = curvature(generator);
    const Rational c1 = slope - c2 * x, c0 = value - x * slope + c2 * x * x / 2;
    made.coefficients.row(piece) << c2.get_d(), c1.get_d(), c0.get_d();
    const bool from_minus_infinity = piece == 0;  // x is then the end of the piece, not its start
    if (piece >= total) break;
    const Rational step = from_minus_infinity ? Rational(0) : Rational(0.25 + std::abs(number(generator)));
    value += step * slope + c2 * step * step / 2;
    slope += c2 * step;
    x += step;
    made.breaks[piece] = x.get_d();
    x = made.breaks[piece];
    last = c2;
    if (generator() % 2 == 0) {
      slope += 0.25 + std::abs(number(generator));
      last = -1;  // any curvature may follow a kink
    }
  }
  return made;
}

}  // namespace

convex::Pieces dyadic_pieces(std::mt19937& generator, int count, Ends ends) {
  return random_pieces(
      generator, count, ends,
      [](std::mt19937& random) { return (static_cast<double>(random() % 33) - 16) / 4; },
      [](std::mt19937& random) {
        return random() % 3 == 0 ? 0.0 : std::ldexp(1, static_cast<int>(random() % 5) - 2);
      });
}

convex::Pieces rounded_pieces(std::mt19937& generator, int count, Ends ends) {
  return random_pieces(
      generator, count, ends,
      [](std::mt19937& random) { return std::uniform_real_distribution<double>(-3, 3)(random); },
      [](std::mt19937& random) {
        return random() % 3 == 0 ? 0.0 : std::uniform_real_distribution<double>(0, 2)(random);
      });
}

}  // namespace oracles
