#include <cmath>

#include "convex/infinity.hpp"
#include "convex/linear_quadratic/functions.hpp"
#include "convex/linear_quadratic/placement.hpp"

namespace convex::linear_quadratic {
namespace {

/// Values and slopes of neighbouring pieces may differ at a break by this part of their terms: coefficients
/// are written with rounding.
constexpr double break_noise = 1e-12;

/// One piece on [low, high].
struct Piece {
  double low, high, c2, c1, c0;
  double slope(double x) const { return c2 * x + c1; }
  double value(double x) const { return (0.5 * c2 * x + c1) * x + c0; }
  double slope_terms(double x) const { return std::abs(c2 * x) + std::abs(c1); }
  double value_terms(double x) const { return std::abs(0.5 * c2 * x * x) + std::abs(c1 * x) + std::abs(c0); }
};

std::vector<Piece> finite_pieces(const Vector& breaks, const Matrix& rows) {
  require(rows.rows() == breaks.size() + 1 && rows.cols() == 3, "plq",
          "breaks and coefficients do not fit; give one row [c2, c1, c0] more than there are breaks");
  std::vector<Piece> pieces;
  bool ended = false;
  for (Index j = 0; j < rows.rows(); ++j) {
    const double low = j > 0 ? breaks[j - 1] : -infinity, high = j < breaks.size() ? breaks[j] : infinity;
    require(low < high, "plq", "the breaks do not increase; sort them and leave out repeated ones");
    if (rows(j, 0) == infinity) {
      ended = !pieces.empty();
      continue;
    }
    require(!ended, "plq",
            "a piece of +inf lies between finite ones, so that it is not convex; leave it at the ends");
    require(rows.row(j).allFinite() && (low == -infinity || std::isfinite(low)) &&
                (high == infinity || std::isfinite(high)),
            "plq", "a coefficient or break is not finite; give numbers, or [inf, 0, 0] for +inf");
    require(rows(j, 0) >= 0, "plq", "a piece curves down, so that it is not convex; give c2 >= 0");
    pieces.push_back({low, high, rows(j, 0), rows(j, 1), rows(j, 2)});
  }
  require(!pieces.empty(), "plq", "it is +inf everywhere; give a finite piece");
  for (std::size_t j = 0; j + 1 < pieces.size(); ++j) {
    const Piece &left = pieces[j], &right = pieces[j + 1];
    const double b = left.high;
    require(std::abs(left.value(b) - right.value(b)) <=
                break_noise * std::max(left.value_terms(b), right.value_terms(b)),
            "plq", "it jumps at a break, so that it is not closed and convex; let neighbouring pieces meet");
    require(
        left.slope(b) <= right.slope(b) + break_noise * std::max(left.slope_terms(b), right.slope_terms(b)),
        "plq", "its slope falls at a break, so that it is not convex; let slopes increase");
  }
  return pieces;
}

/// The piece in which the minimum lies, so that small values near it are not differences of large ones; of
/// two, the flatter. Where there is no minimum, the flattest.
std::size_t anchor_of(const std::vector<Piece>& pieces) {
  const auto rises_at = [](const Piece& p) { return p.low > -infinity && p.slope(p.low) > 0; };
  const auto falls_at = [](const Piece& p) { return p.high < infinity && p.slope(p.high) < 0; };
  const auto has_minimum = [&](std::size_t j) {
    const Piece& p = pieces[j];
    const bool first = j == 0, last = j + 1 == pieces.size();
    return !(rises_at(p) && !first) && !(falls_at(p) && !last);
  };
  std::size_t anchor = 0;
  for (std::size_t j = 1; j < pieces.size(); ++j)
    if (std::make_pair(!has_minimum(j), pieces[j].c2) <
        std::make_pair(!has_minimum(anchor), pieces[anchor].c2))
      anchor = j;
  return anchor;
}

}  // namespace

LinearQuadratic separable_pieces(Index n, const Vector& breaks, const Matrix& coefficients) {
  const std::vector<Piece> pieces = finite_pieces(breaks, coefficients);
  const std::size_t anchor = anchor_of(pieces);
  const Piece& base = pieces[anchor];
  // The least curvature goes to x. Then x = y + Σ (ways into the pieces on the right) - Σ (on the left), y in
  // the anchor, and each way costs by itself. Where the anchor is curved, y is a variable of its own, so that
  // H stays diagonal; else it is what is left of x.
  double common = base.c2;
  for (const Piece& piece : pieces) common = std::min(common, piece.c2);
  const double bend = base.c2 - common;
  const Index ways = static_cast<Index>(pieces.size()) - 1, each = ways + (bend > 0 ? 1 : 0);
  LinearQuadraticBuilder form(n, n * each);
  for (Index i = 0; i < n; ++i) {
    const Index y = bend > 0 ? n + i * each + ways : i;
    const auto way = [&](std::size_t j) { return n + i * each + static_cast<Index>(j > anchor ? j - 1 : j); };
    const auto add_ways = [&](double factor) {
      for (std::size_t j = 0; j < pieces.size(); ++j)
        if (j != anchor) form.entry(way(j), j > anchor ? factor : -factor);
    };
    const auto bound = [&](double limit, double side) {
      form.row(side * limit);
      form.entry(y, side);
      if (bend == 0) add_ways(-side);
    };
    if (bend > 0) {
      form.equation(0);
      form.entry(i, 1);
      form.entry(y, -1);
      add_ways(-1);
      form.curve(y, y, bend);
    }
    if (common > 0) form.curve(i, i, common);
    form.cost(y, base.c1);
    form.constant(base.c0);
    if (base.low > -infinity) bound(base.low, 1);
    if (base.high < infinity) bound(base.high, -1);
    for (std::size_t j = 0; j < pieces.size(); ++j) {
      if (j == anchor) continue;
      const bool right = j > anchor;
      const Piece& piece = pieces[j];
      const double start = right ? piece.low : piece.high, length = piece.high - piece.low;
      const double slope = (piece.c2 - common) * start + piece.c1 - (bend > 0 ? 0 : base.c1);
      form.cost(way(j), right ? slope : -slope);
      if (piece.c2 > common) form.curve(way(j), way(j), piece.c2 - common);
      form.row(0);
      form.entry(way(j), 1);
      if (length < infinity) {
        form.row(-length);
        form.entry(way(j), -1);
      }
    }
  }
  return form.finish();
}

}  // namespace convex::linear_quadratic
