#include <doctest/doctest.h>

#include "mechanics/exact_text.hpp"
#include "tests/mechanics/system_text.hpp"

using mechanics::ContactVerdict;

namespace {

/// What is decided of y >= `floor` for a mass at the height y.
ContactVerdict verdict(const std::string& y, const std::string& floor) {
  const auto system = tests::system({{"y"}, "y'^2/2", "", {}, {}, {}, {{"floor", "y >= " + floor}}});
  return mechanics::contact_verdicts(*system, tests::state_text({{"y", y}}), {0}).at(0);
}

struct Identity {
  const char *left, *right;
};

/// Of the books; none follows from the names of the terms.
const Identity identities[] = {
    {"sqrt(2)*sqrt(3)", "sqrt(6)"},
    {"sqrt(5 + 2*sqrt(6))", "sqrt(2) + sqrt(3)"},
    {"sqrt(3 - 2*sqrt(2)) + 1", "sqrt(2)"},
    {"1/(sqrt(7) - sqrt(6))", "sqrt(7) + sqrt(6)"},
    {"sin(pi/12)", "(sqrt(6) - sqrt(2))/4"},
    {"cos(pi/5)", "(1 + sqrt(5))/4"},
    {"tan(pi/8)", "sqrt(2) - 1"},
    {"cos(2*pi/7) + cos(4*pi/7) + cos(6*pi/7)", "-1/2"},
    {"sin(pi/9)*sin(2*pi/9)*sin(4*pi/9)", "sqrt(3)/8"},
    {"tan(asin(3/7))", "3/sqrt(40)"},
    {"cos(2*atan(1/3))", "4/5"},
    {"tan(4*atan(1/5) - atan(1/239))", "1"},
    {"sin(acos(1/3) + asin(1/4))", "1/12 + sqrt(8)*sqrt(15)/12"},
    {"sin(asin(0.026/sqrt(0.003125)) - atan(1/2) + atan2(1, 2))", "0.026/sqrt(0.003125)"},
};

}  // namespace

TEST_CASE("algebraic identities between roots and sines are proved") {
  for (const Identity& identity : identities) {
    CAPTURE(std::string(identity.left));
    CHECK(verdict(identity.left, identity.right) == ContactVerdict::touches);
    CHECK(verdict(identity.right, identity.left) == ContactVerdict::touches);
  }
}

TEST_CASE("what an identity misses is seen, however little it is") {
  for (const Identity& identity : identities)
    for (const char* gap : {"1e-30", "1e-200", "1e-600"}) {
      CAPTURE(std::string(identity.left));
      CAPTURE(std::string(gap));
      CHECK(verdict(std::string(identity.left) + " + " + gap, identity.right) == ContactVerdict::apart);
      CHECK(verdict(std::string(identity.left) + " - " + gap, identity.right) == ContactVerdict::violated);
    }
}

TEST_CASE("nothing is concluded of numbers that are not algebraic") {
  // sin 2a = 2 sin a cos a at a = 0.7, where sines are transcendental (Lindemann).
  CHECK(verdict("sin(1.4)", "2*sin(0.7)*cos(0.7)") == ContactVerdict::undecided);
  CHECK(verdict("exp(sqrt(2))*exp(-sqrt(2))", "1") == ContactVerdict::undecided);
}

TEST_CASE("numbers that agree to very many digits are told apart or stay open, never taken for equal") {
  // (sqrt 2 - 1)^k is 10^(-0.38 k): a root and a fraction so close.
  CHECK(verdict("(sqrt(2) - 1)^64*(sqrt(2) - 1)^64", "0") == ContactVerdict::apart);
  // Sums of roots that differ by 1e-18 and less (Graham's sums of square roots).
  CHECK(verdict("sqrt(10) + sqrt(11)", "sqrt(5) + sqrt(18)") == ContactVerdict::apart);
  CHECK(verdict("sqrt(1000000000001) + sqrt(1000000000025) + sqrt(1000000000031)",
                "sqrt(1000000000005) + sqrt(1000000000018) + sqrt(1000000000034)") !=
        ContactVerdict::touches);
}
