#include "mechanics/motion/taylor_kernels.hpp"

#include <doctest/doctest.h>

#include <cmath>
#include <random>
#include <vector>

// Loops that are compiled for several families of processors, each put to the test that this machine can run.

using namespace mechanics;

namespace {

/// Numbers of order k: M times v_(k-1) / k, F_(k-1) / k and the rests of products of random numbers among
/// them.
struct RandomRecurrence {
  std::size_t moving, products, blocks, orders;
  std::vector<Eight> of_moving, of_rests, of_time, weighted, input, numbers, x, y;
  std::vector<Places> place_of_x, place_of_y;
  std::vector<double> part, rest_of_part;

  RandomRecurrence(std::size_t moving_numbers, std::size_t product_count, std::size_t block_count,
                   std::size_t order_count, unsigned seed)
      : moving(moving_numbers), products(product_count), blocks(block_count), orders(order_count) {
    std::mt19937 random(seed);
    std::uniform_real_distribution<double> number(-0.25, 0.25);
    const auto fill = [&](std::vector<Eight>& to, std::size_t count) {
      to.resize(count);
      for (Eight& eight : to)
        for (double& each : eight.of) each = number(random);
    };
    fill(of_moving, moving * blocks);
    fill(of_rests, products * blocks);
    fill(of_time, blocks);
    const std::size_t of_products = std::max<std::size_t>(blocks_of(products), 1);
    weighted.resize(of_products);
    place_of_x.resize(of_products);
    place_of_y.resize(of_products);
    std::uniform_int_distribution<long long> place(0, static_cast<long long>(8 * blocks) - 1);
    for (std::size_t p = 0; p < products; ++p) {
      weighted[p / 8].of[p % 8] = p % 3 == 0 ? 1 : 0;
      place_of_x[p / 8].of[p % 8] = place(random);
      place_of_y[p / 8].of[p % 8] = place(random);
    }
    input.resize(blocks_of(moving) + of_products);
    fill(numbers, orders * blocks);  // order 0, and what was there before
    fill(x, of_products * (orders + 2 * TaylorOrders::zeros));
    fill(y, of_products * (orders + 2 * TaylorOrders::zeros));
    for (std::size_t b = 0; b < of_products; ++b)  // order 0 of y and what is before it
      for (std::size_t j = 0; j <= TaylorOrders::zeros; ++j)
        y[b * (orders + 2 * TaylorOrders::zeros) + j] = {};
    for (std::size_t k = 0; k < orders; ++k) {
      part.push_back(k == 0 ? 0 : 1 / static_cast<double>(k));
      rest_of_part.push_back(
          k == 0 ? 0 : std::fma(-static_cast<double>(k), part[k], 1.0) / static_cast<double>(k));
    }
  }

  TaylorOrders view() {
    return {products,
            moving,
            blocks_of(products),
            blocks_of(moving),
            blocks,
            orders,
            of_rests.data()->of,
            of_moving.data()->of,
            of_time.data()->of,
            place_of_x.data(),
            place_of_y.data(),
            weighted.data()->of,
            part.data(),
            rest_of_part.data(),
            input.data()->of,
            numbers.data()->of,
            x.data()->of,
            y.data()->of};
  }

  /// The same by the formula, term by term.
  std::vector<std::vector<long double>> by_formula() const {
    const auto entry = [&](const std::vector<Eight>& of, std::size_t column, std::size_t i) {
      return static_cast<long double>(of[column * blocks + i / 8].of[i % 8]);
    };
    const std::size_t count = 8 * blocks;
    std::vector<std::vector<long double>> found(orders, std::vector<long double>(count));
    for (std::size_t i = 0; i < count; ++i) found[0][i] = entry(numbers, 0, i);
    for (std::size_t k = 1; k < orders; ++k) {
      const auto whole = static_cast<long double>(k);
      for (std::size_t i = 0; i < count; ++i) {
        long double sum = k == 1 ? entry(of_time, 0, i) : 0;
        for (std::size_t m = 0; m < moving; ++m) sum += entry(of_moving, m, i) * found[k - 1][m] / whole;
        for (std::size_t p = 0; p < products; ++p) {
          const auto at_x = static_cast<std::size_t>(place_of_x[p / 8].of[p % 8]);
          const auto at_y = static_cast<std::size_t>(place_of_y[p / 8].of[p % 8]);
          long double rest = 0;
          for (std::size_t j = 1; j < k; ++j)
            rest += (weighted[p / 8].of[p % 8] > 0 ? static_cast<long double>(j) / whole : 1) *
                    found[j][at_x] * found[k - j][at_y];
          sum += entry(of_rests, p, i) * rest;
        }
        found[k][i] = sum;
      }
    }
    return found;
  }
};

}  // namespace

TEST_CASE("on every family of processors the orders of a series are those of the recurrence, term by term") {
  for (const TaylorKernels* kernels : all_taylor_kernels())
    for (const std::size_t orders : {1, 2, 3, 4, 5, 6, 7, 12, 33})
      for (const auto& [moving, products, blocks] : {std::array<std::size_t, 3>{2, 0, 1},
                                                     {4, 5, 1},
                                                     {8, 8, 1},
                                                     {4, 3, 2},
                                                     {6, 11, 2},
                                                     {4, 0, 2},
                                                     {10, 7, 2},
                                                     {6, 17, 3},
                                                     {6, 30, 7},
                                                     {12, 40, 14}}) {
        CAPTURE(orders);
        CAPTURE(products);
        CAPTURE(blocks);
        RandomRecurrence of(moving, products, blocks, orders, static_cast<unsigned>(orders + products));
        const auto expected = of.by_formula();
        bool all_finite = true;
        REQUIRE(kernels->find_orders(of.view(), all_finite) == orders);
        CHECK(all_finite);
        double worst = 0;
        for (std::size_t k = 1; k < orders; ++k) {
          long double size = 0, error = 0;
          for (std::size_t i = 0; i < 8 * blocks; ++i) {
            const double found = of.numbers[k * blocks + i / 8].of[i % 8];
            size = std::max(size, std::abs(expected[k][i]));
            error = std::max(error, std::abs(found - expected[k][i]));
          }
          worst = std::max(worst, static_cast<double>(error / size));
        }
        CHECK(worst <= 1e-13);
      }
}

TEST_CASE("a number of an order that is not finite is told on every family of processors") {
  for (const TaylorKernels* kernels : all_taylor_kernels()) {
    RandomRecurrence of(4, 11, 2, 12, 1);
    of.of_time[1].of[7] = std::numeric_limits<double>::infinity();
    bool all_finite = true;
    kernels->find_orders(of.view(), all_finite);
    CHECK_FALSE(all_finite);
  }
}

TEST_CASE("where all is 0 from an order on, the orders end there on every family of processors") {
  for (const TaylorKernels* kernels : all_taylor_kernels()) {
    RandomRecurrence of(4, 11, 2, 30, 2);
    for (Eight& each : of.of_rests) each = {};
    for (Eight& each : of.of_moving) each = {};
    bool all_finite = true;  // of order 1 alone: its products are of order 2
    CHECK(kernels->find_orders(of.view(), all_finite) < 8);
    CHECK(all_finite);
  }
}

TEST_CASE("velocities are eliminated from a sweep alike on every family of processors") {
  constexpr std::size_t n = 3, columns = 19, blocks = 2;
  // A = L D Lᵀ.
  const double L[n][n] = {{1, 0, 0}, {0.5, 1, 0}, {-0.25, 2, 1}}, D[n] = {2, 0.5, 4};
  const double inverse[n] = {1 / D[0], 1 / D[1], 1 / D[2]};
  std::mt19937 random(3);
  std::uniform_real_distribution<double> number(-1, 1);
  std::vector<Eight> begin(columns * blocks), by_velocity(n * blocks);
  for (auto* all : {&begin, &by_velocity})
    for (Eight& eight : *all)
      for (double& each : eight.of) each = number(random);
  for (const TaylorKernels* kernels : all_taylor_kernels()) {
    std::vector<Eight> found = begin, change(n * blocks_of(columns));
    kernels->eliminate_velocities(
        {n, columns, blocks, &L[0][0], inverse, by_velocity.data()->of, found.data()->of, change.data()->of});
    double worst = 0;
    for (std::size_t c = 0; c < columns; ++c) {
      const bool is_force = c >= n && c < 2 * n;
      // A v = F - p.
      double half[n] = {}, v[n];
      for (std::size_t i = 0; i < n; ++i) v[i] = found[c * blocks].of[i];
      for (std::size_t j = 0; j < n; ++j)
        for (std::size_t i = j; i < n; ++i) half[j] += D[j] * L[i][j] * v[i];
      for (std::size_t i = 0; i < n; ++i) {
        double Av = 0;
        for (std::size_t j = 0; j <= i; ++j) Av += L[i][j] * half[j];
        const double asked = is_force ? (c - n == i ? 1 : 0) : -begin[c * blocks].of[i];
        worst = std::max(worst, std::abs(Av - asked));
      }
      for (std::size_t at = n; at < 8 * blocks; ++at) {
        double sum = is_force ? 0 : begin[c * blocks + at / 8].of[at % 8];
        for (std::size_t i = 0; i < n; ++i) sum += v[i] * by_velocity[i * blocks + at / 8].of[at % 8];
        worst = std::max(worst, std::abs(found[c * blocks + at / 8].of[at % 8] - sum));
      }
    }
    CHECK(worst <= 1e-14);
  }
}

TEST_CASE("rests of products are those of the formula on every family of processors") {
  constexpr std::size_t width = 20, blocks = 2;
  std::mt19937 random(4);
  std::uniform_real_distribution<double> number(-1, 1);
  std::vector<Eight> x(width * blocks), y(width * blocks), weighted(blocks), rest(blocks);
  for (auto* all : {&x, &y})
    for (Eight& eight : *all)
      for (double& each : eight.of) each = number(random);
  for (std::size_t p = 0; p < 8 * blocks; p += 3) weighted[p / 8].of[p % 8] = 1;
  for (const TaylorKernels* kernels : all_taylor_kernels())
    for (std::size_t k = 1; k < width; ++k) {
      kernels->find_rests(x.data()->of, y.data()->of, weighted.data()->of, rest.data()->of, blocks, width, k);
      for (std::size_t p = 0; p < 8 * blocks; ++p) {
        // Factors with the weight j are kept times j.
        double sum = 0;
        for (std::size_t j = 1; j < k; ++j)
          sum += x[p / 8 * width + j].of[p % 8] * y[p / 8 * width + k - j].of[p % 8];
        if (p % 3 == 0) sum /= static_cast<double>(k);
        CHECK(std::abs(rest[p / 8].of[p % 8] - sum) <= 1e-14);
      }
    }
}
