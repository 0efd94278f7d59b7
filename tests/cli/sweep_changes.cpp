#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>

#include "tests/cli/program.hpp"

using Json = nlohmann::ordered_json;
using tests::Folder;
using tests::run;

namespace {

std::vector<double> changes(const std::string& file, const char* over) {
  std::vector<double> found;
  const Json swept = Json::parse(run({"sweep", "--json", file, "--over", over}).out);
  for (const auto& change : swept.at("changes")) found.push_back(change.at("value"));
  std::sort(found.begin(), found.end());
  return found;
}

/// Unit masses above a floor each, with forces and heights.
std::string masses(const std::string& forces, const std::string& heights) {
  return "[system]\ncoordinates = [\"x\", \"y\"]\nkinetic = \"(x'^2 + y'^2)/2\"\n[system.parameters]\nP = "
         "0.0\n"
         "[system.forces]\n" +
         forces +
         "[system.constraints]\na = \"x >= 0\"\nb = \"y >= 0\"\n[state]\n"
         "position = { " +
         heights + " }\n";
}

}  // namespace

TEST_CASE("a sweep finds where a slack begins that the tolerance hides, also beside opposite contacts") {
  // The wedge between d and e pins x - y; c opens as 1e-4 (P - 1/3), within the tolerance for 2e-5 of P.
  const Folder folder;
  const std::string file = folder.write(
      "a.toml",
      "[system]\ncoordinates = [\"x\", \"y\"]\nkinetic = \"(x'^2 + y'^2)/2\"\n[system.parameters]\nP = 0.0\n"
      "[system.forces]\nx = \"1 + 1e-4*(P - 1/3)\"\ny = \"-1\"\n[system.constraints]\nc = \"x + y >= 0\"\n"
      "d = \"x - y >= t^2\"\ne = \"x - y <= t^2\"\n[state]\nposition = { x = 0, y = 0 }\n");
  for (const char* over : {"P=0:0.5:1", "P=1:-0.4:-0.2"}) {
    CAPTURE(over);
    const Json swept = Json::parse(run({"sweep", "--json", file, "--over", over}).out);
    REQUIRE(swept.at("changes").size() == 1);
    CHECK(std::abs(swept.at("changes")[0].at("value").get<double>() - 1.0 / 3) <= 2e-12);
  }
}

TEST_CASE("a row without a gradient is swept like another: it holds, or nothing satisfies it") {
  const Folder folder;
  const std::string file =
      folder.write("zero.toml", "[projection]\nA = [[2]]\nz = [1]\nU = [[0]]\ns = [-1]\n");
  const Json swept = Json::parse(run({"sweep", "--json", file, "--over", "projection.s[0]=-1:1:1"}).out);
  CHECK(swept.at("rows") == 3);
  CHECK(swept.at("without_answer") == 1);  // 0 >= 1
}

TEST_CASE("a sweep finds where a contact leaves that was at exactly 0 until then") {
  const Folder folder;
  const std::string file = folder.write(
      "a.toml", masses("x = -1\ny = \"P - 3/10\"\n", "x = \"max(P - 1/3, 0)*max(2/3 - P, 0)\", y = 0"));
  for (const char* over : {"P=-1:0.25:1", "P=0:0.1:1", "P=1:-0.3:-0.5"}) {
    CAPTURE(over);
    const std::vector<double> found = changes(file, over);
    REQUIRE(found.size() == 3);
    CHECK(std::abs(found[0] - 0.3) <= 2e-12);
    CHECK(std::abs(found[1] - 1.0 / 3) <= 2e-12);
    CHECK(std::abs(found[2] - 2.0 / 3) <= 2e-12);
  }
}

TEST_CASE("a sweep tells two changes apart that are a hundred-millionth of the range from each other") {
  const Folder folder;
  for (const double apart : {1e-3, 1e-7, 1e-8, 1e-10}) {
    CAPTURE(apart);
    const std::string file = folder.write(
        "a.toml", masses("x = \"P - 0.3\"\ny = \"0.3 + " + std::to_string(1e12 * apart) + "*1e-12 - P\"\n",
                         "x = 0, y = 0"));
    const std::vector<double> found = changes(file, "P=0:0.25:1");
    REQUIRE(found.size() == 2);
    CHECK(std::abs(found[0] - 0.3) <= 2e-12);
    CHECK(std::abs(found[1] - 0.3 - apart) <= 2e-12);
  }
}

TEST_CASE("a sweep finds where one contact takes over from another, not where the other would let go") {
  // 2 x'' >= s(P) from where s(P)/2 = 2.6/3: of 1.4 P^3 - 2.8 P + 17/30 = 0 the root below -1.
  const Folder folder;
  const std::string file =
      folder.write("a.toml",
                   "[system]\ncoordinates = [\"x\"]\nkinetic = \"5/2*x'^2\"\n[system.parameters]\nP = "
                   "0.0\n[system.forces]\n"
                   "x = \"0.9 - 0.9*P\"\n[system.constraints]\na = \"2*x >= (2.3 - 2.8*P + 1.4*P^3)*t^2/2\"\n"
                   "b = \"3*x >= 1.3*t^2\"\n[state]\nposition = { x = 0 }\n");
  double root = -1.5;
  for (int k = 0; k < 50; ++k)
    root -= (1.4 * root * root * root - 2.8 * root + 17.0 / 30) / (4.2 * root * root - 2.8);
  const std::vector<double> found = changes(file, "P=-2:0.3:-1");
  REQUIRE(found.size() == 1);
  CHECK(std::abs(found[0] - root) <= 2e-12);
}

TEST_CASE("the JSON of a sweep has its rows, unless a table is written") {
  const Folder folder;
  const std::string file =
      folder.write("a.toml", "[projection]\nA = [[1]]\nz = [-1]\nU = [[1], [-1]]\ns = [0, -1]\n");
  const std::vector<std::string> asked{"sweep", "--json", file, "--over", "projection.s[0]=0,1,2"};
  const Json swept = Json::parse(run(asked).out);
  CHECK(swept.at("rows") == 3);
  REQUIRE(swept.at("table").size() == 3);
  const Json row = swept["table"][1];
  CHECK(row.at("projection.s[0]") == 1);
  CHECK(row.at("status") == "solved");
  CHECK(row.at("active") == Json::parse(R"(["c[0]", "c[1]"])"));
  CHECK(row.at("q[0]''") == 1);
  CHECK(row.at("lambda[c[0]]").is_number());
  CHECK(swept["table"][2].at("status") == "infeasible");
  CHECK(swept["table"][2].at("q[0]''").is_null());
  std::vector<std::string> written = asked;
  written.insert(written.end(), {"--output", folder.path("a.csv")});
  CHECK_FALSE(Json::parse(run(written).out).contains("table"));
}

TEST_CASE("a sweep tells which point is the first without an answer, and why that one has none") {
  const Folder folder;
  const std::string slot =
      folder.write("a.toml", "[projection]\nA = [[1]]\nz = [-1]\nU = [[1], [-1]]\ns = [0, -1]\n");
  const std::string one = run({"sweep", slot, "--over", "projection.s[0]=0,2"}).err;
  CHECK(one.find("1 point has no answer, at projection.s[0] = 2: infeasible") != std::string::npos);
  // The first is infeasible, the second penetrates.
  const std::string jam = folder.write(
      "b.toml",
      "[system]\ncoordinates = [\"x\"]\nkinetic = \"x'^2/2\"\n[system.constraints]\nleft = \"x >= "
      "t^2\"\nright = \"x <= -t^2\"\n[state]\nposition = { x = 0 }\n");
  const std::string two = run({"sweep", jam, "--over", "t=0,0.1"}).err;
  CHECK(two.find("2 points have no answer, the first at t = 0: infeasible") != std::string::npos);
}

TEST_CASE("the gap of a contact, its rates and the state are watched beside its multiplier") {
  const Folder folder;
  const std::string file = folder.write("a.toml", masses("x = \"P\"\n", "x = 0, y = 2"));
  std::vector<std::string> words{"sweep", "--json", file, "--over", "P=-3,2"};
  for (const char* name : {"lambda[a]", "ddf[a]", "f[b]", "df[b]", "y", "y'"}) {
    words.emplace_back("--watch");
    words.emplace_back(name);
  }
  const Json table = Json::parse(run(words).out).at("table");
  REQUIRE(table.size() == 2);
  const std::vector<std::vector<double>> expected{{3, 0, 2, 0, 2, 0}, {0, 2, 2, 0, 2, 0}};
  for (std::size_t row = 0; row < 2; ++row)
    for (std::size_t k = 0; k < 6; ++k) CHECK(table[row].at(words[6 + 2 * k]) == expected[row][k]);
}

TEST_CASE("a sweep refuses a key that two ranges vary") {
  const Folder folder;
  const std::string file = folder.write("swept.toml", masses("x = \"P\"\n", "x = 0, y = 1"));
  const tests::Outcome outcome = run({"sweep", file, "--over", "P=0:1:2", "--over", "P=3,4"});
  CHECK(outcome.code == 2);
  CHECK(outcome.err.find("--over P=3,4: P has its values already") != std::string::npos);
}
