#include "convex/laws/map_potential.hpp"

#include <cmath>
#include <random>

#include "convex/laws/map_cycles.hpp"
#include "convex/laws/quadrature.hpp"

namespace convex::inline law_checks {
namespace {

using symbolic::AffinePiece;

/// T at a point of the line, when it is a fraction there.
std::optional<Fraction> value_on_line(const Map& T, const Fraction& z) {
  const auto image = T.at(exact_vector(std::vector<Fraction>{z}));
  if (!image || image->radius != 0) return std::nullopt;
  return entry(image->value, 0);
}

Fraction slope_between(const Fraction& a, const Fraction& Ta, const Fraction& b, const Fraction& Tb) {
  return (Tb - Ta) / (b - a);
}

/// Affine between kinks that are known: on each interval through points inside of it.
std::optional<std::vector<AffinePiece>> pieces_between(const Map& T, const std::vector<Fraction>& kinks,
                                                       const std::pair<Fraction, Fraction>& range) {
  std::vector<Fraction> ends{range.first};
  ends.insert(ends.end(), kinks.begin(), kinks.end());
  ends.push_back(range.second);
  std::vector<AffinePiece> pieces;
  for (std::size_t k = 0; k + 1 < ends.size(); ++k) {
    const Fraction &low = ends[k], &high = ends[k + 1];
    if (!(low < high)) continue;
    constexpr int inside = 17;  // a prime: no points of symmetry
    const auto at = [&](int i) { return low + (high - low) * Fraction{i, inside}; };
    const auto first = value_on_line(T, at(1)), second = value_on_line(T, at(2));
    if (!first || !second) return std::nullopt;
    const Fraction slope = slope_between(at(1), *first, at(2), *second), offset = *first - slope * at(1);
    for (int i = 0; i <= inside; ++i) {
      const auto value = value_on_line(T, at(i));
      const bool is_end = i == 0 || i == inside;  // at a kink doubles may be all there is
      if (value ? !(*value == slope * at(i) + offset) : !is_end) return std::nullopt;
    }
    if (!pieces.empty() &&
        !(pieces.back().slope * low + pieces.back().offset == Fraction(slope * low + offset)))
      return std::nullopt;
    if (!pieces.empty() && rational(pieces.back().slope) == slope)
      pieces.back().high = high;
    else
      pieces.push_back({low, high, slope, offset});
  }
  if (pieces.empty()) return std::nullopt;
  pieces.front().low.reset();
  pieces.back().high.reset();
  return pieces;
}

}  // namespace

std::pair<Fraction, Fraction> seen_range(const Map& T, double low, double high) {
  std::pair<Fraction, Fraction> range{fraction(low), fraction(high)};
  const Fraction length = range.second - range.first;
  if (T.n != 1 || !T.kinks) return range;
  for (const Fraction& kink : T.kinks(low, high)) {
    if (kink - length < range.first && kink < fraction(low)) range.first = kink - length;
    if (range.second < kink + length && fraction(high) < kink) range.second = kink + length;
  }
  return range;
}

std::vector<AffinePiece> joined_pieces(const std::vector<Fraction>& z, const std::vector<Fraction>& Tz) {
  std::vector<AffinePiece> pieces;
  for (std::size_t k = 0; k + 1 < z.size(); ++k) {
    const Fraction slope = slope_between(z[k], Tz[k], z[k + 1], Tz[k + 1]);
    if (!pieces.empty() && pieces.back().slope == slope) {
      pieces.back().high = z[k + 1];
      continue;
    }
    pieces.push_back({z[k], z[k + 1], slope, Tz[k] - slope * z[k]});
  }
  pieces.front().low.reset();
  pieces.back().high.reset();
  return pieces;
}

std::optional<std::vector<AffinePiece>> seen_pieces(const Map& T, double low, double high) {
  if (T.kinks)
    if (const std::vector<Fraction> kinks = T.kinks(low, high); !kinks.empty())
      return pieces_between(T, kinks, seen_range(T, low, high));
  constexpr int intervals = 96;
  const Fraction first = fraction(low), step = (fraction(high) - first) / Fraction{intervals, 1};
  std::vector<Fraction> z, Tz;
  for (int k = 0; k <= intervals; ++k) {
    const Fraction at = first + step * Fraction{k, 1};
    if (const auto value = value_on_line(T, at)) {
      z.push_back(at);
      Tz.push_back(*value);
    }
  }
  if (z.size() < intervals / 2) return std::nullopt;
  // Three points of a grid on one line show a piece; a bend lies where two pieces meet.
  std::vector<AffinePiece> pieces;
  for (std::size_t k = 0; k + 2 < z.size(); ++k) {
    const Fraction slope = slope_between(z[k], Tz[k], z[k + 1], Tz[k + 1]);
    if (!(slope == slope_between(z[k + 1], Tz[k + 1], z[k + 2], Tz[k + 2]))) continue;
    const Fraction offset = Tz[k] - slope * z[k];
    if (!pieces.empty() && pieces.back().slope == slope && pieces.back().offset == offset)
      pieces.back().high = z[k + 2];
    else
      pieces.push_back({z[k], z[k + 2], slope, offset});
  }
  if (pieces.empty()) return std::nullopt;
  for (std::size_t k = 1; k < pieces.size(); ++k) {
    AffinePiece &before = pieces[k - 1], &after = pieces[k];
    if (before.slope == after.slope) return std::nullopt;  // a jump
    const symbolic::Surd meet = (after.offset - before.offset) / (before.slope - after.slope);
    if (meet < *before.high || *after.low < meet) return std::nullopt;
    before.high = after.low = meet;
  }
  pieces.front().low.reset();
  pieces.back().high.reset();
  std::mt19937 random(5);
  std::uniform_int_distribution<int> part(0, 1 << 20);
  for (int k = 0; k < 4 * intervals; ++k) {
    const Fraction at = first + (fraction(high) - first) * Fraction{part(random), 1 << 20};
    const auto value = value_on_line(T, at);
    if (!value) continue;
    for (const AffinePiece& piece : pieces)
      if ((!piece.low || !(at < *piece.low)) && (!piece.high || !(*piece.high < at)) &&
          !(piece.slope * at + piece.offset == *value))
        return std::nullopt;
  }
  return pieces;
}

std::vector<PotentialPoint> potential(const Map& T, const ExactMetric& W, double low, double high,
                                      Index along) {
  const Index n = T.n;
  const Matrix gram = rounded_gram(W);
  std::vector<PotentialPoint> found;
  Index count = 1;
  for (Index i = 0; i < n; ++i) count *= along;
  for (Index k = 0; k < count; ++k) {
    Vector z(n);
    for (Index i = 0, rest = k; i < n; ++i, rest /= along)
      z[i] = low + (high - low) * static_cast<double>(rest % along) / static_cast<double>(along - 1);
    const auto image = [&](const Vector& at) { return image_in_doubles(T, at); };
    const Vector covector = gram * z;
    const Quadrature phi =
        integral([&](double t) { return covector.dot(image(t * z)); }, 0, 1, 1e-9 * (1 + z.dot(covector)));
    const Vector p = image(z);
    if (std::isfinite(phi.value) && p.allFinite())
      found.push_back({z, p, covector.dot(p) - phi.value - 0.5 * p.dot(gram * p), phi.error});
  }
  return found;
}

}  // namespace convex::inline law_checks
