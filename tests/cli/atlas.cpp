#include <doctest/doctest.h>

#include <cmath>
#include <nlohmann/json.hpp>

#include "tests/cli/program.hpp"

using namespace tests;
using Json = nlohmann::ordered_json;

namespace {

/// Both contacts persist for z in the third quadrant; A = [[2, 1], [1, 2]].
const char* const corner =
    "[projection]\nA = [[2, 1], [1, 2]]\nz = [1, -3]\nU = [[1, 0], [0, 1]]\ns = [0, \"1/3\"]\n";

}  // namespace

TEST_CASE("an atlas of two contacts has four cells and four walls with exact equations") {
  const Outcome outcome = run_json_on("atlas", corner);
  CHECK(outcome.code == 0);
  const Json atlas = Json::parse(outcome.out);
  CHECK(atlas.at("kind") == "atlas");
  CHECK(atlas.at("status") == "solved");
  CHECK(atlas.at("numbers") == "as written");
  CHECK(atlas.at("conical") == true);
  REQUIRE(atlas.at("cells").size() == 4);
  CHECK(atlas.at("cells")[0].at("contacts") == Json({"c[0]", "c[1]"}));
  CHECK(atlas.at("cells")[3].at("contacts").empty());
  REQUIRE(atlas.at("walls").size() == 4);
  // z = A (0, 1/3) - (lambda, mu): both press where z_0 <= 1/3 and z_1 <= 2/3.
  const Json& first = atlas.at("walls")[0];
  CHECK(first.at("cells") == Json({0, 1}));
  CHECK(first.at("exact").at("normal") == Json({"0", "1"}));
  CHECK(first.at("exact").at("offset") == "2/3");
  CHECK(std::abs(double(atlas.at("probability_sum")) - 1) <= double(atlas.at("error_sum")));
}

TEST_CASE("the margins of the file's force are how far it can change before contacts do") {
  const Json atlas = Json::parse(run_json_on("atlas", corner).out);
  const Json& here = atlas.at("here");
  REQUIRE(here.at("cells").size() == 1);
  CHECK(atlas.at("cells")[std::size_t(here.at("cells")[0])].at("contacts") == Json({"c[1]"}));
  const Json& margins = here.at("margins");
  REQUIRE(margins.size() == 2);
  // c[0] closes where z_0 = 1/3, and normal (1, 0) has the length sqrt(2) in A.
  // d.
  CHECK(margins[0].at("closes") == Json({"c[0]"}));
  CHECK(double(margins[0].at("distance")) == doctest::Approx(2.0 / 3 / std::sqrt(2)));
}

TEST_CASE("the force of a mechanism lies in the cell of the contacts that persist") {
  const std::string program_file = point_on_floor();
  const Json atlas = Json::parse(run_json_on("atlas", program_file).out);
  CHECK(atlas.at("contacts") == Json({"floor"}));
  const std::size_t cell = atlas.at("here").at("cells")[0];
  CHECK(atlas.at("cells")[cell].at("contacts") == Json({"floor"}));
  CHECK(double(atlas.at("cells")[cell].at("probability")) == doctest::Approx(0.5));
}

TEST_CASE("a given mean and covariance count, and one that does not fit is refused") {
  const Folder folder;
  const std::string file = folder.write("a.toml", corner);
  const Json shifted = Json::parse(
      run({"atlas", file, "--json", "--mean", "[100, 100]", "--covariance", "[[1, 0], [0, 2]]"}).out);
  CHECK(double(shifted.at("cells")[3].at("probability")) == doctest::Approx(1));
  CHECK(double(shifted.at("probability_sum")) == doctest::Approx(1));
  CHECK(run({"atlas", file, "--mean", "[1]"}).code == 2);
  CHECK(run({"atlas", file, "--covariance", "[[1, 2], [2, 1]]"}).code == 2);
}

TEST_CASE("contacts that exclude each other have no atlas") {
  const Outcome outcome =
      run_json_on("atlas", "[projection]\nA = [[1]]\nz = [0]\nU = [[1], [-1]]\ns = [1, 0]\n");
  CHECK(outcome.code == 1);
  const Json atlas = Json::parse(outcome.out);
  CHECK(atlas.at("status") == "infeasible");
  // 1 u_0 + 1 u_1 = 0, and 1 s_0 + 1 s_1 > 0.
  CHECK(atlas.at("exact").at("farkas") == Json({{"c[0]", "1"}, {"c[1]", "1"}}));
}

TEST_CASE("margins are told where their squares are beyond doubles") {
  const Json atlas =
      Json::parse(run_json_on("atlas", "[projection]\nA = [[1]]\nz = [3e200]\nU = [[1]]\ns = [0]\n").out);
  CHECK(double(atlas.at("here").at("margins")[0].at("distance")) == doctest::Approx(3e200));
}

TEST_CASE("a covariance that is none is called by its name") {
  const Folder folder;
  const Outcome outcome = run({"atlas", folder.write("a.toml", corner), "--covariance", "[[1, 2], [2, 1]]"});
  CHECK(outcome.code == 2);
  CHECK(outcome.err.find("--covariance: ") != std::string::npos);
  CHECK(outcome.err.find("metric:") == std::string::npos);
}

TEST_CASE("the regions of a map fill it, and their corners and areas are exact") {
  const Folder folder;
  const std::string file = folder.write("a.toml", corner);
  const Json map =
      Json::parse(
          run({"atlas", file, "--json", "--over", "force.q[0]=-4:4", "--over", "force.q[1]=-1:7"}).out)
          .at("map");
  double parts = 0;
  for (const Json& region : map.at("regions")) parts += double(region.at("part"));
  CHECK(parts == doctest::Approx(1).epsilon(1e-14));
  // Both press where 1 + p <= 1/3 and -3 + p <= 2/3: a rectangle from (-4, -1) to (-2/3, 11/3).
  const Json& both = map.at("regions")[0];
  CHECK(both.at("contacts") == Json({"c[0]", "c[1]"}));
  CHECK(both.at("exact").at("area") == "140/9");
  CHECK(double(map.at("drop_negative").at("accepted")) == doctest::Approx(140.0 / 9 / 64));
  const Json line = Json::parse(run({"atlas", file, "--json", "--over", "force.q[1]=-1:7"}).out).at("map");
  CHECK(line.at("area") == 8);
}

TEST_CASE("a map of a force that there is not, or that runs backwards, is refused") {
  const Folder folder;
  const std::string file = folder.write("a.toml", corner);
  for (const char* over : {"force.x=0:1", "force.q[0]=1:0", "force.q[0]=a:b", "q[0]=0:1", "force.q[0]=1"}) {
    const Outcome outcome = run({"atlas", file, "--over", over});
    CAPTURE(over);
    CHECK(outcome.code == 2);
    CHECK(outcome.err.find("--over") != std::string::npos);
  }
}

TEST_CASE("an atlas at a singular position has the cells of what solve finds for each force") {
  const Folder folder;
  const std::string file = folder.write("a.toml", pushing_at_dead_centre());
  const Outcome outcome = run({"atlas", file, "--json", "--over", "force.a=-3:3"});
  CHECK(outcome.err.find("24 a'' and -24 b'' is 0") != std::string::npos);
  // a'' = b'' pushes c while the force on a is above 0: 1.2 + p over [-1.8, 4.2].
  const Json map = Json::parse(outcome.out).at("map");
  REQUIRE(map.at("regions").size() == 2);
  for (const Json& region : map.at("regions")) {
    const bool pushes = region.at("contacts").dump().find("push") != std::string::npos;
    CHECK(double(region.at("part")) == doctest::Approx(pushes ? 0.7 : 0.3));
  }
  // Of a force that leaves it at rest second derivatives tell all; of the others they do not.
  const std::string at_rest = folder.write("b.toml", pushing_at_dead_centre({{7, "a = 0"}}));
  CHECK(Json::parse(run({"atlas", at_rest, "--json"}).out).at("contacts").size() == 3);
}

TEST_CASE("an atlas at a position of several branches is refused with what to do") {
  const Outcome outcome = run_json_on("atlas", pushing_at_dead_centre({{12, "a = 0"}, {13, "b = 0"}}));
  CHECK(outcome.code == 2);
  CHECK(outcome.err.find("several branches; give a velocity or move off it") != std::string::npos);
}
