#include "convex/linear_algebra/band_factor.hpp"

#include <doctest/doctest.h>

#include <random>

#include "convex/nearest_point/sparse/sparse_active_set.hpp"

namespace {

using convex::Index;
using convex::Vector;
using convex::linear_algebra::SparseFactor;

/// A symmetric matrix of small integers whose diagonal outweighs its rows, by place.
struct Entries {
  std::vector<SparseFactor::Place> places;
  std::vector<double> values;
};

Entries dominant_band(Index n, Index width, std::mt19937& random) {
  Entries found;
  Vector weight = Vector::Ones(n);
  const auto add = [&](Index i, Index j, double value) {
    // In either triangle, for both are the same.
    found.places.push_back({static_cast<int>(i), static_cast<int>(j)});
    found.values.push_back(value);
  };
  for (Index i = 0; i < n; ++i)
    for (Index j = std::max<Index>(0, i - width); j < i; ++j) {
      const double value = static_cast<double>(random() % 7) - 3;
      if (random() % 2 == 0)
        add(i, j, value);
      else
        add(j, i, value);
      weight[i] += std::abs(value);
      weight[j] += std::abs(value);
    }
  for (Index i = 0; i < n; ++i) add(i, i, weight[i]);
  return found;
}

TEST_CASE("a band system gives back the integers that its right side was made of") {
  std::mt19937 random(5);
  for (const Index n : {1, 2, 3, 7, 40})
    for (const Index width : {0, 1, 2, 5, 16}) {
      CAPTURE(n);
      CAPTURE(width);
      const Entries K = dominant_band(n, width, random);
      CHECK(convex::linear_algebra::BandFactor::width(K.places) == std::min(width, n - 1));
      Vector planted(n), x = Vector::Zero(n);
      for (double& value : planted) value = static_cast<double>(random() % 19) - 9;
      for (std::size_t k = 0; k < K.places.size(); ++k) {
        const auto [i, j] = K.places[k];
        x[i] += K.values[k] * planted[j];
        if (i != j) x[j] += K.values[k] * planted[i];
      }
      convex::linear_algebra::BandFactor factor(n, width);
      const std::vector<Index> slots = factor.slots(K.places);
      for (int again = 0; again < 2; ++again) {  // values change, the pattern stays
        factor.clear_values();
        for (std::size_t k = 0; k < slots.size(); ++k)
          factor.values()[static_cast<std::size_t>(slots[k])] += K.values[k];
        REQUIRE(factor.factor());
        Vector found = x;
        factor.solve(found);
        // Every excess is at least 1, so ||K⁻¹||_∞ <= 1; factors of dominant matrices do not grow.
        CHECK((found - planted).cwiseAbs().maxCoeff() <=
              1e-15 * static_cast<double>(n + width) * (1 + x.cwiseAbs().maxCoeff()));
      }
    }
}

TEST_CASE("a band with a pivot of zero is refused") {
  convex::linear_algebra::BandFactor factor(2, 1);
  factor.values() = {1, 1, 1, 0};
  CHECK_FALSE(factor.factor());
}

TEST_CASE("a string above a floor has the same answer however its coordinates are numbered") {
  // In order it is a band; shuffled it is not, and the multifrontal factor does the work.
  constexpr Index n = 400;
  std::mt19937 random(11);
  std::vector<int> place(n);
  for (Index i = 0; i < n; ++i) place[static_cast<std::size_t>(i)] = static_cast<int>(i);
  const auto solve = [&] {
    std::vector<Eigen::Triplet<double>> A, U;
    Vector z(n), s = Vector::Zero(n);
    for (Index i = 0; i < n; ++i) {
      const int p = place[static_cast<std::size_t>(i)];
      A.emplace_back(p, p, 3);
      U.emplace_back(static_cast<int>(i), p, 1);
      z[p] = static_cast<double>((i * i) % 13) - 7;
      if (i == 0) continue;
      const int before = place[static_cast<std::size_t>(i - 1)];
      A.emplace_back(p, before, -1);
      A.emplace_back(before, p, -1);
    }
    convex::SparseMatrix gram(n, n);
    gram.setFromTriplets(A.begin(), A.end());
    convex::SparseRows rows(n, n);
    rows.setFromTriplets(U.begin(), U.end());
    const convex::Solution found =
        convex::sparse_active_set({convex::Metric::sparse(gram), z, convex::ConstraintRows(rows), s, {}});
    REQUIRE(found.status == convex::Status::solved);
    Vector q(n);
    for (Index i = 0; i < n; ++i) q[i] = found.q[place[static_cast<std::size_t>(i)]];
    return q;
  };
  const Vector in_order = solve();
  std::shuffle(place.begin(), place.end(), random);
  CHECK(solve() == in_order);
}

}  // namespace
