#include "tests/cli/error_form.hpp"

#include <nlohmann/json.hpp>

using namespace tests;
using Json = nlohmann::ordered_json;

TEST_CASE("an error goes to standard error with file, line and column, and nothing to standard output") {
  expect_refusal({point_on_floor({{3, R"(kinetik = "1")"}}), "3:1", {"kinetik"}});
}

TEST_CASE("under --json an error is also an object with the same message and place") {
  const Folder folder;
  const std::string file = folder.write("problem.toml", point_on_floor({{4, R"(potential = "m*gg*y")"}}));
  const Outcome outcome = run({"solve", "--json", file});
  CHECK(outcome.code == 2);
  const Json error = Json::parse(outcome.out);
  CHECK(error.size() == 5);
  CHECK(error.at("file") == file);
  CHECK(error.at("status") == "error");
  CHECK(error.at("line") == 4);
  CHECK(error.at("column") == 16);
  CHECK(outcome.err == "moreau: " + file + ":4:16: " + error.at("message").get<std::string>() + "\n");
}

TEST_CASE("an error that has no place says line one, column one") {
  const Folder folder;
  const std::string file = folder.path("missing.toml");
  const Outcome outcome = run({"solve", "--json", file});
  const Json error = Json::parse(outcome.out);
  CHECK(error.at("line") == 1);
  CHECK(error.at("column") == 1);
  CHECK(outcome.err.starts_with("moreau: " + file + ":1:1: "));
}

TEST_CASE("whatever bytes an error quotes, its object is JSON and its message one line") {
  const std::vector<std::string> texts{
      "\"a\\u001b[31m\\nb\\\"\\\\\" = 1\n",
      point_on_floor({{4, "potential = '''\n\t\x01'''"}}),
      point_on_floor({{4, "potential = \"\\u0000\""}}),
      point_on_floor({{4, "potential = \"\u00e9\u4e2d\""}}),
      point_on_floor({{6, "\"m\\u0000\" = 2"}}),
      point_on_floor({{4, "potential = \"" + std::string(5000, 'q') + "\""}}),
      two_rows({{2, R"(A = { matrix_market = "no\u0000where\n.mtx" })"}}),
      two_rows({{3, R"(z = ["\u0000", 0])"}}),
      two_rows({{3, R"(z = [0, "\n"])"}}),
      "title = \"\xff\"\n",
      "\xc3\x28 = 1\n",
  };
  for (const std::string& text : texts) {
    const Outcome outcome = run_json_on("solve", text);
    CAPTURE(text);
    CAPTURE(outcome.err);
    CHECK(outcome.code == 2);
    REQUIRE(Json::accept(outcome.out));
    const std::string message = Json::parse(outcome.out).at("message").get<std::string>();
    CHECK(message.find('\n') == std::string::npos);
    CHECK(message.find("; ") != std::string::npos);
    CHECK(outcome.err.ends_with(": " + message + "\n"));
  }
}

TEST_CASE("a name of a file may hold quotation marks, spaces and line breaks") {
  const Folder folder;
  const std::string file = folder.write("a \"b\"\n\\c.toml", point_on_floor());
  const Outcome outcome = run({"solve", "--json", file});
  CHECK(outcome.code == 0);
  CHECK(Json::parse(outcome.out).at("file") == file);
}
