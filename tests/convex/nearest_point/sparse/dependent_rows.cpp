#include "convex/nearest_point/sparse/dependent_rows.hpp"

#include <doctest/doctest.h>

#include "convex/nearest_point/isotonic/exact_rise.hpp"

using namespace convex;

namespace {

/// Differences around a triangle, and the last one moved by `off` in an entry.
ConstraintRows triangle(double off) {
  RowMatrix U{{-1, 1, 0, 0}, {0, -1, 1, 0}, {-1, 0, 1, off}};
  return ConstraintRows(std::move(U));
}

constexpr double most = 1e6;

}  // namespace

TEST_CASE("a row that closes a loop is implied, one bit off it is independent, and so is its bound") {
  const Vector s{{0.1, 0.25, 0.1 + 0.25}};
  const auto closed = row_dependences(triangle(0), s, {0, 1}, {2}, most);
  REQUIRE(closed);
  CHECK(closed->independent == std::vector<Index>{0, 1});
  CHECK(closed->consistent);
  // 0.1 + 0.25 rounds: as the doubles stand the bound is off the edge.
  CHECK(closed->off_edge == std::vector<Index>{2});
  const auto dyadic = row_dependences(triangle(0), Vector{{0.125, 0.25, 0.375}}, {0, 1}, {2}, most);
  REQUIRE(dyadic);
  CHECK(dyadic->implied == std::vector<Index>{2});
  CHECK(dyadic->off_edge.empty());

  const auto open = row_dependences(triangle(0x1p-1000), s, {0, 1}, {2}, most);
  REQUIRE(open);
  CHECK(open->independent == std::vector<Index>{0, 1, 2});
  CHECK(open->implied.empty());
}

TEST_CASE("rows held that contradict each other by the last bit are seen to") {
  const double s = 0.375;
  const auto of = [&](double last) {
    return row_dependences(triangle(0), Vector{{0.125, 0.25, last}}, {0, 1, 2}, {}, most);
  };
  CHECK(of(s)->consistent);
  CHECK_FALSE(of(s + 0x1p-54)->consistent);
  CHECK_FALSE(row_dependences(triangle(0), Vector::Zero(3), {0, 1, 2}, {}, 0.0));
}

TEST_CASE("two pools of a string rise by the sign of fractions") {
  // Means 1/3 and 1/3 + 2^-60 by masses of 3, at heights that cancel.
  const auto members = [](double more) {
    return StringMembers([more](Index k) {
      return k == 0 ? StringMember{3, 1, 1, 0} : StringMember{3, 1 + 3 * 0.125 + more, 1, 0.125};
    });
  };
  CHECK(rise(members(0), 0, 1, 2) == 0);
  CHECK(rise(members(0x1p-50), 0, 1, 2) == 1);
  CHECK(rise(members(-0x1p-50), 0, 1, 2) == -1);
  const StringMembers floored = [](Index) { return StringMember{3, 1, 3, 1}; };
  CHECK(rise_over_floor(floored, 0, 0, 1) == 0);
}

TEST_CASE("rows that depend on each other modulo one prime alone are left open, not called dependent") {
  // The determinant is 2^62 - 57, the first of the primes.
  RowMatrix U{{0x1p31, 57}, {1, 0x1p31}};
  const ConstraintRows rows(std::move(U));
  CHECK_FALSE(row_dependences(rows, Vector{{0, 0}}, {0}, {1}, most));
  CHECK_FALSE(row_dependences(rows, Vector{{0, 0}}, {0, 1}, {}, most));
  // 2^62 - 56 is none of them.
  RowMatrix other{{0x1p31, 56}, {1, 0x1p31}};
  const auto found = row_dependences(ConstraintRows(std::move(other)), Vector{{0, 0}}, {0}, {1}, most);
  REQUIRE(found);
  CHECK(found->independent == std::vector<Index>{0, 1});
}
