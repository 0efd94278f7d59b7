#include <doctest/doctest.h>

#include <string>

#include "convex/nearest_point/gallery/gallery.hpp"
#include "convex/nearest_point/methods.hpp"
#include "tests/oracles/nearest_point_error.hpp"

using convex::GalleryInstance;
using convex::Method;
using convex::MethodKind;
using convex::Solution;
using convex::Status;
using oracles::few_roundings;
using oracles::scale;

namespace {

struct Setting {
  const char* family;
  convex::Index size;
};

/// Rows that `enumerate` tries all sets of, and that the test has the time for.
constexpr convex::Index few_rows = 14;

}  // namespace

TEST_CASE("no method gives up on a well-posed family, whatever the setting of its knob") {
  for (const auto& [name, size] : {Setting{"well-posed", 9},
                                   {"redundant", 7},
                                   {"repeated", 7},
                                   {"no-interior", 8},
                                   {"weakly-active", 12},
                                   {"tall", 4},
                                   {"chain", 24},
                                   {"hexagonal-packing", 10},
                                   {"obstacle", 5}}) {
    const convex::GalleryFamily& family = *convex::find_family(name);
    for (const double difficulty : family.ladder)
      for (const std::uint32_t seed : {1U, 2U, 3U}) {
        const GalleryInstance instance = convex::gallery_instance(family, size, difficulty, seed);
        if (instance.problem.rows() > 500) continue;
        for (const Method& method : convex::methods()) {
          if (method.kind == MethodKind::for_comparison || !method.applies(instance.problem).empty())
            continue;
          if (method.name == "enumerate" && instance.problem.rows() > few_rows) continue;
          CAPTURE(std::string(name));
          CAPTURE(difficulty);
          CAPTURE(seed);
          CAPTURE(std::string(method.name));
          const Solution found = method.solve(instance.problem, {.tolerance = 1e-10});
          REQUIRE(found.status == Status::solved);
          const double unit = scale(instance.problem, instance.solution.hi);
          const double error =
              instance.problem.A.norm((found.q - instance.solution.hi) - instance.solution.lo);
          CHECK(error <= (method.kind == MethodKind::direct ? few_roundings : 1e-10) * unit);
          CHECK(error <= found.error_bound + few_roundings * unit);
        }
      }
  }
}

TEST_CASE(
    "a long chain of masses far apart is solved by the dense method too, in as many rounds as it takes") {
  const GalleryInstance chain = convex::gallery_instance(*convex::find_family("chain"), 300, 1e14);
  const Solution found = convex::find_method("active-set")->solve(chain.problem, {});
  REQUIRE(found.status == Status::solved);
  const double error = chain.problem.A.norm((found.q - chain.solution.hi) - chain.solution.lo);
  CHECK(error <= few_roundings * scale(chain.problem, chain.solution.hi));
}
