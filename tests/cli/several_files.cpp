#include <doctest/doctest.h>

#include <nlohmann/json.hpp>
#include <sstream>

#include "tests/cli/program.hpp"

using namespace tests;
using Json = nlohmann::ordered_json;

namespace {

std::vector<Json> lines(const std::string& text) {
  std::vector<Json> objects;
  std::istringstream stream(text);
  for (std::string line; std::getline(stream, line);) objects.push_back(Json::parse(line));
  return objects;
}

}  // namespace

TEST_CASE("several files give one JSON object each, one a line, in the order of the command") {
  const Folder folder;
  const std::vector<std::string> files{folder.write("b.toml", point_on_floor()), folder.path("missing.toml"),
                                       folder.write("a.toml", two_rows()),
                                       folder.write("wrong.toml", "x = 1\n"),
                                       folder.write("c.toml", point_on_floor())};
  std::vector<std::string> arguments{"solve", "--json"};
  arguments.insert(arguments.end(), files.begin(), files.end());
  const Outcome outcome = run(arguments);
  const std::vector<Json> objects = lines(outcome.out);
  REQUIRE(objects.size() == files.size());
  const std::vector<std::string> statuses{"solved", "error", "solved", "error", "solved"};
  for (std::size_t k = 0; k < files.size(); ++k) {
    CHECK(objects[k].at("file") == files[k]);
    CHECK(objects[k].at("status") == statuses[k]);
  }
  CHECK(outcome.code == 2);
}

TEST_CASE("the same file twice is solved twice") {
  const Folder folder;
  const std::string file = folder.write("problem.toml", point_on_floor());
  CHECK(lines(run({"solve", "--json", file, file}).out).size() == 2);
}

TEST_CASE("a dash reads the problem from standard input") {
  const Outcome outcome = run({"solve", "--json", "-"}, point_on_floor());
  CHECK(outcome.code == 0);
  const Json object = Json::parse(outcome.out);
  CHECK(object.at("file") == "-");
  CHECK(object.at("multipliers").at("floor") == 19.62);
  const Outcome derived = run({"derive", "--json", "-"}, two_rows());
  CHECK(derived.code == 0);
  CHECK(Json::parse(derived.out).at("names") == Json{"q[0]", "q[1]"});
}

TEST_CASE("what begins with a brace on standard input is JSON, which no name there could say") {
  const std::string problem = R"(
    {"projection": {"A": [[1]], "z": [-1], "U": [[1]], "s": [0]}})";
  const Outcome outcome = run({"solve", "--json", "-"}, problem);
  CHECK(outcome.code == 0);
  CHECK(Json::parse(outcome.out).at("multipliers").at("c[0]") == 1);
  const Outcome wrong = run({"solve", "-"}, R"({"projection": {"A": [[1]], "z": [-1], "W": [[1]]}})");
  CHECK(wrong.err.starts_with("moreau: -:1:40: unknown key \"W\""));
}

TEST_CASE("an error on standard input names the dash as the file") {
  const Outcome outcome = run({"solve", "-"}, point_on_floor({{3, "kinetik = \"1\""}}));
  CHECK(outcome.code == 2);
  CHECK(outcome.err.starts_with("moreau: -:3:1: "));
  CHECK(run({"solve", "-"}, "").code == 2);
}

TEST_CASE("options may stand before, between and behind the files") {
  const Folder folder;
  const std::string file = folder.write("problem.toml", point_on_floor());
  for (const std::vector<std::string>& arguments : {std::vector<std::string>{"solve", "--json", file, file},
                                                    {"solve", file, "--json", file},
                                                    {"solve", file, file, "--json"}})
    CHECK(lines(run(arguments).out).size() == 2);
}
