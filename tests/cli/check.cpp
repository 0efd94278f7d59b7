#include <doctest/doctest.h>

#include <nlohmann/json.hpp>

#include "tests/cli/program.hpp"

using namespace tests;
using Json = nlohmann::ordered_json;

namespace {

const std::string folder_of_problems = MOREAU_SOURCE "/docs/problems/";

std::vector<std::string> keys_of(const Json& object) {
  std::vector<std::string> keys;
  for (const auto& [key, value] : object.items()) keys.push_back(key);
  return keys;
}

/// The object of `check`, after the claim that it is the object of `solve` with the checks behind it, each
/// of the four keys and passed.
Json checked(const std::string& path) {
  CAPTURE(path);
  const Outcome outcome = run({"check", "--json", path});
  CAPTURE(outcome.out);
  CAPTURE(outcome.err);
  CHECK(outcome.code == 0);
  Json found = Json::parse(outcome.out), solved = Json::parse(run({"solve", "--json", path}).out);
  for (const auto& [key, value] : solved.items())
    if (key != "seconds") CHECK(found.at(key) == value);
  std::vector<std::string> expected = keys_of(solved);
  for (const char* key : {"checks", "no_evidence"}) expected.emplace_back(key);
  CHECK(keys_of(found) == expected);
  CHECK_FALSE(found["checks"].empty());
  for (const Json& check : found["checks"]) {
    CHECK(keys_of(check) == std::vector<std::string>{"name", "value", "bound", "passed"});
    CHECK(check["passed"] == true);
    CHECK(check["value"].get<double>() <= check["bound"].get<double>());
  }
  return found;
}

}  // namespace

TEST_CASE("check adds to the object of solve the laws of the decomposition, each with its bound") {
  for (const char* name : {"decomposition_entropy.toml", "decomposition_portfolio.toml"}) {
    const std::string names = checked(folder_of_problems + name)["checks"].dump();
    for (const char* law : {"z = x + y", "conjugacy", "Fenchel", "no other split", "nonexpansive", "f**"}) {
      CAPTURE(law);
      CHECK(names.find(law) != std::string::npos);
    }
  }
}

TEST_CASE("the readable check has one line a law behind the result") {
  const std::string text = run({"check", folder_of_problems + "decomposition_entropy.toml"}).out;
  for (const char* words :
       {"Entropy in a coupling metric", "x = prox_f z", "passed  z = x + y by two routes", "bound", "laws"}) {
    CAPTURE(words);
    CHECK(text.find(words) != std::string::npos);
  }
}

TEST_CASE("what cannot be solved cannot be checked: the error is that of solve") {
  const Folder folder;
  const std::string file =
      folder.write("empty.toml", "[decomposition]\nz = [1, 2]\nf = \"indicator(ball2(-1))\"\n");
  const Outcome check = run({"check", file}), solve = run({"solve", file});
  CHECK(check.code == 2);
  CHECK(check.err == solve.err);
  CHECK(run({"check", folder.path("missing.toml")}).code == 2);
  CHECK(run({"check"}).code == 2);
}
