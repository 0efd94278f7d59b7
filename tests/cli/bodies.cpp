#include <doctest/doctest.h>

#include <array>
#include <cmath>
#include <nlohmann/json.hpp>

#include "tests/cli/program.hpp"

using namespace tests;
using Json = nlohmann::ordered_json;

namespace {

using Quaternion = std::array<double, 4>;  // e0 first

Quaternion product(const Quaternion& left, const Quaternion& right) {
  return {left[0] * right[0] - left[1] * right[1] - left[2] * right[2] - left[3] * right[3],
          left[0] * right[1] + left[1] * right[0] + left[2] * right[3] - left[3] * right[2],
          left[0] * right[2] - left[1] * right[3] + left[2] * right[0] + left[3] * right[1],
          left[0] * right[3] + left[1] * right[2] - left[2] * right[1] + left[3] * right[0]};
}

/// The rotation by the vector w: its direction is the axis, its length the angle.
Quaternion rotation(double x, double y, double z) {
  const double angle = std::hypot(x, y, z), s = angle == 0 ? 0.5 : std::sin(angle / 2) / angle;
  return {std::cos(angle / 2), s * x, s * y, s * z};
}

Json answer(const std::string& command, const std::string& text, int code = 0) {
  const Folder folder;
  const Outcome outcome = run({command, "--json", folder.write("problem.toml", text)});
  CAPTURE(outcome.err);
  REQUIRE(outcome.code == code);
  return Json::parse(outcome.out);
}

std::string at_rest(const std::string& tables, const std::string& name) {
  return "[system]\n" + tables + "\n[state]\nposition = { " + name + "_x = 0, " + name + "_y = 0, " + name +
         "_z = 0, " + name + "_e0 = 1, " + name + "_e1 = 0, " + name + "_e2 = 0, " + name + "_e3 = 0 }\n";
}

/// f of the constraint "value >= 0" over three vectors r, s, w of a system.
double value_of(const std::string& value) {
  const Json found =
      answer("solve",
             "[system]\ncoordinates = [\"r[1..3]\", \"s[1..3]\", \"w[1..3]\"]\n"
             "kinetic = \"dot(r', r')/2 + norm(s')^2/2 + dot(w', w')\"\n[system.constraints]\nc = \"" +
                 value +
                 " + 1000 >= 0\"\n[state]\nposition = { \"r[i]\" = \"i\", \"s[i]\" = "
                 "\"(i - 2)^2 + 1/4\", \"w[i]\" = \"3 - i^2\" }\nvelocity = { \"r[i]\" = \"2 - i\" }\n");
  return found["constraints"]["c"]["f"].get<double>() - 1000;
}

}  // namespace

TEST_CASE(
    "a free symmetric top turns about its angular momentum and about its axis, each at a constant rate") {
  // Euler's equations, I1 = I2 = 1, I3 = 3/2: R(t) is a turn about L in space by |L| t/I1 behind a turn about
  // the body's axis by w3 (1 - I3/I1) t (Landau and Lifshitz, Mechanics, section 35).
  const double w1 = 0.4, w3 = 2, I1 = 1, I3 = 1.5, t = 3;
  for (const char* inertia : {"[1.0, 1.0, 1.5]", "[1, \"2/2\", \"3/2\"]"}) {
    const Json end = answer(
        "simulate", at_rest("[bodies.top]\nmass = 2.0\ninertia = " + std::string(inertia), "top") +
                        "velocity = { top_e1 = 0.2, top_e3 = 1.0, top_z = 0.5 }\n[simulate]\nuntil = 3.0\n");
    const Quaternion e =
        product(rotation(I1 * w1 / I1 * t, 0, I3 * w3 / I1 * t), rotation(0, 0, w3 * (1 - I3 / I1) * t));
    for (int i = 0; i < 4; ++i)
      CHECK(std::abs(end["position"]["top_e" + std::to_string(i)].get<double>() -
                     e[static_cast<std::size_t>(i)]) <= 1e-9);
    CHECK(end["position"]["top_z"].get<double>() == doctest::Approx(1.5).epsilon(1e-14));
    // T = m v^2/2 + (I1 w1^2 + I3 w3^2)/2.
    CHECK(end["energy"].get<double>() ==
          doctest::Approx(2.0 / 2 * 0.25 + (0.16 + 1.5 * 4) / 2).epsilon(1e-13));
  }
}

TEST_CASE("a plate over two supports at one edge falls about them, and they press as levers say") {
  // By hand: z'' = -g m a^2/(m a^2 + Iy), N = m g Iy/(m a^2 + Iy), shared as 2 to 1 by arms 1 to 2.
  const double m = 3, g = 9.81, a = 0.4, Iy = 0.7, N = m * g * Iy / (m * a * a + Iy);
  const Json found = answer(
      "solve",
      at_rest("potential = \"3*9.81*plate_z\"\nconstraints = { near = \"point(plate, 2/5, 1/5, 0, 3) >= 0\", "
              "far = \"point(plate, 2/5, -2/5, 0, 3) >= 0\", gone = \"point(plate, -1, 0, 0, 3) >= -1\" }\n"
              "[bodies.plate]\nmass = 3\ninertia = [0.5, 0.7, 1.2]",
              "plate"));
  CHECK(found["acceleration"]["plate_z"].get<double>() ==
        doctest::Approx(-g * m * a * a / (m * a * a + Iy)).epsilon(1e-13));
  CHECK(found["multipliers"]["near"].get<double>() == doctest::Approx(N * 2 / 3).epsilon(1e-13));
  CHECK(found["multipliers"]["far"].get<double>() == doctest::Approx(N / 3).epsilon(1e-13));
  CHECK(found["constraints"]["gone"]["state"] == "inactive");
  // It turns about y: e2'' is half of the angle's.
  CHECK(2 * found["acceleration"]["plate_e2"].get<double>() == doctest::Approx(-N * a / Iy).epsilon(1e-13));
  CHECK(std::abs(found["acceleration"]["plate_e1"].get<double>()) <= 1e-14);
}

TEST_CASE(
    "points of a body keep their distances at every attitude, and (a, b, c) stands where a rotation puts "
    "it") {
  // e = (1, 5, 7, 5)/10 is a unit vector.
  const std::string turned =
      "[system]\n[bodies.b]\nmass = 1\ninertia = [1, 2, 2]\n[system.constraints]\n"
      "distance = \"norm(point(b, 1, 2, 3) - point(b, 0, -1, 1)) = sqrt(14)\"\n"
      "first = \"point(b, 1, 2, 3, 1) = 2 + 2.06\"\nsecond = \"point(b, 1, 2, 3, 2) = 1.4\"\n"
      "third = \"sum(k in 3..3, point(b, 1, 2, 3, k)) = 3 + 2.8\"\n"
      "[state]\nposition = { b_x = 2, b_y = 0, b_z = 3, b_e0 = 0.1, b_e1 = 0.5, b_e2 = 0.7, b_e3 = 0.5 }\n";
  // R(e) by its columns e i e*: the numbers are those of the quaternion product.
  const Quaternion e{0.1, 0.5, 0.7, 0.5}, back{0.1, -0.5, -0.7, -0.5},
      p = product(product(e, {0, 1, 2, 3}), back);
  std::string text = turned;
  const auto put = [&](const std::string& from, double value) {
    const std::size_t at = text.find(from);
    REQUIRE(at != std::string::npos);
    text.replace(at, from.size(), "= " + Json(value).dump() + "\"");
  };
  put("= 2 + 2.06\"", 2 + p[1]);
  put("= 1.4\"", p[2]);
  put("= 3 + 2.8\"", 3 + p[3]);
  const Folder folder;
  const Outcome outcome = run({"solve", "--json", folder.write("problem.toml", text)});
  CAPTURE(outcome.err);
  CHECK(outcome.code == 0);
}

TEST_CASE("what a body adds is T and a constraint that derive shows, and T is definite off the constraint") {
  const std::string body = at_rest(
      "coordinates = [\"x\"]\nkinetic = \"x'^2/2\"\n[bodies.b]\nmass = \"m\"\ninertia = [\"J\", \"J\", "
      "\"J\"]\n[system.parameters]\nm = 3\nJ = 5",
      "b");
  std::string text = body;
  text.replace(text.find("position = { "), 13, "position = { x = 0, ");
  const Json found = answer("derive", text);
  CHECK(found["names"] == Json{"x", "b_x", "b_y", "b_z", "b_e0", "b_e1", "b_e2", "b_e3"});
  CHECK(found["two_sided"] == Json{"b_unit"});
  // Of a ball: 4 J in every direction of e, along e too.
  const std::vector<double> diagonal{1, 3, 3, 3, 20, 20, 20, 20};
  for (std::size_t i = 0; i < 8; ++i)
    for (std::size_t j = 0; j < 8; ++j)
      CHECK(found["A"][i][j].get<double>() == doctest::Approx(i == j ? diagonal[i] : 0).epsilon(1e-14));
}

TEST_CASE("dot, cross and norm obey Lagrange's and Jacobi's identities, and are differentiated as products") {
  const double rounding = 1e-11;  // of terms up to 1e3
  CHECK(std::abs(value_of("norm(cross(r, s))^2 + dot(r, s)^2 - dot(r, r)*norm(s)^2")) <= rounding);
  CHECK(std::abs(value_of(
            "dot([1, 2, 4], cross(r, cross(s, w)) + cross(s, cross(w, r)) + cross(w, cross(r, s)))")) <=
        rounding);
  CHECK(std::abs(value_of("dot(r, cross(s, w)) - dot(cross(r, s), w)")) <= rounding);
  CHECK(std::abs(value_of("dot(r, [0, 1, 0]) - r[2] + cross([1, 0, 0], [0, 1, 0])[3] - 1")) <= rounding);
  CHECK(std::abs(value_of("norm(2*r - s/4) - sqrt(sum(i in 1..3, (2*r[i] - s[i]/4)^2))")) <= rounding);
  CHECK(std::abs(value_of("sum(k in 1..3, cross(r, s)[k]*w[k]) - dot(w, cross(r, s))")) <= rounding);
  // r' = (1, 0, -1) at r = (1, 2, 3): (r·r)' = 2 r·r' = -4.
  const Json found = answer("solve",
                            "[system]\ncoordinates = [\"r[1..3]\"]\nkinetic = \"dot(r', r')\"\n"
                            "constraints = { c = \"dot(r, r) >= 0\" }\n[state]\n"
                            "position = { \"r[i]\" = \"i\" }\nvelocity = { \"r[i]\" = \"2 - i\" }\n");
  CHECK(found["constraints"]["c"]["df"] == -4);
  CHECK(found["constraints"]["c"]["ddf"] == 4);  // 2 r'·r'
}
