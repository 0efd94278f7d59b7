#include <doctest/doctest.h>

#include "tests/cli/program.hpp"

using namespace tests;

namespace {

const std::string impossible = two_rows({{4, "U = [[1, 0], [-1, 0]]"}, {5, "s = [1, 1]"}});

}  // namespace

TEST_CASE("a solved problem exits zero and says nothing on standard error") {
  for (const std::string& text : {point_on_floor(), two_rows()}) {
    const Outcome outcome = run_on("solve", text);
    CHECK(outcome.code == 0);
    CHECK(outcome.err.empty());
    CHECK_FALSE(outcome.out.empty());
  }
}

TEST_CASE("a problem without a solution exits one") { CHECK(run_on("solve", impossible).code == 1); }

TEST_CASE("a wrong file exits two") { CHECK(run_on("solve", "nothing = 1\n").code == 2); }

TEST_CASE("a solution that misses its tolerance exits three") {
  const Folder folder;
  const std::string file =
      folder.write("problem.toml", two_rows({{2, "A = [[2, 1], [1, 3]]"}, {3, R"(z = ["1/3", "1/7"])"}}));
  CHECK(run({"solve", file}).code == 0);
  CHECK(run({"solve", "--tolerance", "1e-300", file}).code == 3);
}

TEST_CASE("of several files the largest exit code counts, whatever their order") {
  const Folder folder;
  const std::string solved = folder.write("solved.toml", point_on_floor()),
                    infeasible = folder.write("infeasible.toml", impossible),
                    wrong = folder.write("wrong.toml", "x = 1\n");
  CHECK(run({"solve", solved, solved}).code == 0);
  CHECK(run({"solve", infeasible, solved}).code == 1);
  CHECK(run({"solve", solved, infeasible}).code == 1);
  CHECK(run({"solve", wrong, infeasible, solved}).code == 2);
  CHECK(run({"solve", infeasible, solved, wrong}).code == 2);
}

TEST_CASE("derive exits zero for a system without a solution: it does not solve") {
  CHECK(run_on("derive", impossible).code == 0);
}
