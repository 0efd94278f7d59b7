#include <doctest/doctest.h>

#include <cmath>

#include "mechanics/exact_text.hpp"
#include "tests/mechanics/system_text.hpp"

using namespace tests;
using mechanics::ContactVerdict;

namespace {

/// A crank of radius 3 and a rod of length 5.
const SystemText crank{{"a", "x"},
                       "(a'^2 + x'^2)/2",
                       "",
                       {{"r", "3"}, {"l", "5"}},
                       {{"pin", "r*cos(a)"}, {"piston", "pin + sqrt(l^2 - (r*sin(a))^2)"}},
                       {},
                       {{"rod", "(x - r*cos(a))^2 + (r*sin(a))^2 = l^2"}}};

}  // namespace

TEST_CASE("a state may use definitions, coordinates that it gives and derivatives, in any order") {
  const auto s = system(crank);
  const mechanics::State at =
      s->state(state_text({{"x", "piston"}, {"a", "0.7 + t"}}, {{"x", "piston'"}, {"a", "2*x/x"}}, "0.1"));
  CHECK(at.q[0] == 0.7 + 0.1);
  CHECK(at.v[0] == 2);
  const mechanics::ConstraintRates rates = s->constraint_rates(at);
  CHECK(std::abs(rates.f[0]) <= 1e-14);
  CHECK(std::abs(rates.df[0]) <= 1e-13);
}

TEST_CASE("what a state says of a contact is seen without rounding") {
  const auto s = system({{"x", "y"}, "(x'^2 + y'^2)/2", "", {}, {{"h", "x/3"}}, {}, {{"hill", "y >= x/3"}}});
  const auto verdict = [&](const char* y) {
    return contact_verdicts(*s, state_text({{"x", "0.1"}, {"y", y}}, {{"x", "7"}, {"y", "h'"}}), {0}).front();
  };
  CHECK(verdict("h") == ContactVerdict::touches);
  CHECK(verdict("h + 1e-30") == ContactVerdict::apart);
}

TEST_CASE("a family's members may use each other") {
  const auto s = system({{"x[1..4]"}, "sum(i in 1..4, x[i]'^2)", "", {}, {}, {}, {}});
  const mechanics::State at = s->state(state_text({{"x[1]", "2"}, {"x[i in 2..4]", "x[i-1]^2"}}));
  CHECK(at.q == state({2, 4, 16, 256}, {0, 0, 0, 0}).q);
}

TEST_CASE("values that need each other, or what is not given, are refused") {
  const auto s = system(crank);
  const auto error = [&](const Lines& position, const Lines& velocity) {
    return error_of([&] { s->state(state_text(position, velocity)); });
  };
  CHECK(error({{"a", "x"}, {"x", "2*a"}}, {}).find("needs itself") != std::string::npos);
  CHECK(error({{"x", "piston"}}, {}).find("give every coordinate") != std::string::npos);
  CHECK(error({{"a", "1"}, {"x", "nothing"}}, {}).find("is unknown") != std::string::npos);
  CHECK(error({{"a", "1"}, {"x", "log(a - 1)"}}, {}).find("not finite") != std::string::npos);
}

TEST_CASE("the text tells nothing of dependent rows at a state whose digits miss a contact") {
  const auto twice = system(
      {{"x"}, "x'^2/2", "", {}, {}, {}, {{"drive", "x = t/3"}, {"again", "x*(1 + x) = t/3*(1 + t/3)"}}});
  const auto fractions = [&](const char* velocity) {
    return mechanics::fractions_from_text(*twice, state_text({{"x", "0"}}, {{"x", velocity}}, "0"), {0, 1});
  };
  CHECK(fractions("1/3"));
  CHECK_FALSE(fractions("0.3333333333333333"));
}
