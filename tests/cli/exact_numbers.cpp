#include <doctest/doctest.h>

#include <cmath>

#include <nlohmann/json.hpp>

#include "tests/cli/program.hpp"

using namespace tests;
using Json = nlohmann::ordered_json;

namespace {

/// The double that a value of z is read as.
double read(const std::string& value) {
  const Outcome outcome = run_json_on("derive", two_rows({{3, "z = [" + value + ", 0]"}}));
  CAPTURE(value);
  REQUIRE(outcome.code == 0);
  return Json::parse(outcome.out).at("z").at("q[0]");
}

}  // namespace

TEST_CASE("an exact number in a string is read as the double nearest to it") {
  CHECK(read("\"1/3\"") == 1.0 / 3);
  CHECK(read("\"-1/3\"") == -1.0 / 3);
  CHECK(read("\"+2/6\"") == 1.0 / 3);
  CHECK(read("\"0.1\"") == 0.1);
  CHECK(read("\"-2\"") == -2);
  CHECK(read("\"1e-3\"") == 1e-3);
  CHECK(read("\"1.5e3/4\"") == 375);
  CHECK(read("\" 1 / 3 \"") == 1.0 / 3);
  CHECK(read("\"0\"") == 0);
  CHECK(read("\"1e-5000\"") == 0);
  CHECK(read("\"5e-324\"") == 5e-324);
  CHECK(read("\"1.7976931348623157e308\"") == 1.7976931348623157e308);
}

TEST_CASE("an exact number halfway between two doubles goes to the even one") {
  CHECK(read("\"9007199254740993\"") == 9007199254740992);
  CHECK(read("\"9007199254740995\"") == 9007199254740996);
  CHECK(read("\"-9007199254740993\"") == -9007199254740992);
}

TEST_CASE("integers, floats, underscores and other bases of TOML are numbers") {
  CHECK(read("1_000") == 1000);
  CHECK(read("0x10") == 16);
  CHECK(read("1_0.5e+1") == 105);
  CHECK(read("-0.0") == 0);
}

TEST_CASE("exact strings may stand in A, z, U and s") {
  const std::string text = two_rows({{2, R"(A = [["2/3", 0], [0, "1/3"]])"},
                                     {3, R"(z = ["1/3", "-0.1"])"},
                                     {4, R"(U = [[0, "1/7"], ["1/9", 0]])"},
                                     {5, R"(s = ["1/2", "-1/9"])"}});
  const Json object = Json::parse(run_json_on("solve", text).out);
  CHECK(object.at("status") == "solved");
  CHECK(object.at("acceleration").at("q[0]").get<double>() == doctest::Approx(0.5));
  CHECK(object.at("acceleration").at("q[1]").get<double>() == doctest::Approx(3.5));
}

TEST_CASE(
    "a method that is named tells its distance from the solution of the fractions, not of their doubles") {
  // Row 1 alone holds: q = (-3/5, -4/7).
  const char* text = R"([projection]
A = [["2", "-3"], ["-3", "21"]]
z = ["39/35", "-367/35"]
U = [["-1", "-1/9"], ["-3/5", "2/7"], ["2", "-1"]]
s = ["209/315", "241/1225", "-22/35"]
)";
  Folder folder;
  const std::string file = folder.write("fractions.toml", text);
  for (const std::string method : {"active-set", "nnls", "lemke", "interior-point", "proximal-point"}) {
    CAPTURE(method);
    const Json object = Json::parse(run({"solve", "--json", "--method", method, file}).out);
    const auto q = [&](const char* name) -> long double {
      return object.at("acceleration").at(name).get<double>();
    };
    const long double dx = q("q[0]") + 3 / 5.0L, dy = q("q[1]") + 4 / 7.0L;
    const long double distance = std::sqrt(2 * dx * dx - 6 * dx * dy + 21 * dy * dy);
    CHECK(object.at("status") == "solved");
    const double of_long_double = 1e-3;  // what its rounding makes of a distance of some 1e-15
    CHECK(object.at("certificate").at("error_bound").get<double>() >= (1 - of_long_double) * distance);
    // Each of A, z, U and s is a rounding off.
    CHECK(object.at("certificate").at("error_bound").get<double>() >= 0x1p-53);
  }
}

TEST_CASE("a method that is named solves no fractions that contradict each other by less than a rounding") {
  // Row 3 asks for more than 1e8 times what row 0 sets; both are the same in doubles.
  const char* text = R"([projection]
A = [["3", "-4", "1"], ["-4", "22", "-3"], ["1", "-3", "18"]]
z = ["-3", "5", "69"]
U = [["0", "3", "3"], ["0", "1", "1"], ["-1", "3", "-1"], ["0", "300000000", "300000000"]]
s = ["15", "42949672959/8589934592", "-1", "25769803776000000001/17179869184"]
two_sided = [0]
)";
  Folder folder;
  const std::string file = folder.write("apart.toml", text);
  CHECK(run({"solve", file}).code == 1);
  for (const std::string method : {"proximal-point", "interior-point"}) {
    CAPTURE(method);
    const Outcome outcome = run({"solve", "--json", "--method", method, file});
    CHECK(outcome.code != 0);
    CHECK(Json::parse(outcome.out).at("status") != "solved");
  }
}

TEST_CASE("a method that is named tells no contradiction that fractions do not have") {
  // Rows 1 and 2 are opposite but for some 1e-16: a narrow wedge, with a point in it.
  const char* text = R"([projection]
A = [["20", "3", "-4"], ["3", "28", "6"], ["-4", "6", "7"]]
z = ["44", "-20", "-37"]
U = [["3", "2199023255551/2199023255552", "72057594037927937/36028797018963968"],
     ["1729382256910270465/576460752303423488", "1", "36028797018963967/18014398509481984"],
     ["-3", "-1", "-2251799813685247/1125899906842624"],
     ["-3298534883327/1099511627776", "-144115188075855871/144115188075855872",
      "-576460752303423487/288230376151711744"],
     ["422212465065985/140737488355328", "1073741823/1073741824", "36028797018963969/18014398509481984"]]
s = ["-25/288230376151711744", "-32719/288230376151711744", "16381/1125899906842624",
     "524157/288230376151711744", "253/18014398509481984"]
two_sided = [1]
)";
  Folder folder;
  const std::string file = folder.write("wedge.toml", text);
  CHECK(run({"solve", file}).code == 0);
  const Outcome outcome = run({"solve", "--json", "--method", "nnls", file});
  CHECK(Json::parse(outcome.out).at("status") != "infeasible");
}

TEST_CASE("a multiplier presses however small it is beside others, as fractions say") {
  const auto state = [](const std::string& command, const std::string& small) {
    const Json object =
        Json::parse(run_json_on("solve", "[projection]\nA = [[1, 0], [0, 1]]\nz = [1, " + small +
                                             "]\nU = [[-1, 0], [0, -1]]\ns = [0, 0]\n" + command)
                        .out);
    return object.at("constraints").at("c[1]").at("state").get<std::string>();
  };
  for (const char* method : {"", "[solve]\nmethod = \"exact\"\n"}) {
    CHECK(state(method, "1e-15") == "persists");
    CHECK(state(method, "0") == "touches");
  }
}

TEST_CASE("a force of 1e-14 beside a weight of 10 presses on a wall, and no warning says that it does not") {
  const auto wall = [](const std::string& force, const std::string& option) {
    const Folder folder;
    const Outcome outcome = run({"solve", "--json", option,
                                 folder.write("a.toml",
                                              "[system]\ncoordinates = [\"x\", \"y\"]\nkinetic = \"(x'^2 + "
                                              "y'^2)/2\"\npotential = \"10*y\"\nforces = { x = \"" +
                                                  force +
                                                  "\" }\nconstraints = { floor = \"y >= 0\", wall = \"x <= "
                                                  "0\" }\n[state]\nposition = { x = 0, y = 0 }\n")});
    const Json object = Json::parse(outcome.out);
    CHECK(outcome.err.empty() == object.at("warnings").empty());
    return object.at("constraints").at("wall").at("state").get<std::string>();
  };
  for (const char* option : {"--ranges", "--certify"}) {
    CHECK(wall("1e-14", option) == "persists");
    CHECK(wall("0", option) == "touches");
  }
  // What rounding made of 0 is not told from it.
  CHECK(wall("sin(pi)", "--ranges") == "touches");
}

namespace {

Outcome solve_by(const std::string& method, const std::string& A, const std::string& z, const std::string& s,
                 const std::string& U = "[[1, 1]]") {
  return run_json_on("solve", two_rows({{2, "A = " + A},
                                        {3, "z = " + z},
                                        {4, "U = " + U},
                                        {5, "s = [" + s + "]"},
                                        {7, "[solve]\nmethod = \"" + method + "\""}}));
}

}  // namespace

TEST_CASE("the exact method takes an A at its exact value that is definite by less than doubles can tell") {
  // det A = 1e-27; A (3, 0) = z, and 3 >= 0.
  const Outcome outcome = solve_by(
      "exact", R"([["1", "1/3"], ["1/3", "1000000000000000000000000009/9000000000000000000000000000"]])",
      "[3, 1]", "0");
  const Json object = Json::parse(outcome.out);
  CAPTURE(outcome.out);
  CHECK(object.at("exact").at("acceleration").at("q[0]") == "3");
  CHECK(object.at("exact").at("acceleration").at("q[1]") == "0");
  CHECK(object.at("status") == "solved");
}

TEST_CASE("an A of doubles definite by one unit in the last place is solved, a singular one refused") {
  const auto A = [](const std::string& last) { return "[[1, 1], [1, " + last + "]]"; };
  // A⁻¹z = (1 - e, e) / e, e = 2^-52: q0 + q1 = 1 < 3, so that lambda = 2 lifts the first entry by 2.
  for (const char* method : {"auto", "exact", "active-set", "lemke", "interior-point"}) {
    CAPTURE(std::string(method));
    const Outcome outcome = solve_by(method, A("1.0000000000000002"), "[1, 2]", "3");
    REQUIRE(outcome.code == 0);
    const Json object = Json::parse(outcome.out);
    CHECK(object.at("acceleration").at("q[1]") == 0x1p52);
    CHECK(object.at("acceleration").at("q[0]") == 3 - 0x1p52);
    CHECK(object.at("multipliers").at("c[0]") == 2);
  }
  const Outcome beside =
      solve_by("auto", "[[1, 1, 0], [1, 1.0000000000000002, 0], [0, 0, 1]]", "[1, 2, 1]", "3", "[[1, 1, 0]]");
  REQUIRE(beside.code == 0);  // in an island of its own
  CHECK(Json::parse(beside.out).at("multipliers").at("c[0]") == 2);
  // The derivatives there have no digits in doubles.
  const Folder folder;
  const std::string file =
      folder.write("a.toml", two_rows({{2, "A = [[1, 1], [1, 1.0000000000000002]]"}, {3, "z = [1, 2]"}}));
  const Json object = Json::parse(run({"solve", "--json", "--sensitivity", file}).out);
  CHECK(object.at("sensitivity").at("by_force").at("q[0]").at("more").is_null());
  for (const char* singular : {"1", "0.9999999999999999"})
    CHECK(solve_by("exact", A(singular), "[1, 2]", "3").code == 2);
}

TEST_CASE("whole numbers are exact however long they are, wherever they are written") {
  const std::string rows = "[projection]\nA = [[1]]\nz = [0]\nU = [[1], [-1]]\ns = ";
  const std::string apart = rows + "[9007199254740993, -9007199254740992]\n";
  const Outcome contradiction = run_json_on("solve", apart);
  CHECK(contradiction.code == 1);
  CHECK(Json::parse(contradiction.out).at("farkas") == Json{{"c[0]", 1}, {"c[1]", 1}});
  for (const std::string option : {"--certify", "--method=exact"})
    CHECK(run({"solve", option, "-"}, apart).code == 1);

  const auto acceleration = [](const std::vector<std::string>& arguments, const std::string& text) {
    std::vector<std::string> command{"solve", "--json", "--method", "exact"};
    command.insert(command.end(), arguments.begin(), arguments.end());
    const Outcome outcome = run(command, text);
    CAPTURE(outcome.err);
    REQUIRE(outcome.code < 2);
    return Json::parse(outcome.out).at("exact").at("acceleration").at("q[0]").get<std::string>();
  };
  const std::string free = "[projection]\nA = [[1]]\nz = [";
  CHECK(acceleration({"-"}, free + "9007199254740993]\n") == "9007199254740993");
  CHECK(acceleration({"-"}, free + "0x20000000000001]\n") == "9007199254740993");
  CHECK(acceleration({"--set", "projection.z[0]=9007199254740993", "-"}, free + "0]\n") ==
        "9007199254740993");
  CHECK(acceleration({"-"}, R"({"projection": {"A": [[1]], "z": [100000000000000000000000001]}})") ==
        "100000000000000000000000001");
  // Floats are the doubles nearest to them.
  CHECK(acceleration({"-"}, free + "9007199254740993.0]\n") == "9007199254740992");

  const Folder folder;
  const std::string header = "%%MatrixMarket matrix coordinate ",
                    one = " general\n1 1 1\n1 1 9007199254740993\n";
  folder.write("whole.mtx", header + "integer" + one);
  folder.write("real.mtx", header + "real" + one);
  const auto quotient = [&](const std::string& matrix, const std::string& text) {
    return acceleration({folder.write("p.toml", "[projection]\n" + text)}, "") ==
           (matrix == "whole.mtx" ? "1" : "9007199254740993/9007199254740992");
  };
  for (const std::string matrix : {"whole.mtx", "real.mtx"}) {
    CAPTURE(matrix);
    const std::string named = "{ matrix_market = \"" + matrix + "\" }\n";
    CHECK(quotient(matrix, "z = [9007199254740993]\nA = " + named));
    CHECK(quotient(matrix, "A = [[1]]\nz = [0]\ns = [9007199254740993]\nU = " + named));
  }
  const std::string program =
      "NAME t\nROWS\n N f\n G a\n L b\nCOLUMNS\n x a 1\n x b 1\nRHS\n r a 9007199254740993\n"
      " r b 9007199254740992\nBOUNDS\n FR d x\nQUADOBJ\n x x 1\nENDATA\n";
  CHECK(run({"solve", folder.write("t.qps", program)}).code == 1);
  // What has doubles alone refuses others.
  const Outcome refused =
      run({"convert", folder.write("z.toml", free + "9007199254740993]\n"), folder.path("z.mtx")});
  CHECK(refused.code == 2);
  CHECK(refused.err.find("9007199254740993 is no double") != std::string::npos);
}

TEST_CASE("a folder of matrix files of integers has them exactly") {
  const Folder folder;
  const std::string header = "%%MatrixMarket matrix array integer general\n1 1\n";
  folder.write("z.mtx", header + "9007199254740993\n");
  folder.write("A.mtx", header + "1\n");
  const Outcome outcome = run({"solve", "--json", "--method", "exact", folder.path("")});
  CAPTURE(outcome.err);
  REQUIRE(outcome.code < 2);
  CHECK(Json::parse(outcome.out).at("exact").at("acceleration").at("q[0]") == "9007199254740993");
}

TEST_CASE("integers longer than 64 bits survive a conversion to TOML") {
  const Folder folder;
  const std::string file =
      folder.write("p.json", R"({"projection": {"A": [[1]], "z": [123456789012345678901234567890]}})");
  const Outcome converted = run({"convert", file, folder.path("p.toml")});
  CAPTURE(converted.err);
  REQUIRE(converted.code == 0);
  const Outcome outcome = run({"solve", "--json", "--method", "exact", folder.path("p.toml")});
  CAPTURE(outcome.err);
  REQUIRE(outcome.code < 2);
  CHECK(Json::parse(outcome.out).at("exact").at("acceleration").at("q[0]") ==
        "123456789012345678901234567890");
}

TEST_CASE("--method exact tells the fractions of a projection in words too, where they are short") {
  const tests::Outcome told = tests::run_on(
      "solve",
      "[projection]\nA = [[2, 0], [0, 3]]\nz = [\"1/3\", -7]\nU = [[0, 1]]\ns = [0]\n[solve]\nmethod = "
      "\"exact\"\n");
  CHECK(told.out.find("In fractions: q[0]'' = 1/6, q[1]'' = 0; lambda c[0] 7.\n") != std::string::npos);
}
