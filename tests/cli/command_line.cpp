#include <doctest/doctest.h>

#include <nlohmann/json.hpp>

#include "tests/cli/program.hpp"

using namespace tests;
using Json = nlohmann::ordered_json;

namespace {

/// Exit 2, one line `moreau: …; …` on standard error, nothing on standard output.
void expect_wrong(const std::vector<std::string>& arguments, const std::vector<std::string>& words) {
  const Outcome outcome = run(arguments);
  CAPTURE(arguments.front());
  CAPTURE(arguments.back());
  CAPTURE(outcome.err);
  CHECK(outcome.code == 2);
  CHECK(outcome.out.empty());
  CHECK(outcome.err.starts_with("moreau: "));
  CHECK(outcome.err.find('\n') == outcome.err.size() - 1);
  CHECK(outcome.err.find("; ") != std::string::npos);
  constexpr std::size_t longest = 300;  // an error that is read
  CHECK(outcome.err.size() < longest);
  for (const std::string& word : words) {
    CAPTURE(word);
    CHECK(outcome.err.find(word) != std::string::npos);
  }
}

}  // namespace

TEST_CASE("help and version go to standard output and exit zero") {
  for (const std::vector<std::string>& arguments : {std::vector<std::string>{"--help"},
                                                    {"--version"},
                                                    {"solve", "--help"},
                                                    {"derive", "--help"},
                                                    {"prox", "--help"},
                                                    {"conjugate", "--help"},
                                                    {"functions", "--help"},
                                                    {"methods", "--help"}}) {
    const Outcome outcome = run(arguments);
    CHECK(outcome.code == 0);
    CHECK(outcome.err.empty());
    CHECK_FALSE(outcome.out.empty());
  }
  CHECK(run({"--version"}).out.starts_with("moreau "));
  for (const char* command : {"solve", "derive", "prox", "conjugate", "functions", "methods"})
    CHECK(run({"--help"}).out.find(command) != std::string::npos);
}

TEST_CASE("the program alone exits two and shows what it can do on standard error") {
  const Outcome outcome = run({});
  CHECK(outcome.code == 2);
  CHECK(outcome.out.empty());
  CHECK(outcome.err.find("solve") != std::string::npos);
}

TEST_CASE("what the program never heard of exits two and is named") {
  const Folder folder;
  const std::string file = folder.write("problem.toml", point_on_floor());
  expect_wrong({"slove", file}, {"slove"});
  expect_wrong({"solve", "--tolerence", "1", file}, {"--tolerence"});
  expect_wrong({"solve", "--method", "activeset", file}, {"activeset", "active-set"});
  expect_wrong({"solve"}, {"FILE"});
  expect_wrong({"derive"}, {"FILE"});
  expect_wrong({"check"}, {"FILE, --catalogue or --map"});
  expect_wrong({"check", "--catalogue", file}, {"--catalogue"});
  expect_wrong({"check", file, "--metric", "[[1]]"}, {"--metric goes with --map or --table"});
  expect_wrong({"check", "--catalogue", "--box", "0:1"}, {"--box goes with --map"});
  expect_wrong({"check", file, "--data", folder.path("f.csv")}, {"--data goes with --map"});
  expect_wrong({"simulate", file, "--until", "1", "--modulo", "x=2"},
               {"--modulo", "--output F.csv", "--phase"});
  expect_wrong({"prox"}, {"f is required"});
  expect_wrong({"prox", "norm2()"}, {"--at"});
  expect_wrong({"conjugate"}, {"f is required"});
  expect_wrong({"methods", "extra"}, {"extra"});
}

TEST_CASE("who asks for JSON has what is wrong with the command line in one object, with the file it names") {
  const Folder folder;
  const std::string file = folder.write("problem.toml", point_on_floor());
  const auto expect_object = [](const std::vector<std::string>& arguments, const std::string& named,
                                const std::string& word) {
    const Outcome outcome = run(arguments);
    CAPTURE(outcome.out);
    CHECK(outcome.code == 2);
    const Json object = Json::parse(outcome.out);  // throws beside anything else
    CHECK(object.at("status") == "error");
    CHECK(object.at("file") == named);
    CHECK(object.at("message").get<std::string>().find(word) != std::string::npos);
    CHECK(object.at("line") == 1);
    CHECK(object.at("column") == 1);
    CHECK(outcome.err == "moreau: " + object.at("message").get<std::string>() + "\n");
  };
  expect_object({"sweep", "--json", file}, file, "--over is required");
  expect_object({"solve", file, "--json", "--tolerance", "0"}, file, "--tolerance");
  expect_object({"solve", file, "--json", "--tolerance"}, file, "--tolerance");
  expect_object({"solve", file, file, "--json", "--quietly"}, file, "--quiet");
  expect_object({"derive", "--method", "exact", file, "--json"}, file, "--method");
  expect_object({"derive", "--latex", file, "--json"}, file, "--latex");
  expect_object({"convert", file, "--json"}, file, "OUT");
  expect_object({"solve", "--json"}, "", "FILE");
  expect_object({"slove", file, "--json"}, "", "solve");
  expect_object({"--json", "solve", file}, file, "behind");
}

TEST_CASE("a tolerance that is no positive finite number is refused") {
  const Folder folder;
  const std::string file = folder.write("problem.toml", point_on_floor());
  for (const char* value : {"0", "-1", "nan", "inf", "abc", "1e999", ""})
    expect_wrong({"solve", "--tolerance", value, file}, {"--tolerance"});
}

TEST_CASE("quiet leaves the exit code alone to tell, and errors where they belong") {
  const Folder folder;
  const std::string file = folder.write("problem.toml", point_on_floor());
  for (const char* command : {"solve", "derive"}) {
    const Outcome outcome = run({command, "--quiet", file});
    CHECK(outcome.code == 0);
    CHECK(outcome.out.empty());
    CHECK(outcome.err.empty());
  }
  const Outcome wrong = run({"solve", "--quiet", folder.path("missing.toml")});
  CHECK(wrong.code == 2);
  CHECK(wrong.out.empty());
  CHECK(wrong.err.starts_with("moreau: "));
}

TEST_CASE("the methods are listed with the name first, and the same names as JSON") {
  const Json methods = Json::parse(run({"methods", "--json"}).out).at("methods");
  const std::string text = run({"methods"}).out;
  std::size_t at = 0;
  for (const Json& method : methods) {
    const std::string name = method.at("name");
    CHECK(text.compare(at, name.size() + 1, name + " ") == 0);
    at = text.find('\n', at) + 1;
  }
  CHECK(at == text.size());
  CHECK(methods.dump().find("\"active-set\"") != std::string::npos);
}

TEST_CASE("no colour and no progress reaches a file") {
  const Outcome outcome = run_on("solve", point_on_floor());
  CHECK(outcome.out.find('\x1b') == std::string::npos);
  CHECK(outcome.err.empty());
}
