#include <doctest/doctest.h>

#include <nlohmann/json.hpp>

#include "tests/cli/program.hpp"

using namespace tests;
using Json = nlohmann::ordered_json;

TEST_CASE("the prox of |x| is told by its three cases, in fractions") {
  const Json answer =
      Json::parse(run({"prox", "norm1(1/3)", "--symbolic", "--json"}).out).at("symbolic").at("prox");
  REQUIRE(answer.size() == 3);
  CHECK(answer[0].at("low").is_null());
  CHECK(answer[0].at("high") == "-1/3");
  CHECK(answer[0].at("formula") == "z + 1/3");
  CHECK(answer[1].at("formula") == "0");
  CHECK(answer[2].at("formula") == "z - 1/3");
}

TEST_CASE("the metric's weight enters prox and conjugate as the product has it") {
  CHECK(run({"prox", "norm1()", "--symbolic", "--metric", "[[2]]"}).out.find("z - 1/2") != std::string::npos);
  // g(y) = sup 2xy - x²/2 = 2y².
  CHECK(run({"conjugate", "squared_norm2()", "--symbolic", "--metric", "[[2]]"}).out.find("2*y^2") !=
        std::string::npos);
}

TEST_CASE("with a step the prox is that of so many times f, and is named so") {
  const Json answer = Json::parse(run({"prox", "norm1(1/3)", "--symbolic", "--step", "6", "--json"}).out);
  CHECK(answer.at("step") == "6");
  CHECK(answer.at("symbolic").at("f").back().at("formula") == "x/3");  // f itself is told as it is
  CHECK(answer.at("symbolic").at("prox")[2].at("formula") == "z - 2");
  // A tenth is 1/10 here. The envelope of |x| is that of the metric, whatever the step: 0 = x - z + 1/10 x.
  const std::string text = run({"prox", "envelope(norm1(), 1)", "--symbolic", "--step", "0.1"}).out;
  CHECK(text.find("prox_(1/10 f)(z) =") != std::string::npos);
  CHECK(text.find("10*z/11") != std::string::npos);
  CHECK(run({"prox", "norm1()", "--symbolic", "--step", "2", "--latex"}).out.find("prox}_{2 f}(z)") !=
        std::string::npos);
  // In the product 2xy, with step 6: 2(x - z) + 6/3 sign(x) = 0.
  CHECK(run({"prox", "norm1(1/3)", "--symbolic", "--step", "6", "--metric", "[[2]]"}).out.find("z - 1 ") !=
        std::string::npos);
}

TEST_CASE("symbols refuse what only numbers have: a method, a tolerance, a limit, a proof") {
  for (const char* command : {"prox", "conjugate"})
    for (const std::vector<std::string>& option : {std::vector<std::string>{"--method", "exact"},
                                                   {"--tolerance", "1e-3"},
                                                   {"--limit", "2"},
                                                   {"--certify"}}) {
      std::vector<std::string> words{command, "norm1()", "--symbolic"};
      words.insert(words.end(), option.begin(), option.end());
      const Outcome outcome = run(words);
      CAPTURE(command);
      CAPTURE(option.front());
      CHECK(outcome.code == 2);
      CHECK(outcome.out.empty());
      CHECK(outcome.err.find(option.front() + " goes with a point") != std::string::npos);
    }
}

TEST_CASE("of a sum by rules the prox is the root of its equation, without factors that cancel") {
  CHECK(
      run({"prox", "sum(exponential(), entropy())", "--symbolic"}).out.find("u + exp(u) + log(u) + 1 = z") !=
      std::string::npos);
}

TEST_CASE(
    "of a rule and pieces the prox is told piece by piece, by the rule's own solution and the corners") {
  // u + e^u + sign(u) = z, e^0 = 1.
  const Json prox = Json::parse(run({"prox", "sum(exponential(), norm1())", "--symbolic", "--json"}).out)
                        .at("symbolic")
                        .at("prox");
  REQUIRE(prox.size() == 3);
  CHECK(prox[0].at("formula") == "z - W(exp(z + 1)) + 1");
  CHECK(prox[0].at("high") == "0");
  CHECK(prox[1].at("formula") == "0");
  CHECK(prox[1].at("high") == "2");
  CHECK(prox[2].at("formula") == "z - W(exp(z - 1)) - 1");
  // (log x)' = 1/2 at the end 2 of the interval: z stays at 2 from 2 - 1/2 on.
  const std::string barrier = run({"prox", "sum(log_barrier(), indicator(box(0, 2)))", "--symbolic"}).out;
  CHECK(barrier.find("z >= 3/2") != std::string::npos);
  // Where the slope at a corner is no fraction, its formula is the end of a case.
  CHECK(run({"prox", "sum(entropy(), translate(norm1(), [2]))", "--symbolic", "--latex"}).out.find("\\log") !=
        std::string::npos);
}

TEST_CASE("in LaTeX cases stand in their environment, with where the function is infinite") {
  const std::string text = run({"conjugate", "logistic()", "--symbolic", "--latex"}).out;
  CHECK(text.find("\\begin{cases}") != std::string::npos);
  CHECK(text.find("+\\infty & \\text{otherwise}") != std::string::npos);
}

TEST_CASE(
    "symbols refuse a point, several variables and what has no rule, and prox without them wants a point") {
  CHECK(run({"prox", "norm1()", "--symbolic", "--at", "[1]"}).code == 2);
  CHECK(run({"prox", "norm1()", "--symbolic", "--metric", "[[2, 1], [1, 2]]"}).code == 2);
  CHECK(run({"prox", "box([0, 0], [1, 1])", "--symbolic"}).code == 2);
  const Outcome bent = run({"prox", "sum(envelope(exponential(), 1), norm1())", "--symbolic"});
  CHECK(bent.code == 2);
  CHECK(bent.err.find("derivative") != std::string::npos);
  CHECK(run({"prox", "norm1()"}).code == 2);
  CHECK(run({"prox", "norm1()", "--latex", "--at", "[1]"}).code == 2);
}
