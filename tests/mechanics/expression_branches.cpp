#include <doctest/doctest.h>

#include <cmath>

#include "mechanics/branch_edges.hpp"
#include "tests/mechanics/system_text.hpp"

using namespace tests;

namespace {

/// The force on x at a place x, with the parameter p = 2.
double force_at(const std::string& expression, double x, double v = 0) {
  const auto s = system({{"x"}, "x'^2/2", "", {{"p", "2"}}, {}, {{"x", expression}}, {}});
  return s->inertia(state({x}, {v})).z[0];
}

std::string edges_at(const SystemText& text, double x) {
  const auto s = system(text);
  const auto warning = mechanics::branch_edges(*s, state({x}, {0}), {});
  return warning ? warning->message : "";
}

}  // namespace

TEST_CASE("a comparison takes the branch that holds, and at equality the one that says so") {
  for (const auto& [expression, below, at, above] :
       std::vector<std::tuple<std::string, double, double, double>>{
           {"if(x >= 1, 5, 7)", 7, 5, 5},
           {"if(x > 1, 5, 7)", 7, 7, 5},
           {"if(x <= 1, 5, 7)", 5, 5, 7},
           {"if(x < 1, 5, 7)", 5, 7, 7},
           {"sign(x - 1)", -1, 0, 1},
           {"step(x - 1)", 0, 1, 1},
           {"min(x, 1)", 0.5, 1, 1},
           {"max(x, 1, 0)", 1, 1, 1.5},
           {"if(p > 1, if(x < 1, 1, 2), 1/0)", 1, 2, 2}}) {
    CAPTURE(expression);
    CHECK(force_at(expression, 0.5) == below);
    CHECK(force_at(expression, 1) == at);
    CHECK(force_at(expression, 1.5) == above);
  }
}

TEST_CASE("between equal expressions there is no tie") {
  const auto edges = [](const std::string& kinetic) -> std::string {
    const auto s = system({{"x", "y"}, kinetic, "", {}, {}, {}, {}});
    const auto warning = mechanics::branch_edges(*s, state({1, 3}, {0, 0}), {});
    return warning ? warning->message : "";
  };
  for (const char* equal :
       {"min(x, x)", "max(x + 1, x + 1)", "min(min(y, x), x)", "max(x, max(y, x, 2), y)"}) {
    CAPTURE(equal);
    CHECK(edges("(1 + " + std::string(equal) + ")*x'^2 + y'^2").empty());
  }
  for (const char* tie : {"min(x, 2*x - 1)", "max(min(y, x), x)"}) {
    CAPTURE(tie);
    CHECK(edges("(1 + " + std::string(tie) + ")*x'^2 + y'^2").find("a tie") != std::string::npos);
  }
}

TEST_CASE("the branch that is not taken may be undefined") {
  CHECK(force_at("if(x > 0, sqrt(x), 3)", -1) == 3);
  CHECK(force_at("if(x > 0, sqrt(x), 3)", 4) == 2);
}

TEST_CASE("kinetic energy and constraints may have branches") {
  const auto s = system({{"x"},
                         "if(x < 0, log(-x), 2)*x'^2",
                         "if(x < 0, log(-x), 3*x)",
                         {},
                         {},
                         {},
                         {{"stop", "if(x < 0, log(-x), x^2) >= 0"}}});
  const mechanics::State at = state({3}, {1});
  CHECK(s->inertia(at).A.coeff(0, 0) == 4);
  CHECK(s->inertia(at).z[0] == -3);
  const mechanics::ContactRows rows = s->contact_rows(at, {0});
  CHECK(rows.U.coeff(0, 0) == 6);
  CHECK(rows.s[0] == -2);
  // At -e the mass is 2 log e = 2, and its derivative 1/x enters z = m' x'^2/2 - m' x'^2 - dV/dx.
  const mechanics::State left = state({-std::exp(1.0)}, {1});
  CHECK(s->inertia(left).A.coeff(0, 0) == doctest::Approx(2));
  CHECK(s->inertia(left).z[0] == doctest::Approx(2 / std::exp(1.0)));
}

TEST_CASE("a condition needs a value at the state and no derivative") {
  const auto s = system({{"x", "y"},
                         "(x'^2 + y'^2)/2",
                         "if(hypot(x, y) < 1, x^2 + y^2, 1)",
                         {},
                         {},
                         {},
                         {{"bowl", "if(hypot(x, y) < 1, y + x, y) >= 0"}}});
  CHECK(s->inertia(state({0, 0}, {0, 0})).z.isZero(0));
  CHECK(s->contact_rows(state({0, 0}, {0, 0}), {0}).U.coeff(0, 0) == 1);
}

TEST_CASE("a power of abs above two is smooth at 0") {
  const SystemText text{{"x"}, "x'^2/2", "abs(x)^3 + abs(x)^2.5", {}, {}, {}, {{"c", "abs(x)^3 - t >= 0"}}};
  const auto s = system(text);
  CHECK(s->inertia(state({0}, {1})).z[0] == 0);
  CHECK(s->contact_rows(state({0}, {1}), {0}).s[0] == 0);
  CHECK(edges_at(text, 0).empty());
}

TEST_CASE("a state between two branches is told, one beside them is not") {
  const SystemText text{{"x"}, "x'^2/2", "", {}, {}, {{"x", "if(x >= 0.3, 1, 2)"}}, {}};
  CHECK(edges_at(text, 0.3).find("x-0.3 = 0") != std::string::npos);
  CHECK(edges_at(text, 0.4).empty());
  // A force is used by its value, which at a tie is the same on both sides; a constraint by its derivatives.
  CHECK(edges_at({{"x"}, "x'^2/2", "", {}, {}, {{"x", "max(x, 1)"}}, {}}, 1).empty());
  CHECK(!edges_at({{"x"}, "x'^2/2", "", {}, {}, {}, {{"c", "max(x, 1) >= 0"}}}, 1).empty());
  // What is compared may be a coordinate, a velocity or the time itself.
  for (const char* force : {"step(x)", "step(x')", "step(t)", "sign(x)", "if(0 <= x, 1, 2)"}) {
    CAPTURE(std::string(force));
    CHECK(!edges_at({{"x"}, "x'^2/2", "", {}, {}, {{"x", force}}, {}}, 0).empty());
  }
  // sign(x) asks for -x as well.
  CHECK(edges_at({{"x"}, "x'^2/2", "", {}, {}, {{"x", "sign(x)"}}, {}}, 0).find("-x") == std::string::npos);
  // The cut of atan2 is an edge, the positive axis is none.
  CHECK(!edges_at({{"x"}, "x'^2/2", "", {}, {}, {{"x", "atan2(x, -1)"}}, {}}, 0).empty());
  CHECK(edges_at({{"x"}, "x'^2/2", "", {}, {}, {{"x", "atan2(x, 1)"}}, {}}, 0).empty());
  // The knots of a table are no edges.
  CHECK(edges_at({{"x"}, "x'^2/2", "", {}, {}, {{"x", "table(x, [0, 1, 2], [0, 1, 0])"}}, {}}, 1).empty());
}

TEST_CASE("a natural cubic spline goes through its points and has no curvature at its ends") {
  const std::string table = "table(x, [-1, 0, 0.5, 2, 2.25], [3, 1, -1, 0, 4])";
  const std::vector<std::pair<double, double>> points{{-1, 3}, {0, 1}, {0.5, -1}, {2, 0}, {2.25, 4}};
  for (const auto& [x, y] : points) CHECK(force_at(table, x) == doctest::Approx(y));
  const auto bend = [&](double x) {
    const auto s = system({{"x"}, "x'^2/2", "", {}, {}, {}, {{"c", table + " >= t - 100"}}});
    return -s->contact_rows(state({x}, {1}), {0}).s[0];
  };
  CHECK(bend(-1) == doctest::Approx(0));
  CHECK(bend(2.25) == doctest::Approx(0));
  for (const double knot : {0.0, 0.5, 2.0})
    CHECK(bend(knot - 1e-9) == doctest::Approx(bend(knot)).epsilon(1e-6));
}

TEST_CASE("a table says what is wrong with it, and where it ends") {
  for (const auto& [expression, message] : std::vector<std::pair<std::string, std::string>>{
           {"table(x, [0, 1], [1])", "2 points and 1 values"},
           {"table(x, [0], [1])", "fewer than two points"},
           {"table(x, [0, 0], [1, 2])", "do not increase"},
           {"table(x, [0, x], [1, 2])", "no constant"},
           {"table(x)", "too few arguments"},
           {"table(x, \"F.csv\")", "read from a problem file only"},
           {"table(x, [0, 1], [1, 2])", "outside 0 to 1"},
           {"if(x, 1, 2)", "no comparison"},
           {"if(x > 1, 2)", "too few arguments"},
           {"if(x > 1, 2, 3, 4)", "too many arguments"},
           {"max(x)", "at least 2"},
           {"hypot(x)", "at least 2"},
           {"step(x, 1)", "too many"},
           {"x > 1", "is no relation"}}) {
    CAPTURE(expression);
    const std::string error = error_of([&] { force_at(expression, 5); });
    CHECK(error.find(message) != std::string::npos);
  }
}

TEST_CASE("names that were free before these functions are free still") {
  const auto s =
      system({{"step", "min"}, "(step'^2 + min'^2)/2", "max*min(step, min)", {{"max", "3"}}, {}, {}, {}});
  CHECK(s->inertia(state({1, 2}, {0, 0})).z[0] == -3);
}
