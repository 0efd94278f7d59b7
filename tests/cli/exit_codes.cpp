#include <doctest/doctest.h>

#include <utility>

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

TEST_CASE("one curve written twice has a motion at a state that meets it within its digits") {
  const std::string third = R"text(drive = "x = t/3", again = "x*(1 + x) = t/3*(1 + t/3)")text",
                    tenth = R"text(drive = "x = 0.1*t", again = "(x + 1)^2 = (0.1*t + 1)^2")text";
  const Folder folder;
  for (const auto& [curve, velocity] :
       {std::pair{third, "0.3333333333333333"}, {tenth, "0.10000000000000001"}}) {
    const std::string file = folder.write(
        "curve.toml", "[system]\ncoordinates = [\"x\"]\nkinetic = \"x'^2/2\"\nconstraints = { " + curve +
                          " }\n[state]\nposition = { x = 0 }\nvelocity = { x = " + velocity + " }\n");
    for (const char* command : {"solve", "check", "explain"}) CHECK(run({command, file}).code == 0);
    for (const char* method : {"exact", "lemke"}) CHECK(run({"solve", "--method", method, file}).code == 0);
  }
}
