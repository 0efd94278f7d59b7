#include "mechanics/motion/taylor_recurrence.hpp"

#include <algorithm>
#include <cmath>
#include <cstring>

#include "convex/processor.hpp"

namespace mechanics::inline motions {
namespace {

/// Instructions of a row, of a term, and of eight numbers of a column.
constexpr std::size_t work_of_row = 14, work_of_term = 6, work_of_eight = 2;

/// What an order is made of, in blocks of eight.
struct Orders {
  std::size_t products, moving;  // columns of each kind
  std::size_t product_blocks, number_blocks, moving_blocks, blocks, count;
  const Wide *of_rests, *of_moving, *of_time;
  const Wide* weighted;
  const double *part, *rest_of_part;  // 1 / k and its rounding error, by order
  const Wide *share, *rest_of_share;  // the same for weighted products, by order and block
  Wide *input, *numbers, *x, *y;
};

/// The numbers of an order, and the factors after them: so many blocks of a matrix times a vector. Two sums
/// each, so that an addition need not wait for the one before.
template <std::size_t blocks>
[[gnu::always_inline]] inline void multiply_blocks(const Orders& all, std::size_t first, Wide* to) {
  Wide sum[blocks] = {}, other[blocks] = {};
  const double* w = reinterpret_cast<const double*>(all.input);
  const Wide* column = all.of_moving + first;
  for (std::size_t i = 0; i < all.moving; ++i, column += all.blocks)
    for (std::size_t b = 0; b < blocks; ++b) sum[b] += w[i] * column[b];
  w += all.moving_blocks * Eight::count;
  column = all.of_rests + first;
  std::size_t i = 0;
  for (; i + 2 <= all.products; i += 2, column += 2 * all.blocks)
    for (std::size_t b = 0; b < blocks; ++b) {
      sum[b] += w[i] * column[b];
      other[b] += w[i + 1] * column[all.blocks + b];
    }
  if (i < all.products)
    for (std::size_t b = 0; b < blocks; ++b) sum[b] += w[i] * column[b];
  for (std::size_t b = 0; b < blocks; ++b) to[b] = sum[b] + other[b];
}

[[gnu::always_inline]] inline void multiply_all(const Orders& all, Wide* to) {
  std::size_t first = 0;
  for (; all.blocks - first > 6; first += 4) multiply_blocks<4>(all, first, to + first);
  switch (all.blocks - first) {
    case 1:
      return multiply_blocks<1>(all, first, to + first);
    case 2:
      return multiply_blocks<2>(all, first, to + first);
    case 3:
      return multiply_blocks<3>(all, first, to + first);
    case 4:
      return multiply_blocks<4>(all, first, to + first);
    case 5:
      return multiply_blocks<5>(all, first, to + first);
    default:
      return multiply_blocks<6>(all, first, to + first);
  }
}

/// R of order k. Factors hold zeros from order k on, and below order 1: four orders at a time reach them.
[[gnu::always_inline]] inline void find_free_rests(const Orders& all, std::size_t k, Wide* rest) {
  constexpr std::size_t at_once = 4;
  const std::size_t width = all.count + at_once;
  for (std::size_t b = 0; b < all.product_blocks; ++b) {
    const Wide *x = all.x + b * width, *y = all.y + b * width + at_once + k;
    Wide sum{}, other{};
    for (std::size_t j = 2; j < k; j += at_once) {
      sum += x[j] * y[-static_cast<std::ptrdiff_t>(j)];
      other += x[j + 1] * y[-static_cast<std::ptrdiff_t>(j + 1)];
      sum += x[j + 2] * y[-static_cast<std::ptrdiff_t>(j + 2)];
      other += x[j + 3] * y[-static_cast<std::ptrdiff_t>(j + 3)];
    }
    sum += other;
    sum += x[1] * y[-1];  // the newest
    const std::size_t at = k * all.product_blocks + b;
    rest[b] = sum * all.share[at] + sum * all.rest_of_share[at];
  }
}

[[gnu::always_inline]] inline bool blocks_are_zero(const Wide* x, std::size_t blocks) {
  const double* of = reinterpret_cast<const double*>(x);
  for (std::size_t i = 0; i < blocks * Eight::count; ++i)
    if (of[i] != 0) return false;
  return true;
}

/// Orders 1 to count - 1, from that of 0. Returns the last one that is not 0 for certain. With nothing above
/// order d, products of lower orders are 0 above order 2d: then all the rest is 0.
MOREAU_CLONES std::size_t find_orders(const Orders& of, bool& all_finite) {
  const Orders all = of;
  constexpr std::size_t before_first = 4;
  const std::size_t width = all.count + before_first;
  std::size_t degree = 1, end = all.count;
  Wide found[64], spoiled{};  // 0 times a number, unless it is not finite
  for (std::size_t k = 1; k < all.count; ++k) {
    const Wide* last = all.numbers + (k - 1) * all.number_blocks;
    for (std::size_t b = 0; b < all.moving_blocks; ++b)
      all.input[b] = last[b] * all.part[k] + last[b] * all.rest_of_part[k];
    find_free_rests(all, k, all.input + all.moving_blocks);
    if (k > 1 && blocks_are_zero(all.input, all.moving_blocks + all.product_blocks)) {
      if (2 * degree + 1 < k) {
        end = k;
        break;
      }
    } else {
      degree = k;
    }
    multiply_all(all, found);
    if (k == 1)
      for (std::size_t b = 0; b < all.blocks; ++b) found[b] += all.of_time[b];
    for (std::size_t b = 0; b < all.number_blocks; ++b) {
      all.numbers[k * all.number_blocks + b] = found[b];
      spoiled += 0.0 * found[b];
    }
    for (std::size_t b = 0; b < all.product_blocks; ++b) {
      const double more = static_cast<double>(k) - 1;
      all.x[b * width + k] = found[all.number_blocks + b] * (1.0 + more * all.weighted[b]);
      all.y[b * width + before_first + k] = found[all.number_blocks + all.product_blocks + b];
    }
  }
  const double* each = reinterpret_cast<const double*>(&spoiled);
  for (std::size_t lane = 0; lane < Eight::count; ++lane) all_finite = all_finite && each[lane] == 0;
  return end;
}

void set_to_zero(std::vector<Eight>& x) {
  if (!x.empty()) std::memset(static_cast<void*>(x.data()), 0, x.size() * sizeof(Eight));
}

/// to += c · from.
[[gnu::always_inline]] inline void add_multiple(const Wide* from, double c, Wide* to, std::size_t blocks) {
  for (std::size_t b = 0; b < blocks; ++b) to[b] += c * from[b];
}

MOREAU_CLONES void sweep_rows(const TaylorRows::Row* rows, std::size_t count, const TaylorRows::Term* terms,
                              const TaylorRows::Product* products, const double* factor, std::size_t blocks,
                              Wide* of_series, Wide* of_rests) {
  for (std::size_t r = count; r-- > 0;) {
    const TaylorRows::Row row = rows[r];
    const Wide* of_row = of_series + row.out * blocks;
    for (std::uint32_t p = row.first_product; p < row.end_product; ++p)
      add_multiple(of_row, factor[r] * products[p].scale, of_rests + p * blocks, blocks);
    for (std::uint32_t t = row.first; t < row.end; ++t)
      add_multiple(of_row, terms[t].c, of_series + terms[t].series * blocks, blocks);
  }
}

MOREAU_CLONES void add_columns(const Wide* columns, const double* c, std::size_t count, Wide* to,
                               std::size_t blocks) {
  for (std::size_t i = 0; i < count; ++i) add_multiple(columns + i * blocks, c[i], to, blocks);
}

}  // namespace

TaylorRecurrence::TaylorRecurrence(const TaylorSteps& steps, const TaylorRows& rows, std::size_t groups,
                                   Equations equations, int order)
    : equations_(std::move(equations)),
      coordinates_(equations_.momentum.size()),
      variables_(steps.variables),
      rows_(rows.ends[groups - 1].rows),
      products_(rows.ends[groups - 1].products),
      orders_(static_cast<std::size_t>(order)) {
  if (!steps.switches.empty()) return;  // what is not finite on a branch not taken would spoil the others
  first_kept_ = 2 * coordinates_;
  const std::size_t numbers = blocks_of(first_kept_ + equations_.kept.size()), factors = blocks_of(products_);
  const std::size_t blocks = numbers + 2 * factors;
  const std::size_t terms = rows_ == 0 ? 0 : rows.rows[rows_ - 1].end;
  constexpr std::size_t most_blocks = 64;
  if (blocks > most_blocks || (products_ + 2 * coordinates_) * blocks * work_of_eight >
                                  rows_ * work_of_row + terms * work_of_term + 2 * first_kept_ * first_kept_)
    return;
  number_blocks_ = numbers;
  product_blocks_ = factors;
  blocks_ = blocks;
  for (std::size_t i = 0; i < coordinates_; ++i) places_.emplace_back(equations_.momentum[i], i);
  for (const auto& [i, slot] : equations_.force)
    places_.emplace_back(slot, coordinates_ + static_cast<std::size_t>(i));
  for (std::size_t k = 0; k < equations_.kept.size(); ++k)
    places_.emplace_back(equations_.kept[k], first_kept_ + k);
  for (std::size_t p = 0; p < products_; ++p) {
    places_.emplace_back(rows.products[p].x, numbers * Eight::count + p);
    places_.emplace_back(rows.products[p].y, (numbers + factors) * Eight::count + p);
  }
  by_series_.resize(rows.series * blocks);
  of_moving_.resize(first_kept_ * blocks);
  of_rests_.resize(products_ * blocks);
  numbers_.resize(orders_ * numbers);
  constexpr std::size_t before_first = 4;
  x_.resize(factors * (orders_ + before_first));
  y_.resize(factors * (orders_ + before_first));
  weighted_.resize(factors);
  for (std::size_t p = 0; p < products_; ++p)
    weighted_[p / Eight::count].of[p % Eight::count] = rows.products[p].is_weighted ? 1 : 0;
  input_.resize(blocks_of(first_kept_) + factors);
  part_.resize(orders_);
  rest_of_part_.resize(orders_);
  for (std::size_t k = 1; k < orders_; ++k) {
    part_[k] = 1.0 / static_cast<double>(k);
    rest_of_part_[k] = std::fma(-static_cast<double>(k), part_[k], 1.0) / static_cast<double>(k);
  }
  share_.resize(orders_ * factors);
  rest_of_share_.resize(orders_ * factors);
  for (std::size_t at = 0; at < orders_ * factors * Eight::count; ++at) {
    const std::size_t lane = at % Eight::count, block = at / Eight::count, k = block / factors;
    const bool is_shared = k > 0 && weighted_[block % factors].of[lane] != 0;
    share_[block].of[lane] = is_shared ? part_[k] : 1;
    rest_of_share_[block].of[lane] = is_shared ? rest_of_part_[k] : 0;
  }
  change_.resize(static_cast<Index>(coordinates_));
}

/// ∂(numbers, factors) / ∂(series), of variables and rests in the end, with p in the place of v.
void TaylorRecurrence::sweep(const TaylorRows& rows, const std::vector<double>& factor) {
  set_to_zero(by_series_);
  set_to_zero(of_rests_);
  for (const auto& [series, at] : places_)
    by_series_[series * blocks_ + at / Eight::count].of[at % Eight::count] = 1;
  sweep_rows(rows.rows.data(), rows_, rows.terms.data(), rows.products.data(), factor.data(), blocks_,
             wide(by_series_), wide(of_rests_));
}

/// v = A⁻¹(F_(k-1) / k - p): `change_` is that by one unit of an input, and its column becomes what the unit
/// changes through v too.
void TaylorRecurrence::fold(Eight* column) {
  add_columns(wide(by_series_) + coordinates_ * blocks_, change_.data(), coordinates_,
              reinterpret_cast<Wide*>(column), blocks_);
  for (std::size_t i = 0; i < coordinates_; ++i)
    column[i / Eight::count].of[i % Eight::count] = change_[static_cast<Index>(i)];
}

bool TaylorRecurrence::find(const TaylorRows& rows, const std::vector<double>& factor, const InertiaFactor& A,
                            const double* v, const double* F) {
  sweep(rows, factor);
  const auto through_velocity = [&](Eight* column) {
    for (std::size_t i = 0; i < coordinates_; ++i)
      change_[static_cast<Index>(i)] = -column[i / Eight::count].of[i % Eight::count];
    A.solve(change_);
    fold(column);
  };
  for (std::size_t p = 0; p < products_; ++p) through_velocity(of_rests_.data() + p * blocks_);
  std::copy_n(by_series_.begin(), coordinates_ * blocks_, of_moving_.begin());
  for (std::size_t i = 0; i < coordinates_; ++i) through_velocity(of_moving_.data() + i * blocks_);
  through_velocity(by_series_.data() + (variables_ - 1) * blocks_);
  std::fill(of_moving_.begin() + static_cast<std::ptrdiff_t>(coordinates_ * blocks_), of_moving_.end(),
            Eight{});
  for (std::size_t i = 0; i < coordinates_; ++i) {
    change_.setZero();
    change_[static_cast<Index>(i)] = 1;
    A.solve(change_);
    fold(of_moving_.data() + (coordinates_ + i) * blocks_);
  }
  for (std::size_t i = 0; i < coordinates_; ++i) {
    numbers_[i / Eight::count].of[i % Eight::count] = v[i];
    const std::size_t at = coordinates_ + i;
    numbers_[at / Eight::count].of[at % Eight::count] = F[i];
  }
  return run();
}

bool TaylorRecurrence::run() {
  set_to_zero(x_);
  const Orders all{products_,
                   first_kept_,
                   product_blocks_,
                   number_blocks_,
                   blocks_of(first_kept_),
                   blocks_,
                   orders_,
                   wide(of_rests_),
                   wide(of_moving_),
                   wide(by_series_) + (variables_ - 1) * blocks_,
                   wide(weighted_),
                   part_.data(),
                   rest_of_part_.data(),
                   wide(share_),
                   wide(rest_of_share_),
                   wide(input_),
                   wide(numbers_),
                   wide(x_),
                   wide(y_)};
  bool all_finite = true;
  end_ = find_orders(all, all_finite);
  return all_finite;
}

}  // namespace mechanics::inline motions
