#include <nlohmann/json.hpp>

#include "tests/cli/error_form.hpp"

using namespace tests;
using Json = nlohmann::ordered_json;

namespace {

/// Lines: 1 [decomposition], 2 z, 3 f, 4 metric, 5 [solve], 6 empty.
std::string split(const Changes& changes = {}) {
  std::vector<std::string> lines{"[decomposition]", "z = [3, -4]", "f = \"norm2(weight=2)\"", "", "", ""};
  for (const auto& [line, text] : changes) lines[static_cast<std::size_t>(line - 1)] = text;
  std::string file;
  for (const std::string& line : lines) file += line + "\n";
  return file;
}

std::string f(const std::string& call) { return split({{3, "f = \"" + call + "\""}}); }

Json solved(const std::string& text) {
  const Outcome outcome = run_json_on("solve", text);
  CAPTURE(text);
  CAPTURE(outcome.err);
  CHECK(outcome.code == 0);
  return Json::parse(outcome.out);
}

void check_near(const Json& found, const std::vector<double>& expected) {
  REQUIRE(found.size() == expected.size());
  for (std::size_t i = 0; i < expected.size(); ++i)
    CHECK(found[i].get<double>() == doctest::Approx(expected[i]).epsilon(1e-14));
}

}  // namespace

TEST_CASE("a decomposition splits z in a point and its covector, with values, gap, residual and routes") {
  const Json split_of = solved(split());
  check_near(split_of["x"], {1.8, -2.4});
  check_near(split_of["y"], {1.2, -1.6});
  CHECK(split_of["kind"] == "decomposition");
  CHECK(split_of["status"] == "solved");
  CHECK(split_of["f_x"].get<double>() == doctest::Approx(6).epsilon(1e-14));
  CHECK(split_of["g_y"] == 0);
  CHECK(split_of["inner"].get<double>() == doctest::Approx(6).epsilon(1e-14));
  CHECK(std::abs(split_of["fenchel_gap"].get<double>()) <= 1e-14);
  CHECK(split_of["residual"].get<double>() <= 1e-14);
  CHECK(split_of["route"]["x"].is_string());
  CHECK(split_of["route"]["y"].is_string());
  CHECK(split_of["certificate"]["level"] == "estimate");
  CHECK(split_of["certificate"]["error_bound"].get<double>() <= 1e-13);
  std::vector<std::string> keys;
  for (const auto& [key, value] : split_of.items()) keys.push_back(key);
  CHECK(keys == std::vector<std::string>{"file", "kind", "status", "x", "y", "f_x", "g_y", "inner",
                                         "fenchel_gap", "residual", "route", "certificate", "seconds"});
}

TEST_CASE("a split that is not as accurate as asked for says so and exits three") {
  const std::string strict = split({{2, "z = [1, \"1/3\"]"}, {5, "[solve]\ntolerance = 1e-300"}});
  const Outcome outcome = run_json_on("solve", strict);
  CHECK(outcome.code == 3);
  CHECK(Json::parse(outcome.out)["status"] == "inaccurate");
  CHECK(run_on("solve", strict).out.find("NOT solved") != std::string::npos);
  const Folder folder;
  CHECK(run({"solve", "--tolerance", "1e-6", folder.write("problem.toml", strict)}).code == 0);
}

TEST_CASE("the readable split shows z, x and y, and how each was found") {
  const std::string text = run_on("solve", "title = \"A ball\"\n" + split()).out;
  for (const char* words :
       {"A ball", "x = prox_f z", "y = prox_g z", "1.8", "-1.6", "x: closed form", "Solved"}) {
    CAPTURE(words);
    CHECK(text.find(words) != std::string::npos);
  }
}

TEST_CASE("wrong decompositions are refused where they are wrong") {
  const std::vector<Wrong> table{
      {split({{2, ""}}), "1:1", {"z is missing"}},
      {split({{3, ""}}), "1:1", {"f is missing"}},
      {split({{2, "z = []"}}), "2:5", {"empty"}},
      {split({{2, "z = [1, inf]"}}), "2:9", {"z[1]", "not finite"}},
      {split({{2, "z = 3"}}), "2:5", {"not a list"}},
      {split({{3, "f = 3"}}), "3:5", {"not a string"}},
      {split({{3, "g = \"norm2()\""}}), "3:1", {"unknown key \"g\"", "decomposition"}},
      {split({{4, "metrics = [[1, 0], [0, 1]]"}}), "4:1", {"did you mean \"metric\""}},
      {split({{4, "metric = [[1, 0]]"}}), "4:10", {"metric: 1 row", "2"}},
      {split({{4, "metric = [[1], [1]]"}}), "4:11", {"metric[0]: 1 entry", "2"}},
      {split({{4, "metric = [[1, 2], [2, 1]]"}}), "4:10", {"metric", "not positive definite"}},
      {split({{4, "metric = [[2, 1], [0, 2]]"}}), "4:10", {"not symmetric", "metric[0][1]"}},
      {split({{4, "metric = { diagonal = [1] }"}}), "4:23", {"metric.diagonal", "1", "2"}},
      {split({{4, "metric = { diagonal = [1, -1] }"}}), "4:10", {"not positive definite"}},
      {split({{4, "metric = { }"}}), "4:10", {"diagonal", "matrix_market"}},
      {split({{4, "metric = { diag = [1, 2] }"}}), "4:12", {"did you mean \"diagonal\""}},
      {f(""), "3:6", {"name(arguments)"}},
      {f("norm2"), "3:6", {"norm2()"}},
      {f("norm22()"), "3:6", {"norm22", "did you mean \"norm2\""}},
      {f("norm2(wait=2)"), "3:12", {"wait", "its one argument is \"weight\""}},
      {f("norm2(1, 2)"), "3:15", {"too many"}},
      {f("norm2(1, weight=2)"), "3:15", {"twice"}},
      {f("norm2([1, 2])"), "3:12", {"norm2(weight)", "number"}},
      {f("norm2(-1)"), "3:12", {"norm2(weight)"}},
      {f("indicator(norm2())"), "3:16", {"set"}},
      {f("indicator(ball2(radius=-1))"), "3:22", {"ball2(radius)"}},
      {f("quadratic([[1, 0], [0, -1]])"), "3:16", {"quadratic"}},
      {f("quadratic([[1]])"), "3:6", {"quadratic", "1 entry", "2"}},
      {split({{3, "f = \"\"\"\n  norm2(\n    oops)\"\"\""}}), "5:5", {"oops()"}},
      {split({{5, "[solve]\nmethod = \"active-set\""}}), "6:10", {"active-set", "does not apply"}},
      {split({{5, "[solve]\ncontact_tolerance = 1e-3"}}), "6:21", {"contact_tolerance"}},
      {split({{5, "[state]"}}), "5:1", {"[state]"}},
  };
  for (const Wrong& wrong : table) expect_refusal(wrong);
}

TEST_CASE("derive has nothing to say about a decomposition") {
  const Outcome outcome = run_on("derive", split());
  CHECK(outcome.code == 2);
  CHECK(outcome.err.find("[system] or [projection]") != std::string::npos);
}
