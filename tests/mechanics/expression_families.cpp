#include <doctest/doctest.h>

#include <cmath>

#include "tests/mechanics/system_text.hpp"

using namespace tests;

namespace {

const std::string sum_of_squares = "sum(i in 1..N, x[i]'^2/2)";

std::vector<double> values(const mechanics::Vector& v) { return {v.begin(), v.end()}; }

}  // namespace

TEST_CASE("members are named by their indices, the last index fastest") {
  const auto s = system({{"a", "y[1..2,0..N]", "e[1..0]"},
                         "a'^2",
                         "",
                         {{"N", "4/2"}},
                         {},
                         {},
                         {{"gap[i in 1..2, j in 0..i-1]", "y[i,j] >= 0"}, {"c", "a = 1"}}});
  CHECK(s->coordinates() ==
        std::vector<std::string>{"a", "y[1,0]", "y[1,1]", "y[1,2]", "y[2,0]", "y[2,1]", "y[2,2]"});
  std::vector<std::string> names;
  for (const auto& constraint : s->constraints()) names.push_back(constraint.name);
  CHECK(names == std::vector<std::string>{"gap[1,0]", "gap[2,0]", "gap[2,1]", "c"});
  CHECK(s->constraints()[3].two_sided);
  CHECK(!s->constraints()[0].two_sided);
  CHECK(s->constraints()[3].place->line == 41);
  const auto rows = s->contact_rows(state({1, 2, 3, 4, 5, 6, 7}, std::vector<double>(7)), {2, 0});
  CHECK(rows.U.coeff(0, 5) == 1);
  CHECK(rows.U.coeff(1, 1) == 1);
  CHECK(rows.U.nonZeros() == 2);
}

TEST_CASE("a member overrides a range, a range overrides the family, in any order") {
  const auto s = system({{"x[1..N]"},
                         sum_of_squares,
                         "",
                         {{"N", "5"}},
                         {},
                         {{"x[3]", "300"}, {"x[i]", "i"}, {"x[k in 2..4]", "10*k"}, {"x[N]", "-1"}},
                         {}});
  CHECK(values(s->inertia(state({0, 0, 0, 0, 0}, {0, 0, 0, 0, 0})).z) ==
        std::vector<double>{1, 20, 300, 40, -1});
}

TEST_CASE("definitions and constraints are families with overrides of their own") {
  const auto s = system({{"x[1..3]"},
                         "sum(i in 1..3, x[i]'^2/2)",
                         "",
                         {},
                         {{"h[2]", "7"}, {"h[i in 1..3]", "i*x[i]"}},
                         {},
                         {{"c[i in 1..3]", "h[i] >= 0"}, {"d", "x[1] >= 0"}, {"c[1]", "x[1] <= 9"}}});
  const auto rates = s->constraint_rates(state({1, 2, 3}, {0, 0, 0}));
  CHECK(values(rates.f) == std::vector<double>{8, 7, 9, 1});
  CHECK(s->constraints()[0].place->line == 42);
  CHECK(s->constraints()[1].place->line == 40);
}

TEST_CASE("positions and velocities of families are given like forces") {
  const auto s =
      system({{"x[1..N]", "y"}, sum_of_squares + "+y'^2", "", {{"N", "3"}, {"r", "0.5"}}, {}, {}, {}});
  const auto at =
      s->state(state_text({{"x[i]", "r + 2*r*(i-1) + t"}, {"y", "sum(j in 1..N, j)"}, {"x[N]", "-3"}},
                          {{"x[i in 2..2]", "i*r"}}, "r/2"));
  CHECK(at.t == 0.25);
  CHECK(values(at.q) == std::vector<double>{0.75, 1.75, -3, 6});
  CHECK(values(at.v) == std::vector<double>{0, 1, 0, 0});
}

TEST_CASE("definitions may refer to a hundred thousand members one after the other, up or down") {
  const auto s = system({{"a[1..N]"},
                         "sum(i in 1..N, a[i]'^2/2)",
                         "X[N] + Z[1]",
                         {{"N", "1e5"}},
                         {{"X[i in 1..N]", "X[i-1] + a[i]"},
                          {"X[0]", "0"},
                          {"Z[i in 1..N]", "Z[i+1] + 2*a[i]"},
                          {"Z[N+1]", "0"}},
                         {},
                         {}});
  std::vector<double> ones(100000, 1.0);
  CHECK(s->energy(state(ones, std::vector<double>(100000))) == 300000);
  CHECK(s->inertia(state(ones, std::vector<double>(100000))).z.maxCoeff() == -3);
}

TEST_CASE("chains of single definitions may be as long") {
  Lines definitions;
  for (int k = 0; k < 20000; ++k)
    definitions.push_back({"d" + std::to_string(k), "d" + std::to_string(k + 1) + " + 1"});
  definitions.push_back({"d20000", "x"});
  const auto s = system({{"x"}, "d0'^2/2", "d0", {}, definitions, {}, {}});
  CHECK(s->energy(state({1}, {2})) == 20003);
}

TEST_CASE("an empty range has no members and no contact") {
  const auto s = system({{"x[1..1]"},
                         "x[1]'^2/2 + sum(i in 1..0, x[i]'^2)",
                         "",
                         {},
                         {{"e[i in 3..2]", "x[i]"}},
                         {{"x[i in 2..1]", "1"}},
                         {{"gap[i in 1..0]", "x[i+1] >= x[i]"}}});
  CHECK(s->constraints().empty());
  CHECK(s->inertia(state({1}, {1})).z[0] == 0);
}

TEST_CASE("families that are too large are refused before they are expanded") {
  const auto refused = [](const SystemText& text) { return error_of([&] { system(text); }); };
  CHECK(refused({{"x[1..1e300]"}, "0", "", {}, {}, {}, {}}).find("is not an integer") != std::string::npos);
  CHECK(refused({{"x[1..1e15]"}, "0", "", {}, {}, {}, {}}).find("at most 1e7") != std::string::npos);
  CHECK(refused({{"x[1..1e4,1..1e4]"}, "0", "", {}, {}, {}, {}}).find("at most 1e7") != std::string::npos);
  CHECK(refused({{"x"}, "x'^2*sum(i in 1..1e7+1, 1)", "", {}, {}, {}, {}})
            .find("2:106 kinetic: a sum of 10000001") != std::string::npos);
  CHECK(refused({{"x"}, "x'^2*sum(i in 1..1e5, j in 1..1e5, 1)", "", {}, {}, {}, {}}).find("at most 1e7") !=
        std::string::npos);
  CHECK(
      refused({{"x"}, "x'^2", "", {}, {{"d[i in 1..1e5, j in 1..1e5]", "1"}}, {}, {}}).starts_with("20:1 "));
  CHECK(refused({{"x"}, "x'^2", "", {}, {{"d[i in 1..1e7, j in 1..0, k in 1..1e7]", "1"}}, {}, {}}) ==
        "no error");
}
