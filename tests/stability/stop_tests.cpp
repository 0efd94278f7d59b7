#include <doctest/doctest.h>

#include "convex/nearest_point/methods.hpp"
#include "tests/stability/naive_methods.hpp"

using convex::GalleryInstance;
using convex::Status;

TEST_CASE("an unscaled residual calls the first guess solved when the numbers are small") {
  for (const double unit : {1e-20, 1e-100, 1e-150}) {
    CAPTURE(unit);
    const GalleryInstance instance = instance_of("scaled", 12, unit);
    const naive::Answer answer = naive::gauss_seidel(
        instance.problem, [](double residual, double) { return residual <= 1e-9; }, 1000);
    CHECK(answer.says_solved);
    CHECK(true_error(instance, answer.q) > 1e-2);
    const convex::Solution found = by_default(instance.problem);
    CHECK(found.status == Status::solved);
    CHECK(true_error(instance, found.q) <= few_roundings);
    CHECK(found.error_bound <= 1e-14 * instance.problem.A.norm(found.q));
  }
}

TEST_CASE("an absolute stop test is never met when the numbers are large, though the answer is right") {
  const GalleryInstance instance = instance_of("scaled", 12, 1e20);
  const naive::Answer answer = naive::gauss_seidel(
      instance.problem, [](double residual, double) { return residual > 0 && residual <= 1e-9; }, 3000);
  CHECK_FALSE(answer.says_solved);
  CHECK(true_error(instance, answer.q) <= few_roundings);
  for (const double unit : {1e20, 1e100, 1e150}) {
    const GalleryInstance same = instance_of("scaled", 12, unit);
    const convex::Solution found = by_default(same.problem);
    CHECK(found.status == Status::solved);
    CHECK(true_error(same, found.q) <= few_roundings);
  }
}

TEST_CASE("a small change is no small error: an iteration that creeps is called solved by itself alone") {
  const GalleryInstance instance = instance_of("heavy-on-light", 12, 1e16);
  const double largest = instance.multipliers.maxCoeff();
  const naive::Answer answer = naive::gauss_seidel(
      instance.problem, [&](double, double change) { return change <= 1e-6 * largest; }, 2000);
  CHECK(answer.says_solved);
  CHECK(true_error(instance, answer.q) > 0.5);
  CHECK(naive::judged(instance.problem, answer) != Status::solved);
  const convex::Solution found = by_default(instance.problem);
  CHECK(found.status == Status::solved);
  CHECK(true_error(instance, found.q) <= few_roundings);
}

TEST_CASE("no method is wrong without saying so, whatever the family and the difficulty") {
  for (const convex::GalleryFamily& family : convex::gallery())
    for (const double difficulty : family.ladder) {
      const GalleryInstance instance = convex::gallery_instance(family, 6, difficulty);
      for (const convex::Method& method : convex::methods()) {
        if (!method.applies(instance.problem).empty()) continue;
        CAPTURE(family.name);
        CAPTURE(difficulty);
        CAPTURE(method.name);
        const bool is_iterative = method.kind == convex::MethodKind::iterative;
        const convex::Solution found =
            method.solve(instance.problem, {.step_limit = is_iterative ? 200 : 0, .polish = false});
        if (found.status == Status::infeasible) {
          CHECK_FALSE(instance.feasible);
        } else if (!instance.feasible) {
          CHECK(found.status != Status::solved);
        } else if (found.q.size() > 0) {
          const double scale = oracles::scale(instance.problem, instance.solution.hi);
          CHECK(true_error(instance, found.q) <= 10 * std::max(found.error_bound / scale, 0x1p-53));
        }
      }
    }
}
