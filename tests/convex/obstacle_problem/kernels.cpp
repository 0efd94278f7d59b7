#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <memory>
#include <random>
#include <vector>

#include "convex/nearest_point/isotonic/chain_kernels.hpp"
#include "convex/obstacle_problem/cut_kernels.hpp"
#include "convex/obstacle_problem/grid_kernels.hpp"
#include "convex/zero_tolerances.hpp"

using convex::Index;

namespace {

std::size_t at(Index k) { return static_cast<std::size_t>(k); }

/// Rows of every length, what they hold and who of them is free drawn at random.
struct Row {
  Index n;
  std::vector<float> free;
  std::vector<double> x, y, z;
};
std::vector<Row> rows() {
  std::mt19937 random(3);
  std::normal_distribution<double> normal;
  std::vector<Row> made;
  for (Index n = 1; n <= 200; ++n) {
    Row row{n, {}, {}, {}, {}};
    for (Index i = 0; i < n; ++i) {
      row.free.push_back(random() % 3 == 0 ? 0 : 1);
      for (std::vector<double>* one : {&row.x, &row.y, &row.z}) one->push_back(normal(random));
    }
    made.push_back(row);
  }
  return made;
}

}  // namespace

TEST_CASE("kernels of rows leave out exactly what is not free, whatever instructions they are compiled to") {
  for (const Row& row : rows()) {
    CAPTURE(row.n);
    double square = 0;
    for (Index i = 0; i < row.n; ++i) square += row.free[at(i)] > 0 ? row.x[at(i)] * row.x[at(i)] : 0;
    CHECK(convex::grid_kernels::free_square(row.n, row.free.data(), row.x.data()) ==
          doctest::Approx(square).epsilon(1e-14));

    std::vector<float> taken(at(row.n)), residual(at(row.n));
    convex::grid_kernels::take_free(row.n, row.free.data(), row.x.data(), 3, taken.data());
    const std::vector<double> none(at(row.n + 2));
    const std::vector<float> no_links(at(row.n + 2));
    convex::CutRow<double> alone;  // A = 1
    alone.n = row.n;
    alone.stride = {1, 0, 0};
    alone.link[0] = none.data() + 1;
    const std::vector<double> ones(at(row.n), 1);
    alone.pull = ones.data();
    std::vector<double> q(at(row.n + 2));
    std::copy(row.y.begin(), row.y.end(), q.begin() + 1);
    convex::cut_kernels::residual(alone, row.x.data(), row.free.data(), 2, q.data() + 1, residual.data());
    for (Index i = 0; i < row.n; ++i) {
      const bool is_free = row.free[at(i)] > 0;
      CHECK(taken[at(i)] == (is_free ? static_cast<float>(3 * row.x[at(i)]) : 0.0F));
      CHECK(residual[at(i)] == (is_free ? static_cast<float>(2 * (row.x[at(i)] - row.y[at(i)])) : 0.0F));
    }

    std::vector<double> free(row.free.begin(), row.free.end()), chosen = free;
    const double changed =
        convex::grid_kernels::choose(row.n, 4, row.x.data(), row.y.data(), row.z.data(), chosen.data());
    Index count = 0;
    for (Index i = 0; i < row.n; ++i) {
      const double next = 4 * (row.x[at(i)] - row.y[at(i)]) > row.z[at(i)] ? 0 : 1;
      CHECK(chosen[at(i)] == next);
      count += next != free[at(i)];
    }
    CHECK(changed == static_cast<double>(count));
  }
}

TEST_CASE("kernels of chains count as their definitions do") {
  for (const Row& row : rows()) {
    if (row.n > convex::chain_kernels::width) break;
    CAPTURE(row.n);
    std::vector<double> pairs;
    Index fit = 0, units = 0, ones = 0, pulls = 0;
    for (Index i = 0; i < row.n; ++i) {
      const double c = i % 4 == 0 ? 1 : row.x[at(i)], other = i % 5 == 0 ? c : -c;
      pairs.push_back(other);
      pairs.push_back(c);
      fit += c > 0 && other == -c;
      units += c == 1;
    }
    CHECK(convex::chain_kernels::count_links(row.n, pairs.data(), ones) == fit);
    CHECK(ones == units);

    const auto block = std::make_unique<convex::chain_kernels::Block>();
    block->count = row.n;
    for (Index i = 0; i < row.n; ++i) {
      block->pushed[at(i)] =
          row.free[at(i)] > 0 ? row.x[at(i)] : convex::zero_of_long_sums * std::tanh(row.y[at(i)]);
      block->largest[at(i)] = std::abs(row.z[at(i)]) + 1;
    }
    const convex::chain_kernels::Numbers before = block->pushed;
    const Index told = convex::chain_kernels::drop_rounding(*block);
    for (Index i = 0; i < row.n; ++i) {
      CHECK((block->pushed[at(i)] == 0 || block->pushed[at(i)] == before[at(i)]));
      CHECK((block->pushed[at(i)] > 0) == (row.free[at(i)] > 0 && before[at(i)] > 0));
      pulls += row.free[at(i)] > 0 && before[at(i)] < 0;
    }
    CHECK(told == pulls);
  }
}
