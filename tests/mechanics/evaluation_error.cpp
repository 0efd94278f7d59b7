#include "mechanics/evaluation_error.hpp"

#include <doctest/doctest.h>

#include <cmath>

#include "mechanics/gauss_problem.hpp"
#include "tests/mechanics/system_text.hpp"

using convex::Index;
using convex::Status;
using convex::Vector;

namespace {

struct Answer {
  convex::Solution primal;
  convex::NearestPointProblem problem;
};

Answer answer_of(const tests::SystemText& text, const mechanics::StateText& state) {
  const mechanics::WrittenMechanism written = mechanics::written_mechanism(tests::system(text), state);
  const auto m = static_cast<Index>(written.system->constraints().size());
  const mechanics::GaussProblem gauss = mechanics::gauss_problem(written, Vector::Constant(m, 1e-9));
  convex::Solution primal = mechanics::solve(gauss.problem, {}).primal;
  mechanics::count_evaluation_error(
      primal, mechanics::evaluation_error(written, gauss.contacts.present, {}, gauss.problem, primal, {}),
      {});
  return {std::move(primal), gauss.problem};
}

/// Two light masses e that a rod of mass 1 nearly holds together, x + a = const, and others between them.
tests::SystemText light_pair(const std::string& e, int between) {
  std::vector<std::string> coordinates{"x"};
  std::string kinetic = e + "/2*x'^2 + " + e + "/2*a'^2 + 1/2*(2*x' + 2*a')^2";
  for (int k = 0; k < between; ++k) {
    coordinates.push_back("y" + std::to_string(k));
    kinetic += " + 0.1/2*y" + std::to_string(k) + "'^2";
  }
  coordinates.emplace_back("a");
  return {coordinates, kinetic, "a", {}, {}, {}, {}};
}

mechanics::StateText at_rest(const tests::SystemText& text) {
  std::vector<std::pair<std::string, std::string>> zeros;
  for (const std::string& q : text.coordinates) zeros.emplace_back(q, "0");
  return tests::state_text(zeros);
}

}  // namespace

TEST_CASE("the bound counts what the rounding of A moves, whichever coordinates are coupled") {
  for (const char* e : {"1e-4", "1e-8", "1e-11", "1e-13"})
    for (int between = 0; between <= 4; ++between) {
      CAPTURE(std::string(e));
      CAPTURE(between);
      const tests::SystemText text = light_pair(e, between);
      const Answer found = answer_of(text, at_rest(text));
      // A = e + 4 (1 1; 1 1) in x and a, and the force -1 at a: by Cramer's rule.
      const long double eps = std::stold(e), x = 4 / (eps * (8 + eps)), a = -(4 + eps) / (eps * (8 + eps));
      const Vector& q = found.primal.q;
      const long double dx = static_cast<long double>(q[0]) - x,
                        da = static_cast<long double>(q[q.size() - 1]) - a;
      const long double off = std::sqrt(eps * (dx * dx + da * da) + 4 * (dx + da) * (dx + da));
      CHECK(found.primal.error_bound >= static_cast<double>(off) * (1 - 1e-9));
      // Half a rounding of 4 beside e, a few times over.
      CHECK(found.primal.error_bound <=
            1e-14 * static_cast<double>(1 / eps) * found.primal.acceleration_norm);
      if (found.primal.status == Status::solved)
        CHECK(off <= 1e-9L * std::max(1.0L, static_cast<long double>(found.primal.acceleration_norm)));
    }
}

TEST_CASE("a contact that presses by less than A tells may open: the bound says how far") {
  // x'' is 5.0e12 without the stop, which asks for 5.01e12 and less: it is apart, as written.
  tests::SystemText text = light_pair("1e-13", 1);
  text.constraints = {{"stop", "x <= 2.505e12*t^2"}};
  const Answer found = answer_of(text, at_rest(text));
  const long double eps = 1e-13L, x = 4 / (eps * (8 + eps));
  CHECK(found.primal.error_bound >=
        std::sqrt(2e-13) * std::abs(found.primal.q[0] - static_cast<double>(x)) * 0.999);
  CHECK(found.primal.status != Status::solved);
}
