#include "mechanics/gauss_laws.hpp"

#include <doctest/doctest.h>

#include <cmath>
#include <numbers>
#include <set>

#include "cli/scene.hpp"
#include "mechanics/farkas_laws.hpp"
#include "tests/this_build.hpp"

using convex::Check;
using convex::Index;
using convex::LawReport;
using convex::NearestPointProblem;
using convex::RowMatrix;
using convex::Vector;
using mechanics::GaussSolution;

namespace {

struct Scene {
  std::string name;
  NearestPointProblem problem;
  GaussSolution solution;
};

Scene of_file(const std::string& name) {
  const cli::Scene scene = cli::read_scene(tests::source_folder() + "docs/problems/" + name + ".toml", {});
  return {name, scene.problem, mechanics::solve(scene.problem)};
}

Scene of_numbers(std::string name, NearestPointProblem problem) {
  GaussSolution solution = mechanics::solve(problem);
  return {std::move(name), std::move(problem), std::move(solution)};
}

/// Systems: contacts that open, that are redundant, two-sided, sparse. Projections: with an x_0, without one,
/// with numbers whose squares are no doubles.
std::vector<Scene> solved_scenes() {
  std::vector<Scene> scenes;
  for (const char* name : {"delassus_drops_too_much", "table_off_centre", "slider_crank_tilted",
                           "trammel_stop", "packing_in_box", "projection_two_sided"})
    scenes.push_back(of_file(name));
  // q_1 <= 1 and q_1 >= 0 pull apart as equations; z pushes on the first.
  scenes.push_back(of_numbers("no x_0", {convex::Metric::diagonal(Vector{{2.0, 1.0}}),
                                         Vector{{5.0, -3.0}},
                                         convex::ConstraintRows(RowMatrix{{-1, 0}, {1, 0}, {1, 1}}),
                                         Vector{{-1.0, 0.0, 0.0}},
                                         {}}));
  scenes.push_back(of_numbers("extreme units", {convex::Metric::diagonal(Vector{{2e-160, 1e-160}}),
                                                Vector{{0.0, -3.0}},
                                                convex::ConstraintRows(RowMatrix{{0, 1}, {1, 1}}),
                                                Vector{{0.0, 0.0}},
                                                {}}));
  return scenes;
}

std::vector<Scene> infeasible_scenes() { return {of_file("jammed_seesaw"), of_file("squeezed_pistons")}; }

struct Planted {
  const char* what;
  void (*plant)(const NearestPointProblem&, GaussSolution&);
  std::vector<std::string> caught_by;
};

/// A row that is held with a push.
Index loaded(const GaussSolution& solution) {
  Index a = 0;
  solution.multipliers.least_norm.cwiseAbs().maxCoeff(&a);
  return a;
}

/// q'' moved against the row with the largest push, by a millionth of what there is.
void move_into_a_contact(const NearestPointProblem& problem, GaussSolution& solution) {
  const Index a = loaded(solution);
  const Vector step = problem.A.solve(problem.U.row(a));
  const double size = std::max(solution.primal.acceleration_norm, solution.primal.force_norm);
  const double sign = solution.multipliers.least_norm[a] > 0 ? 1 : -1;
  solution.primal.q -= sign * 1e-6 * size / problem.A.norm(step) * step;
}

const Planted table[] = {
    {"an acceleration into a contact",
     move_into_a_contact,
     {"u_a.q'' >= s_a", "A q'' = z +", "z = x + y", "lambda_a (u_a.q''"}},
    {"a multiplier that pulls",
     [](const NearestPointProblem& problem, GaussSolution& solution) {
       for (Index a = 0; a < problem.rows(); ++a)
         if (std::find(problem.two_sided.begin(), problem.two_sided.end(), a) == problem.two_sided.end())
           solution.multipliers.least_norm[a] = -1e-6 * solution.multipliers.least_norm.cwiseAbs().maxCoeff();
     },
     {"lambda_a >= 0"}},
    {"a reaction in another direction",
     [](const NearestPointProblem&, GaussSolution& solution) {
       solution.reaction = -solution.reaction;
       solution.multipliers.least_norm *= 1.5;
     },
     {"A q'' = z +", "conjugacy f(x) + g(y)"}},
    {"a reaction off by a millionth in one coordinate",
     [](const NearestPointProblem& problem, GaussSolution& solution) {
       solution.reaction[0] += 1e-6 * std::sqrt(problem.A.diagonal()[0]) *
                               std::max(solution.primal.acceleration_norm, solution.primal.force_norm);
     },
     {"R is the sum of lambda_a u_a"}},
    {"the free acceleration",
     [](const NearestPointProblem& problem, GaussSolution& solution) {
       solution.primal.q = problem.A.solve(problem.z);
     },
     {"no other force of the contacts", "conjugacy f(x) + g(y)"}},
    {"an acceleration that overshoots",
     [](const NearestPointProblem& problem, GaussSolution& solution) {
       const Vector free = problem.A.solve(problem.z);
       solution.primal.q += solution.primal.q - free;
     },
     {"no other acceleration that the contacts allow", "no other force of the contacts"}},
};

const Planted farkas_table[] = {
    {"a weight of the wrong sign",
     [](const NearestPointProblem&, GaussSolution& solution) { solution.primal.farkas[0] *= -1; },
     {"the Farkas weights w are >= 0"}},
    {"a weight off by a millionth",
     [](const NearestPointProblem&, GaussSolution& solution) { solution.primal.farkas[0] *= 1 + 1e-6; },
     {"w.U = 0"}},
    {"no weights",
     [](const NearestPointProblem&, GaussSolution& solution) { solution.primal.farkas.setZero(); },
     {"w.s > 0"}},
};

std::set<std::string> names(const LawReport& report, bool failed_only) {
  std::set<std::string> found;
  for (const Check& check : report.checks)
    if (!failed_only || !check.passed) found.insert(check.name);
  return found;
}

template <class Table>
void check_table(const std::vector<Scene>& scenes, const Table& planted_errors) {
  for (const Scene& right : scenes) {
    CAPTURE(right.name);
    const LawReport of_right = mechanics::gauss_laws(right.problem, right.solution);
    INFO(of_right.text());
    CHECK(of_right.all_passed());
    std::set<std::string> uncaught = names(of_right, false);
    for (const Planted& error : planted_errors) {
      CAPTURE(error.what);
      GaussSolution wrong = right.solution;
      error.plant(right.problem, wrong);
      const std::set<std::string> failed = names(mechanics::gauss_laws(right.problem, wrong), true);
      CHECK_FALSE(failed.empty());
      for (const std::string& law : error.caught_by)
        for (const std::string& name : failed)
          if (name.rfind(law, 0) == 0) uncaught.erase(name);
    }
    for (const std::string& law : uncaught) FAIL_CHECK("no planted error is caught by: " << law);
  }
}

}  // namespace

TEST_CASE("for every law of contacts there is an error that it catches, on every kind of scene") {
  check_table(solved_scenes(), table);
}

TEST_CASE("for every law of an infeasible problem there is an error that it catches") {
  check_table(infeasible_scenes(), farkas_table);
}

TEST_CASE(
    "weights that combine a row and its multiple to their rounding alone do not pass as a contradiction") {
  const double pi = std::numbers::pi, multiple = 1e3 * pi;
  const Eigen::RowVector3d first(pi, std::sqrt(2), 0.3);
  const Eigen::RowVector3d turned = first + 1e-4 * Eigen::RowVector3d(std::sqrt(2), std::cos(2), 0);
  RowMatrix U(3, 3);
  U << first, multiple * turned, turned;
  NearestPointProblem problem{convex::Metric::diagonal(Eigen::Vector3d(1, 1, 1e6)),
                              Vector::Zero(3),
                              convex::ConstraintRows(U),
                              Eigen::Vector3d(-2, multiple * 2 * std::sqrt(7), 2 * std::sqrt(7)),
                              {0, 2}};
  problem.radii = convex::rounding_radii(problem, 1);
  const Eigen::Vector3d seeming(-1, 124824608.59130849, -392148073336.67615);
  CHECK_FALSE(mechanics::farkas_laws(problem, seeming).all_passed());
  problem.s[1] *= 1 + 1e-6;  // now the multiple does contradict its row
  const Eigen::Vector3d weights(0, 1, -multiple);
  CHECK(mechanics::farkas_laws(problem, weights).all_passed());
}

TEST_CASE("no law fails the weights of a contradiction because its bounds are far below others") {
  // 3 c_0 + c_1 is 0 >= 1.8e-315, beside a bound of 1e10.
  RowMatrix U(3, 2);
  U << -1, -1, 3, 3, -2, -3;
  const NearestPointProblem problem{convex::Metric::diagonal(Vector{{5, 5}}),
                                    Vector{{5e-10, 8e-10}},
                                    convex::ConstraintRows(U),
                                    Vector{{1e-300, -2.999999999999998e-300, 1e10}},
                                    {}};
  const GaussSolution solution = mechanics::solve(problem, {});
  REQUIRE(solution.primal.status == convex::Status::infeasible);
  const LawReport report = mechanics::gauss_laws(problem, solution);
  INFO(report.text());
  CHECK(report.all_passed());
  GaussSolution wrong = solution;
  wrong.primal.farkas[1] *= 1 + 1e-9;
  CHECK_FALSE(mechanics::gauss_laws(problem, wrong).all_passed());
}

TEST_CASE("no law fails a right answer because A is ill-conditioned") {
  for (const double apart : {1e-1, 1e-3, 1e-5}) {
    CAPTURE(apart);
    convex::Matrix A = convex::Matrix::Constant(3, 3, 1e4);
    A.diagonal().array() += apart;
    for (const double s : {-1.0, 2.0}) {
      const NearestPointProblem problem{convex::Metric::dense(A),
                                        Eigen::Vector3d(0.3, -0.7, 0.2),
                                        convex::ConstraintRows(RowMatrix(Eigen::RowVector3d(1, 0.3, -2))),
                                        Vector::Constant(1, s),
                                        {}};
      const GaussSolution solution = mechanics::solve(problem);
      REQUIRE(solution.primal.status == convex::Status::solved);
      const LawReport report = mechanics::gauss_laws(problem, solution);
      CHECK(report.checks.size() >= 7);
      CHECK(report.all_passed());
    }
  }
}

TEST_CASE("a wrong acceleration does not pass because the dual was asked with it") {
  for (const Scene& right : solved_scenes()) {
    CAPTURE(right.name);
    GaussSolution wrong = right.solution;
    move_into_a_contact(right.problem, wrong);
    wrong.hypothesis = mechanics::hypothesis(right.problem, wrong.primal, 1e-9);
    wrong.from_dual.reset();
    bool caught = false;
    for (const Check& check : mechanics::gauss_laws(right.problem, wrong).checks)
      caught = caught || (check.name.rfind("z = x + y", 0) == 0 && !check.passed);
    CHECK(caught);
  }
}
