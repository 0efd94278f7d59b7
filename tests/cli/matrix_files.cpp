#include <doctest/doctest.h>

#include <filesystem>
#include <nlohmann/json.hpp>

#include "tests/cli/program.hpp"

using namespace tests;
using Json = nlohmann::ordered_json;

namespace {

const std::string header = "%%MatrixMarket matrix ";
const std::string by_files =
    two_rows({{2, R"(A = { matrix_market = "A.mtx" })"}, {4, R"(U = { matrix_market = "U.mtx" })"}});
const std::string A = header + "coordinate real symmetric\n% a comment\n\n2 2 3\n1 1 2\n2 1 0.5\n2 2 1e0\n";
const std::string U = header + "array integer general\n2 2\n0\n1\n1\n1\n";

/// Runs `solve` on a file that names A.mtx and U.mtx beside it.
Outcome solve(const std::string& A_file, const std::string& U_file) {
  const Folder folder;
  folder.write("A.mtx", A_file);
  folder.write("U.mtx", U_file);
  return run({"solve", "--json", folder.write("problem.toml", by_files)});
}

}  // namespace

TEST_CASE("matrix files are found beside the problem file, wherever the program is started") {
  const Outcome outcome = solve(A, U);
  CHECK(outcome.code == 0);
  const Json by_numbers = Json::parse(run_json_on("solve", two_rows({{2, "A = [[2, 0.5], [0.5, 1]]"}})).out);
  CHECK(Json::parse(outcome.out).at("acceleration") == by_numbers.at("acceleration"));
}

TEST_CASE("a matrix file may be in a folder beside the problem, or be named by its whole path") {
  const Folder folder;
  std::filesystem::create_directory(folder.path("data"));
  folder.write("data/A.mtx", A);
  const std::string whole = folder.write("whole.mtx", U);
  const std::string file =
      folder.write("problem.toml", two_rows({{2, R"(A = { matrix_market = "data/A.mtx" })"},
                                             {4, "U = { matrix_market = \"" + whole + "\" }"}}));
  CHECK(run({"solve", file}).code == 0);
}

TEST_CASE("words of a matrix file's first line may be in any case") {
  const std::string shouted = "%%MatrixMarket MATRIX Coordinate REAL Symmetric\n2 2 2\n1 1 2\n2 2 1\n";
  CHECK(solve(shouted, U).code == 0);
}

TEST_CASE("a wrong matrix file is named with its line") {
  const std::vector<std::pair<std::string, std::string>> table{
      {"", "line 1"},
      {"hello\n", "line 1"},
      {header + "coordinate complex general\n2 2 0\n", "line 1"},
      {header + "coordinate real general\n", "ends too early"},
      {header + "coordinate real general\n2 2 5\n1 1 2\n", "ends too early"},
      {header + "coordinate real general\n2 2 1\n3 1 2\n", "line 3"},
      {header + "coordinate real general\n2 2 1\n0 1 2\n", "line 3"},
      {header + "coordinate real general\n2 2 1\n1 1 nan\n", "line 3"},
      {header + "coordinate real general\n2 2 1\n1 1 1e999\n", "line 3"},
      {header + "coordinate real general\n2 2 1\n1 1 x\n", "line 3"},
      {header + "coordinate real general\n2 2 1\n1 1 2 surplus\n", "line 3"},
      {header + "coordinate real general\n2 2 2\n1 1 2\n2 2 1\n2 2 1\n", "line 5"},
      {header + "coordinate real general\n2 -2 1\n1 1 2\n", "line 2"},
      {header + "coordinate real general\n2 99999999999999999999 1\n", "line 2"},
      {header + "coordinate real symmetric\n2 3 1\n1 1 2\n", "line 2"},
      {header + "coordinate real symmetric\n2 2 3\n1 1 2\n2 1 1\n1 2 1\n", "line 5"},
      {header + "array real general\n1000000000 1000000000\n1\n", "1000000000 x 1000000000"},
  };
  for (const auto& [bytes, words] : table) {
    const Outcome outcome = solve(bytes, U);
    CAPTURE(bytes);
    CAPTURE(outcome.err);
    CHECK(outcome.code == 2);
    CHECK(outcome.err.find("A.mtx") != std::string::npos);
    CHECK(outcome.err.find(words) != std::string::npos);
    CHECK(outcome.err.find("; ") != std::string::npos);
  }
}

TEST_CASE("an error in a matrix file points at the line of the problem file that names it") {
  CHECK(solve("hello\n", U).err.find("problem.toml:2:") != std::string::npos);
  CHECK(solve(A, "hello\n").err.find("problem.toml:4:") != std::string::npos);
  const Folder folder;
  folder.write("A.mtx", A);
  const Outcome missing = run({"solve", folder.write("problem.toml", by_files)});
  CHECK(missing.code == 2);
  CHECK(missing.err.find("problem.toml:4:") != std::string::npos);
  CHECK(missing.err.find("no such file") != std::string::npos);
}

TEST_CASE("a matrix of the wrong size is refused before memory is given to it") {
  constexpr int megabytes = 1000;
  const std::string vast = header + "coordinate real general\n1000000000 1000000000 0\n";
  const Folder folder;
  const std::string file = folder.write("problem.toml", by_files);
  for (const auto& [A_file, U_file] : {std::pair(vast, U), std::pair(A, vast)}) {
    folder.write("A.mtx", A_file);
    folder.write("U.mtx", U_file);
    const Outcome outcome = run_within(megabytes, {"solve", file});
    CAPTURE(outcome.err);
    CHECK(outcome.code == 2);
    CHECK(outcome.err.find("1000000000") != std::string::npos);
  }
}
