#include "mechanics/motion/taylor_products.hpp"

#include <algorithm>

#include "convex/processor.hpp"

namespace mechanics::inline motions {
namespace {

/// The newest factors, those of order k - 1, come last: what is older can be summed while they are found.
MOREAU_CLONES void find_rests(const Wide* x, const Wide* y, const Wide* weighted, Wide* rest,
                              std::size_t blocks, std::size_t width, std::size_t k) {
  const double more = static_cast<double>(k) - 1;
  for (std::size_t b = 0; b < blocks; ++b, x += width, y += width) {
    Wide sum{}, other{};
    std::size_t j = 2;
    for (; j + 3 <= k; j += 2) {
      sum += x[j] * y[k - j];
      other += x[j + 1] * y[k - j - 1];
    }
    if (j + 2 <= k) sum += x[j] * y[k - j];
    sum += other;
    if (k >= 2) sum += x[1] * y[k - 1];
    if (k >= 3) sum += x[k - 1] * y[1];
    rest[b] = sum / (1.0 + more * weighted[b]);
  }
}

}  // namespace

TaylorProducts::TaylorProducts(std::span<const TaylorRows::Product> products, int order)
    : products_(products), width_(static_cast<std::size_t>(order) + 1) {
  const std::size_t blocks = blocks_of(products.size());
  x_.resize(blocks * width_);
  y_.resize(blocks * width_);
  weighted_.resize(blocks);
  rest_.resize(blocks);
  for (std::size_t p = 0; p < products.size(); ++p)
    weighted_[p / Eight::count].of[p % Eight::count] = products[p].is_weighted ? 1 : 0;
}

void TaylorProducts::find(int k) {
  find_rests(wide(x_), wide(y_), wide(weighted_), wide(rest_), blocks(), width_, static_cast<std::size_t>(k));
}

void TaylorProducts::take(const double* of_series, int k) {
  const auto order = static_cast<std::size_t>(k);
  for (std::size_t p = 0; p < products_.size(); ++p) {
    const std::size_t at = p / Eight::count * width_ + order, lane = p % Eight::count;
    x_[at].of[lane] = (products_[p].is_weighted ? k : 1) * of_series[products_[p].x];
    y_[at].of[lane] = of_series[products_[p].y];
  }
}

bool TaylorProducts::are_zero() const {
  return std::all_of(rest_.begin(), rest_.end(), [](const Eight& rests) {
    return std::all_of(rests.of, rests.of + Eight::count, [](double R) { return R == 0; });
  });
}

}  // namespace mechanics::inline motions
