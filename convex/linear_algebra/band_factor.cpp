#include "convex/linear_algebra/band_factor.hpp"

#include <algorithm>
#include <cmath>

namespace convex::linear_algebra {

Index BandFactor::width(const std::vector<Place>& places) {
  Index width = 0;
  for (const Place& place : places) width = std::max<Index>(width, std::abs(place.i - place.j));
  return width;
}

BandFactor::BandFactor(Index n, Index width)
    : n_(n), width_(width), values_(static_cast<std::size_t>(n * (width + 1)), 0.0) {}

std::vector<Index> BandFactor::slots(const std::vector<Place>& places) const {
  std::vector<Index> found;
  found.reserve(places.size());
  for (const auto& [i, j] : places) found.push_back(std::min(i, j) * (width_ + 1) + std::abs(i - j));
  return found;
}

bool BandFactor::factor() {
  for (Index j = 0; j < n_; ++j) {
    double* const column = values_.data() + j * (width_ + 1);
    const double pivot = column[0];
    if (!std::isfinite(pivot) || !(std::abs(pivot) > 0)) return false;
    const double inverse = 1 / pivot;
    const Index below = std::min(width_, n_ - 1 - j);
    for (Index k = 1; k <= below; ++k) {
      const double part = column[k] * inverse;
      double* const to = column + k * (width_ + 1);
      for (Index i = k; i <= below; ++i) to[i - k] -= column[i] * part;
    }
    for (Index k = 1; k <= below; ++k) column[k] *= inverse;
  }
  return true;
}

void BandFactor::solve(Vector& x) const {
  for (Index j = 0; j < n_; ++j) {
    const double* const column = values_.data() + j * (width_ + 1);
    const Index below = std::min(width_, n_ - 1 - j);
    for (Index k = 1; k <= below; ++k) x[j + k] -= column[k] * x[j];
  }
  for (Index j = n_; j-- > 0;) {
    const double* const column = values_.data() + j * (width_ + 1);
    double sum = x[j] / column[0];
    for (Index k = std::min(width_, n_ - 1 - j); k > 0; --k) sum -= column[k] * x[j + k];
    x[j] = sum;
  }
}

double BandFactor::flops() const {
  const double w = static_cast<double>(width_);
  return static_cast<double>(n_) * (w * (w + 1) / 2 + 2 * w);
}

}  // namespace convex::linear_algebra
