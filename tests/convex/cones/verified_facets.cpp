#include "convex/cones/verified_facets.hpp"

#include <doctest/doctest.h>
#include <sys/wait.h>
#include <unistd.h>

#include <csignal>
#include <cstdio>

#include "convex/cones/section_hull.hpp"

using convex::IntegerRows;
using Simplices = std::vector<std::vector<std::size_t>>;

namespace {

/// The cone over a square, and the sides of the square.
const IntegerRows square{{1, 1, 1}, {1, -1, 1}, {-1, -1, 1}, {-1, 1, 1}};
const Simplices square_sides{{0, 1}, {1, 2}, {2, 3}, {0, 3}};

/// Whether the proof fails, and the program stops.
bool is_refused(const IntegerRows& rays, const Simplices& simplices) {
  const pid_t child = fork();
  if (child == 0) {
    if (std::freopen("/dev/null", "w", stderr) == nullptr) _exit(1);
    std::signal(SIGABRT, SIG_DFL);
    convex::verified_facets(rays, rays.front().size(), simplices);
    _exit(0);
  }
  int status = 0;
  waitpid(child, &status, 0);
  return WIFSIGNALED(status) && WTERMSIG(status) == SIGABRT;
}

IntegerRows octahedron() {
  return {{1, 0, 0, 1}, {-1, 0, 0, 1}, {0, 1, 0, 1}, {0, -1, 0, 1}, {0, 0, 1, 1}, {0, 0, -1, 1}};
}

}  // namespace

TEST_CASE("a complete list of facets is accepted") {
  CHECK_FALSE(is_refused(square, square_sides));
  CHECK(convex::verified_facets(square, 3, square_sides).normals.size() == 4);
}

TEST_CASE("a list that lacks a facet, has one twice or one of another cone is never returned") {
  CHECK(is_refused(square, {{0, 1}, {1, 2}, {2, 3}}));
  CHECK(is_refused(square, {{0, 1}, {1, 2}, {2, 3}, {0, 3}, {0, 3}}));
  CHECK(is_refused(square, {{0, 1}, {1, 2}, {0, 2}}));
  CHECK(is_refused(square, {}));
  CHECK(is_refused(square, {{0, 1}, {0, 1}, {1, 2}, {1, 2}, {2, 3}, {2, 3}, {0, 3}, {0, 3}}));
  IntegerRows outside = square;
  outside.push_back({3, 0, 1});
  CHECK(is_refused(outside, square_sides));
}

TEST_CASE("every single simplex of a triangulated boundary is needed") {
  const IntegerRows rays = octahedron();
  const Simplices all = convex::section_hull(rays, {0, 0, 0, 1});
  REQUIRE(all.size() == 8);
  CHECK_FALSE(is_refused(rays, all));
  for (std::size_t left_out = 0; left_out < all.size(); ++left_out) {
    Simplices rest = all;
    rest.erase(rest.begin() + static_cast<std::ptrdiff_t>(left_out));
    CHECK(is_refused(rays, rest));
  }
}
