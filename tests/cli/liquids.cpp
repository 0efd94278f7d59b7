#include <cmath>
#include <fstream>
#include <nlohmann/json.hpp>
#include <sstream>

#include "tests/cli/error_form.hpp"
#include "tests/this_build.hpp"

using namespace tests;
using Json = nlohmann::ordered_json;

namespace {

double number(const Json& text) { return std::stod(text.get<std::string>()); }

double fraction(const Json& text) {
  const std::string digits = text.get<std::string>();
  const std::size_t slash = digits.find('/');
  return std::stod(digits) / (slash == std::string::npos ? 1 : std::stod(digits.substr(slash + 1)));
}

/// Lines: 1 [liquid], 2 coordinates, 3 domain, 4 density, 5 velocity, 6 force, 7 free, 8 walls, 9 cells,
/// 10 [liquid.parameters], 11 p0.
std::string tank(const Changes& changes = {}) {
  std::vector<std::string> lines{"[liquid]",
                                 "coordinates = [\"x\", \"y\"]",
                                 "domain = \"box(low=[0, 0], high=[1, 1])\"",
                                 "density = 2",
                                 "",
                                 "force = [\"0\", \"-9\"]",
                                 "free = { top = { where = \"y >= 1\", pressure = \"p0\" } }",
                                 "walls = { rest = { where = \"true\", acceleration = 0 } }",
                                 "",
                                 "[liquid.parameters]",
                                 "p0 = 1"};
  for (const auto& [line, text] : changes) lines[static_cast<std::size_t>(line - 1)] = text;
  std::string file;
  for (const std::string& line : lines) file += line + "\n";
  return file;
}

Json solved_liquid(const std::string& text, std::vector<std::string> options = {}) {
  const Folder folder;
  std::vector<std::string> arguments{"solve", "--json", folder.write("liquid.toml", text)};
  arguments.insert(arguments.end(), options.begin(), options.end());
  const Outcome outcome = run(arguments);
  CAPTURE(text);
  CAPTURE(outcome.err);
  CHECK(outcome.code <= 1);
  return Json::parse(outcome.out);
}

}  // namespace

TEST_CASE("the liquids of the library have the answers of closed forms, within their error bounds") {
  for (const std::string name : {"piston", "tube", "disc", "ball", "square", "hemisphere", "tank"}) {
    CAPTURE(name);
    std::ifstream file(tests::source_folder() + "tests/cases/liquid_" + name + ".expected.json");
    const Json expected = Json::parse(file);
    std::vector<std::string> arguments{"solve", "--json",
                                       tests::source_folder() + "docs/problems/liquid_" + name + ".toml"};
    for (const Json& probe : expected["probes"]) {
      arguments.push_back("--probe");
      arguments.push_back(probe["at"]);
    }
    std::string onset;
    for (const auto& [parameter, value] : expected["onset"].items()) {
      onset = parameter;
      arguments.insert(arguments.end(), {"--onset", parameter});
    }
    const Outcome outcome = run(arguments);
    CAPTURE(outcome.err);
    REQUIRE(outcome.code == 0);
    const Json found = Json::parse(outcome.out);
    const double largest = number(expected["max"]), tolerance = number(expected["tolerance"]);
    const double bound = found["certificate"]["error_bound"].get<double>() + 1e-12 * largest;
    CHECK(std::abs(found["pressure"]["max"].get<double>() - largest) <= bound);
    CHECK(found["parted_walls"] == expected["parted_walls"]);
    for (std::size_t k = 0; k < expected["probes"].size(); ++k) {
      const double error =
          std::abs(found["probes"][k]["p"].get<double>() - number(expected["probes"][k]["p"]));
      CHECK(error <= bound);
      CHECK(error <= tolerance * largest);
      CHECK(found["probes"][k]["growth"].get<double>() ==
            doctest::Approx(number(expected["probes"][k]["growth"])));
    }
    const double measure = number(expected["measure"]);
    CHECK(std::abs(found["cavity"]["measure"].get<double>() - measure) <=
          std::max(tolerance, 1e-11) * std::max(1.0, measure));
    CHECK(found["cavity"]["extent"].is_null() == expected["extent"].is_null());
    if (!expected["extent"].is_null())
      CHECK(std::abs(found["cavity"]["extent"]["x"][1].get<double>() - number(expected["extent"])) <=
            std::max(tolerance, 1e-11));
    if (onset.empty()) continue;
    const double value = fraction(expected["onset"][onset]),
                 error = std::abs(found["onset"][onset].get<double>() - value);
    CHECK(error <= found["onset_error"].get<double>());
    CHECK(error <= 1e-7);
  }
}

TEST_CASE("a liquid without a free surface is squeezed, rests, or parts from the wall that leaves") {
  const auto lid = [](const std::string& acceleration) {
    return tank({{7, "free = {}"},
                 {8, "walls = { lid = { where = \"y >= 1\", acceleration = " + acceleration +
                         " }, rest = { where = \"true\", acceleration = 0 } }"}});
  };
  const Json squeezed = solved_liquid(lid("-1")),
             at_rest = solved_liquid(lid("0"), {"--probe", "x=0.5, y=0.25"}),
             lifted = solved_liquid(lid("1"));
  CHECK(squeezed["status"] == "infeasible");
  for (const char* key : {"cavity", "pressure", "onset", "certificate"}) CHECK(squeezed[key].is_null());
  for (const char* key : {"parted_walls", "probes"}) CHECK(squeezed[key] == Json::array());
  CHECK(squeezed["surplus"].get<double>() == doctest::Approx(2));
  CHECK(at_rest["status"] == "solved");
  CHECK(at_rest["probes"][0]["p"].get<double>() == doctest::Approx(13.5).epsilon(1e-6));
  CHECK(at_rest["parted_walls"].empty());
  CHECK(lifted["parted_walls"] == Json::parse(R"(["lid"])"));
}

TEST_CASE("a parameter has no onset where no value of it brings cavitation") {
  CHECK(solved_liquid(tank(), {"--onset", "p0"})["onset"].is_null());
}

TEST_CASE(
    "the table and the image of a liquid have a row for each point of the domain and for each of the box") {
  const Folder folder;
  const std::string table = folder.path("p.csv"), image = folder.path("p.vti");
  solved_liquid(tank({{9, "cells = 8"}}), {"--data", table, "--vtk", image});
  std::ifstream rows(table);
  std::string line;
  REQUIRE(std::getline(rows, line));
  CHECK(line == "x,y,p,growth,cavity");
  int count = 0;
  while (std::getline(rows, line)) {
    std::replace(line.begin(), line.end(), ',', ' ');
    std::istringstream numbers(line);
    double x = 0, y = 0, p = 0;
    numbers >> x >> y >> p;
    CHECK(p == doctest::Approx(1 + 18 * (1 - y)));
    ++count;
  }
  CHECK(count == 81);
  std::ifstream text(image);
  std::stringstream whole;
  whole << text.rdbuf();
  CHECK(whole.str().find("WholeExtent=\"0 8 0 8 0 0\"") != std::string::npos);
}

TEST_CASE("where rates of stretching are what is left of terms that cancel their rounding is no divergence") {
  // A dipole, whose ∂u/∂x and ∂v/∂y vanish along the line y = x/√3 through the domain.
  const Folder folder;
  const std::string file = folder.write("a.toml",
                                        "[liquid]\ncoordinates = [\"x\", \"y\"]\n"
                                        "domain = \"disc(center=[3, 1.7320508], radius=1)\"\ndensity = 1\n"
                                        "velocity = [\"-(x^2-y^2)/(x^2+y^2)^2\", \"-2*x*y/(x^2+y^2)^2\"]\n"
                                        "free = { rim = { where = \"true\", pressure = 1 } }\ncells = 64\n");
  CHECK(run({"solve", file}).code == 0);
}

TEST_CASE("what is wrong in a liquid is named, with its place") {
  const std::vector<Wrong> wrong{
      {tank({{8, ""}}), "1:1", {"boundary point", "no part"}},
      {tank({{11, "p0 = -1"}}), "7:10", {"free.top", "below 0"}},
      {tank({{5, "velocity = [\"x\", \"y\"]"}}), "5:14", {"divergence is 2", "no cavity"}},
      {tank({{5, "velocities = [0, 0]"}}), "5:1", {"velocities", "velocity"}},
      {tank({{5, "velocity = [0]"}}), "5:12", {"one a coordinate"}},
      {tank({{3, "domain = \"box(low=[0, 0], high=[1, 0])\""}}), "3:11", {"empty"}},
      {tank({{3, "domain = \"disk(center=[0, 0], radius=1)\""}}), "3:11", {"no shape"}},
      {tank({{3, "domain = \"{x^2 + y^2 <= -1}\""}}), "3:11", {"empty"}},
      {tank({{3, "domain = \"{x >= 0, y >= 0}\""}}), "3:11", {"does not end"}},
      {tank({{3, "domain = \"{(x^2 - 1)^2 + y^2 <= 0.5}\""}, {9, "low = [-2, -1]\nhigh = [2, 1]"}}),
       "1:1",
       {"not connected"}},
      {tank({{3, "domain = \"polygon(vertices=[[0, 0], [2, 2], [2, 0], [0, 1]])\""}}), "3:11", {"cross"}},
      {tank({{4, "density = 0"}}), "4:11", {"above 0"}},
      {tank({{6, "force = [\"0\", \"if(y > 0.3, -9, -8)\"]"}}), "6:16", {"force", "jumps at", "y = 0.3"}},
      {tank({{5, "velocity = [\"step(y - 0.6)\", \"0\"]"}}), "5:14", {"velocity", "jumps at", "y = 0.6"}},
      {tank({{7, "free = { top = { where = \"y\", pressure = \"p0\" } }"}}), "7:27", {"relation"}},
      {tank({{7, "free = { top = { where = \"z >= 1\", pressure = \"p0\" } }"}}), "7:27", {"unknown"}},
      {tank({{9, "cells = 100000"}}), "1:1", {"GB of memory"}},
      {tank({{9, "symmetry = \"radial\""}}), "1:1", {"radial"}},
  };
  for (const Wrong& one : wrong) expect_refusal(one);
}

TEST_CASE("--certify encloses the pressure of a disc, also at its onset, and of no scene in doubt") {
  // The edges are cited: roots of the closed forms in y = p0/(rho omega^2 R^2), and of the ball's in p0/(k
  // R^2).
  const auto disc = [](const std::string& p0, const std::string& where) {
    return "[liquid]\ncoordinates = [\"x\", \"y\"]\ndomain = \"disc(center=[0, 0], radius=1)\"\ndensity = 1\n"
           "velocity = [\"-2*y\", \"2*x\"]\nfree = { rim = { where = \"" +
           where + "\", pressure = \"" + p0 + "\" } }\n";
  };
  struct Edge {
    const char* p0;
    long double s;
  };
  for (const Edge& edge : {Edge{"1.6", 0.2237660542638937L}, Edge{"1", 0.43206748182527804L},
                           Edge{"0.4", 0.6621956952852164L}, Edge{"0.08", 0.8548867369907398L}}) {
    CAPTURE(edge.p0);
    const Json found = solved_liquid(disc(edge.p0, "true"), {"--certify", "--probe", "x=0.54, y=0.72"});
    REQUIRE(found["certificate"]["level"] == "enclosure");
    const double bound = found["certificate"]["error_bound"].get<double>();
    CHECK(bound <= 1e-12);
    const long double r = 0.9L, s = edge.s;
    const long double p = 2 * (r * r - s * s) - 4 * s * s * std::log(r / s);
    CHECK(std::abs(static_cast<double>(found["probes"][0]["p"].get<double>() - p)) <= bound);
    CHECK(found["pressure"]["max"].get<double>() == std::stod(edge.p0));
  }
  // At its onset the cavity is a point.
  const Json onset = solved_liquid(disc("2", "true"), {"--certify", "--probe", "x=0.6, y=0"});
  CHECK(onset["certificate"]["level"] == "enclosure");
  CHECK(std::abs(onset["probes"][0]["p"].get<double>() - 0.72) <=
        onset["certificate"]["error_bound"].get<double>());
  // Where a condition that is not radial chooses the boundary, on grids, and where neither h nor F has a
  // bound at an end, nothing is proved, and it is said why.
  const Folder folder;
  const std::string rough =
      "[liquid]\ncoordinates = [\"x\"]\ndomain = \"interval(low=0, high=1)\"\ndensity = 1\nforce = "
      "[\"log(x)\"]\nfree = { ends = { where = \"true\", pressure = 0.1 } }\n";
  for (const std::string& text : {disc("1", "x > -7"), rough, tank({{9, "cells = 32"}})}) {
    const Outcome outcome = run({"solve", "--json", "--certify", folder.write("open.toml", text)});
    CAPTURE(text);
    CHECK(outcome.code == 3);
    CHECK(Json::parse(outcome.out)["certificate"]["level"] == "none");
    CHECK(Json::parse(outcome.out)["certificate"]["why"].get<std::string>().size() > 20);
  }
}

TEST_CASE("--certify encloses lines, balls and shells whose h varies, with free ends and walls") {
  const auto scene = [](const std::string& names, const std::string& domain, const std::string& force,
                        const std::string& parts) {
    return "[liquid]\ncoordinates = [" + names + "]\ndomain = \"" + domain + "\"\ndensity = 1\nforce = [" +
           force + "]\n" + parts;
  };
  const auto free = [](const std::string& p) {
    return "free = { rim = { where = \"true\", pressure = \"" + p + "\" } }\n";
  };
  // F = (1 + r²) x in the plane: (r p')' = (r² + r⁴)', so from an edge s on
  // p = (r² - s²)/2 + (r⁴ - s⁴)/4 - (s² + s⁴) ln(r/s).
  const auto swirl = [](long double r, long double s) {
    return (r * r - s * s) / 2 + (r * r * r * r - s * s * s * s) / 4 -
           (s * s + s * s * s * s) * std::log(r / s);
  };
  const std::string turning = "\"(1 + x^2 + y^2)*x\", \"(1 + x^2 + y^2)*y\"", plane = "\"x\", \"y\"";
  // F = 8 max(x - 1/4, 0): p is a line up to 1/4, then 4 (x - l)², and 4 (x - 3/4)² before the end. By the
  // low end 4 e² + 10 e = 1/4 with e = l - 1/4.
  const long double e = (std::sqrt(104.0L) - 10) / 8;
  struct Proved {
    std::string text, probe;
    long double p, edge;
  };
  const std::vector<Proved> cases{
      {scene(plane, "disc(center=[0, 0], radius=1)", turning,
             free("(1 - 1/4)/2 + (1 - 1/16)/4 - (1/4 + 1/16)*log(2)")),
       "x=0.48, y=0.64", swirl(0.8L, 0.5L), 0.5L},
      {scene(
           plane, "{0.04 <= x^2 + y^2, x^2 + y^2 <= 1}", turning,
           "free = { out = { where = \"x^2 + y^2 > 0.5\", pressure = \"3/8 + 15/64 - 5/16*log(2)\" }, in = { "
           "where = \"true\", pressure = 0 } }\n"),
       "x=0.48, y=0.64", swirl(0.8L, 0.5L), 0.5L},
      {scene(plane, "{(x - 1/3)^2 + y^2 <= 1}",
             "\"(1 + (x - 1/3)^2 + y^2)*(x - 1/3)\", \"(1 + (x - 1/3)^2 + y^2)*y\"",
             free("3/8 + 15/64 - 5/16*log(2)")),
       "x=1/3, y=0.8", swirl(0.8L, 0.5L), 1 / 3.0L + 0.5L},
      {scene("\"x\"", "interval(low=-1, high=1)", "\"8*max(x - 1/4, 0)\"", free("1/4")), "x=0",
       4 * e * e + 2 * e, 0.75L},
      // A wall that takes p' = 1 at 0 from F = x² - 1: p' = F there, and p(1) = 1/3 makes p(0) = 1.
      {scene(
           "\"x\"", "interval(low=0, high=1)", "\"x^2 - 1\"",
           "free = { top = { where = \"x >= 1\", pressure = \"1/3\" } }\nwalls = { bed = { where = \"true\", "
           "acceleration = 0 } }\n"),
       "x=0.5", 1 - 0.5L + 1 / 24.0L, 0},
  };
  for (const Proved& one : cases) {
    CAPTURE(one.text);
    const Json found = solved_liquid(one.text, {"--certify", "--probe", one.probe});
    REQUIRE(found["certificate"]["level"] == "enclosure");
    const double bound = found["certificate"]["error_bound"].get<double>();
    CHECK(bound <= 1e-11);
    if (one.edge > 0) {
      CHECK(std::abs(found["probes"][0]["p"].get<double>() - static_cast<double>(one.p)) <= bound + 1e-16);
      CHECK(std::abs(found["cavity"]["extent"]["x"][1].get<double>() - static_cast<double>(one.edge)) <=
            1e-11);
    }
  }
  CHECK(std::abs(solved_liquid(cases.back().text, {"--certify", "--probe", "x=0.5"})["probes"][0]["p"]
                     .get<double>() -
                 static_cast<double>(cases.back().p)) <= 1e-12);
}

TEST_CASE("the box that is found around inequalities holds all of the domain, whatever its size") {
  // p = 1 + (1 - x² - y²/b²) on the ellipse: h = 2 + 2/b².
  for (const double b : {0.9, 1.03, 1.05, 1.1, 1.5, 2.05, 2.2}) {
    CAPTURE(b);
    const std::string q = std::to_string(1 / (b * b));
    const Json found =
        solved_liquid("[liquid]\ncoordinates = [\"x\", \"y\"]\ndomain = \"{x^2 + " + q +
                          "*y^2 <= 1}\"\ndensity = 1\nforce = [\"-(2 + 2*" + q +
                          ")*x\", \"0\"]\nfree = { rim = { where = \"true\", pressure = 1 } }\ncells = "
                          "64\n",
                      {"--tolerance", "1e-2"});
    CHECK(std::abs(found["pressure"]["max"].get<double>() - 2) <= 1e-3);
  }
  // A wedge that no sample meets near its tip, where the grid has no node either.
  const Folder folder;
  const std::string wedge = folder.write("wedge.toml",
                                         "[liquid]\ncoordinates = [\"x\", \"y\"]\ndomain = \"{y >= 0, y <= "
                                         "0.02*x, x <= 1}\"\ndensity = 1\nfree = "
                                         "{ rim = { where = \"true\", pressure = 1 } }\ncells = 256\n");
  const Outcome tip = run({"solve", wedge, "--probe", "x=0.02, y=0.0001"});
  CHECK(tip.code == 2);
  CHECK(tip.err.find("thinner than the cells") != std::string::npos);
  CHECK(run({"solve", wedge, "--probe", "x=0.9, y=0.01"}).code == 0);
}

TEST_CASE("--certify encloses the solution of a grid's equations, and says that it is of them alone") {
  const Folder folder;
  const std::string file = folder.write("tank.toml", tank({{9, "cells = 32"}}));
  const Outcome told = run({"solve", "--certify", file}), json = run({"solve", "--certify", "--json", file});
  CHECK(told.code == 3);
  CHECK(told.out.find("Proved of the grid's equations alone") != std::string::npos);
  const Json certificate = Json::parse(json.out)["certificate"];
  CHECK(certificate["level"] == "none");
  CHECK(certificate["grid"]["level"] == "enclosure");
  CHECK(certificate["grid"]["error_bound"].get<double>() <= 1e-10);
  CHECK_FALSE(solved_liquid(tank({{9, "cells = 32"}}))["certificate"].contains("grid"));
}

TEST_CASE("the velocity is drawn as arrows beside the pressure, where there is a plane") {
  const Folder folder;
  const std::string turning = tank({{5, "velocity = [\"y\", \"-x\"]"}, {9, "cells = 16"}});
  const std::string file = folder.write("tank.toml", turning), picture = folder.path("p.svg");
  REQUIRE(run({"solve", file, "--plot", picture, "--velocity"}).code <= 1);
  std::stringstream text;
  text << std::ifstream(picture).rdbuf();
  CHECK(text.str().find("arrows: the velocity, the longest 1.") != std::string::npos);
  CHECK(run({"solve", file, "--velocity"}).err.find("--plot") != std::string::npos);
  const Outcome line = run(
      {"solve", tests::source_folder() + "docs/problems/liquid_tube.toml", "--velocity", "--plot", picture});
  CHECK(line.code == 2);
  CHECK(line.err.find("--velocity") != std::string::npos);
}
