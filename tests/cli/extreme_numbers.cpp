#include <doctest/doctest.h>

#include <array>
#include <cmath>
#include <limits>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "tests/cli/program.hpp"

using namespace tests;
using Json = nlohmann::ordered_json;

namespace {

/// A number of the answer, which may be the word "inf".
double number(const Json& value) {
  return value.is_number() ? value.get<double>() : std::numeric_limits<double>::infinity();
}

}  // namespace

TEST_CASE("whatever the powers of ten of A, z and U, an answer called solved is one") {
  for (const std::string a : {"1e-150", "1", "1e150"})
    for (const std::string w : {"1e-200", "1", "1e100", "1e200", "1e300"})
      for (const std::string u : {"1e-300", "1e-200", "1e-100", "1", "1e100", "1e200", "1e300"}) {
        const Outcome outcome =
            run_json_on("solve", "[projection]\nA = { diagonal = [" + a + ", " + a + "] }\nz = [" + w +
                                     ", -" + w + "]\nU = [[0, " + u + "]]\ns = [0]\n");
        CAPTURE(a);
        CAPTURE(w);
        CAPTURE(u);
        CHECK((outcome.code == 0 || outcome.code == 2 || outcome.code == 3));
        if (outcome.code != 0) continue;  // refused, or not solved to its accuracy: it said so
        const Json q = Json::parse(outcome.out).at("acceleration");
        const double weight = std::sqrt(std::stod(a)), x = std::stod(w) / std::stod(a);  // q'' = (x, 0)
        const double error = std::hypot(weight * (number(q.at("q[0]")) - x), weight * number(q.at("q[1]")));
        CHECK(error <= 1e-9 * std::max(1.0, weight * x));
      }
}

TEST_CASE("an infinite number in an answer is the word inf") {
  const Outcome outcome = run_json_on("solve", two_rows({{3, "z = [0, 1e200]"}}));
  CHECK(Json::accept(outcome.out));
  if (outcome.code == 0) CHECK(Json::parse(outcome.out).at("gauss") == "-inf");
}

TEST_CASE(
    "rows whose squares are beyond doubles, and fractions that doubles round, are solved as they are read") {
  struct Case {
    const char* problem;
    std::array<double, 2> q;
  };
  // By hand: the held rows fix q in the first two; in the third q0 = -1e15/9 and q1 = 1e15/9.
  for (const Case& one : {Case{"A = [[1,0],[0,1]]\nz = [5,0]\nU = [[1e200,0],[1e-200,1e-200]]\ns = "
                               "[1e200,3e-200]\ntwo_sided = [1]\n",
                               {4, -1}},
                          Case{"A = [[1,0],[0,1]]\nz = [0,0]\nU = [[0,2e200],[0,2e-200],[-1e-200,0]]\n"
                               "s = [-4.4e200,-4e-200,1e-200]\ntwo_sided = [1,2]\n",
                               {-1, -2}},
                          Case{"A = [[\"1\",\"1\"],[\"1\",\"1000000000000009/1000000000000000\"]]\nz = "
                               "[0,1]\nU = [[1,0]]\ns = [-1e30]\n",
                               {-1e15 / 9, 1e15 / 9}}}) {
    const Outcome outcome = run_json_on("solve", std::string("[projection]\n") + one.problem);
    CAPTURE(one.problem);
    REQUIRE(outcome.code == 0);
    const Json q = Json::parse(outcome.out).at("acceleration");
    CHECK(number(q.at("q[0]")) == doctest::Approx(one.q[0]).epsilon(1e-15));
    CHECK(number(q.at("q[1]")) == doctest::Approx(one.q[1]).epsilon(1e-15));
  }
}

namespace {

const std::vector<std::vector<std::string>> ways_to_solve{{}, {"--certify"}, {"--method", "exact"}};

Outcome solved_by(const std::vector<std::string>& way, const std::string& problem) {
  const Folder folder;
  std::vector<std::string> arguments{"solve", "--json", folder.write("problem.toml", problem)};
  arguments.insert(arguments.end(), way.begin(), way.end());
  return run(arguments);
}

}  // namespace

TEST_CASE("an acceleration beyond doubles is never called solved, by no way of solving") {
  // x'' = -1/m or z/m, larger than 1.8e308.
  for (const char* problem :
       {"[projection]\nA = [[5e-324]]\nz = [1]\nU = [[1]]\ns = [0]\n",
        "[projection]\nA = [[1e-320]]\nz = [1e300]\nU = [[1]]\ns = [0]\n",
        "[projection]\nA = [[1e-300, 0], [0, 1]]\nz = [1e300, 1]\nU = [[1, 1]]\ns = [-1]\n",
        "[system]\ncoordinates = [\"x\"]\nkinetic = \"1e-320/2*x'^2\"\npotential = \"x\"\n[state]\nposition "
        "= "
        "{ x = 0 }\n",
        "[system]\ncoordinates = [\"x\", \"y\"]\nkinetic = \"1e-300/2*x'^2 + y'^2/2\"\npotential = "
        "\"1e300*x\"\n[system.constraints]\nfloor = \"y >= 0\"\n[state]\nposition = { x = 0, y = 0 }\n"})
    for (const auto& way : ways_to_solve) {
      CAPTURE(problem);
      CAPTURE(way.size());
      const Outcome outcome = solved_by(way, problem);
      CHECK(outcome.code == 3);
      CHECK(Json::parse(outcome.out).at("status") == "inaccurate");
    }
}

TEST_CASE("a contradiction of the least double there is, is one") {
  for (const char* problem :
       {"[projection]\nA = [[1]]\nz = [0]\nU = [[1], [1]]\ns = [0, 5e-324]\ntwo_sided = [0, 1]\n",
        "[system]\ncoordinates = [\"y\"]\nkinetic = \"y'^2/2\"\n[system.constraints]\nslot = \"y = 0\"\nlate "
        "= "
        "\"y = 5e-324*t^2\"\n[state]\nposition = { y = 0 }\n"})
    for (const auto& way : ways_to_solve) {
      CAPTURE(problem);
      CAPTURE(way.size());
      CHECK(solved_by(way, problem).code == 1);
    }
}

TEST_CASE("a mechanism of very heavy bodies is solved as it is written") {
  // At rest in a corner, x'' = y'' = 0 with both contacts pressing.
  const char* corner =
      "[system]\ncoordinates = [\"x\", \"y\"]\nkinetic = \"1e307/2*(x'^2 + y'^2) + 1e306*x'*y'\"\npotential "
      "= "
      "\"9.81*1e307*y\"\n[system.constraints]\nleft = \"y >= x\"\nright = \"y >= -x\"\n[state]\nposition = { "
      "x = "
      "0, y = 0 }\n";
  for (const auto& way : ways_to_solve) {
    CAPTURE(way.size());
    const Outcome outcome = solved_by(way, corner);
    REQUIRE(outcome.code == 0);
    const Json q = Json::parse(outcome.out).at("acceleration");
    CHECK(q.at("x") == 0);
    CHECK(q.at("y") == 0);
  }
}

TEST_CASE("multipliers of rows that are independent by a few roundings are unique, and told as they are") {
  // The rods meet at (0, 2) alone, where the free motion is: both multipliers are 0.
  const Json answer = Json::parse(
      run_json_on("solve",
                  "[projection]\nA = [[1, 0], [0, 1]]\nz = [0, 2]\nU = [[-1, -3], [1.0000000000000053, 3]]\n"
                  "s = [-6, 6]\ntwo_sided = [0, 1]\n")
          .out);
  CHECK(answer.at("multipliers_unique") == true);
  CHECK(answer.at("multipliers").at("c[0]") == 0);
  CHECK(answer.at("model").at("islands").at(0).at("in_fractions") == "whether rows depend on each other");
}

TEST_CASE("multipliers of rows that nearly depend on each other are the same by every way of solving") {
  // lambda_1 (1, 0) + lambda_2 (-1, 2^-49) = 0 for lambda = 0 alone.
  for (const auto& way : ways_to_solve) {
    CAPTURE(way.size());
    const Json answer = Json::parse(
        solved_by(
            way,
            "[projection]\nA = [[1, 0], [0, 1]]\nz = [0, 0]\nU = [[1, 0], [-1, \"1/562949953421312\"]]\n"
            "s = [0, 0]\n")
            .out);
    CHECK(answer.at("multipliers_unique") == true);
    CHECK(answer.at("multiplier_ranges").at("c[1]") == Json::array({0, 0}));
  }
}

TEST_CASE(
    "powers of small numbers are fractions however large their exponents, so that fractions decide beside "
    "them") {
  for (const char* power : {"2^63", "2^95", "2^110"}) {
    const Json answer = Json::parse(
        run_json_on("solve", std::string("[system]\ncoordinates = [\"x\"]\nkinetic = \"x'^2/2\"\n"
                                         "forces = {x = \"-1\"}\nconstraints = {a = \"x/") +
                                 power + " >= 0\", b = \"x >= 0\"}\n[state]\nposition = {x = 0}\n")
            .out);
    CAPTURE(power);
    CHECK(answer.at("status") == "solved");
    CHECK(answer.at("multipliers_unique") == false);
    CHECK(answer.at("model").at("islands").at(0).at("in_fractions") == "whether rows depend on each other");
  }
}

TEST_CASE("a method that was named solves rightly, or says that it does not, where squares are no doubles") {
  struct Case {
    const char* problem;
    std::vector<double> q;  ///< empty: no motion keeps the rows
  };
  // By hand: -1e200 is no bound (lambda = 438/65 of the other row), the row of 1e-300 is that of 1, and 0 >=
  // 5e-324 is wrong.
  const std::vector<Case> cases{
      {"A = [[6, 2], [2, 11]]\nz = [-2.4, -1]\nU = [[1, 1], [-1, 2]]\ns = [1, -1e200]\n",
       {38 / 65.0, 27 / 65.0}},
      {"A = [[1, 0], [0, 1]]\nz = [3, -1]\nU = [[1e-300, 1e-300], [1, 0]]\ns = [4e-300, -1e308]\n", {4, 0}},
      {"A = [[1, 0], [0, 1]]\nz = [3, -1]\nU = [[1, 0], [0, 0]]\ns = [-1e308, 5e-324]\n", {}},
      {"A = [[4]]\nz = [5]\nU = [[2], [-1]]\ns = [0, 5e-324]\n", {}}};
  for (const Case& one : cases)
    for (const char* method : {"auto", "active-set", "nnls", "lemke", "block-pivoting", "enumerate", "admm",
                               "interior-point", "drop-negative"}) {
      CAPTURE(one.problem);
      CAPTURE(method);
      const Folder folder;
      const std::string file = folder.write("p.toml", std::string("[projection]\n") + one.problem);
      const Outcome outcome = run({"solve", "--json", "--limit", "0", "--method", method, file});
      if (outcome.code == 3) continue;  // it says so
      REQUIRE(outcome.code == (one.q.empty() ? 1 : 0));
      if (one.q.empty()) continue;
      const Json answer = Json::parse(outcome.out);
      double square = 0;
      for (std::size_t i = 0; i < one.q.size(); ++i) {
        const double off = number(answer.at("acceleration").at("q[" + std::to_string(i) + "]")) - one.q[i];
        square += off * off;
      }
      const double bound = number(answer.at("certificate").at("error_bound"));
      CHECK(std::sqrt(square) <= bound + 1e-15);
      CHECK(number(answer.at("residuals").at("feasibility")) <= 1e-9);
    }
}

TEST_CASE("an A whose masses are a power of 1e380 apart is called indefinite by no method") {
  const Folder folder;
  const std::string file = folder.write("p.toml", R"([projection]
A = [[2.3866690339840662e-153, -6.80564733841877e+38], [-6.80564733841877e+38, 3.8812952307517723e+230]]
z = [3.488120700934677e-105, 1.9892929456391466e+87]
U = [[0.0, 0.0], [-1.0363402266113334e-76, 3.940200619639448e+115]]
s = [0.0, 0.0]
)");
  for (const char* method : {"auto", "active-set", "nnls", "lemke", "block-pivoting", "enumerate",
                             "semismooth-newton", "proximal-point", "interior-point", "admm",
                             "accelerated-gradient", "projected-gauss-seidel", "drop-negative", "exact"}) {
    CAPTURE(method);
    const Outcome outcome = run({"solve", "--method", method, file});
    CAPTURE(outcome.err);
    CHECK((outcome.code == 0 || outcome.code == 3));
    CHECK(outcome.err.find("not positive") == std::string::npos);
  }
}

TEST_CASE("a value of a conjugate beyond doubles is told as not known, and infinite ones as infinite") {
  const auto conjugate = [](const std::string& f, const std::string& at, int code) {
    const Outcome outcome = run({"conjugate", f, "--at", at, "--json"});
    CAPTURE(f);
    CHECK(outcome.code == code);
    return Json::parse(outcome.out);
  };
  for (const std::string f :
       {"power(2)", "power(1.5)", "squared_norm2() + norm2()", "squared_norm2() + norm1()",
        "elastic_net(1, 1)", "quadratic([[1, 0], [0, 1]])", "entropy()"})
    for (const std::string at : {"[1e300, 1e300]", "[1e300, -1e300]"}) {
      const Json told = conjugate(f, at, 3);
      CHECK(told.at("status") == "inaccurate");
      CHECK(told.at("value") == "inf");
      CHECK(told.at("error_bound") == "inf");
      const Outcome text = run({"conjugate", f, "--at", at});
      CHECK(text.out.find("beyond the largest double") != std::string::npos);
      CHECK(text.out.find("nan") == std::string::npos);
    }
  for (const std::string f : {"norm1()", "norm2()", "huber(1)", "max()", "logistic()"}) {
    const Json told = conjugate(f, "[1e300, 1e300]", 0);
    CHECK(told.at("value") == "inf");
    CHECK(told.at("error_bound") == 0);
  }
  // In fractions it is known.
  const Outcome exact = run({"conjugate", "power(2)", "--at", "[1e300, 0]", "--method", "exact"});
  CHECK(exact.out.find("exactly 25" + std::string(598, '0') + "\nProved: it is finite.") !=
        std::string::npos);
}

TEST_CASE("a conjugate whose curvatures are beyond doubles has a value, or says that it is not known") {
  // The supremum of xy - x² - |x|³ is (2/3) y^(3/2) / sqrt(3) for large y.
  const Outcome outcome = run({"conjugate", "power(2) + power(3)", "--at", "[1e160]", "--json"});
  const Json told = Json::parse(outcome.out);
  const double value = number(told.at("value")), error = number(told.at("error_bound"));
  CHECK(std::abs(value - 3.849001794597505e239) <= error + 1e226);
}
