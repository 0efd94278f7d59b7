#include "mechanics/proof_as_written.hpp"

#include <doctest/doctest.h>

#include <cmath>

#include "mechanics/evaluation_error.hpp"
#include "mechanics/gauss_problem.hpp"
#include "tests/mechanics/system_text.hpp"

using convex::Index;
using convex::ProofLevel;
using convex::Vector;
using mechanics::CertifiedSolution;
using mechanics::ContactVerdict;

namespace {

struct Asked {
  mechanics::WrittenMechanism written;
  mechanics::GaussProblem gauss;
};

Asked asked(const tests::SystemText& text, const mechanics::StateText& state, double tolerance = 1e-9) {
  mechanics::WrittenMechanism written = mechanics::written_mechanism(tests::system(text), state);
  const auto m = static_cast<Index>(written.system->constraints().size());
  mechanics::GaussProblem gauss = mechanics::gauss_problem(written, Vector::Constant(m, tolerance));
  return {std::move(written), std::move(gauss)};
}

CertifiedSolution certified(const Asked& asked) {
  CertifiedSolution found;
  found.solution = mechanics::solve(asked.gauss.problem, {});
  mechanics::prove_as_written(found, asked.gauss.problem, asked.written, asked.gauss.contacts.present, {});
  return found;
}

/// Of a method that was named: it keeps its own answer, whatever the text says.
mechanics::GaussOptions named_method() {
  mechanics::GaussOptions options;
  options.method = convex::find_method("active-set");
  return options;
}

/// A mass at the height y over the floor, pushed down or lifted.
CertifiedSolution over_the_floor(const std::string& y, const std::string& weight = "9.81",
                                 const std::string& floor = "y >= 0") {
  return certified(asked({{"x", "y"}, "(x'^2 + y'^2)/2", weight + "*y", {}, {}, {}, {{"floor", floor}}},
                         tests::state_text({{"x", "0"}, {"y", y}})));
}

tests::SystemText pendulum(const std::string& centre) {
  return {{"x", "y"},
          "(x'^2 + y'^2)/2",
          "9.81*y",
          {{"c", centre}, {"a", "0.3"}},
          {},
          {},
          {{"rod", "(x - c)^2 + (y - c)^2 = 1"}}};
}

}  // namespace

TEST_CASE("a contact that is open as written is not certified as one, however small its gap") {
  for (const char* gap :
       {"1e-10", "1e-300", "1/3 - 0.3333333333", "sqrt(2) - 1.4142135623730950488016887242"}) {
    CAPTURE(std::string(gap));
    const CertifiedSolution found = over_the_floor(gap);
    CHECK(found.certificate.level == ProofLevel::none);
    CHECK(found.text->refuted == std::vector<Index>{0});
    CHECK_FALSE(found.text->contacts_hold);
    CHECK_FALSE(found.text->error_bound.value_or(0) < 1);
  }
  const CertifiedSolution touching = over_the_floor("0");
  CHECK(touching.certificate.level == ProofLevel::exact);
  CHECK(touching.text->contacts_hold);
  CHECK(touching.certificate.error_bound == 0);
}

TEST_CASE("a contact that opens anyway is certified whether it touches as written or not") {
  for (const char* floor : {"y >= 0", "y >= sin(1.4) - 2*sin(0.7)*cos(0.7)"})
    for (const char* y : {"0", "1e-10"}) {
      CAPTURE(std::string(floor));
      CAPTURE(std::string(y));
      const CertifiedSolution found = over_the_floor(y, "-9.81", floor);
      CHECK(found.certificate.level == ProofLevel::exact);
      CHECK(found.certificate.error_bound <= 1e-15);
      CHECK(found.certificate.error_bound >=
            std::abs(convex::nearest_double(convex::fraction(9.81) - convex::Fraction{981, 100})));
    }
}

TEST_CASE("a contact that the coordinates do not enter asks nothing, and the answer is proved beside it") {
  for (const char* floor : {"0 >= 0", "t^2 >= 0"}) {
    CAPTURE(std::string(floor));
    const CertifiedSolution found = over_the_floor("1", "9.81", floor);
    CHECK(found.text->vanishing.empty());
    CHECK(found.certificate.level == ProofLevel::exact);
  }
  const CertifiedSolution vanishing = over_the_floor("0", "9.81", "y^3 >= 0");
  CHECK(vanishing.text->vanishing == std::vector<Index>{0});
  CHECK(vanishing.certificate.level == ProofLevel::none);
}

TEST_CASE("a contact whose gradient is 0 is certified where second derivatives open it") {
  for (const auto& [y, floor] :
       {std::pair{"0", "(y - t)^2 >= 0"}, std::pair{"sqrt(2)", "(y^2 - 2 - t)^2 >= 0"}}) {
    CAPTURE(std::string(floor));
    const CertifiedSolution found = over_the_floor(y, "9.81", floor);
    CHECK(found.text->vanishing.empty());
    CHECK(found.certificate.level == ProofLevel::exact);
  }
}

TEST_CASE("where the text leaves a contact open, and it matters, nothing is certified") {
  const CertifiedSolution found = over_the_floor("0", "9.81", "y >= sin(1.4) - 2*sin(0.7)*cos(0.7)");
  CHECK(found.text->open == std::vector<Index>{0});
  CHECK(found.certificate.level == ProofLevel::none);
}

TEST_CASE("a state that penetrates as written is not certified") {
  const CertifiedSolution found = over_the_floor("-1e-10");
  CHECK(found.text->violated == std::vector<Index>{0});
  CHECK(found.certificate.level == ProofLevel::none);
}

TEST_CASE("the bound of a spoilt answer is at least its error") {
  const Asked question = asked(pendulum("0"), tests::state_text({{"x", "sin(a)"}, {"y", "-cos(a)"}}));
  CertifiedSolution found;
  found.solution = mechanics::solve(question.gauss.problem, {});
  found.solution.primal.q[0] += 1e-6;
  CertifiedSolution replaced = found;
  mechanics::prove_as_written(found, question.gauss.problem, question.written,
                              question.gauss.contacts.present, named_method());
  CHECK(found.certificate.error_bound >= 1e-6 * (1 - 1e-6));
  CHECK(found.solution.primal.status == convex::Status::inaccurate);
  // Where the method was left to the program, the answer becomes that of the text.
  mechanics::prove_as_written(replaced, question.gauss.problem, question.written,
                              question.gauss.contacts.present, {});
  CHECK(replaced.solution.primal.status == convex::Status::solved);
  CHECK(replaced.certificate.error_bound <= 1e-15);
  CHECK((found.solution.primal.q - replaced.solution.primal.q).norm() >= 1e-6 * (1 - 1e-6));
}

TEST_CASE("a two-sided constraint holds by declaration: the bound covers the state at which it does") {
  // The nearest state on the circle is radial from the one typed, and the velocity loses its radial part.
  // There q'' = -g e_2·t t - |v|² q, t the tangent: the pendulum's equation.
  struct Typed {
    const char *x, *y, *x1, *y1;
    bool is_another_state;
  };
  for (const Typed& typed : {Typed{"0.2955202067", "-0.9553364891", "1.9106729783", "0.5910404133", true},
                             {"0.29552020666", "-0.95533648913", "1.91067297825", "0.59104041332", true},
                             {"0.295520206661339575", "-0.955336489125606020", "1.91067297825121204",
                              "0.591040413322679150", false}}) {
    CAPTURE(std::string(typed.x));
    const CertifiedSolution found =
        certified(asked(pendulum("0"), tests::state_text({{"x", typed.x}, {"y", typed.y}},
                                                         {{"x", typed.x1}, {"y", typed.y1}})));
    REQUIRE(found.certificate.level == ProofLevel::enclosure);
    const double x = std::stod(typed.x), y = std::stod(typed.y), r = std::hypot(x, y), g = 9.81;
    const double speed = (std::stod(typed.y1) * x - std::stod(typed.x1) * y) / r;
    const Eigen::Vector2d truth(g * x * y / r / r - speed * speed * x / r,
                                -g * x * x / r / r - speed * speed * y / r);
    const double off = (found.solution.primal.q - truth).norm();
    CHECK(found.certificate.error_bound + 1e-14 >= off);
    CHECK(found.certificate.error_bound <= 1e-8);
    if (typed.is_another_state) CHECK(off > 1e-12);
  }
}

TEST_CASE("the estimate of a plain answer covers the rounding of A, z, U, s, and does not exaggerate it") {
  for (const char* centre : {"0", "1", "1e3", "1e6", "1e8/3"}) {
    CAPTURE(std::string(centre));
    const Asked question = asked(
        pendulum(centre),
        tests::state_text({{"x", "c + sin(a)"}, {"y", "c - cos(a)"}}, {{"x", "2*cos(a)"}, {"y", "2*sin(a)"}}),
        1e-6);
    convex::Solution plain = mechanics::solve(question.gauss.problem, {}).primal;
    CertifiedSolution proof;
    proof.solution.primal = plain;
    proof.solution.multipliers.least_norm = plain.lambda;
    mechanics::prove_as_written(proof, question.gauss.problem, question.written,
                                question.gauss.contacts.present, named_method());
    REQUIRE(proof.certificate.level == ProofLevel::enclosure);
    const double truth =
        proof.certificate.error_bound;  // to 28 digits, see tests/mechanics/proof_from_text.cpp
    const double estimate = mechanics::evaluation_error(question.written, question.gauss.contacts.present, {},
                                                        question.gauss.problem, plain, {});
    CHECK(plain.error_bound + estimate >= truth);
    CHECK(estimate <= 200 * truth + 1e-14);
    mechanics::count_evaluation_error(plain, estimate, {});
    CHECK(plain.error_bound >= truth);
    CHECK((plain.status == convex::Status::solved) ==
          (plain.error_bound <= 1e-9 * std::max(1.0, plain.acceleration_norm)));
  }
}

TEST_CASE("systems too large for fractions are certified in doubles, with K proved one by one") {
  tests::SystemText stack{{"x[1..N]"},
                          "sum(i in 1..N, m/2*x[i]'^2)",
                          "",
                          {{"N", "90"}, {"m", "1.1"}, {"r", "0.3"}},
                          {},
                          {{"x[i]", "-m*9.81"}},
                          {{"floor", "x[1] >= r"}, {"gap[i in 1..N-1]", "x[i+1] - x[i] >= 2*r"}}};
  const CertifiedSolution at_rest = certified(asked(stack, tests::state_text({{"x[i]", "r + 2*r*(i-1)"}})));
  CHECK(at_rest.certificate.level == ProofLevel::enclosure);
  CHECK(at_rest.text->contacts_hold);
  CHECK(at_rest.certificate.error_bound <= 1e-10);
  CHECK(at_rest.certificate.error_bound > 0);
  // One body a little higher than its place.
  const CertifiedSolution lifted = certified(
      asked(stack, tests::state_text({{"x[i]", "r + 2*r*(i-1)"}, {"x[90]", "r + 2*r*89 + 1e-10"}})));
  CHECK(lifted.certificate.level == ProofLevel::none);
  CHECK(lifted.text->refuted.size() == 1);
}

namespace {

/// A rod written twice, in two ways, at the angle a.
Asked doubled_rod(const std::string& angle, const std::string& second = "sqrt(x^2 + y^2) = 1") {
  return asked({{"x", "y"},
                "(x'^2 + y'^2)/2",
                "9.81*y",
                {{"a", angle}},
                {},
                {},
                {{"rod", "x^2 + y^2 = 1"}, {"again", second}}},
               tests::state_text({{"x", "sin(a)"}, {"y", "-cos(a)"}}));
}

/// -g sin(a) along the circle.
Vector of_a_pendulum(double a) { return -9.81 * std::sin(a) * Vector{{std::cos(a), std::sin(a)}}; }

}  // namespace

TEST_CASE("a rod written twice stays redundant, and a proof that is not found changes nothing") {
  for (const double angle : {0.7, 1.1, 0.123, 2.4}) {
    CAPTURE(angle);
    const Asked question = doubled_rod(std::to_string(angle));
    const mechanics::GaussSolution plain = mechanics::solve(question.gauss.problem, {});
    const CertifiedSolution found = certified(question);
    CHECK(found.certificate.level == ProofLevel::none);
    CHECK(found.text->dependent.size() == 1);
    CHECK(found.solution.primal.status == plain.primal.status);
    CHECK(found.solution.primal.q == plain.primal.q);
    CHECK_FALSE(found.solution.multipliers.unique);
    CHECK((plain.primal.q - of_a_pendulum(angle)).norm() <= 1e-14);
  }
}

TEST_CASE("a one-sided row beside a two-sided one that says the same by exp counts as dependent") {
  for (const char* side : {"y + u/10 >= 11/100", "y + u/10 <= 11/100"})
    for (const char* same : {"exp(0.8*y + 0.08*u) = exp(0.088)", "exp(-0.7*y - 0.07*u) = exp(-0.077)"})
      for (const double pull : {2.7237, -2.7237, 0.0}) {
        CAPTURE(std::string(side));
        CAPTURE(std::string(same));
        CAPTURE(pull);
        const Asked question = asked({{"y", "u"},
                                      "y'^2/2 + u'^2/4",
                                      "",
                                      {},
                                      {},
                                      {{"u", std::to_string(pull)}},
                                      {{"side", side}, {"same", same}}},
                                     tests::state_text({{"y", "0.1"}, {"u", "0.1"}}));
        const CertifiedSolution found = certified(question);
        CHECK(found.solution.primal.status == convex::Status::solved);
        CHECK_FALSE(found.solution.multipliers.unique);
        CHECK(found.certificate.level == ProofLevel::none);
        // Along y = -u/10: (1/100 + 1/2) u'' = pull.
        const double u = pull / 0.51;
        CHECK((found.solution.primal.q - Vector{{-u / 10, u}}).norm() <= 1e-14 * (1 + std::abs(u)));
      }
}

TEST_CASE("a rod written twice at a rational angle is proved in fractions") {
  for (const char* angle : {"asin(3/5)", "asin(5/13)", "asin(-7/25)"}) {
    CAPTURE(std::string(angle));
    const CertifiedSolution found = certified(doubled_rod(angle));
    CHECK(found.certificate.level == ProofLevel::exact);
    CHECK(found.certificate.error_bound <= 1e-14);
    CHECK(found.solution.primal.status == convex::Status::solved);
    CHECK_FALSE(found.solution.multipliers.unique);
    const double sine = std::string(angle) == "asin(3/5)"    ? 0.6
                        : std::string(angle) == "asin(5/13)" ? 5 / 13.0
                                                             : -0.28;
    CHECK((found.solution.primal.q - of_a_pendulum(std::asin(sine))).norm() <= 1e-14);
  }
}

TEST_CASE("a rod written twice with two lengths in time contradicts itself as written") {
  for (const char* rate : {"t^2", "1e-9*t^2", "1e-30*t^2"}) {
    CAPTURE(std::string(rate));
    const CertifiedSolution found =
        certified(doubled_rod("asin(3/5)", std::string("sqrt(x^2 + y^2) = 1 + ") + rate));
    CHECK(found.solution.primal.status == convex::Status::infeasible);
    CHECK(found.certificate.level == ProofLevel::exact);
  }
}

TEST_CASE(
    "rows carry the radii of their evaluation, 0 where they are exact, and none where forces are, too") {
  const auto radii = [](const std::string& floor, const std::string& x, const std::string& potential) {
    return asked({{"x", "y"}, "(x'^2 + y'^2)/2", potential, {}, {}, {}, {{"floor", floor}}},
                 tests::state_text({{"x", x}, {"y", "0"}}))
        .gauss.problem.radii;
  };
  for (const auto& [floor, x] :
       {std::pair{"y >= x", "0"}, {"y >= 0.5*x", "0"}, {"y >= x*(x - 0.25)", "0.25"}}) {
    CAPTURE(std::string(floor));
    CHECK_FALSE(radii(floor, x, "9.75*y"));
    const auto of_rounded_force = radii(floor, x, "9.81*y");
    REQUIRE(of_rounded_force);
    CHECK(of_rounded_force->is_zero());
  }
  const auto rounded = radii("y >= 0.1*x", "0", "9.81*y");
  REQUIRE(rounded);
  // 0.1 is off by 5.551115123125783e-18.
  CHECK(rounded->row[0] >= 5.551115123125783e-18);
  CHECK(rounded->row[0] <= 1e-16);
  CHECK(rounded->s[0] == 0);
}
