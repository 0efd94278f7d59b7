#include "mechanics/motion/taylor_products.hpp"

#include <algorithm>

#include "mechanics/motion/taylor_kernels.hpp"

namespace mechanics::inline motions {
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
  if (k == 1) return std::fill(rest_.begin(), rest_.end(), Eight{});  // of no terms
  taylor_kernels().find_rests(x_.data()->of, y_.data()->of, weighted_.data()->of, rest_.data()->of, blocks(),
                              width_, static_cast<std::size_t>(k));
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
