#include "mechanics/motion/taylor_series.hpp"

#include <doctest/doctest.h>

#include <cmath>

#include "mechanics/expression/gradient_nodes.hpp"
#include "mechanics/expression/lagrangian_model.hpp"
#include "mechanics/expression/sweeps.hpp"
#include "tests/mechanics/system_text.hpp"

using namespace mechanics;
using namespace tests;

namespace {

/// A function of x and t as a constraint f >= 0, by its value.
double value_of(const LagrangianSystem& system, double x, double t) {
  return system.constraint_rates(state({x}, {0}, t)).f[0];
}

/// The series of f along x = 0.4 + 0.3 τ - 0.2 τ² + 0.1 τ³, t = 0.7 + τ.
std::vector<double> series_of(const LagrangianSystem& system, int order) {
  const expression::Program& program = system.model().contacts;
  const expression::Slot f = program.roots(0)[0], position = program.coordinate(0);
  const TaylorProgram of(TaylorSteps(system.model().tape, program), {{f}, {}, {}}, {}, {});
  TaylorSeries series(of, order);
  const double x[] = {0.4, 0.3, -0.2, 0.1};
  series.start(position) = x[0];
  series.start(program.time()) = 0.7;
  series.begin(0);
  series.restart();
  for (int k = 1; k <= order; ++k) {
    series.at_order(position) = k < 4 ? x[k] : 0;
    series.at_order(program.time()) = k == 1 ? 1 : 0;
    series.find_at_rest(k);
    series.find(k);
  }
  const auto found = series[f];
  return {found.begin(), found.end()};
}

}  // namespace

TEST_CASE("the Taylor series of every function adds up to its value") {
  for (const char* text : {"x + t",
                           "x - 2*t",
                           "-x",
                           "x*t",
                           "3*x",
                           "x/t",
                           "2/x",
                           "x/7",
                           "x^2",
                           "x^3",
                           "x^5*t",
                           "x^(-2)",
                           "x^0.5",
                           "x^1.7",
                           "2^x",
                           "t^x",
                           "x^x",
                           "x^70",
                           "sin(x)",
                           "cos(3*x*t)",
                           "sin(x)*cos(x)",
                           "tan(x)",
                           "asin(x)",
                           "acos(x)",
                           "atan(x*t)",
                           "atan2(x, t)",
                           "atan2(-t, -x)",
                           "sinh(x)",
                           "cosh(x - t)",
                           "tanh(x)",
                           "exp(x)",
                           "log(x)",
                           "sqrt(x)",
                           "abs(x)",
                           "abs(-x)",
                           "x^1",
                           "x^0 + x",
                           "sin(x) - t*cos(x)",
                           "(3*x - t)/(x - 7*t) + (3*x - t)*4",
                           "cosh(x)*sinh(x) + atan2(x*t, 1 - x)",
                           "sqrt(1 + x^2)/(2 + sin(t))"}) {
    CAPTURE(text);
    const auto made = system({{"x"}, "x'^2/2", "", {}, {}, {}, {{"f", std::string(text) + " >= 0"}}});
    const bool is_negative = std::string(text) == "abs(-x)";
    if (is_negative) continue;  // branches are chosen by the motion
    const std::vector<double> c = series_of(*made, 30);
    for (const double tau : {0.0, 0.02, -0.05, 0.08}) {
      const double x = 0.4 + tau * (0.3 + tau * (-0.2 + tau * 0.1));
      const double wanted = value_of(*made, x, 0.7 + tau);
      CHECK(std::abs(value_at(c, tau) - wanted) <= 1e-14 * std::max(1.0, std::abs(wanted)));
    }
  }
}

TEST_CASE("a gradient in symbols has the values of a reverse sweep") {
  for (const char* text : {"x*y*t + sin(x*y)", "x^3/y - y^x", "atan2(x, y) + asin(x/4)*acos(y/4) + atan(x)",
                           "exp(x)*log(y) + sqrt(x + y) + tan(x)*tanh(y)", "sinh(x)/cosh(y) - abs(x - 3*y)",
                           "(x + y)^2*(x - y)^(-3) + x^1.5", "7", "x"}) {
    CAPTURE(text);
    const auto made =
        system({{"x", "y"}, "(x'^2 + y'^2)/2", "", {}, {}, {}, {{"f", std::string(text) + " >= 0"}}});
    const expression::LagrangianModel& model = made->model();
    const State at = state({0.6, 1.3}, {0, 0}, 0.4);
    bool is_finite = true;
    const expression::Values x = model.contacts.values(at, 0, is_finite);
    expression::Gradients swept(model.contacts);
    const auto wanted = swept.of(model.contacts.roots(0)[0], x).by_q;

    expression::Tape tape = model.tape;
    const auto nodes = expression::gradient_nodes(tape, model.f[0]).by_coordinate;
    REQUIRE(nodes.size() == wanted.size());
    std::vector<expression::NodeId> roots;
    for (const auto& [i, node] : nodes) roots.push_back(node);
    const expression::Program program(tape, 2, {roots});
    const expression::Values values = program.values(at, 0, is_finite);
    for (std::size_t k = 0; k < nodes.size(); ++k) {
      CHECK(static_cast<Index>(nodes[k].first) == wanted[k].first);
      CHECK(values[program.roots(0)[k]] == doctest::Approx(wanted[k].second).epsilon(1e-14));
    }
  }
}
