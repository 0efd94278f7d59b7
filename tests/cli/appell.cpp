#include <doctest/doctest.h>

#include <cmath>
#include <nlohmann/json.hpp>

#include "tests/cli/program.hpp"

using namespace tests;
using Json = nlohmann::ordered_json;

namespace {

/// Two masses on rods, the second on the first, with the weights and a force along x on the second.
constexpr double m1 = 2, m2 = 3, l1 = 1.5, l2 = 0.5, g = 9.81, push = 4;
constexpr double a = 0.3, b = -0.7, va = 1.25, vb = -2.5;

const std::string double_pendulum = R"T(
[system]
coordinates = ["a", "b"]
kinetic = "m1/2*(X1'^2 + Y1'^2) + m2/2*(X2'^2 + Y2'^2)"
potential = "g*(m1*Y1 + m2*Y2) - push*X2"
[system.parameters]
m1 = 2
m2 = 3
l1 = 1.5
l2 = 0.5
g = 9.81
push = 4
[system.definitions]
X1 = "l1*sin(a)"
Y1 = "-l1*cos(a)"
X2 = "X1 + l2*sin(b)"
Y2 = "Y1 - l2*cos(b)"
[state]
position = { a = 0.3, b = -0.7 }
velocity = { a = 1.25, b = -2.5 }
)T";

/// ½ Σ m Γ² - Σ Γ·F, with the accelerations of the masses in space as kinematics gives them.
double appell(double aa, double bb) {
  const double x1 = l1 * (std::cos(a) * aa - std::sin(a) * va * va),
               y1 = l1 * (std::sin(a) * aa + std::cos(a) * va * va);
  const double x2 = x1 + l2 * (std::cos(b) * bb - std::sin(b) * vb * vb),
               y2 = y1 + l2 * (std::sin(b) * bb + std::cos(b) * vb * vb);
  return m1 / 2 * (x1 * x1 + y1 * y1) + m2 / 2 * (x2 * x2 + y2 * y2) + g * (m1 * y1 + m2 * y2) - push * x2;
}

}  // namespace

TEST_CASE("Gauss' function of derive is Appell's, but for a number without accelerations") {
  const Json derived = Json::parse(run_json_on("derive", double_pendulum).out);
  const auto gauss = [&](double aa, double bb) {
    const Json& A = derived["A"];
    return A[0][0].get<double>() * aa * aa / 2 + A[0][1].get<double>() * aa * bb +
           A[1][1].get<double>() * bb * bb / 2 - derived["z"]["a"].get<double>() * aa -
           derived["z"]["b"].get<double>() * bb;
  };
  const double number = appell(0, 0);
  CHECK(number > 10);  // the masses accelerate by their velocities alone
  for (const auto& [aa, bb] : {std::pair{1.0, 0.0}, {0.0, 1.0}, {3.0, -2.0}, {-40.0, 25.0}})
    CHECK(gauss(aa, bb) == doctest::Approx(appell(aa, bb) - number).epsilon(1e-12));
}

TEST_CASE("Appell's function is written out term by term, and left out where nobody could read it") {
  CHECK(Json::parse(run_json_on("derive", point_on_floor()).out)["appell"] == "x''^2 + y''^2 + 19.62 y''");
  CHECK(Json::parse(
            run_json_on("derive", "[projection]\nA = [[2, -1], [-1, 4]]\nz = [1, 0]\n").out)["appell"] ==
        "q[0]''^2 - q[0]'' q[1]'' + 2 q[1]''^2 - q[0]''");
  const std::string wide =
      "[system]\ncoordinates = [\"x[1..13]\"]\nkinetic = \"sum(i in 1..13, x[i]'^2)\"\n"
      "[state]\nposition = { \"x[i]\" = 0 }\n";
  CHECK(Json::parse(run_json_on("derive", wide).out)["appell"].is_null());
  CHECK(run_on("derive", point_on_floor()).out.find("x''^2 + y''^2 + 19.62 y'' + a number") !=
        std::string::npos);
}
