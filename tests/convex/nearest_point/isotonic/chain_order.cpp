#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <numeric>
#include <random>

#include "convex/nearest_point/active_set/active_set.hpp"
#include "convex/nearest_point/isotonic/chain.hpp"

using convex::Index;
using convex::NearestPointProblem;
using convex::Solution;
using convex::Status;
using convex::Vector;

namespace {

/// n bodies on a floor that are pulled down, with gaps or level, and many that press equally hard.
struct Column {
  Vector mass, force, gap;
  Column(Index n, unsigned seed) : mass(n), force(n), gap(n) {
    std::mt19937 generator(seed);
    std::normal_distribution<double> normal;
    for (Index i = 0; i < n; ++i) {
      mass[i] = seed % 2 == 0 ? 1 : std::exp(normal(generator));
      force[i] = mass[i] * (seed % 3 == 0 ? -9.81 : normal(generator) + 2e-3 * static_cast<double>(i));
      gap[i] = seed % 4 < 2 ? 0 : 0.1 * normal(generator);
    }
  }
  /// Body k is coordinate place[k], the row under it rows[k].
  NearestPointProblem problem(const std::vector<int>& place, const std::vector<int>& rows) const {
    const Index n = mass.size();
    NearestPointProblem found{convex::Metric::identity(1), Vector(n), {}, Vector(n), {}};
    Vector diagonal(n);
    std::vector<Eigen::Triplet<double>> entries;
    for (std::size_t k = 0; k < place.size(); ++k) {
      const Index body = static_cast<Index>(k);
      diagonal[place[k]] = mass[body];
      found.z[place[k]] = force[body];
      found.s[rows[k]] = gap[body];
      entries.emplace_back(rows[k], place[k], 1.0);
      if (k > 0) entries.emplace_back(rows[k], place[k - 1], -1.0);
    }
    convex::SparseRows U(n, n);
    U.setFromTriplets(entries.begin(), entries.end());
    found.A = convex::Metric::diagonal(diagonal);
    found.U = convex::ConstraintRows(U);
    return found;
  }
};

}  // namespace

TEST_CASE(
    "a column moves the same in whatever order its bodies and contacts are told, as the general method "
    "says") {
  for (unsigned seed = 0; seed < 12; ++seed)
    for (Index n : {1, 2, 127, 128, 129, 300}) {
      CAPTURE(seed);
      CAPTURE(n);
      const Column column(n, seed);
      std::vector<int> place(static_cast<std::size_t>(n)), rows;
      std::iota(place.begin(), place.end(), 0);
      rows = place;
      const NearestPointProblem in_order = column.problem(place, rows);
      const std::optional<Solution> found = convex::solve_chain(in_order);
      REQUIRE(found.has_value());
      REQUIRE(found->status == Status::solved);
      const Solution general = convex::active_set(in_order);
      const double scale = std::max(found->acceleration_norm, found->force_norm);
      CHECK(in_order.A.norm(found->q - general.q) <= 2e-15 * scale);
      CHECK(found->residuals.feasibility <= 4e-15);
      CHECK(found->residuals.complementarity <= 4e-15);
      CHECK(found->residuals.stationarity <= 1e-13);  // multipliers are rounded

      std::mt19937 generator(seed);
      std::shuffle(place.begin(), place.end(), generator);
      std::shuffle(rows.begin(), rows.end(), generator);
      const std::optional<Solution> shuffled = convex::solve_chain(column.problem(place, rows));
      REQUIRE(shuffled.has_value());
      const auto agree = [](double x, double y) { return std::abs(x - y) <= 1e-9 * x; };
      CHECK(agree(found->residuals.feasibility, shuffled->residuals.feasibility));
      CHECK(agree(found->residuals.complementarity, shuffled->residuals.complementarity));
      for (std::size_t k = 0; k < place.size(); ++k) {
        const Index body = static_cast<Index>(k);
        CHECK(shuffled->q[place[k]] == found->q[body]);
        CHECK(shuffled->lambda[rows[k]] == found->lambda[body]);
        CHECK(shuffled->slack[rows[k]] == found->slack[body]);
      }
    }
}
