#include "convex/nearest_point/gallery/gallery.hpp"

#include <doctest/doctest.h>

#include <cmath>
#include <string>

#include "convex/invalid_input.hpp"
#include "convex/nearest_point/active_set/active_set.hpp"
#include "tests/oracles/rational_kkt.hpp"

using convex::GalleryFamily;
using convex::GalleryInstance;
using convex::Index;
using convex::Status;
using convex::Vector;

namespace {

Index small_size(const GalleryFamily& family) { return family.name == "obstacle" ? 5 : 12; }

/// q and lambda are what the instance says, as fractions.
oracles::RationalPoint said(const GalleryInstance& instance) {
  oracles::RationalPoint point;
  for (Index i = 0; i < instance.solution.size(); ++i)
    point.q.push_back(oracles::Rational(instance.solution.hi[i]) +
                      oracles::Rational(instance.solution.lo[i]));
  for (const double lambda : instance.multipliers) point.lambda.emplace_back(lambda);
  return point;
}

/// The exact solution with the loaded rows held, when it satisfies all conditions.
bool exact_solution_is_near(const GalleryInstance& instance) {
  std::vector<Index> loaded;
  for (Index a = 0; a < instance.problem.rows(); ++a)
    if (instance.multipliers[a] > 0) loaded.push_back(a);
  const oracles::RationalPoint exact = oracles::solve_kkt(instance.problem, loaded);
  if (!oracles::is_exact_solution(instance.problem, exact)) return false;
  const oracles::RationalPoint point = said(instance);
  for (std::size_t i = 0; i < exact.q.size(); ++i) {
    const oracles::Rational difference = point.q[i] - exact.q[i];
    if (std::abs(difference.get_d()) > std::ldexp(std::abs(exact.q[i].get_d()), -104)) return false;
  }
  return true;
}

}  // namespace

TEST_CASE("the truth of every instance of the gallery is the exact solution of its data") {
  for (const GalleryFamily& family : convex::gallery())
    for (const double difficulty : family.ladder)
      for (const std::uint32_t seed : {1U, 2U}) {
        CAPTURE(std::string(family.name));
        CAPTURE(difficulty);
        const GalleryInstance instance =
            convex::gallery_instance(family, small_size(family), difficulty, seed);
        if (!instance.feasible) {
          CHECK(oracles::is_farkas_witness(instance.problem, instance.farkas, 0));
          continue;
        }
        CHECK((oracles::is_exact_solution(instance.problem, said(instance)) ||
               exact_solution_is_near(instance)));
      }
}

TEST_CASE("the default method is right on every instance of the gallery, or says that it is not sure") {
  for (const GalleryFamily& family : convex::gallery())
    for (const double difficulty : family.ladder) {
      CAPTURE(std::string(family.name));
      CAPTURE(difficulty);
      const Index size = family.sparse ? (family.name == "obstacle" ? 10 : 60) : family.size;
      const GalleryInstance instance = convex::gallery_instance(family, size, difficulty);
      const convex::Solution found = convex::active_set(instance.problem);
      if (!instance.feasible) {
        CHECK(found.status == Status::infeasible);
        CHECK(oracles::is_farkas_witness(instance.problem, found.farkas, 1e-12));
        continue;
      }
      if (found.status != Status::solved) {  // rows opposite but for some roundings
        CHECK((family.name == "near-opposite" && difficulty <= 1e-14));
        CHECK(found.status == Status::inaccurate);
        continue;
      }
      const Vector error = found.q - instance.solution.hi - instance.solution.lo;
      const double scale = std::max(found.acceleration_norm, found.force_norm);
      CHECK(instance.problem.A.norm(error) <= 8e-15 * scale);
    }
}

TEST_CASE("the same arguments give the same instance, another seed another") {
  for (const GalleryFamily& family : convex::gallery()) {
    CAPTURE(std::string(family.name));
    const auto forces = [&](std::uint32_t seed) {
      return convex::gallery_instance(family, 16, family.usual, seed).problem.z;
    };
    CHECK(forces(7) == forces(7));
    if (family.name != "obstacle" && family.name != "heavy-on-light") CHECK(forces(7) != forces(8));
  }
}

TEST_CASE("a family is found by its name, and settings outside its range are refused") {
  CHECK(convex::find_family("tall")->name == "tall");
  CHECK(convex::find_family("small") == nullptr);
  const GalleryFamily& tall = *convex::find_family("tall");
  CHECK_THROWS_WITH_AS(convex::gallery_instance(tall, 3, 2),
                       "tall: size 3; give a number of coordinates from 4 to 10000000", convex::InvalidInput);
  CHECK_THROWS_WITH_AS(
      convex::gallery_instance(tall, 8, 1e6),
      "tall: difficulty 1e+06 (rows for each coordinate) is outside; give one from 2 to 1000",
      convex::InvalidInput);
}
