#pragma once

#include "convex/composite/closed_form.hpp"

namespace convex::inline operations {

/// The prox x of a whole at z in W, and its v, from the prox of a part at `point`: from(point). What rounding
/// left of the residual r = W(x - z) + v, which is formed with W and z as given, moves the point by
/// -correction(r), and the part is asked again: the answer is then that of the given data, and not of a
/// rounded metric or point. correction(r): by how much more point adds r.
template <class From, class Correction>
Prox reduced(Vector point, const Vector& z, const Metric& W, const From& from, const Correction& correction) {
  constexpr int most_corrections = 2;
  constexpr double roundings_left = 16;  // a residual of so many roundings is not worth another prox
  Prox best = from(point);
  for (int pass = 0; pass < most_corrections && best.x.size() > 0; ++pass) {
    const Vector r = stationarity(z, W, best.x, best.v);
    if (!(W.dual_norm(r) > roundings_left * unit_roundoff * (W.norm(z) + W.norm(best.x)))) break;
    point -= correction(r);
    Prox next = from(point);
    if (!(next.x.size() > 0 && next.error_bound < best.error_bound)) break;
    const bool slow = next.error_bound > 0.1 * best.error_bound;
    best = std::move(next);
    if (slow) break;
  }
  return best;
}

}  // namespace convex::inline operations
