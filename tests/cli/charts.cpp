#include <doctest/doctest.h>

#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>
#include <set>
#include <sstream>

#include "cli/drawing/gnuplot.hpp"
#include "convex/nearest_point/methods.hpp"
#include "tests/cli/program.hpp"

using namespace tests;
using Json = nlohmann::ordered_json;

namespace {

std::string bytes_of(const std::string& file) {
  std::stringstream bytes;
  bytes << std::ifstream(file).rdbuf();
  return bytes.str();
}

std::vector<std::vector<std::string>> table_of(const std::string& csv) {
  std::vector<std::vector<std::string>> rows;
  std::istringstream lines(csv);
  for (std::string line; std::getline(lines, line);) {
    rows.emplace_back();
    std::istringstream fields(line + ",");
    for (std::string field; std::getline(fields, field, ',');) rows.back().push_back(field);
  }
  return rows;
}

const char* const slope = R"([projection]
A = [[2, 1], [1, 3]]
z = [0, "-10/3"]
U = [[0, 1], [1, 1]]
s = [0, 0]
)";

}  // namespace

TEST_CASE("a chart of a file has every method, with the columns that were promised") {
  const Folder folder;
  const std::string data = folder.path("chart.csv");
  const Outcome outcome = run({"chart", folder.write("slope.toml", slope), "--data", data});
  CHECK(outcome.code == 0);
  const auto rows = table_of(bytes_of(data));
  CHECK(rows[0] ==
        std::vector<std::string>{"problem", "n", "m", "method", "setting", "seconds", "error", "status"});
  std::set<std::string> methods;
  for (std::size_t k = 1; k < rows.size(); ++k) {
    REQUIRE(rows[k].size() == 8);
    methods.insert(rows[k][3]);
    CHECK(rows[k][1] == "2");
    if (rows[k][3] == "active-set") {
      CHECK(rows[k][7] == "ok");
      CHECK(std::stod(rows[k][6]) < 1e-15);
      CHECK(std::stod(rows[k][5]) > 0);
    }
  }
  CHECK(methods.size() == convex::methods().size());
  const Json about = Json::parse(bytes_of(folder.path("chart.about.json")));
  CHECK(about["rows"].size() == rows.size() - 1);
  CHECK(outcome.out.find("active-set") != std::string::npos);
}

TEST_CASE(
    "the failure map has a row for every method and difficulty, and Delassus' rule is not called right") {
  const Folder folder;
  const std::string data = folder.path("stress.csv");
  CHECK(run({"stress", "near-parallel", "--data", data, "--quiet"}).code == 0);
  const auto rows = table_of(bytes_of(data));
  CHECK(rows[0] ==
        std::vector<std::string>{"family", "difficulty", "n", "m", "method", "seconds", "error", "status"});
  CHECK(rows.size() == 1 + convex::methods().size() * 9);
  for (std::size_t k = 1; k < rows.size(); ++k)
    if (rows[k][4] == "active-set" || rows[k][4] == "auto") CHECK(rows[k][7] == "ok");
}

TEST_CASE("pictures are drawn by gnuplot where it is, and its script is kept where it is not") {
  const Folder folder;
  const std::string file = folder.write("slope.toml", slope);
  for (const std::vector<std::string>& command :
       {std::vector<std::string>{"solve", "--quiet", "--plot"},
        {"chart", "--method", "active-set", "--output"},
        {"chart", "--method", "active-set", "--profile", "--output"}}) {
    const std::string picture = folder.path(command[0] + std::to_string(command.size()) + ".svg");
    std::vector<std::string> arguments = command;
    arguments.push_back(picture);
    arguments.push_back(file);
    const Outcome outcome = run(arguments);
    CHECK(outcome.code == 0);
    CHECK_MESSAGE(outcome.err.empty() == cli::has_gnuplot(), outcome.err);
    const std::string drawn = bytes_of(cli::has_gnuplot() ? picture : picture + ".gnuplot");
    CHECK(drawn.find(cli::has_gnuplot() ? "</svg>" : "plot ") != std::string::npos);
  }
}

TEST_CASE("what cannot be drawn or is not there is refused before any work") {
  const Folder folder;
  const std::string three =
      folder.write("three.toml", "[projection]\nA = [[1,0,0],[0,1,0],[0,0,1]]\nz = [0,0,0]\n");
  for (const auto& [arguments, words] : std::vector<std::pair<std::vector<std::string>, std::string>>{
           {{"solve", three, "--plot", folder.path("x.svg")}, "a picture needs two"},
           {{"solve", three, "--plot", folder.path("x.gif")}, "named .svg or .png"},
           {{"chart", "--output", "x.pdf"}, "named .svg or .png"},
           {{"chart", "--method", "simplex"}, "there is no such method"},
           {{"stress", "paralell"}, "did you mean"},
           {{"chart", "no-such-file.toml"}, "no-such-file.toml"}}) {
    const Outcome outcome = run(arguments);
    CHECK(outcome.code == 2);
    CHECK_MESSAGE(outcome.err.find(words) != std::string::npos, outcome.err);
  }
}
