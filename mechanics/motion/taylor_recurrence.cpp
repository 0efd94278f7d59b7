#include "mechanics/motion/taylor_recurrence.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include "convex/invariant.hpp"
#include "mechanics/motion/taylor_kernels.hpp"

namespace mechanics::inline motions {
namespace {

/// 1 / k and its rounding error.
struct Parts {
  static constexpr std::size_t count = 64;
  std::array<double, count> whole{}, rest{};
  Parts() {
    for (std::size_t k = 1; k < count; ++k) {
      whole[k] = 1.0 / static_cast<double>(k);
      rest[k] = std::fma(-static_cast<double>(k), whole[k], 1.0) / static_cast<double>(k);
    }
  }
};

const Parts& parts() {
  static const Parts all;
  return all;
}

}  // namespace

TaylorRecurrence::TaylorRecurrence(const TaylorMatrix& plan, int order)
    : plan_(&plan), orders_(static_cast<std::size_t>(order)) {
  if (!plan.pays()) return;
  convex::invariant(orders_ + 1 < Parts::count, "series of a motion have fewer coefficients");
  const std::size_t factors = plan.weighted.size();
  c_.resize(plan.sweep.coefficients());
  changes_.resize(blocks_of(plan.variables + plan.products) * plan.coordinates);
  const std::size_t width = factors * (orders_ + 2 * TaylorOrders::zeros);
  const std::pair<Eight**, std::size_t> parts_of_memory[] = {
      {&columns_, plan.sweep.size()},
      {&by_velocity_, plan.coordinates * plan.blocks},
      {&numbers_, orders_ * plan.blocks},
      {&x_, width},
      {&y_, width},
      {&input_, blocks_of(2 * plan.coordinates) + factors}};
  std::size_t size = 0;
  for (const auto& [part, count] : parts_of_memory) size += count;
  memory_.resize(size);
  Eight* free = memory_.data();
  for (const auto& [part, count] : parts_of_memory) {
    *part = free;
    free += count;
  }
}

/// The columns are found with p in the place of v first. Those of v_(k-1) / k are the ones of the
/// coordinates; those of the velocities make room for the ones of F_(k-1) / k.
bool TaylorRecurrence::find(const TaylorRows& rows, const TaylorRows::Term* terms, const double* factor,
                            const InertiaFactor& A, const double* v, const double* F) {
  const std::size_t n = plan_->coordinates, blocks = plan_->blocks;
  plan_->sweep.find(rows, terms, factor, c_, columns_);
  std::copy_n(columns_ + n * blocks, n * blocks, by_velocity_);
  taylor_kernels().eliminate_velocities({n, plan_->variables + plan_->products, blocks, A.lower(),
                                         A.inverse_of_diagonal(), by_velocity_->of, columns_->of,
                                         changes_.data()->of});
  for (std::size_t i = 0; i < n; ++i) {
    numbers_[i / Eight::count].of[i % Eight::count] = v[i];
    const std::size_t at = n + i;
    numbers_[at / Eight::count].of[at % Eight::count] = F[i];
  }
  return run();
}

bool TaylorRecurrence::run() {
  const TaylorMatrix& plan = *plan_;
  const double* columns = columns_->of;
  const std::size_t column = plan.blocks * Eight::count;
  const TaylorOrders all{plan.products,
                         2 * plan.coordinates,
                         blocks_of(plan.products),
                         blocks_of(2 * plan.coordinates),
                         plan.blocks,
                         orders_,
                         columns + plan.variables * column,
                         columns,
                         columns + (plan.variables - 1) * column,
                         plan.place_of_x.data(),
                         plan.place_of_y.data(),
                         plan.weighted.data()->of,
                         parts().whole.data(),
                         parts().rest.data(),
                         input_->of,
                         numbers_->of,
                         x_->of,
                         y_->of};
  bool all_finite = true;
  end_ = taylor_kernels().find_orders(all, all_finite);
  return all_finite;
}

void TaylorRecurrence::positions(std::size_t i, double* q) const {
  const Parts& part = parts();
  for (std::size_t k = 1; k <= end_; ++k) {
    const double v = number(i, static_cast<int>(k) - 1);
    q[k] = v * part.whole[k] + v * part.rest[k];
  }
}

}  // namespace mechanics::inline motions
