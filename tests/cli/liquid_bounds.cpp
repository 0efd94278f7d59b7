#include <cmath>
#include <fstream>
#include <iterator>
#include <nlohmann/json.hpp>
#include <tuple>

#include "tests/cli/program.hpp"
#include "tests/this_build.hpp"

using namespace tests;
using Told = nlohmann::json;

namespace {

/// A liquid in the plane of density 1.
Told told(const std::string& domain, const std::string& force, const std::string& parts,
          const std::string& probe = "") {
  const Folder folder;
  const std::string file =
      folder.write("liquid.toml", "[liquid]\ncoordinates = [\"x\", \"y\"]\ndensity = 1\ndomain = \"" +
                                      domain + "\"\nforce = " + force + "\n" + parts);
  const Outcome outcome =
      probe.empty() ? run({"solve", "--json", file}) : run({"solve", "--json", file, "--probe", probe});
  CAPTURE(outcome.err);
  REQUIRE((outcome.code == 0 || outcome.code == 3));
  return Told::parse(outcome.out);
}

double bound_of(const Told& answer) { return answer["certificate"]["error_bound"].get<double>(); }

}  // namespace

TEST_CASE(
    "the largest pressure is that of the closed domain: at a vertex where p0 is largest, and no further than "
    "walls") {
  // p = 3 + x, largest at the vertex.
  const Told polygon =
      told("polygon(vertices=[[0.097, 0.607], [-0.567, 1.48], [-1.872, 0.299], [-1.191, -0.42]])",
           "[\"0\", \"0\"]", "free = { all = { where = \"true\", pressure = \"3 + x\" } }\ncells = 32\n");
  CHECK(polygon["pressure"]["max"].get<double>() == doctest::Approx(3.097).epsilon(1e-12));
  CHECK(polygon["pressure"]["at"]["x"].get<double>() == doctest::Approx(0.097));

  // p = (1 + r²)/2, largest on the rim, nearly all of which is a wall.
  for (const int cells : {48, 100, 256}) {
    CAPTURE(cells);
    const Told disc = told(
        "disc(center=[0, 0], radius=1)", "[\"x\", \"y\"]",
        "free = { tip = { where = \"x >= 0.99999\", pressure = 1 } }\nwalls = { rim = { where = \"true\", "
        "acceleration = 0 } }\ncells = " +
            std::to_string(cells) + "\n");
    CHECK(std::abs(disc["pressure"]["max"].get<double>() - 1) <= bound_of(disc));
    const double x = disc["pressure"]["at"]["x"].get<double>(), y = disc["pressure"]["at"]["y"].get<double>();
    CHECK(std::hypot(x, y) <= 1 + 1e-9);
  }
}

TEST_CASE(
    "where a cavity ends beyond a node that all grids share, and these agree on what is wrong, the error "
    "bound covers it") {
  // p = max(x - e, 0)²/2.
  for (const int cells : {16, 32, 64, 128})
    for (const double beyond : {0.1, 0.3, 0.45, 0.49}) {
      const double edge = 0.5 + beyond / cells;
      CAPTURE(cells);
      CAPTURE(beyond);
      const Told answer =
          told("box(low=[0, 0], high=[1, 1])", "[\"x\", \"0\"]",
               "free = { all = { where = \"true\", pressure = \"max(x - e, 0)^2/2\" } }\ncells = " +
                   std::to_string(cells) + "\n[liquid.parameters]\ne = " + std::to_string(edge) + "\n",
               "x=0.6,y=0.5");
      const double e = std::stod(std::to_string(edge)), p = answer["probes"][0]["p"].get<double>();
      CHECK(std::abs(p - 0.5 * std::pow(std::max(0.0, 0.6 - e), 2)) <= bound_of(answer));
    }
}

TEST_CASE(
    "a bump of what the boundary gives between the points where a grid asks for it counts in the error "
    "bound") {
  // p at (0.9, 0.3) is 1.316799 by Poisson's integral on 4e7 points.
  const std::string parts =
      "free = { all = { where = \"true\", pressure = \"1 + 100*exp(-1e7*(y - 0.30003)^2)\" } }\n";
  const Told answer =
      told("disc(center=[0, 0], radius=1)", "[\"0.1*x\", \"0.1*y\"]", parts + "cells = 256\n", "x=0.9,y=0.3");
  CHECK(answer["status"] == "inaccurate");
  CHECK(std::abs(answer["probes"][0]["p"].get<double>() - 1.316799) <= bound_of(answer));
  // The same of a wall's acceleration: p(0.5, 0.5) = 1.09111 and p(0.5, 0.01) = 1.33300 by Fourier series.
  const Told wall =
      told("box(low=[0, 0], high=[1, 1])", "[\"0\", \"0\"]",
           "free = { top = { where = \"y >= 1\", pressure = 1 } }\nwalls = { bed = { where = \"y <= 0\", "
           "acceleration "
           "= \"-1000*exp(-((x - 0.50113)/1e-4)^2)\" }, sides = { where = \"true\", acceleration = 0 } }\n",
           "x=0.5,y=0.01");
  CHECK(wall["status"] == "inaccurate");
  CHECK(std::abs(wall["probes"][0]["p"].get<double>() - 1.333) <= bound_of(wall));
  // A pressure that hides nothing, though its terms cancel: of the order of the grid's own error.
  const Told smooth = told("disc(center=[0, 0], radius=1)", "[\"0\", \"0\"]",
                           "free = { all = { where = \"true\", pressure = \"2 + x*y + (x^2 + y^2)^2 - 2*(x^2 "
                           "+ y^2)\" } }\ncells = 128\n");
  CHECK(bound_of(smooth) <= 1e-3);
}

TEST_CASE(
    "over a hemisphere the pressure converges at second order, the cavity's edge at first, and bounds cover "
    "both") {
  std::ifstream file(tests::source_folder() + "docs/problems/liquid_hemisphere.toml");
  const std::string text{std::istreambuf_iterator<char>(file), {}};
  const double a = 0.697965148223374, p = a * a / std::sqrt(1 - a * a) * std::log(2 / 1.5) - std::sqrt(0.19) +
                                          0.9 / std::sqrt(0.19) * (1.5 - 0.9);
  double first_error = 0, first_edge = 0;
  for (const int cells : {128, 512}) {
    const Folder folder;
    std::string scene = text;
    scene.replace(scene.find("density"), 0, "cells = " + std::to_string(cells) + "\n");
    const Outcome outcome =
        run({"solve", "--json", folder.write("liquid.toml", scene), "--probe", "x=1.5, y=0"});
    CAPTURE(outcome.err);
    REQUIRE((outcome.code == 0 || outcome.code == 3));
    const Told answer = Told::parse(outcome.out);
    const double error = std::abs(answer["probes"][0]["p"].get<double>() - p),
                 edge = std::abs(answer["cavity"]["extent"]["x"][1].get<double>() - a);
    CHECK(error <= bound_of(answer));
    if (cells == 128) {
      first_error = error;
      first_edge = edge;
      continue;
    }
    CHECK(error <= first_error / 8);  // 16 at second order
    CHECK(edge <= first_edge / 4);
  }
}

TEST_CASE(
    "what of a boundary lies between the nodes of a grid, a part of it, a gap or a cut, is refused by name") {
  const auto refusal = [](const std::string& domain, const std::string& parts) {
    const Folder folder;
    const Outcome outcome =
        run({"solve", folder.write("liquid.toml",
                                   "[liquid]\ncoordinates = [\"x\", \"y\"]\ndensity = 1\ncells = "
                                   "64\nforce = [\"0\", \"-1\"]\ndomain = \"" +
                                       domain + "\"\n" + parts)});
    return std::pair{outcome.code, outcome.err};
  };
  const std::string slit = "x > 0.3001 and x < 0.3006", wall = "w = { where = \"true\", acceleration = 0 }",
                    square = "box(low=[0, 0], high=[1, 1])", disc = "disc(center=[0, 0], radius=1)";
  // p = 2 - y as long as the slit is there, and without a free part none at all.
  const std::string open =
      "free = { slit = { where = \"y >= 1 and " + slit + "\", pressure = 1 } }\nwalls = { ";
  for (const auto& [domain, parts, name] : {
           std::tuple{square, open + wall + " }", "free.slit"},
           std::tuple{square, open + "top = { where = \"y >= 1\", acceleration = 0 }, " + wall + " }",
                      "free.slit"},
           std::tuple{square,
                      "free = { top = { where = \"y >= 1\", pressure = 1 } }\nwalls = { jet = { where = \"y "
                      "<= 0 and " +
                          slit + "\", acceleration = -1000 }, " + wall + " }",
                      "walls.jet"},
           std::tuple{
               square,
               "free = { top = { where = \"y >= 1\", pressure = 1 }, slit = { where = \"(x - 0.30035)^2 <= "
               "1e-8\", pressure = 0 } }\nwalls = { " +
                   wall + " }",
               "free.slit"},
           std::tuple{disc,
                      "free = { slit = { where = \"y > 0 and " + slit +
                          "\", pressure = 0 }, rest = { where = \"true\", pressure = 1 } }\n",
                      "free.slit"},
       }) {
    const auto [code, words] = refusal(domain, parts);
    CAPTURE(parts);
    CHECK(code == 2);
    CHECK(words.find(name + std::string(": it has a piece at (x = 0.30")) != std::string::npos);
  }
  const std::string ends =
      "free = { left = { where = \"x <= -1\", pressure = 1 }, right = { where = \"x >= 1\", "
      "pressure = 3 } }\nwalls = { " +
      wall + " }";
  for (const char* vertices : {
           // two boxes joined by a channel, a box nearly cut in two, and a cut that is a wedge
           "[-1,-0.5],[-0.1,-0.5],[-0.1,0.1001],[0.1,0.1001],[0.1,-0.5],[1,-0.5],[1,0.5],[0.1,0.5],[0.1,0."
           "1011],"
           "[-0.1,0.1011],[-0.1,0.5],[-1,0.5]",
           "[-1,-0.5],[1,-0.5],[1,0.5],[0.1011,0.5],[0.1011,-0.499],[0.1001,-0.499],[0.1001,0.5],[-1,0.5]",
           "[-1,-0.5],[1,-0.5],[1,0.5],[0.1011,0.5],[0.1005,-0.499],[0.1001,0.5],[-1,0.5]",
       }) {
    const auto [code, words] = refusal("polygon(vertices=[" + std::string(vertices) + "])", ends);
    CAPTURE(vertices);
    CHECK(code == 2);
    CHECK(words.find("domain: it has a hole or a gap at (x = ") != std::string::npos);
  }
  // A piece that nothing claims.
  const auto [unclaimed, said] =
      refusal(square, "free = { all = { where = \"x < 0.3137 or x > 0.3138 or y < 0.5\", pressure = 1 } }\n");
  CHECK(unclaimed == 2);
  CHECK(said.find("the boundary point (x = 0.3137") != std::string::npos);
  // Tips of wedges, of the liquid and into it, and a part that claims a point alone are no such thing.
  for (const auto& [domain, parts] : {
           std::pair{
               std::string("polygon(vertices=[[-1,-0.5],[1,-0.48],[0.2,-0.1],[1,0.5],[0.1,0.2],[-1,0.5]])"),
               ends},
           std::pair<std::string, std::string>{
               square,
               "free = { corner = { where = \"x >= 1 and y >= 1\", pressure = 5 }, top = { where = \"y "
               ">= 1\", pressure = 1 }, rest = { where = \"x <= 1\", pressure = 1 } }"},
           std::pair<std::string, std::string>{square,
                                               "free = { left = { where = \"x < 0.5\", pressure = 1 }, right "
                                               "= { where = \"x > 0.5\", pressure = 1 } }"},
           std::pair<std::string, std::string>{
               disc, "free = { top = { where = \"x^2 + y^2 >= 1 and y > -2\", pressure = 1 } }\nwalls = { " +
                         wall + " }"},
       }) {
    CAPTURE(parts);
    CHECK(refusal(domain, parts).second == "");
  }
}

TEST_CASE(
    "where h jumps along lines that are none of the grid the bound covers what its difference to fine grids "
    "shows") {
  // h = 2 A sign(x - c) sign(y - d); 512 cells take the lines where they are to a 64th of a cell.
  const Folder folder;
  const auto pressure = [&](const std::string& cells) {
    const std::string file = folder.write("jump.toml",
                                          "[liquid]\ncoordinates = [\"x\", \"y\"]\ndomain = \"box(low=[0, "
                                          "0], high=[1, 1])\"\ndensity = 1\nvelocity = "
                                          "[\"abs(y - 0.2113)\", \"A*abs(x - 0.4441)\"]\nfree = { rim = { "
                                          "where = \"true\", pressure = 1 } }\ncells = " +
                                              cells + "\n[liquid.parameters]\nA = 2\n");
    const auto json =
        nlohmann::json::parse(run({"solve", "--json", "--probe", "x=0.4441, y=0.2113", file}).out);
    return std::pair<double, double>{json["probes"][0]["p"], json["certificate"]["error_bound"]};
  };
  const double fine = pressure("512").first;
  for (const char* cells : {"24", "32", "36", "52", "64", "100"}) {
    CAPTURE(cells);
    const auto [p, bound] = pressure(cells);
    CHECK(std::abs(p - fine) <= bound);
  }
}

TEST_CASE("a bump of a given pressure whose foot one crossing of the grid sees is in the bound") {
  const Folder folder;
  for (const char* k : {"0.012", "0.02", "0.05"}) {
    CAPTURE(k);
    const std::string file = folder.write("bump.toml",
                                          "[liquid]\ncoordinates = [\"x\", \"y\"]\ndomain = "
                                          "\"disc(center=[0, 0], radius=1)\"\ndensity = 1\nforce = "
                                          "[\"0.1*x\", \"0.1*y\"]\nfree = { a = { where = \"true\", pressure "
                                          "= \"1 + k*exp(-1e7*(y - 0.30003)^2)\" } "
                                          "}\ncells = 512\n[liquid.parameters]\nk = " +
                                              std::string(k) + "\n");
    const auto json = nlohmann::json::parse(run({"solve", "--json", file}).out);
    const double told = json["pressure"]["max"], bound = json["certificate"]["error_bound"];
    CHECK(1 + std::stod(k) <= told + bound);
  }
}

TEST_CASE("a liquid whose accuracy is not met tells what was asked, how near it came, and what is met") {
  const Folder folder;
  const std::string file = folder.write("a.toml",
                                        "[liquid]\ncoordinates = [\"x\", \"y\"]\ndomain = "
                                        "\"polygon(vertices=[[0,0],[2,0],[2,1],[1,1],[1,2],[0,2]])\"\n"
                                        "density = 1\nforce = [\"3*y\", \"-1\"]\ncells = 16\nfree = { top = "
                                        "{ where = \"y >= 2\", pressure = 1 } }\n"
                                        "walls = { rest = { where = \"true\", acceleration = 0 } }\n");
  const Outcome told = run({"solve", file});
  CHECK(told.code == 3);
  CHECK(told.out.find("The accuracy asked for, 0.1 % of the largest pressure, was not met; --tolerance ") !=
        std::string::npos);
  CHECK(told.out.find(" % of the largest.\n") != std::string::npos);
  const std::string before = "--tolerance ";
  const std::string rest = told.out.substr(told.out.find(before) + before.size());
  CHECK(run({"solve", "--quiet", file, "--tolerance", rest.substr(0, rest.find(' '))}).code == 0);
}
