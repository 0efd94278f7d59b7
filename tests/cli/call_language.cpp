#include <doctest/doctest.h>

#include <cmath>
#include <cstdint>
#include <limits>

#include "cli/function_language/parse_call.hpp"

using namespace cli;
using convex::Call;
using convex::Matrix;
using convex::Vector;

namespace {

constexpr double infinity = std::numeric_limits<double>::infinity();

Call parse(const std::string& text) { return parse_call(text, "f"); }

const Call& nested(const convex::Argument& argument) {
  return *std::get<std::shared_ptr<const Call>>(argument);
}

std::string repeated(const std::string& part, int count) {
  std::string text;
  for (int i = 0; i < count; ++i) text += part;
  return text;
}

struct Refusal {
  std::string text;
  int line, column;
  std::string words;
};

}  // namespace

TEST_CASE("a call has its name, and its arguments in the order of the text, with keys and places") {
  const Call call = parse(" box( [0,-1], upper =\n  [1, inf] )");
  CHECK(call.name == "box");
  CHECK(call.place->column == 2);
  REQUIRE(call.arguments.size() == 2);
  CHECK(call.arguments[0].key.empty());
  CHECK(std::get<Vector>(call.arguments[0].value) == Vector{{0, -1}});
  CHECK(call.arguments[1].key == "upper");
  CHECK(std::get<Vector>(call.arguments[1].value) == Vector{{1, infinity}});
  CHECK(call.arguments[1].place->line == 1);
  CHECK(call.arguments[1].place->column == 15);
}

TEST_CASE("a number is the double nearest to what is written") {
  const std::vector<std::pair<std::string, double>> table{
      {"2", 2.0},
      {"-0.5", -0.5},
      {"+3", 3.0},
      {".5", 0.5},
      {"5.", 5.0},
      {"1e-3", 1e-3},
      {"1E+3", 1000.0},
      {"1/3", 1.0 / 3.0},
      {"-2/6", -1.0 / 3.0},
      {"0.1/0.3", 1.0 / 3.0},
      {"1e-999", 0.0},
      {"inf", infinity},
      {"-inf", -infinity},
      {"+inf", infinity},
      {"123456789012345678901234567890", 123456789012345678901234567890.0}};
  for (const auto& [text, value] : table) {
    CAPTURE(text);
    CHECK(std::get<double>(parse("f(" + text + ")").arguments[0].value) == value);
    CHECK(std::get<double>(parse("f(k = " + text + " )").arguments[0].value) == value);
    CHECK(parse_vector("[" + text + "]", "z") == Vector::Constant(1, value));
  }
}

TEST_CASE("rows are read as the rows of a matrix, and an empty list as a vector") {
  const Call call = parse("affine([[1, 2, 3],\n [4, 5, 6]], b=[ ])");
  CHECK(std::get<Matrix>(call.arguments[0].value) == Matrix{{1, 2, 3}, {4, 5, 6}});
  CHECK(std::get<Vector>(call.arguments[1].value).size() == 0);
}

TEST_CASE("calls stand in calls, by position and by key") {
  const Call call = parse("sum(translate(norm1(), by=[1]), g=indicator(orthant()), 2)");
  REQUIRE(call.arguments.size() == 3);
  CHECK(nested(nested(call.arguments[0].value).arguments[0].value).name == "norm1");
  CHECK(call.arguments[1].key == "g");
  CHECK(nested(nested(call.arguments[1].value).arguments[0].value).name == "orthant");
  CHECK(nested(call.arguments[1].value).place->column == 35);
}

TEST_CASE("a name may begin with inf") {
  CHECK(nested(parse("f(inf_convolution(g(), h()))").arguments[0].value).name == "inf_convolution");
  CHECK(parse("f(infinite=1)").arguments[0].key == "infinite");
}

TEST_CASE("a sum and a multiple between functions are the calls of sum and scale") {
  const std::vector<std::pair<const char*, const char*>> table{
      {"2*norm1()", "scale(norm1(), 2)"},
      {" norm1()*2 ", "scale(norm1(), 2)"},
      {"1/2 * norm1() + norm2()", "sum(scale(norm1(), 1/2), norm2())"},
      {"norm1()+2*norm2()+3*hinge()", "sum(norm1(), scale(norm2(), 2), scale(hinge(), 3))"},
      {"conjugate(norm1() + 2*norm2())", "conjugate(sum(norm1(), scale(norm2(), 2)))"},
      {"envelope(3*norm1() + indicator(orthant()), gamma=2)",
       "envelope(sum(scale(norm1(), 3), indicator(orthant())), gamma=2)"},
      {"inf_convolution(f=2*norm1(), g=norm2() + norm1())",
       "inf_convolution(f=scale(norm1(), 2), g=sum(norm2(), norm1()))"},
  };
  for (const auto& [written, meant] : table) {
    CAPTURE(written);
    CHECK(convex::to_text(parse(written)) == convex::to_text(parse(meant)));
  }
}

TEST_CASE("what is no call is refused where it goes wrong, with what to do") {
  const std::vector<Refusal> table{
      {"", 1, 1, "name(arguments)"},
      {"   ", 1, 4, "name(arguments)"},
      {"norm1", 1, 1, "norm1()"},
      {"indicator(orthant)", 1, 11, "orthant()"},
      {"2", 1, 1, "constant(2)"},
      {"2*3", 1, 3, "name"},
      {"norm1()*norm2()", 1, 1, "product"},
      {"norm1() - norm2()", 1, 9, "difference"},
      {"norm1() +", 1, 10, "name"},
      {"norm1()/2", 1, 8, "1/2*norm1()"},
      {"norm1())", 1, 8, "behind the end"},
      {"norm1(", 1, 1, "no ) closes norm1("},
      {"sum(norm1(), norm2()", 1, 1, "no ) closes sum("},
      {"sum(norm1(2, norm2())", 1, 1, "no ) closes sum("},
      {"norm1(weight=)", 1, 14, "argument"},
      {"norm1(weight==2)", 1, 14, "\"=\" where an argument"},
      {"norm1(,)", 1, 7, "argument"},
      {"norm1(1,)", 1, 9, "argument"},
      {"norm1(1 2)", 1, 9, "commas"},
      {"norm1(1;2)", 1, 8, "commas"},
      {"norm1('a')", 1, 7, "argument"},
      {"norm1(2x)", 1, 8, "right behind a number"},
      {"norm1(-)", 1, 7, "where an argument should be"},
      {"norm1(1/0)", 1, 7, "denominator"},
      {"norm1(1e999)", 1, 7, "too large"},
      {"norm1(nan)", 1, 7, "no number"},
      {"norm1(Infinity)", 1, 7, "inf or -inf"},
      {"linear([1, 2)", 1, 13, "in a list"},
      {"linear([1, 2", 1, 8, "no ] closes"},
      {"linear([1,", 1, 8, "no ] closes"},
      {"linear([1,,2])", 1, 11, "where a number should be"},
      {"linear([1, f()])", 1, 12, "where a number should be"},
      {"linear([1, [2]])", 1, 12, "where a number should be"},
      {"affine([[1, 2],\n [3]], [1, 2])", 2, 2, "row 2 has length 1, the first 2"},
      {"affine([[1, 2], 3], [1, 2])", 1, 17, "where a row should be"},
      {"affine([[[1]]], [1, 2])", 1, 10, "where a number should be"},
      {"linear([\u00e9, 1])", 1, 9, "\u00e9"},
      {"\u00e9t\u00e9()", 1, 1, "\u00e9"},
      {"f(\u03bb=1)", 1, 3, "\u03bb"},
  };
  for (const Refusal& refusal : table) {
    CAPTURE(refusal.text);
    try {
      parse(refusal.text);
      FAIL("not refused");
    } catch (const convex::InvalidInput& error) {
      const std::string message = error.what();
      CAPTURE(message);
      CHECK(message.starts_with("f: "));
      CHECK(message.find("; ") != std::string::npos);
      CHECK(message.find(refusal.words) != std::string::npos);
      REQUIRE(error.place().has_value());
      CHECK(error.place()->line == refusal.line);
      CHECK(error.place()->column == refusal.column);
    }
  }
}

TEST_CASE("places count from where the text begins in its file") {
  try {
    parse_call("norm1(\n  oops)", "f", {7, 6});
    FAIL("not refused");
  } catch (const convex::InvalidInput& error) {
    CHECK(error.place()->line == 8);
    CHECK(error.place()->column == 3);
  }
  CHECK(parse_call("f(g())", "f", {7, 6}).arguments[0].place->column == 8);
}

TEST_CASE("calls may be 256 deep and no deeper, and no depth overflows the stack") {
  CHECK_NOTHROW(parse(repeated("f(", deepest_call) + repeated(")", deepest_call)));
  for (const std::string& text :
       {repeated("f(", deepest_call + 1) + repeated(")", deepest_call + 1), repeated("f(", 1000000),
        "f(" + repeated("[", 1000000), repeated("f(a=", 1000000), "f(" + repeated("-", 1000000)})
    CHECK_THROWS_AS(parse(text), convex::InvalidInput);
}

TEST_CASE("whatever the bytes, reading ends in a call or in a refusal with a place in the text") {
  const std::string alphabet = "fg_19.,,==()()[][]+-e/ \n\t\"'#inf\xc3\xa9\x80";
  std::uint32_t state = 1966;
  const auto below = [&](std::size_t bound) {
    state = state * 1664525U + 1013904223U;
    return static_cast<std::size_t>(state >> 8U) % bound;
  };
  const std::string seed = "sum(f(g([1, -2.5e3], b=[[1, inf], [1/3, 4]])), a=translate(h(), by=[]), 3)";
  int calls = 0;
  for (int run = 0; run < 20000; ++run) {
    std::string text = run % 2 == 0 ? seed : std::string();
    for (std::size_t k = 0; k <= below(6); ++k) {
      const std::size_t at = below(text.size() + 1);
      if (run % 2 == 0 && below(2) == 0) text.erase(at, below(4));
      text.insert(std::min(at, text.size()), 1, alphabet[below(alphabet.size())]);
    }
    if (run % 100 == 1)
      for (char& c : text) c = static_cast<char>(below(256));
    if (run % 7 == 3) text += '\0';
    try {
      parse(text);
      ++calls;
    } catch (const convex::InvalidInput& error) {
      REQUIRE(error.place().has_value());
      CHECK(error.place()->column <= static_cast<int>(text.size()) + 1);
    }
  }
  CHECK(calls > 100);
}
