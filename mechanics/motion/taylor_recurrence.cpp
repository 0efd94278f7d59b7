#include "mechanics/motion/taylor_recurrence.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include "convex/invariant.hpp"
#include "convex/processor.hpp"
#include "mechanics/motion/taylor_orders.hpp"

namespace mechanics::inline motions {
namespace {

/// column += Σ_i change_i by_velocity_i for each column, and change_i in the place of v_i.
#pragma GCC push_options
#pragma GCC optimize("fp-contract=fast")
MOREAU_CLONES void add_changes(const double* change, std::size_t n, std::size_t columns, std::size_t blocks,
                               const Wide* by_velocity, Wide* column) {
  for (std::size_t c = 0; c < columns; ++c, change += n, column += blocks) {
    for (std::size_t b = 0; b < blocks; ++b) {
      Wide sum = column[b];
      for (std::size_t i = 0; i < n; ++i) sum += change[i] * by_velocity[i * blocks + b];
      column[b] = sum;
    }
    for (std::size_t i = 0; i < n; ++i)
      reinterpret_cast<Eight*>(column)[i / Eight::count].of[i % Eight::count] = change[i];
  }
}
#pragma GCC pop_options

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
  changes_.resize((plan.variables + plan.products) * plan.coordinates);
  const std::size_t width = factors * (orders_ + TaylorOrders::zeros);
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

/// The columns are found with p in the place of v first. Then v = A⁻¹(F_(k-1) / k - p): `changes_` is v by
/// one unit of an input. The columns of v_(k-1) / k are those of the coordinates; those of the velocities
/// make room for the ones of F_(k-1) / k.
bool TaylorRecurrence::find(const TaylorRows& rows, const TaylorRows::Term* terms, const double* factor,
                            const InertiaFactor& A, const double* v, const double* F) {
  const std::size_t n = plan_->coordinates, blocks = plan_->blocks;
  const std::size_t columns = plan_->variables + plan_->products;
  plan_->sweep.find(rows, terms, factor, c_, columns_);
  Eight* const first = columns_;
  Eight* const forces = first + n * blocks;
  std::copy_n(forces, n * blocks, by_velocity_);
  std::fill_n(forces, n * blocks, Eight{});
  for (std::size_t c = 0; c < columns; ++c) {
    double* change = changes_.data() + c * n;
    const bool is_force = c >= n && c < 2 * n;
    for (std::size_t i = 0; i < n; ++i)
      change[i] =
          is_force ? (c - n == i ? 1 : 0) : -first[c * blocks + i / Eight::count].of[i % Eight::count];
    A.solve(change);
  }
  add_changes(changes_.data(), n, columns, blocks, wide(by_velocity_), wide(first));
  for (std::size_t i = 0; i < n; ++i) {
    numbers_[i / Eight::count].of[i % Eight::count] = v[i];
    const std::size_t at = n + i;
    numbers_[at / Eight::count].of[at % Eight::count] = F[i];
  }
  return run();
}

bool TaylorRecurrence::run() {
  const TaylorMatrix& plan = *plan_;
  const Wide* columns = wide(columns_);
  const auto constant = [](const std::vector<Eight>& x) { return reinterpret_cast<const Wide*>(x.data()); };
  const TaylorOrders all{plan.products,
                         2 * plan.coordinates,
                         blocks_of(plan.products),
                         blocks_of(2 * plan.coordinates),
                         plan.blocks,
                         orders_,
                         columns + plan.variables * plan.blocks,
                         columns,
                         columns + (plan.variables - 1) * plan.blocks,
                         reinterpret_cast<const Places*>(plan.place_of_x.data()),
                         reinterpret_cast<const Places*>(plan.place_of_y.data()),
                         constant(plan.weighted),
                         parts().whole.data(),
                         parts().rest.data(),
                         wide(input_),
                         wide(numbers_),
                         wide(x_),
                         wide(y_)};
  bool all_finite = true;
  end_ = find_orders(all, all_finite);
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
