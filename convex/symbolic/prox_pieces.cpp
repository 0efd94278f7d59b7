#include "convex/symbolic/exact_curve.hpp"

namespace convex::symbolic {

std::vector<AffinePiece> prox_pieces(const ExactCurve& f, const Fraction& gamma) {
  // The graph of T: corners (x + gamma y, x), which the curve passes in order; z increases strictly.
  std::vector<Surd> z;
  for (std::size_t k = 0; k < f.corners(); ++k) z.push_back(f.x[k] + gamma * f.y[k]);
  const auto piece = [&](std::optional<Surd> low, std::optional<Surd> high, const Surd& run, const Surd& rise,
                         std::size_t k) {
    const Surd slope = run / (run + gamma * rise);
    return AffinePiece{std::move(low), std::move(high), slope, f.x[k] - slope * z[k]};
  };
  std::vector<AffinePiece> found{piece(std::nullopt, z.front(), f.left_run, f.left_rise, 0)};
  for (std::size_t k = 0; k + 1 < f.corners(); ++k)
    found.push_back(piece(z[k], z[k + 1], f.x[k + 1] - f.x[k], f.y[k + 1] - f.y[k], k));
  found.push_back(piece(z.back(), std::nullopt, f.right_run, f.right_rise, f.corners() - 1));
  std::vector<AffinePiece> joined;
  for (AffinePiece& one : found) {
    if (!joined.empty() && joined.back().slope == one.slope && joined.back().offset == one.offset)
      joined.back().high = one.high;
    else
      joined.push_back(std::move(one));
  }
  return joined;
}

std::optional<ExactCurve> function_of_prox(const std::vector<AffinePiece>& map) {
  const Surd zero, one{Fraction{1, 1}};
  for (const AffinePiece& piece : map)
    if (sign(piece.slope) < 0 || one < piece.slope) return std::nullopt;
  // z splits into x = T z and the slope y = z - T z of f at x.
  ExactCurve f{{},  {}, map.front().slope, one - map.front().slope, map.back().slope, one - map.back().slope,
               zero};
  const auto corner = [&](const AffinePiece& piece, const Surd& z) {
    f.x.push_back(piece.slope * z + piece.offset);
    f.y.push_back(z - f.x.back());
  };
  for (const AffinePiece& piece : map)
    if (piece.low) corner(piece, *piece.low);
  if (f.x.empty()) corner(map.front(), zero);
  return f;
}

}  // namespace convex::symbolic
