#include <doctest/doctest.h>

#include <cmath>
#include <numbers>

#include "tests/mechanics/system_text.hpp"

using namespace tests;

namespace {

/// The value of an expression in x (at 3), t (at 0.5) and the parameter p = 2.
double value_of(const std::string& expression) {
  const auto s = system({{"x"}, "x'^2/2", expression, {{"p", "2"}}, {}, {}, {}});
  return s->energy(state({3}, {0}, 0.5));
}

}  // namespace

TEST_CASE("operators bind as in the contract") {
  const std::vector<std::pair<std::string, double>> table{
      {"2^3^0", 2},
      {"-x^2", -9},
      {"2^-1", 0.5},
      {"2^-p^2", 0.0625},
      {"-2^2", -4},
      {"(-2)^2", 4},
      {"8 - 3 - 2", 3},
      {"16/4/2", 2},
      {"2*3+4", 10},
      {"2+3*4", 14},
      {"--x", 3},
      {"+x", 3},
      {"2*-x", -6},
      {"x - -x", 6},
      {"1 - 2 + 3", 2},
      {"12/2*3", 18},
      {"x^2*2", 18},
      {"2*x^2", 18},
      {"t", 0.5},
      {"1.5e1", 15},
      {"2.5e-3", 0.0025},
      {".5", 0.5},
      {"2.", 2},
      {"1_000", 1000},
      {"p*x", 6},
      {"(2*t)'", 2},
      {"(t^2)'*3", 3},
      {"sum(i in 1..3, i^2)", 14},
      {"sum(i in 1..3, j in 1..i, i*j)", 25},
      {"sum(i in 2..1, 1/0)", 0},
      {"sum(i in -1..1, i)", 0},
      {"sum(i in 1..p, sum(j in i..p, 1))", 3},
  };
  for (const auto& [expression, expected] : table) {
    CAPTURE(expression);
    CHECK(value_of(expression) == expected);
  }
  CHECK(value_of("pi") == std::numbers::pi);
}

TEST_CASE("a function's name stands for that function") {
  CHECK(value_of("atan2(1, -1)") == doctest::Approx(3 * std::numbers::pi / 4));
  CHECK(value_of("tan(1)*cos(1) - sin(1)") == doctest::Approx(0));
  CHECK(value_of("sin(asin(0.3)) + cos(acos(0.2)) + tan(atan(4))") == doctest::Approx(4.5));
  CHECK(value_of("cosh(1)^2 - sinh(1)^2 + tanh(1) - sinh(1)/cosh(1)") == doctest::Approx(1));
  CHECK(value_of("log(exp(2)) + sqrt(9) + abs(-4)") == doctest::Approx(9));
}

TEST_CASE("nesting may be exactly as deep as the contract says") {
  const auto nested = [](std::size_t depth, const char* open, const char* close) {
    std::string text;
    for (std::size_t k = 0; k < depth; ++k) text += open;
    text += "x";
    for (std::size_t k = 0; k < depth; ++k) text += close;
    return text;
  };
  CHECK(value_of(nested(256, "(", ")")) == 3);
  for (const auto& [open, close] : {std::pair{"(", ")"}, {"-", ""}, {"sin(", ")"}, {"2^", ""}, {"-(", ")"}}) {
    CAPTURE(open);
    CHECK(error_of([&] { value_of(nested(257, open, close)); }).find("nested more than 256 deep") !=
          std::string::npos);
    CHECK(error_of([&] { value_of(nested(20000, open, close)); }).find("nested more than 256 deep") !=
          std::string::npos);
  }
}

TEST_CASE("a flat sum or product is not nested, however long") {
  std::string sum = "x", product = "1", times = "t";
  for (int k = 0; k < 100000; ++k) {
    sum += "+x";
    product += "*1";
    times += "-t";
  }
  CHECK(value_of(sum) == 300003);
  CHECK(value_of(product) == 1);
  CHECK(value_of("(" + times + ")'") == -99999);
}

TEST_CASE("garbage is refused at once") {
  for (const std::string piece :
       {"(", "[", "x[", "sum(", "sum(i in ", "'", "^", "-", "x ", "1", "é", "\x80", "..", "a=", "sin"}) {
    std::string text;
    while (text.size() < 2'000'000) text += piece;
    CAPTURE(piece);
    CHECK(error_of([&] { value_of(text); }) != "no error");
  }
}
