#include <doctest/doctest.h>

#include <algorithm>
#include <fstream>
#include <iterator>
#include <nlohmann/json.hpp>
#include <set>
#include <sstream>

#include "convex/catalogue/catalogue.hpp"
#include "convex/catalogue/references.hpp"
#include "tests/cli/program.hpp"
#include "tests/this_build.hpp"

using namespace tests;
using Json = nlohmann::ordered_json;

namespace {

struct WrongArguments {
  std::vector<std::string> arguments;
  std::string beginning;  ///< of the message
  std::vector<std::string> words;
};

}  // namespace

TEST_CASE("the domain of a conjugate of pieces lies between the slopes at both ends") {
  const std::vector<std::pair<std::string, std::string>> domains = {
      {"huber(0.5)", "box(-1, 1)"},
      {"hinge()", "box(-1, 0)"},
      {"squared_hinge()", "box(-inf, 0)"},
      {"separable(huber(1), 1, norm1(), 2)", "box(-1, 1) for entry 1, ball_inf(radius=1) for entries 2 to 3"},
      {"max_affine([[1,0],[0,1]], [0,1])", "the convex hull of the rows of A"}};
  for (const auto& [f, domain] : domains) {
    CAPTURE(f);
    CHECK(Json::parse(run({"conjugate", f, "--json"}).out)["domain"] == domain);
  }
}

TEST_CASE("outside the sum of two domains a conjugate is infinite, also where a program has no scale there") {
  // Slopes of |x| + |x| smoothed lie in [-2, 2]; in the metric 4 those of y in [-1/2, 1/2].
  for (const auto& [at, value] :
       {std::pair("[-1]", Json("inf")), {"[0.125]", Json(0)}, {"[0.6]", Json("inf")}}) {
    const Outcome outcome =
        run({"conjugate", "sum(envelope(norm1(),1),norm1())", "--metric", "[[4]]", "--at", at, "--json"});
    CAPTURE(at);
    CHECK(outcome.code == 0);
    CHECK(Json::parse(outcome.out)["value"] == value);
  }
}

TEST_CASE("the conjugate prints as an expression that reads back, with its domain and its value") {
  const Json norm = Json::parse(run({"conjugate", "norm2(weight=2)", "--json"}).out);
  CHECK(norm["g"] == "indicator(ball2(radius=2))");
  CHECK(norm["domain"] == "ball2(radius=2)");
  CHECK_FALSE(norm.contains("value"));
  const Json ball = Json::parse(run({"conjugate", norm["g"], "--at", "[3, 4]", "--json"}).out);
  CHECK(ball["g"] == "norm2(weight=2)");
  CHECK(ball["domain"] == "everywhere");
  CHECK(ball["value"] == 10);
  CHECK(Json::parse(run({"conjugate", "norm2(weight=2)", "--at", "[3, 4]", "--json"}).out)["value"] == "inf");
  const std::string text = run({"conjugate", "norm2(weight=2)", "--at", "[3, 4]"}).out;
  for (const char* words :
       {"g = indicator(ball2(radius=2))", "domain of g: ball2(radius=2)", "g([3, 4]) = inf"})
    CHECK(text.find(words) != std::string::npos);
}

TEST_CASE("the value of a conjugate is printed with its error, a domain in the variable of the conjugate") {
  CHECK(run({"conjugate", "ball2(2)", "--at", "[1, 0.5]"})
            .out.find("g([1, 0.5]) = 2.23607, error at most 9.9e-16") != std::string::npos);
  CHECK(run({"conjugate", "norm1()", "--at", "[3]"}).out.find("g([3]) = inf\n") != std::string::npos);
  CHECK(run({"conjugate", "precompose(norm2(), [[2, 1], [1, 1]])"})
            .out.find("]]y + [0,0] in (ball2(radius=1))") != std::string::npos);
}

TEST_CASE("what is 0 is printed as 0") {
  const std::string split = run({"prox", "norm1()", "--at", "[1]"}).out;
  CHECK(split.find("f(x) + g(y) - (x|y) = 0\n") != std::string::npos);
  CHECK(split.find("Their sum misses z by 0.\n") != std::string::npos);
}

TEST_CASE("a point beyond the edge of a conjugate's domain is told with the digits that put it there") {
  CHECK(run({"conjugate", "norm2()", "--at", "[1.0000001, 0]"}).out.find("g([1.0000001, 0]) = inf\n") !=
        std::string::npos);
}

TEST_CASE("a conjugate needs no number of entries where the data tell it") {
  const Json answer = Json::parse(run({"conjugate", "quadratic([[2, 0], [0, 4]])", "--json"}).out);
  CHECK(answer["entries"] == 2);
}

TEST_CASE("wrong expressions are told from wrong points and wrong metrics, with a caret under the place") {
  const std::vector<WrongArguments> table{
      {{"prox", "norm3()", "--at", "[1]"}, "f:1:1: ", {"norm3", "did you mean", "\n  norm3()\n  ^\n"}},
      {{"prox", "indicator(ball2(-1))", "--at", "[1]"}, "f:1:17: ", {"\n                  ^\n"}},
      {{"prox", "indicator(ball2)", "--at", "[1]"}, "f:1:11: ", {"ball2()"}},
      {{"prox", "norm2()", "--at", "[1,"}, "--at:1:1: ", {"no ] closes"}},
      {{"prox", "norm2()", "--at", "1"}, "--at:1:1: ", {"vector"}},
      {{"prox", "norm2()", "--at", "[]"}, "--at:1:1: ", {"empty"}},
      {{"prox", "norm2()", "--at", "[[1]]"}, "--at:1:1: ", {"vector"}},
      {{"prox", "norm2()", "--at", "[1, inf]"}, "--at:1:5: ", {"finite"}},
      {{"prox", "norm2()", "--at", "[1, 2]", "--metric", "[1, 2]"}, "--metric:1:1: ", {"diagonal"}},
      {{"prox", "norm2()", "--at", "[1, 2]", "--metric", "diagonal [[1]]"}, "--metric:1:1: ", {"diagonal"}},
      {{"prox", "norm2()", "--at", "[1, 2]", "--metric", "diag [1, 2]"}, "--metric:1:1: ", {"diagonal"}},
      {{"prox", "norm2()", "--at", "[1, 2]", "--metric", "diagonal [1]"}, "--metric:1:1: ", {"1", "2"}},
      {{"prox", "norm2()", "--at", "[1, 2]", "--metric", "[[1, 2], [2, 1]]"},
       "--metric:1:1: ",
       {"metric: not positive"}},
      {{"prox", "norm2()", "--at", "[1]", "--method", "active-set"}, "--method:1:1: ", {"does not apply"}},
      {{"conjugate", "quadratic([[1]])", "--at", "[1, 2]"}, "f:1:1: ", {"quadratic"}},
      {{"conjugate", "quadratic([[-1]])"}, "f:1:11: ", {"quadratic"}},
      {{"conjugate", "norm2(", "--at", "[1, 2]"}, "f:1:1: ", {"no ) closes"}},
      {{"functions", "norm3"}, "norm3:1:1: ", {"norm3", "did you mean"}},
  };
  for (const auto& [arguments, beginning, words] : table) {
    const Outcome outcome = run(arguments);
    CAPTURE(arguments[1]);
    CAPTURE(outcome.err);
    CHECK(outcome.code == 2);
    CHECK(outcome.out.empty());
    CHECK(outcome.err.starts_with("moreau: " + beginning));
    CHECK(outcome.err.find("; ") != std::string::npos);
    for (const std::string& word : words) {
      CAPTURE(word);
      CHECK(outcome.err.find(word) != std::string::npos);
    }
    if (arguments[0] == "functions") continue;
    std::vector<std::string> as_json = arguments;
    as_json.emplace_back("--json");
    CHECK(Json::parse(run(as_json).out).at("status") == "error");
  }
}

TEST_CASE("the functions are listed with the name first, and the same names as JSON") {
  const Json functions = Json::parse(run({"functions", "--json"}).out).at("functions");
  const std::string text = run({"functions"}).out;
  std::size_t at = 0;
  for (const Json& function : functions) {
    const std::string name = function.at("name");
    CHECK(text.compare(at, name.size() + 1, name + " ") == 0);
    at = text.find('\n', at) + 1;
    for (const char* key : {"kind", "arguments", "formula", "facts", "prox", "source", "examples"}) {
      CAPTURE(key);
      CHECK(function.contains(key));
    }
    const Outcome details = run({"functions", name});
    CHECK(details.code == 0);
    CHECK(details.out.starts_with(name + "("));
    CHECK(Json::parse(run({"functions", name, "--json"}).out).at("functions") == Json::array({function}));
  }
  CHECK(at == text.size());
}

TEST_CASE("the page of functions is what the catalogue says today") {
  std::ifstream page(tests::source_folder() + "docs/functions.md");
  const std::string written{std::istreambuf_iterator<char>(page), {}};
  const Outcome made = run({"functions", "--markdown"});
  CHECK(made.code == 0);
  const auto [in_page, in_made] =
      std::mismatch(written.begin(), written.end(), made.out.begin(), made.out.end());
  INFO("made anew with: moreau functions --markdown > docs/functions.md; the first line that differs: ",
       std::string(in_made, std::find(in_made, made.out.end(), '\n')));
  CHECK(in_page == written.end());
  CHECK(in_made == made.out.end());
}

TEST_CASE("every source of the catalogue is in the list of references, and the list has nothing else") {
  std::set<std::string_view> cited;
  for (const convex::CatalogueEntry& entry : convex::catalogue()) {
    CAPTURE(entry.name);
    CHECK_FALSE(entry.source.empty());
    for (const convex::Reference& work : convex::references_of(entry.source)) cited.insert(work.name);
  }
  for (const convex::Reference& work : convex::references()) {
    CAPTURE(work.name);
    CHECK(cited.count(work.name) == 1);
  }
  CHECK(std::ranges::is_sorted(convex::references(), {}, &convex::Reference::name));
  CHECK_THROWS_AS(convex::references_of("Nobody 1900"), convex::InvalidInput);
}

TEST_CASE("a fact that the list tells holds for every example of its entry") {
  const auto facts = [](const std::string& name) {
    return Json::parse(run({"functions", name, "--json"}).out).at("functions").at(0).at("facts");
  };
  CHECK(facts("power") == Json{"separable", "finite"});
  CHECK(facts("epigraph") == Json{"indicator"});
  CHECK(facts("box") == Json{"indicator", "separable", "piecewise linear-quadratic"});
}

TEST_CASE("the prox with a step is that of the multiple, and that of the metric over the step") {
  const auto x = [](const std::vector<std::string>& arguments) {
    return Json::parse(run(arguments).out).at("x").get<std::vector<double>>();
  };
  const std::string z = "[3, -1, 0.2]";
  const auto stepped = x({"prox", "norm1()", "--at", z, "--step", "0.5", "--json"});
  CHECK(stepped == x({"prox", "norm1(0.5)", "--at", z, "--json"}));
  CHECK(stepped == x({"prox", "norm1()", "--at", z, "--metric", "diagonal [2, 2, 2]", "--json"}));
  CHECK(stepped == std::vector<double>{2.5, -0.5, 0});
  CHECK(run({"prox", "norm1()", "--at", z, "--step", "0"}).code == 2);
  // Functions that take the product of the space are those of W, not of W over the step.
  for (const std::string f : {"envelope(norm1(), 1)", "support(ball2(2, [1,0,-1]))", "conjugate(norm2(3))",
                              "tilt(proximal_average(norm1(), zero(), 0.5, 1), [1,2,3])"}) {
    CAPTURE(f);
    const auto multiple = x({"prox", "scale(" + f + ", 2)", "--at", z, "--json"});
    CHECK(x({"prox", f, "--at", z, "--step", "2", "--json"}) == multiple);
  }
}

TEST_CASE("several points of a file are answered line by line, and a wrong one is told by its place") {
  const Folder folder;
  const std::string points = folder.write("points.csv", "# three points\n3, -1\n\n1/2, 0\r\n-4,2e0\n");
  const std::string out = run({"prox", "norm1()", "--at", "@" + points, "--json"}).out;
  std::istringstream lines(out);
  const std::vector<std::pair<int, std::string>> expected{{2, "[2,0]"}, {4, "[0,0]"}, {5, "[-3,1]"}};
  for (const auto& [number, z] : expected) {
    std::string line;
    REQUIRE(std::getline(lines, line));
    const Json split = Json::parse(line);
    CHECK(split.at("line") == number);
    CHECK(split.at("x") == Json::parse(z));
  }
  CHECK(run({"prox", "norm1()", "--at", "@" + points}).out.find("line 4\n") != std::string::npos);
  const std::string wrong = folder.write("wrong.csv", "3, -1\n2, x\n");
  const Outcome refused = run({"prox", "norm1()", "--at", "@" + wrong});
  CHECK(refused.code == 2);
  CHECK(refused.err.find("wrong.csv:2:4: ") != std::string::npos);
  CHECK(run({"prox", "norm1()", "--at", "@" + folder.write("none.csv", "# none\n")})
            .err.find("no point in it") != std::string::npos);
}

TEST_CASE("a conjugate has the numbers of its function, and is told in words where it has no name") {
  const std::vector<std::pair<std::string, std::string>> table{
      {"log_barrier()", "dilate(log_barrier(offset=-1), rho=-1)"},
      {"log_barrier(2)", "dilate(log_barrier(offset=-3), rho=-1)"},
      {"dilate(log_barrier(), -2)", "dilate(log_barrier(offset=-1), rho=0.5)"},
      {"power(3)", "scale(dilate(power(p=1.5), rho=3), alpha=2)"},
      {"inverse_power(3)", "scale(dilate(negative_power(r=0.75), rho=-3), alpha=4)"},
      {"negative_power(0.5)", "scale(dilate(inverse_power(q=1), rho=-0.5), alpha=0.5)"},
      {"pinball(0.75)", "indicator(box(lower=-0.25, upper=0.75))"},
      {"max_affine([[1,2]], [3])", "min -b.l over l >= 0"},
      {"neg_log_det()", "-n - log det(-(Y + Y^T)/2)"},
      {"perspective(exponential())", "h = tilt(entropy(), c=-1)"},
      {"epigraph(norm2())", "-r h(-v/r) for r < 0"}};
  for (const auto& [f, words] : table) {
    CAPTURE(f);
    CHECK(run({"conjugate", f}).out.find(words) != std::string::npos);
  }
  // The expression that is printed is the conjugate: both have one value.
  for (const char* f : {"log_barrier(2)", "power(3)", "inverse_power(3)", "negative_power(0.5)"}) {
    const Json told = Json::parse(run({"conjugate", f, "--at", "[-0.7]", "--json"}).out);
    const Json again = Json::parse(
        run({"conjugate", "conjugate(" + told.at("g").get<std::string>() + ")", "--at", "[-0.7]", "--json"})
            .out);
    CAPTURE(f);
    CHECK(again.at("value").get<double>() == doctest::Approx(told.at("value").get<double>()).epsilon(1e-12));
  }
}

TEST_CASE("a chart of a file follows --set, and without a file there is nothing to set") {
  const Folder folder;
  const std::string file = folder.write("problem.toml", point_on_floor());
  CHECK(run({"chart", "--quick", "--set", "m=3", "--method", "active-set", file}).code == 0);
  CHECK(run({"chart", "--quick", "--set", "mm=3", "--method", "active-set", file}).err.find("mm") !=
        std::string::npos);
  CHECK(run({"chart", "--quick", "--set", "m=3"}).err.find("--set goes with problem files") !=
        std::string::npos);
}
