#include <cmath>
#include <fstream>
#include <functional>
#include <nlohmann/json.hpp>
#include <sstream>

#include "tests/cli/program.hpp"

using namespace tests;
using LiquidJson = nlohmann::json;

namespace {

/// A liquid in the plane of density 1.
std::string plane(const std::string& domain, const std::string& force_x, const std::string& free,
                  const std::string& walls, int cells) {
  return "[liquid]\ncoordinates = [\"x\", \"y\"]\ndomain = \"" + domain + "\"\ndensity = 1\nforce = [\"" +
         force_x + "\", \"0\"]\nfree = { " + free + " }\nwalls = { " + walls +
         " }\ncells = " + std::to_string(cells) + "\n";
}

struct Measured {
  LiquidJson told;
  double error = 0;  ///< the largest of p at the points of the table
};

Measured measured(const std::string& text, const std::function<double(double, double)>& exact) {
  const Folder folder;
  const std::string table = folder.path("p.csv");
  const Outcome outcome = run({"solve", "--json", folder.write("liquid.toml", text), "--data", table});
  CAPTURE(outcome.err);
  REQUIRE((outcome.code == 0 || outcome.code == 3));  // the bound may be above 1e-3 of the largest p
  Measured found{LiquidJson::parse(outcome.out), 0};
  std::ifstream rows(table);
  std::string line;
  std::getline(rows, line);
  while (std::getline(rows, line)) {
    std::replace(line.begin(), line.end(), ',', ' ');
    std::istringstream numbers(line);
    double x = 0, y = 0, p = 0;
    numbers >> x >> y >> p;
    found.error = std::max(found.error, std::abs(p - exact(x, y)));
  }
  return found;
}

double bound_of(const Measured& found) { return found.told["certificate"]["error_bound"].get<double>(); }

// p = max(0, g)² with g = x - 0.2 - 0.3 y²: the cavity ends at a parabola. -Δp = h = div of minus this force.
const std::string g = "(x - 0.2 - 0.3*y^2)", force = "2*x + 0.72*y^2*x - 0.6*x^2 + 0.24*x + 0.36*y^2*x",
                  squared = "max(0, " + g + ")^2";
double parabolic(double x, double y) { return std::pow(std::max(0.0, x - 0.2 - 0.3 * y * y), 2); }

/// The acceleration of a wall that the liquid just follows: F·n - ∂p/∂n.
std::string follows(const std::string& nx, const std::string& ny) {
  return "(" + force + ")*" + nx + " - 2*max(0, " + g + ")*(" + nx + " - 0.6*y*" + ny + ")";
}

// r^(2/3) sin(2θ/3) at the re-entrant corner of an L, r^(1/2) sin(θ/2) where a free part meets a wall.
double at_corner(double x, double y) {
  const double angle = std::atan2(y, x), turn = angle < -1e-3 ? angle + 2 * std::acos(-1.0) : angle;
  return 2 + std::cbrt(x * x + y * y) * std::sin(2 * turn / 3);
}
double at_junction(double x, double y) {
  return 2 + std::sqrt(std::hypot(x, y)) * std::sin(std::atan2(y, x) / 2);
}

Measured corner(int cells) {
  return measured(
      plane("polygon(vertices=[[0,0],[1,0],[1,1],[-1,1],[-1,-1],[0,-1]])", "0",
            "all = { where = \"true\", pressure = \"2 + (x^2+y^2)^(1/3)*sin(2/3*(if(atan2(y,x) < -0.001, "
            "atan2(y,x) + 2*pi, atan2(y,x))))\" }",
            "", cells),
      at_corner);
}

Measured junction(const std::string& low, int cells) {
  return measured(
      plane("box(low=[" + low + ", 0], high=[1, 1])", "0",
            "all = { where = \"y > 1e-7 or x >= 0\", pressure = \"2 + sqrt(hypot(x, y))*sin(atan2(y, "
            "x)/2)\" }",
            "floor = { where = \"true\", acceleration = 0 }", cells),
      at_junction);
}

}  // namespace

TEST_CASE("the error bound covers the truth on curved boundaries, free, and free beside walls") {
  const std::string all = "all = { where = \"true\", pressure = \"" + squared + "\" }";
  for (const int cells : {24, 48, 100})
    for (const std::string domain :
         {"box(low=[-1,-1], high=[1,1])", "disc(center=[0.1, -0.05], radius=0.9)", "{x^2 + 3*y^2 <= 1}",
          "polygon(vertices=[[-1,-1],[1.2,-0.7],[0.3,1]])", "{x^2 + y^2 <= 1, (x - 0.8)^2 + y^2 <= 1.1}"}) {
      CAPTURE(domain);
      CAPTURE(cells);
      const Measured found = measured(plane(domain, force, all, "", cells), parabolic);
      CHECK(found.error <= bound_of(found));
    }
  const std::string disc_wall = follows("((x - 0.1)/0.9)", "((y + 0.05)/0.9)"),
                    ellipse_wall = follows("(x/sqrt(x^2 + 9*y^2))", "(3*y/sqrt(x^2 + 9*y^2))");
  const auto beside = [](const std::string& where) {
    return "rim = { where = \"" + where + "\", pressure = \"" + squared + "\" }";
  };
  const auto rest = [](const std::string& a) {
    return "rest = { where = \"true\", acceleration = \"" + a + "\" }";
  };
  for (const int cells : {32, 64, 100, 128, 256}) {
    CAPTURE(cells);
    for (const std::string where : {"y >= 0", "x >= 0.6"}) {
      CAPTURE(where);
      const Measured found = measured(
          plane("disc(center=[0.1, -0.05], radius=0.9)", force, beside(where), rest(disc_wall), cells),
          parabolic);
      CHECK(found.error <= bound_of(found));
    }
    const Measured found = measured(
        plane("{x^2 + 3*y^2 <= 1}", force, beside("y >= 0.1"), rest(ellipse_wall), cells), parabolic);
    CHECK(found.error <= bound_of(found));
    CHECK(found.error <= 4.0 / (cells * cells));
  }
}

TEST_CASE("where walls end at free parts, and at edges and corners, the equations hold for every linear p") {
  const std::string wall = "rest = { where = \"true\", acceleration = 0 }";
  for (const std::string domain :
       {"disc(center=[0.1, -0.05], radius=0.9)", "{x^2 + 3*y^2 <= 1}", "{x^2 + y^2 <= 1, y >= -0.3}",
        "{x^2 + y^2 <= 1, x^2 + y^2 >= 0.2}", "polygon(vertices=[[-1,-1],[1.2,-0.7],[0.3,1]])",
        "polygon(vertices=[[0,0],[1,0],[1,1],[-1,1],[-1,-1],[0,-1]])"})
    for (const std::string where : {"x > 0.113", "x + y > 0.37", "y > 0.1 and x > -0.8"})
      for (const int cells : {25, 50, 64}) {
        CAPTURE(domain);
        CAPTURE(where);
        CAPTURE(cells);
        const Measured found =
            measured(plane(domain, "0.7", "rim = { where = \"" + where + "\", pressure = \"3 + 0.7*x\" }",
                           wall, cells),
                     [](double x, double) { return 3 + 0.7 * x; });
        CHECK(found.error <= 1e-9);
      }
  const Folder folder;
  for (const std::string domain : {"ball(center=[0.1, 0, 0.05], radius=1)", "{x^2 + y^2 + 2*z^2 <= 1}"}) {
    const Outcome outcome = run(
        {"solve", "--json", "--probe", "x=-0.576, y=-0.64, z=0.3",
         folder.write("space.toml",
                      "[liquid]\ncoordinates = [\"x\", \"y\", \"z\"]\ndensity = 1\ncells = 32\n"
                      "force = [\"0.7\", \"0.3\", \"-0.4\"]\ndomain = \"" +
                          domain +
                          "\"\nfree = { rim = { where = \"x + y > 0.13\", pressure = \"3 + 0.7*x + 0.3*y - "
                          "0.4*z\" } }\nwalls = { " +
                          wall + " }\n")});
    CAPTURE(outcome.err);
    REQUIRE(outcome.code == 0);
    const LiquidJson probe = LiquidJson::parse(outcome.out)["probes"][0];
    CHECK(std::abs(probe["p"].get<double>() - (3 - 0.7 * 0.576 - 0.3 * 0.64 - 0.4 * 0.3)) <= 1e-8);
  }
}

TEST_CASE("where two walls of a box meet, the equations hold for every quadratic p") {
  // p = 3 + xy + x²/2 - y/4: the flux along one wall changes towards the other.
  const auto exact = [](double x, double y) { return 3 + x * y + 0.5 * x * x - 0.25 * y; };
  for (const int cells : {8, 9, 32}) {
    const Measured found =
        measured(plane("box(low=[0, 0], high=[1, 2])", "x",
                       "top = { where = \"y >= 2\", pressure = \"2.5 + 2*x + x^2/2\" }",
                       "left = { where = \"x <= 0\", acceleration = \"y\" }, bed = { where = \"y <= 0\", "
                       "acceleration = \"x - 1/4\" }, right = { where = \"true\", acceleration = \"-y\" }",
                       cells),
                 exact);
    CHECK(found.error <= 1e-9);
  }
}

TEST_CASE(
    "where walls of two accelerations meet between nodes, errors are below a tenth of the jump by the step") {
  // ∂p/∂n jumps by π at (s, 0) for p = 6 + r ln r cos θ - r θ sin θ around it.
  constexpr double pi = 3.141592653589793;
  const std::string free_where = "where = \"y > 0 or x <= 0 or x >= 1\", ";
  for (const std::string s : {"0.5", "0.3", "0.7071"})
    for (const std::string& walls :
         {"a = { where = \"x < " + s +
              "\", acceleration = \"-pi\" }, b = { where = "
              "\"true\", acceleration = 0 }",
          "a = { where = \"true\", acceleration = \"if(x < " + s + ", -pi, 0)\" }"})
      for (const int cells : {64, 128}) {
        CAPTURE(s);
        CAPTURE(walls);
        CAPTURE(cells);
        const std::string dx = "(x - " + s + ")";
        const double place = std::stod(s);
        const Measured found =
            measured(plane("box(low=[0, 0], high=[1, 1])", "0",
                           "rim = { " + free_where + "pressure = \"6 + " + dx + "*ln(hypot(" + dx +
                               ", y)) - y*atan2(y, " + dx + ")\" }",
                           walls, cells),
                     [&](double x, double y) {
                       const double r = std::hypot(x - place, y);
                       return r > 0 ? 6 + (x - place) * std::log(r) - y * std::atan2(y, x - place) : 6;
                     });
        CHECK(found.error <= 0.1 * pi / cells);
        CHECK(found.error <= bound_of(found));
      }
}

TEST_CASE(
    "at a re-entrant corner errors go with the power 2/3 of the step, at a junction with 1/2, and are "
    "covered") {
  for (const int cells : {32, 64, 128}) {
    const Measured coarse = corner(cells), fine = corner(2 * cells);
    CHECK(coarse.error <= bound_of(coarse));
    CHECK(std::log2(coarse.error / fine.error) == doctest::Approx(2.0 / 3).epsilon(0.1));
    const Measured rough = junction("-1", cells), smooth = junction("-1", 2 * cells);
    CHECK(rough.error <= bound_of(rough));
    CHECK(bound_of(smooth) <= 0.4);  // p0 = 2 + √r sin(θ/2), which hides nothing
    CHECK(std::log2(rough.error / smooth.error) == doctest::Approx(0.5).epsilon(0.1));
  }
  // Grids that cannot be halved twice, and corners on which coarser grids lie otherwise, tell no order.
  for (const int cells : {50, 60, 100, 120}) {
    CAPTURE(cells);
    const Measured found = corner(cells), between = junction("-0.837", cells);
    CHECK(found.error <= bound_of(found));
    CHECK(between.error <= bound_of(between));
  }
  // Where the junction lies between nodes the error goes up and down below that power.
  for (const int cells : {32, 64, 100, 128, 256}) {
    CAPTURE(cells);
    const Measured found = junction("-0.9", cells);
    CHECK(found.error <= bound_of(found));
    CHECK(found.error <= 0.6 / std::sqrt(cells));
  }
}

TEST_CASE("where h jumps between nodes its mean over the cells counts, to second order") {
  // F = -20 max(g - a, 0): h is 20 beyond g = a, and p = 10 ((1 - a)² - max(g - a, 0)²) falls to 0 at g = 1.
  for (const std::string at : {"0.45966", "0.51"}) {
    const double edge = std::stod(at), whole = 10 * (1 - edge) * (1 - edge);
    for (const int cells : {16, 50, 100, 200}) {
      CAPTURE(cells);
      const Measured found =
          measured(plane("box(low=[0, 0], high=[1, 0.5])", "-20*max(x - " + at + ", 0)",
                         "top = { where = \"x >= 1\", pressure = 0 }",
                         "rest = { where = \"true\", acceleration = 0 }", cells),
                   [&](double x, double) { return whole - 10 * std::pow(std::max(0.0, x - edge), 2); });
      CHECK(found.error <= bound_of(found));
      CHECK(found.error <= 3e-3 * whole * std::pow(100.0 / cells, 2) / 4);
    }
  }
  // The same slanting across the cells, all of the boundary free.
  for (const int cells : {32, 64, 128}) {
    CAPTURE(cells);
    const std::string slant = "max(0.6*x + 0.8*y - 0.1, 0)";
    const Measured found = measured(
        plane("box(low=[-1, -1], high=[1, 1])", "-20/0.6*" + slant,
              "all = { where = \"true\", pressure = \"40 - 10*" + slant + "^2\" }", "", cells),
        [](double x, double y) { return 40 - 10 * std::pow(std::max(0.6 * x + 0.8 * y - 0.1, 0.0), 2); });
    CHECK(found.error <= bound_of(found));
    CHECK(found.error <= 40.0 / (cells * cells));
  }
}

TEST_CASE("a cavity that reaches a free surface without pressure is measured up to it") {
  // ∫ over |y| < 1 of 1.2 + 0.3 y², in the square (-1, 1)².
  const std::string all = "all = { where = \"true\", pressure = \"" + squared + "\" }";
  for (const int cells : {32, 64}) {
    const Measured found = measured(plane("box(low=[-1,-1], high=[1,1])", force, all, "", cells), parabolic);
    CHECK(std::abs(found.told["cavity"]["measure"].get<double>() - 2.6) <= 0.5 / cells);
  }
}

TEST_CASE("a box without pressure that parts everywhere is cavity up to its corners, and it is proved") {
  const Folder folder;
  const std::string text =
      "[liquid]\ncoordinates = [\"x\", \"y\"]\ndomain = \"box(low=[0, 0], high=[1, 2])\"\ndensity = 1\nforce "
      "= "
      "[\"4*x + y\", \"FORCE\"]\nfree = { rim = { where = \"true\", pressure = 0 } }\ncells = 64\n";
  const auto told = [&](std::string force_y) {
    std::string with = text;
    with.replace(with.find("FORCE"), 5, force_y);
    return run({"solve", "--json", "--certify", folder.write("box.toml", with)});
  };
  const Outcome all = told("exp(y)");
  REQUIRE(all.code == 0);
  const LiquidJson found = LiquidJson::parse(all.out);
  CHECK(found["cavity"]["measure"].get<double>() == doctest::Approx(2).epsilon(1e-12));
  CHECK(found["cavity"]["extent"]["x"] == LiquidJson::array({0.0, 1.0}));
  CHECK(found["cavity"]["extent"]["y"] == LiquidJson::array({0.0, 2.0}));
  CHECK(found["certificate"]["level"] == "enclosure");
  CHECK(found["certificate"]["error_bound"] == 0.0);
  // h = 0.001 - ... > 0 in a corner too small for the grid: nothing is proved.
  const LiquidJson doubted = LiquidJson::parse(told("exp(y) - 20*max(0, y - 1.995)").out);
  CHECK(doubted["certificate"]["level"] == "none");
}

TEST_CASE("a scene counts as radial where its text says so, and never where a choice is not") {
  const auto method = [](const std::string& domain, const std::string& x, const std::string& y) {
    const Folder folder;
    const std::string file =
        folder.write("r.toml", "[liquid]\ncoordinates = [\"x\", \"y\"]\ndomain = \"" + domain +
                                   "\"\ndensity = 1\nforce = [\"" + x + "\", \"" + y +
                                   "\"]\nfree = { rim = { where = \"true\", pressure = 1 } }\ncells = 32\n");
    const Outcome outcome = run({"solve", "--json", file});
    CAPTURE(outcome.err);
    CHECK((outcome.code == 0 || outcome.code == 3));
    return LiquidJson::parse(outcome.out)["method"].get<std::string>();
  };
  const std::string disc = "disc(center=[0, 0], radius=1)";
  CHECK(method(disc, "x*exp(-(x^2 + y^2))", "y*exp(-(x^2 + y^2))") == "radial");
  CHECK(method(disc, "if(x^2 + y^2 > 0.3, x*sqrt(0.3/(x^2 + y^2)), x)",
               "if(x^2 + y^2 > 0.3, y*sqrt(0.3/(x^2 + y^2)), y)") == "radial");
  CHECK(method(disc, "x + 3*y", "y - 3*x + 7") == "radial");  // of the force h alone counts
  CHECK(method("{(x - 1)^2 + (y + 2)^2 <= 1, (x - 1)^2 + (y + 2)^2 >= 1/9}", "(x - 1)^3 + (x - 1)*(y + 2)^2",
               "(y + 2)^3 + (y + 2)*(x - 1)^2") == "radial");
  CHECK(method(disc, "x^3", "y^3") == "radial");  // 3 (x² + y²)
  CHECK(method(disc, "x^3", "1.0000001*y^3") == "grid");
  CHECK(method(disc, "2*x + if(x > 0.97, 5*(x - 0.97)^2, 0)", "2*y") == "grid");  // seen in a small part only
  CHECK(method(disc, "2*x + max(0, x - 0.999)^2", "2*y") == "grid");
  CHECK(method("disc(center=[0.1, 0], radius=1)", "x^3", "y^3") == "grid");
}

TEST_CASE("a grid that has no coarser one is not called solved, since nothing tells its error") {
  const Folder folder;
  const std::string file = folder.write("odd.toml", plane("box(low=[0, 0], high=[1, 1])", "x",
                                                          "all = { where = \"true\", pressure = 1 }", "", 7));
  const Outcome outcome = run({"solve", "--json", file});
  CHECK(outcome.code == 3);
  CHECK(LiquidJson::parse(outcome.out)["certificate"]["error_bound"] == "inf");
  CHECK(run({"solve", file}).out.find("can be halved") != std::string::npos);
}

TEST_CASE(
    "a wall that moves as the liquid would without it is not parted from, whatever cells make of its curve") {
  const std::string of_disc = "3*x^2", of_ellipse = "3*x^2/sqrt(x^2 + 4*y^2)";  // F·n
  for (const auto& [domain, along] :
       {std::pair<std::string, std::string>{"disc(center=[0, 0], radius=1)", of_disc},
        {"{x^2 + 2*y^2 <= 1}", of_ellipse}})
    for (const auto& [times, parts] :
         {std::pair<std::string, std::size_t>{"1", 0}, {"0.99", 0}, {"1.0001", 1}}) {
      const std::string bed = "bed = { where = \"true\", acceleration = \"" + times + "*(" + along + ")\" }";
      const Outcome outcome =
          run({"solve", "--json", "-"},
              plane(domain, "3*x", "top = { where = \"y > 0.1\", pressure = 0.05 }", bed, 32));
      CAPTURE(domain);
      CAPTURE(times);
      const LiquidJson found = LiquidJson::parse(outcome.out);
      CHECK(found["cavity"]["measure"].get<double>() > 0.5);
      CHECK(found["parted_walls"].size() == parts);
    }
}
