#include <Eigen/QR>
#include <algorithm>
#include <fstream>
#include <nlohmann/json.hpp>

#include "tests/cli/error_form.hpp"
#include "tests/this_build.hpp"

using namespace tests;
using Json = nlohmann::ordered_json;

namespace {

/// Lines: 1 [cone], 2 generators, 3 lines, 4 z, 5 metric, 6 dimension.
std::string wedge(const Changes& changes = {}) {
  std::vector<std::string> lines{"[cone]", "generators = [[1, 0], [1, 2]]", "", "z = [-1, 3]", "", ""};
  for (const auto& [line, text] : changes) lines[static_cast<std::size_t>(line - 1)] = text;
  std::string file;
  for (const std::string& line : lines) file += line + "\n";
  return file;
}

Json solved(const std::string& text) {
  const Outcome outcome = run_json_on("solve", text);
  CAPTURE(text);
  CAPTURE(outcome.err);
  CHECK(outcome.code == 0);
  return Json::parse(outcome.out);
}

double number(const Json& value) {
  if (value.is_number()) return value.get<double>();
  const std::string text = value.get<std::string>();
  const std::size_t slash = text.find('/');
  return std::stod(text) / (slash == std::string::npos ? 1 : std::stod(text.substr(slash + 1)));
}

Eigen::MatrixXd columns(const Json& rows, Eigen::Index n) {
  Eigen::MatrixXd M(n, static_cast<Eigen::Index>(rows.size()));
  for (Eigen::Index j = 0; j < M.cols(); ++j)
    for (Eigen::Index i = 0; i < n; ++i)
      M(i, j) = number(rows[static_cast<std::size_t>(j)][static_cast<std::size_t>(i)]);
  return M;
}

/// The rest of each vector off the span, of length 1, sorted so that sets can be compared.
std::vector<std::vector<double>> rays(const Json& rows, const Json& modulo, Eigen::Index n) {
  const Eigen::MatrixXd span = columns(modulo, n), vectors = columns(rows, n);
  std::vector<std::vector<double>> found;
  for (Eigen::VectorXd v : vectors.colwise()) {
    if (span.cols() > 0) v -= span * span.colPivHouseholderQr().solve(v);
    v /= v.norm();
    found.emplace_back();
    for (double entry : v) found.back().push_back(std::round(entry * 1e9) / 1e9 + 0.0);
  }
  std::sort(found.begin(), found.end());
  return found;
}

void compare_descriptions(const Json& found, const Json& expected, Eigen::Index n) {
  for (const auto& [one_way, two_way] : {std::pair{"generators", "lines"}, {"halfspaces", "equations"}}) {
    CAPTURE(one_way);
    CHECK(rays(found[one_way], expected[two_way], n) == rays(expected[one_way], expected[two_way], n));
    REQUIRE(found[two_way].size() == expected[two_way].size());
    if (found[two_way].empty()) continue;
    Eigen::MatrixXd both(n, static_cast<Eigen::Index>(2 * found[two_way].size()));
    both << columns(found[two_way], n), columns(expected[two_way], n);
    CHECK(both.fullPivHouseholderQr().rank() == static_cast<Eigen::Index>(found[two_way].size()));
  }
}

}  // namespace

TEST_CASE("the cones of the library have the values of an independent derivation") {
  for (const std::string name : {"cone_isotonic", "cone_friction_pyramid", "cone_hidden_line"}) {
    CAPTURE(name);
    std::ifstream file(tests::source_folder() + "tests/cases/" + name + ".expected.json");
    REQUIRE(file.good());
    const Json expected = Json::parse(file);
    const Outcome outcome =
        run({"solve", "--json", tests::source_folder() + "docs/problems/" + name + ".toml"});
    REQUIRE(outcome.code == 0);
    const Json found = Json::parse(outcome.out);
    const auto n = static_cast<Eigen::Index>(expected["x"].size());
    compare_descriptions(found, expected, n);
    compare_descriptions(found["polar"], expected["polar"], n);
    CHECK(found["dimension"] == expected["dimension"]);
    CHECK(found["pointed"] == expected["pointed"]);
    for (const char* point : {"x", "y"})
      for (std::size_t i = 0; i < expected[point].size(); ++i)
        CHECK(found[point][i].get<double>() == number(expected[point][i]));
    CHECK(found["inner"] == 0);
    CHECK(found["residual"] == 0);
  }
}

TEST_CASE("a cone's object has the keys of the contract, those of the point only with z") {
  std::vector<std::string> keys;
  const Json with_point = solved(wedge());
  for (const auto& [key, value] : with_point.items()) keys.push_back(key);
  CHECK(keys == std::vector<std::string>{"file", "kind", "status", "generators", "lines", "halfspaces",
                                         "equations", "polar", "dimension", "pointed", "x", "y", "inner",
                                         "residual", "face", "polar_face", "seconds"});
  const Json without = solved(wedge({{4, ""}}));
  CHECK_FALSE(without.contains("x"));
  CHECK_FALSE(without.contains("residual"));
  CHECK(without["kind"] == "cone");
  CHECK(without["status"] == "solved");
}

TEST_CASE("a point is split between a cone and its polar, with the faces that the two lie on") {
  const Json found = solved(wedge());
  CHECK(found["x"] == Json::parse("[1, 2]"));
  CHECK(found["y"] == Json::parse("[-2, 1]"));
  CHECK(found["face"] == Json::parse(R"({"dimension": 1, "generators": [1], "halfspaces": [0]})"));
  CHECK(found["polar_face"]["dimension"] == 1);
  // In the metric diag(4, 1): (x|y) = 4 x0 y0 + x1 y1.
  const Json weighted = solved(wedge({{5, "metric = [[4, 0], [0, 1]]"}}));
  CHECK(weighted["x"] == Json::parse("[0.25, 0.5]"));
  CHECK(weighted["y"] == Json::parse("[-1.25, 2.5]"));
  CHECK(weighted["polar"]["generators"] == Json::parse("[[-1, 2], [0, -1]]"));
  CHECK(weighted["polar"]["halfspaces"] == Json::parse("[[1, 0], [2, 1]]"));
  CHECK(solved(wedge({{5, "metric = { diagonal = [4, 1] }"}}))["x"] == weighted["x"]);
}

TEST_CASE("subspaces, the whole space and 0 print empty lists") {
  const Json plane = solved("[cone]\ngenerators = []\nlines = [[1, 1, 0], [0, 0, 2]]\n");
  CHECK(plane["generators"].empty());
  CHECK(plane["lines"] == Json::parse("[[1, 1, 0], [0, 0, 1]]"));
  CHECK(plane["halfspaces"].empty());
  CHECK(plane["equations"] == Json::parse("[[1, -1, 0]]"));
  CHECK(plane["dimension"] == 2);
  CHECK(plane["pointed"] == false);
  const Json zero = solved("[cone]\ngenerators = []\nz = [1, 2]\n");
  CHECK(zero["generators"].empty());
  CHECK(zero["equations"].size() == 2);
  CHECK(zero["dimension"] == 0);
  CHECK(zero["pointed"] == true);
  CHECK(zero["x"] == Json::parse("[0, 0]"));
  CHECK(zero["y"] == Json::parse("[1, 2]"));
  CHECK(zero["polar"]["lines"].size() == 2);
  const Json whole = solved("[cone]\nhalfspaces = []\ndimension = 2\n");
  CHECK(whole["lines"].size() == 2);
  CHECK(whole["equations"].empty());
  CHECK(solved("[cone]\nequations = [[1, 2]]\n")["lines"] == Json::parse("[[2, -1]]"));
}

TEST_CASE("numbers are taken at their exact values, and printed as integers where those are doubles") {
  CHECK(solved(wedge({{2, R"(generators = [["1/3", "1/2"], [0x10, 1_0]])"}}))["generators"] ==
        Json::parse("[[2, 3], [8, 5]]"));
  // The double 0.1 is above a tenth and 0.3 below three of them: (0.1, 0.3) is no multiple of (1, 3).
  CHECK(solved(wedge({{2, "generators = [[0.1, 0.3], [1, 3]]"}}))["generators"].size() == 2);
  CHECK(solved(wedge({{2, R"(generators = [["0.1", "0.3"], [1, 3]])"}}))["generators"].size() == 1);
  CHECK(solved(wedge({{2, "generators = [[9007199254740993, 1], [1, 0]]"}}))["generators"] ==
        Json::parse("[[1, 1.1102230246251564e-16], [1, 0]]"));
  CHECK(solved(wedge({{2, "generators = [[9007199254740993, 9007199254740992], [1, 0]]"}}))["halfspaces"]
            .size() == 2);
  CHECK(run_on("solve", wedge({{2, "generators = [[100000, 1], [1, 0]]"}})).out.find("1e+05") ==
        std::string::npos);
  CHECK(run_json_on("solve", wedge({{2, "generators = [[100000, 1], [1, 0]]"}})).out.find("[100000,1]") !=
        std::string::npos);
}

TEST_CASE("a wrong cone is refused where it is wrong") {
  const std::vector<Wrong> table{
      {wedge({{2, "generators = [[1, 0], [1, 0, 0]]"}}), "2:23", {"generators[1]", "3", "2"}},
      {wedge({{4, "z = [1, 2, 3]"}}), "4:5", {"z", "3", "2"}},
      {wedge({{3, "lines = [[1]]"}}), "3:10", {"lines[0]", "1 entry", "2"}},
      {wedge({{5, "metric = [[1]]"}}), "5:11", {"metric[0]", "1 entry", "2"}},
      {wedge({{5, "metric = [[1, 0]]"}}), "5:10", {"metric", "1 row", "2"}},
      {wedge({{5, "metric = [[1, 2], [2, 1]]"}}), "5:10", {"metric", "not positive definite"}},
      {wedge({{5, "metric = [[1, 2], [0, 1]]"}}), "5:10", {"metric", "not symmetric"}},
      {wedge({{6, "dimension = 3"}}), "6:13", {"dimension", "3", "2"}},
      {wedge({{6, "dimension = 0"}}), "6:13", {"dimension", "0"}},
      {wedge({{6, "dimension = 1.5"}}), "6:13", {"dimension", "1.5"}},
      {wedge({{3, "halfspaces = [[1, 0]]"}}), "3:1", {"generators", "halfspaces"}},
      {wedge({{3, "equations = [[1, 0]]"}}), "3:1", {"generators", "equations"}},
      {wedge({{3, "rays = [[1, 0]]"}}), "3:1", {"unknown key", "rays"}},
      {wedge({{2, "generators = [[1, nan], [1, 0]]"}}), "2:19", {"generators[0][1]", "not finite"}},
      {wedge({{2, "generators = [[1, \"1e999\"], [1, 0]]"}}), "2:19", {"generators[0][1]", "too large"}},
      {wedge({{2, "generators = [[1, \"1e-9999\"], [1, 0]]"}}), "2:19", {"generators[0][1]", "too small"}},
      {wedge({{2, "generators = [[1, x], [1, 0]]"}}), "2:19", {}},
      {wedge({{2, "generators = [[]]"}}), "2:15", {"generators[0]", "0 entries"}},
      {wedge({{2, "generators = [1, 2]"}}), "2:15", {"generators[0]", "list"}},
      {wedge({{2, "generators = 1"}}), "2:14", {"generators", "list"}},
      {wedge({{2, "generators = []"}, {4, ""}}), "1:1", {"dimension"}},
      {wedge({{2, ""}}), "1:1", {"generators", "halfspaces"}},
      {wedge({{6, "[solve]\nmethod = \"active-set\""}}), "7:10", {"active-set", "cone"}},
      {wedge({{6, "[solve]\ncontact_tolerance = 1e-6"}}), "7:21", {"contact_tolerance"}},
  };
  for (const Wrong& wrong : table) expect_refusal(wrong);
  CHECK(run_on("derive", wedge()).code == 2);
}

TEST_CASE("the readable result names the descriptions, the polar and the face") {
  const std::string text = run_on("solve", wedge()).out;
  for (const char* word : {"pointed", "2 generators", "half-spaces a·x <= 0", "polar", "face of dimension 1",
                           "g[1]", "hold exactly"}) {
    CAPTURE(word);
    CHECK(text.find(word) != std::string::npos);
  }
}
