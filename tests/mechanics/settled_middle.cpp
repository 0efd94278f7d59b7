#include "mechanics/settled_middle.hpp"

#include <doctest/doctest.h>

#include "mechanics/gauss_problem.hpp"
#include "mechanics/proof_as_written.hpp"
#include "tests/mechanics/system_text.hpp"

using convex::Fraction;
using convex::Index;
using convex::Matrix;
using convex::RowMatrix;
using convex::Vector;

namespace {

using Rows = std::vector<std::vector<Fraction>>;

/// Of the unit metric, every number of U and s within the radius of the row.
convex::UncertainProblem uncertain(const Rows& rows, const std::vector<Fraction>& s, const Vector& radius,
                                   const std::vector<Index>& two_sided) {
  const auto n = static_cast<Index>(rows[0].size());
  convex::ExactRows U;
  for (const auto& row : rows) U.push_back(convex::exact_vector(row));
  return {convex::exact_problem(convex::exact_rows(Matrix::Identity(n, n)),
                                convex::exact_vector(Vector(Vector::Zero(n))), U, convex::exact_vector(s),
                                two_sided),
          Matrix::Zero(n, n), Vector::Zero(n), radius * Eigen::RowVectorXd::Ones(n), radius};
}

Fraction off(std::int64_t whole, double by) { return Fraction{whole, 1} + convex::fraction(by); }

/// w·(u_1 … u_m, s) = 0.
bool cancel(const convex::ExactProblem& problem, const std::vector<std::int64_t>& w) {
  for (Index i = 0; i <= problem.dimension(); ++i) {
    Fraction sum{};
    for (std::size_t a = 0; a < w.size(); ++a)
      sum = sum +
            Fraction{w[a], 1} * Fraction{i < problem.dimension() ? problem.U[a][convex::at(i)] : problem.s[a],
                                         problem.row_unit[a]};
    if (convex::sign(sum) != 0) return false;
  }
  return true;
}

/// Of a unit mass in the plane, at rest at 0.
mechanics::CertifiedSolution certified(const tests::Lines& constraints, const tests::Lines& forces) {
  const mechanics::WrittenMechanism written = mechanics::written_mechanism(
      tests::system({{"x", "y"}, "(x'^2 + y'^2)/2", "", {}, {}, forces, constraints}),
      tests::state_text({{"x", "0"}, {"y", "0"}}));
  const mechanics::GaussProblem gauss =
      mechanics::gauss_problem(written, Vector::Constant(static_cast<Index>(constraints.size()), 1e-9));
  mechanics::CertifiedSolution found;
  found.solution = mechanics::solve(gauss.problem, {});
  mechanics::prove_as_written(found, gauss.problem, written, gauss.contacts.present, {});
  return found;
}

}  // namespace

TEST_CASE("a row that others make up within the radii is made of them, and its bound too where it may be") {
  const Vector radius = Vector::Constant(3, 1e-40);
  const Rows rows{{{1, 1}, {2, 1}, {0, 1}}, {{1, 1}, {2, 1}, off(0, 1e-9)}, {{2, 1}, off(4, 1e-41), {0, 1}}};
  const auto settled = [&](const Fraction& s) {
    return mechanics::settled_middle(uncertain(rows, {{3, 1}, {5, 1}, s}, radius, {0, 1}), {});
  };
  const mechanics::SettledMiddle same = settled(off(6, -1e-41));
  CHECK(same.dependent == std::vector<Index>{2});
  CHECK(cancel(same.problem, {2, 0, -1}));
  const mechanics::SettledMiddle beyond = settled(off(6, -1e-20));
  CHECK(beyond.dependent == std::vector<Index>{2});
  CHECK_FALSE(cancel(beyond.problem, {2, 0, -1}));
}

TEST_CASE("rows that are independent for all numbers within the radii stay as they are") {
  const Vector radius = Vector::Constant(2, 1e-40);
  const auto problem =
      uncertain({{{1, 1}, {2, 1}, {0, 1}}, {{2, 1}, off(4, 1e-30), {0, 1}}}, {{0, 1}, {0, 1}}, radius, {0});
  const mechanics::SettledMiddle settled = mechanics::settled_middle(problem, {});
  CHECK(settled.dependent.empty());
  CHECK(settled.problem.U[1] == problem.middle.U[1]);
}

TEST_CASE(
    "a contact written twice in irrational numbers is not certified to open by the last digit of balls") {
  const std::string twice = "pi*x + y + 1e-8*(x - sqrt(2)*y)";
  const mechanics::CertifiedSolution found =
      certified({{"first", "pi*x + y = 0.3*t^2"},
                 {"second", twice + " >= sin(1)*t^2"},
                 {"again", "sqrt(2)*(" + twice + " - sin(1)*t^2) >= 0"}},
                {{"y", "-9.81"}});
  CHECK(found.certificate.level == convex::ProofLevel::enclosure);
  CHECK(found.solution.multipliers.tight == std::vector<Index>{0, 1, 2});
  CHECK_FALSE(found.solution.multipliers.unique);
  CHECK(found.solution.hypothesis.accepted);
  REQUIRE(found.text);
  CHECK(found.text->dependent.size() == 1);
}

TEST_CASE("where doubles do not solve a mechanism, all that is certified is told from balls") {
  const std::string row = "sqrt(7)*x + sin(1)*y", near = row + " + 1e-7*sqrt(2)*y - sqrt(7)*t^2";
  const mechanics::CertifiedSolution found = certified({{"again", "1e3*pi*(" + near + ") >= 0"},
                                                        {"first", row + " + sqrt(2)*t^2 = 0"},
                                                        {"near", near + " >= 0"}},
                                                       {{"x", "log(3)"}, {"y", "sqrt(2)"}});
  CHECK(found.certificate.level == convex::ProofLevel::enclosure);
  CHECK(found.solution.primal.status == convex::Status::solved);
  CHECK(found.solution.hypothesis.accepted);
}

TEST_CASE("a contact that counts as tight and opens in fractions only touches") {
  const mechanics::CertifiedSolution found =
      certified({{"wall", "x + y >= 0"}}, {{"x", "1"}, {"y", "-0.999999999997"}});
  CHECK(found.certificate.level == convex::ProofLevel::exact);
  CHECK(found.solution.multipliers.tight == std::vector<Index>{0});
  CHECK(found.solution.touching == std::vector<Index>{0});
}
