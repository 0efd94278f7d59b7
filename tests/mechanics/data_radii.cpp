#include "mechanics/data_radii.hpp"

#include <doctest/doctest.h>

#include <random>

#include "convex/nearest_point/proof/exact_method.hpp"
#include "mechanics/exact_text.hpp"
#include "tests/mechanics/system_text.hpp"

using convex::Index;
using convex::Matrix;
using convex::Vector;

namespace {

/// Whether |x - exact| <= radius, and the radius no more than doubles explain.
void check_entry(double x, const convex::Fraction& exact, double ball, double radius, double scale) {
  const double off = std::abs(convex::nearest_double(convex::fraction(x) - exact));
  CHECK(off <= (radius + ball) * (1 + 0x1p-40));
  CHECK(radius <= 1e-11 * scale);
}

void check_against_text(const tests::SystemText& text, const mechanics::StateText& state,
                        const std::vector<Index>& contacts) {
  const auto system = tests::system(text);
  const auto truth = mechanics::problem_from_text(*system, state, contacts);
  REQUIRE(truth);
  const mechanics::State in_doubles = system->state(state);
  const mechanics::Inertia inertia = system->inertia(in_doubles);
  const mechanics::ContactRows rows = system->contact_rows(in_doubles, contacts);
  const convex::EntryRadii radii = mechanics::data_radii(
      *system, in_doubles, mechanics::state_radii(*system, state, in_doubles), contacts);
  const convex::UncertainProblem& exact = truth->problem;
  const Matrix A(inertia.A), A_radius(radii.A);
  const Matrix U(rows.U), U_radius(radii.U);
  const double A_scale = std::max(1.0, A.cwiseAbs().maxCoeff()),
               z_scale = std::max(1.0, inertia.z.cwiseAbs().maxCoeff());
  const auto entry = [](const convex::Integer& p, const convex::Integer& q) {
    return convex::Fraction{p, q};
  };
  for (std::size_t i = 0; i < exact.middle.z.size(); ++i) {
    const auto r = static_cast<Index>(i);
    check_entry(inertia.z[r], entry(exact.middle.z[i], exact.middle.unit), exact.z[r], radii.z[r], z_scale);
    for (std::size_t j = 0; j < exact.middle.z.size(); ++j) {
      const auto c = static_cast<Index>(j);
      check_entry(A(r, c), entry(exact.middle.A[i][j], exact.middle.unit), exact.A(r, c), A_radius(r, c),
                  A_scale);
    }
  }
  for (std::size_t k = 0; k < contacts.size(); ++k) {
    const auto r = static_cast<Index>(k);
    const double scale = std::max(1.0, U.row(r).cwiseAbs().maxCoeff() + std::abs(rows.s[r]));
    check_entry(rows.s[r], entry(exact.middle.s[k], exact.middle.row_unit[k]), exact.s[r], radii.s[r], scale);
    for (std::size_t i = 0; i < exact.middle.z.size(); ++i) {
      const auto c = static_cast<Index>(i);
      check_entry(U(r, c), entry(exact.middle.U[k][i], exact.middle.row_unit[k]), exact.U(r, c),
                  U_radius(r, c), scale);
    }
  }
}

}  // namespace

TEST_CASE(
    "the numbers of the mechanism as written lie within the radii, for every function of the language") {
  const std::vector<std::string> functions{
      "sin(u)",  "cos(u)",    "tan(u)",       "asin(u/9)", "acos(u/9)", "atan(u)",     "atan2(u, w)",
      "sinh(u)", "cosh(u)",   "tanh(u)",      "exp(u)",    "log(u)",    "sqrt(u)",     "abs(-u)",
      "u^w",     "u^0.5",     "u^-1.5",       "u^0.3",     "u^2",       "2^w",         "u/w",
      "u*w*pi",  "u^70/1e20", "atan2(w, -u)", "u^3",       "(-u)^5",    "1/(u - 0.1)", "0.1*u + 0.7*w"};
  std::mt19937 generator(4);
  std::uniform_real_distribution<double> uniform(0.3, 2.2);
  for (const std::string& function : functions)
    for (int trial = 0; trial < 6; ++trial) {
      CAPTURE(function);
      CAPTURE(trial);
      const tests::SystemText text{{"u", "w"},
                                   "u'^2 + w'^2/2 + (" + function + ")'^2/2 + u'*(" + function + ")",
                                   "(" + function + ")*w",
                                   {{"k", "1/3"}},
                                   {},
                                   {{"u", "k*(" + function + ")"}},
                                   {{"wall", "(" + function + ") + w*t >= -1e30"}}};
      const auto number = [&] { return std::to_string(uniform(generator)); };
      check_against_text(text,
                         tests::state_text({{"u", number()}, {"w", number() + "*k"}},
                                           {{"u", number()}, {"w", "-" + number()}}, "0.25"),
                         {0});
    }
}

TEST_CASE("what doubles hold exactly has radius 0, and a decimal that they do not hold has half an ulp") {
  const tests::SystemText text{{"x", "y"},
                               "m/2*(x'^2 + y'^2) + x'*y'/4",
                               "m*9.75*y",
                               {{"m", "2"}},
                               {},
                               {{"x", "-3*x'"}},
                               {{"floor", "y + 2*x >= 0"}, {"slope", "0.1*x + y >= -10"}}};
  const auto system = tests::system(text);
  const mechanics::StateText written = tests::state_text({{"x", "1"}, {"y", "0.5"}}, {{"x", "-0.25"}});
  const mechanics::State state = system->state(written);
  const mechanics::StateRadii at = mechanics::state_radii(*system, written, state);
  CHECK(mechanics::data_radii(*system, state, at, {0}).is_zero());
  const convex::EntryRadii slope = mechanics::data_radii(*system, state, at, {1});
  CHECK(slope.U.coeff(0, 0) >= 0x1p-58);
  CHECK(slope.U.coeff(0, 0) <= 0x1p-56);
  CHECK(slope.U.coeff(0, 1) == 0);
  const mechanics::StateText decimal = tests::state_text({{"x", "0.1"}, {"y", "sqrt(2)"}});
  const mechanics::StateRadii off = mechanics::state_radii(*system, decimal, system->state(decimal));
  CHECK(off.q[0] >= std::abs(convex::nearest_double(convex::fraction(0.1) - convex::Fraction{1, 10})));
  CHECK(off.q[0] <= 0x1p-56);
  CHECK(off.q[1] > 0);
  CHECK(off.v.isZero(0));
}

TEST_CASE("a number that the state's radii may turn into a kink or a pole is known to nothing") {
  const auto radius_of = [](const std::string& force, double x) {
    const tests::SystemText text{{"x"}, "x'^2/2", "", {}, {}, {{"x", force}}, {}};
    const auto system = tests::system(text);
    mechanics::StateRadii radii{0, Vector::Constant(1, 1e-3), Vector::Zero(1)};
    return mechanics::data_radii(*system, tests::state({x}, {0}), radii, {}).z[0];
  };
  CHECK(radius_of("1/x", 1e-4) == INFINITY);
  CHECK(radius_of("log(x)", 1e-4) == INFINITY);
  CHECK(radius_of("1/x", 1) >= 1e-3);
  CHECK(radius_of("1/x", 1) <= 1.1e-3);
  CHECK(radius_of("abs(x)", 1e-4) <= 1.1e-3);
  CHECK(radius_of("abs(x)'", 1e-4) == INFINITY);
}

TEST_CASE(
    "at a knot of decimals the text tells which piece a table takes, and rounding alone is in the radii") {
  const char* const track = "y - table(x, [0.5, 1.7, 2, 3], [1.57, 0.1, 0.24, -1.06]) >= 0";
  const tests::SystemText text{{"x", "y"}, "(x'^2 + y'^2)/2", "9.81*y + sin(x)", {}, {},
                               {},         {{"track", track}}};
  const auto system = tests::system(text);
  const mechanics::StateText written = tests::state_text({{"x", "1.7"}, {"y", "0.1"}}, {{"x", "1"}});
  const mechanics::State state = system->state(written);
  const convex::EntryRadii radii =
      mechanics::data_radii(*system, state, mechanics::state_radii(*system, written, state), {0});
  CHECK(radii.U.coeff(0, 0) <= 1e-14);
  CHECK(radii.s[0] <= 1e-14);
  // Of a state without its text it is one piece or the other.
  const convex::EntryRadii guessed =
      mechanics::data_radii(*system, state, mechanics::guessed_radii(state), {0});
  CHECK(guessed.U.coeff(0, 0) >= 0.1);
}

TEST_CASE("the pieces of a table of decimals are fractions, and what stands at a knot is proved") {
  // h = 0.1, 0.2 and chords 1, -1/2: 2 (h_0 + h_1) M_1 = 6 (-1/2 - 1), M_1 = -15; the slope at 0.1 is
  // 1 + h_0 M_1/3 = 1/2.
  const tests::SystemText text{{"x", "y"},
                               "(x'^2 + y'^2)/2",
                               "10*y",
                               {},
                               {},
                               {},
                               {{"track", "y >= table(x, [0, 0.1, 0.3], [0, 0.1, 0])"}}};
  const auto system = tests::system(text);
  const auto found =
      mechanics::problem_from_text(*system, tests::state_text({{"x", "0.1"}, {"y", "0.1"}}, {}), {0});
  REQUIRE(found);
  CHECK(found->is_exact);
  const convex::IntegerVector& row = found->problem.middle.U[0];
  CHECK(row[1] == -2 * row[0]);
}
