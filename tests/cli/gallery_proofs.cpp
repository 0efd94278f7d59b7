#include <doctest/doctest.h>

#include <cmath>
#include <nlohmann/json.hpp>

#include "convex/nearest_point/gallery/gallery.hpp"
#include "tests/cli/program.hpp"
#include "tests/oracles/rational_kkt.hpp"

using namespace tests;
using Json = nlohmann::json;
using convex::GalleryFamily;
using convex::GalleryInstance;
using convex::Index;
using convex::NearestPointProblem;
using oracles::Rational;
using oracles::RationalVector;

// What the program prints is judged here by the numbers of the gallery and GMP's fractions alone: no code of
// the prover is called.

namespace {

/// Fractions "p/q" of c[0], c[1], …, in the order of the rows or coordinates.
RationalVector fractions(const Json& by_name, const char* letter, Index count) {
  RationalVector all;
  for (Index k = 0; k < count; ++k) {
    Rational value(by_name.at(letter + ("[" + std::to_string(k) + "]")).get<std::string>());
    value.canonicalize();
    all.push_back(value);
  }
  return all;
}

RationalVector doubles(const Json& by_name, const char* letter, Index count) {
  RationalVector all;
  for (Index k = 0; k < count; ++k)
    all.emplace_back(by_name.at(letter + ("[" + std::to_string(k) + "]")).get<double>());
  return all;
}

/// ||x - y||_A².
Rational squared_distance(const convex::Matrix& A, const RationalVector& x, const RationalVector& y) {
  Rational sum = 0;
  for (std::size_t i = 0; i < x.size(); ++i)
    for (std::size_t j = 0; j < x.size(); ++j)
      sum += (x[i] - y[i]) * Rational(A(static_cast<Index>(i), static_cast<Index>(j))) * (x[j] - y[j]);
  return sum;
}

/// The checker: whether the answer in fractions is the solution, or its weights prove that there is none.
bool is_proved_exactly(const NearestPointProblem& problem, const Json& answer) {
  const Json& exact = answer.at("exact");
  if (answer.at("status") == "infeasible")
    return oracles::is_exact_farkas_witness(problem, fractions(exact.at("farkas"), "c", problem.rows()));
  return oracles::is_exact_solution(problem, {fractions(exact.at("acceleration"), "q", problem.dimension()),
                                              fractions(exact.at("multipliers"), "c", problem.rows())});
}

/// Whether the printed acceleration lies within the printed bound of the exact one.
bool is_within_bound(const NearestPointProblem& problem, const RationalVector& exact, const Json& answer) {
  const Rational bound(answer.at("certificate").at("error_bound").get<double>());
  const RationalVector printed = doubles(answer.at("acceleration"), "q", problem.dimension());
  return squared_distance(oracles::gram(problem.A), printed, exact) <= bound * bound;
}

/// The measure of a bound: within 100 times the true error, or 4 ulp of the acceleration.
bool is_tight(const NearestPointProblem& problem, const RationalVector& exact, const Json& answer) {
  const convex::Matrix A = oracles::gram(problem.A);
  const double bound = answer.at("certificate").at("error_bound").get<double>();
  const RationalVector printed = doubles(answer.at("acceleration"), "q", problem.dimension());
  const double error = std::sqrt(squared_distance(A, printed, exact).get_d());
  const double size = std::sqrt(squared_distance(A, exact, RationalVector(exact.size())).get_d());
  return bound <= std::max(100 * error, 4 * 0x1p-52 * size);
}

/// The size at which an instance has at most `most` coordinates.
Index fitting_size(const GalleryFamily& family, Index most) {
  for (Index size = most; size > 4; --size)
    if (convex::gallery_instance(family, size, family.usual).problem.dimension() <= most) return size;
  return 4;
}

struct Solved {
  NearestPointProblem problem;
  Json exact, certified;
  bool feasible;
};

Solved solved(const GalleryFamily& family, Index size, double difficulty) {
  const Folder folder;
  const std::string name(family.name), file = folder.path(name + ".toml");
  const GalleryInstance instance = convex::gallery_instance(family, size, difficulty);
  REQUIRE(run({"gallery", name, "--size", std::to_string(size), "--difficulty", Json(difficulty).dump(),
               "--output", file})
              .code == 0);
  return {instance.problem, Json::parse(run({"solve", "--json", "--method", "exact", file}).out),
          Json::parse(run({"solve", "--json", "--certify", file}).out), instance.feasible};
}

}  // namespace

TEST_CASE("every certificate over the gallery is verified by fractions that share nothing with the prover") {
  int enclosed = 0, exact = 0, infeasible = 0;
  for (const GalleryFamily& family : convex::gallery()) {
    const Index size = fitting_size(family, 12);
    for (const double difficulty : family.ladder) {
      CAPTURE(std::string(family.name));
      CAPTURE(difficulty);
      const Solved answer = solved(family, size, difficulty);
      CHECK((answer.exact.at("status") != "infeasible") == answer.feasible);
      CHECK(answer.certified.at("status") == answer.exact.at("status"));
      CHECK(is_proved_exactly(answer.problem, answer.exact));
      const std::string level = answer.certified.at("certificate").at("level");
      CHECK((level == "enclosure" || level == "exact"));
      if (!answer.feasible) {
        ++infeasible;
        continue;
      }
      ++(level == "exact" ? exact : enclosed);
      const RationalVector q =
          fractions(answer.exact.at("exact").at("acceleration"), "q", answer.problem.dimension());
      CHECK(is_within_bound(answer.problem, q, answer.certified));
      CHECK(is_within_bound(answer.problem, q, answer.exact));
      CHECK(is_tight(answer.problem, q, answer.certified));
    }
  }
  MESSAGE("enclosed " << enclosed << ", exact " << exact << ", infeasible " << infeasible);
}

TEST_CASE("the checker refuses what is changed: an answer, a fraction, a bound, a weight") {
  Solved answer = solved(*convex::find_family("well-posed"), 12, 0.5);
  const RationalVector q =
      fractions(answer.exact.at("exact").at("acceleration"), "q", answer.problem.dimension());
  REQUIRE(is_within_bound(answer.problem, q, answer.certified));
  Json moved = answer.certified;
  moved["acceleration"]["q[3]"] = moved["acceleration"]["q[3]"].get<double>() * (1 + 1e-12) + 1e-12;
  CHECK_FALSE(is_within_bound(answer.problem, q, moved));
  for (const char* key : {"acceleration", "multipliers"})
    for (const auto& [name, value] : answer.exact.at("exact").at(key).items()) {
      Json changed = answer.exact;
      changed["exact"][key][name] =
          Rational(Rational(value.get<std::string>()) + Rational("1/1000000000000")).get_str();
      CHECK_FALSE(is_proved_exactly(answer.problem, changed));
    }
  // A bound below the true error.
  moved = answer.certified;
  moved["acceleration"]["q[0]"] = moved["acceleration"]["q[0]"].get<double>() + 1;
  moved["certificate"]["error_bound"] = 0.5 * std::sqrt(oracles::gram(answer.problem.A)(0, 0));
  CHECK_FALSE(is_within_bound(answer.problem, q, moved));
  moved["certificate"]["error_bound"] = 2 * std::sqrt(oracles::gram(answer.problem.A)(0, 0));
  CHECK(is_within_bound(answer.problem, q, moved));

  answer = solved(*convex::find_family("infeasible"), 12, 0.01);
  REQUIRE(is_proved_exactly(answer.problem, answer.exact));
  for (const auto& [name, value] : answer.exact.at("exact").at("farkas").items()) {
    Json changed = answer.exact;
    changed["exact"]["farkas"][name] = Rational(Rational(value.get<std::string>()) + 1).get_str();
    CHECK_FALSE(is_proved_exactly(answer.problem, changed));
  }
}
