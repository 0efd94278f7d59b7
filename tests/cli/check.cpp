#include <doctest/doctest.h>

#include <algorithm>
#include <nlohmann/json.hpp>

#include "cli/json_writer.hpp"
#include "cli/report/checks_report.hpp"
#include "tests/cli/program.hpp"
#include "tests/this_build.hpp"

using namespace tests;
using Json = nlohmann::ordered_json;

namespace {

const std::string folder_of_problems = tests::source_folder() + "docs/problems/";

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

TEST_CASE("check tries the split of a cone with its polar, in fractions: every bound is zero") {
  for (const char* name : {"cone_friction_pyramid.toml", "cone_isotonic.toml", "cone_hidden_line.toml"}) {
    const Json checks = checked(folder_of_problems + name)["checks"];
    for (const Json& check : checks) CHECK(check["bound"] == 0);
    for (const char* law : {"(x|y) = 0", "polar of the polar", "is a facet", "z = x + y"}) {
      CAPTURE(law);
      CHECK(checks.dump().find(law) != std::string::npos);
    }
  }
}

TEST_CASE("check finds the reaction of contacts from the dual and compares it with the one of the motion") {
  for (const char* name :
       {"table_off_centre.toml", "delassus_drops_too_much.toml", "slider_crank_tilted.toml",
        "projection_two_sided.toml", "projection_redundant.toml"}) {
    const std::string names = checked(folder_of_problems + name)["checks"].dump();
    for (const char* law : {"from the dual by section 5's cone", "two-sided reaction", "lambda_a (u_a.q''",
                            "as small a G", "conjugacy"}) {
      CAPTURE(law);
      CHECK(names.find(law) != std::string::npos);
    }
  }
}

TEST_CASE("where the contacts contradict each other as equations the dual is a least distance") {
  const Folder folder;
  // q <= 1 and q >= 0 pull apart as equations; z pushes on the first.
  const std::string file =
      folder.write("apart.toml", "[projection]\nA = [[2]]\nz = [5]\nU = [[-1], [1]]\ns = [-1, 0]\n");
  const Json found = checked(file);
  CHECK(found["reaction_from_dual"].is_null());
  CHECK(found["checks"].dump().find("from the dual by least distance") != std::string::npos);
}

TEST_CASE("an answer in fractions passes where A written in fractions is ill-conditioned, Hilbert's matrix") {
  for (const int n : {4, 6, 8, 11}) {
    std::string A, U, z;
    for (int i = 0; i < n; ++i) {
      A += "[";
      for (int k = 0; k < n; ++k) A += "\"1/" + std::to_string(i + k + 1) + "\", ";
      A += "], ";
      z += std::to_string(i % 2 == 0 ? i + 1 : -i - 1) + ", ";
    }
    for (int a = 0; a < 2; ++a) {
      U += "[";
      for (int k = 0; k < n; ++k) U += a == k ? "1, " : "0, ";
      U += "], ";
    }
    const Folder folder;
    checked(folder.write("hilbert.toml",
                         "[projection]\nA = [" + A + "]\nz = [" + z + "]\nU = [" + U + "]\ns = [0, 0.1]\n"));
  }
}

TEST_CASE("without contacts the laws hold for the free motion") {
  const Folder folder;
  checked(folder.write("free.toml", "[projection]\nA = [[2]]\nz = [5]\nU = []\ns = []\n"));
}

TEST_CASE("an infeasible problem exits one with its witness checked") {
  const Outcome outcome = run({"check", "--json", folder_of_problems + "jammed_seesaw.toml"});
  CHECK(outcome.code == 1);
  const Json found = Json::parse(outcome.out);
  CHECK(found["status"] == "infeasible");
  CHECK(found["checks"].size() == 3);
  for (const Json& check : found["checks"]) CHECK(check["passed"] == true);
}

TEST_CASE("of several checked files the largest exit code counts, and each has its object") {
  const Folder folder;
  const std::string wrong = folder.write("wrong.toml", "[cone]\n"),
                    solved = folder_of_problems + "cone_isotonic.toml",
                    infeasible = folder_of_problems + "squeezed_pistons.toml";
  CHECK(run({"check", "--quiet", solved, solved}).code == 0);
  CHECK(run({"check", "--quiet", infeasible, solved}).code == 1);
  const Outcome outcome = run({"check", "--json", solved, wrong, infeasible});
  CHECK(outcome.code == 2);
  CHECK(std::count(outcome.out.begin(), outcome.out.end(), '\n') == 3);
}

TEST_CASE("a failed law decides the exit code, and is shown with its counterexample") {
  convex::LawReport report;
  report.checks = {convex::check_that("right", 1, 2), convex::check_that("wrong", 3, 2)};
  report.checks.back().counterexample = "z = [1]";
  for (const convex::Status status : {convex::Status::solved, convex::Status::inaccurate})
    CHECK(cli::exit_code(report, status) == cli::Exit::no_solution);
  CHECK(cli::checks_text(report).find("FAILED  wrong (3, bound 2) at z = [1]") != std::string::npos);
  CHECK(cli::checks_text(report).find("1 of 2 laws FAILED") != std::string::npos);
  cli::JsonWriter json;
  json.begin_object();
  cli::write_checks(json, report);
  const Json checks = Json::parse(json.end_object().text())["checks"];
  CHECK(checks[0]["passed"] == true);
  CHECK(checks[1]["passed"] == false);
  CHECK(checks[1]["counterexample"] == "z = [1]");
  report.checks.pop_back();
  CHECK(cli::exit_code(report, convex::Status::solved) == cli::Exit::solved);
  CHECK(cli::exit_code(report, convex::Status::inaccurate) == cli::Exit::inaccurate);
  report.checks.clear();  // nothing was tried
  CHECK(cli::exit_code(report, convex::Status::solved) == cli::Exit::no_solution);
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
