#include <doctest/doctest.h>

#include "convex/catalogue/catalogue.hpp"

using convex::argument;
using convex::Call;
using convex::InvalidInput;
using convex::Matrix;
using convex::Metric;
using convex::Vector;

namespace {

const convex::Space plain{Metric::identity(3)};

std::string message_of(const Call& call) {
  try {
    convex::make_function(call, plain);
  } catch (const InvalidInput& error) {
    return error.what();
  }
  return "";
}

bool contains(const std::string& text, const std::string& part) {
  return text.find(part) != std::string::npos;
}

}  // namespace

TEST_CASE("an argument may be given by position or by name") {
  const Vector x = Eigen::Vector3d(1, 2, 2);
  CHECK(convex::make_function({"norm2", {{"", 2.0, {}}}}, plain)(x) == 6);
  CHECK(convex::make_function({"norm2", {argument("weight", 2.0)}}, plain)(x) == 6);
  CHECK(convex::make_function({"norm2"}, plain)(x) == 3);
}

TEST_CASE("a wrong argument is refused with its name and the nearest known one") {
  CHECK(contains(message_of({"norm2", {argument("wieght", 2.0)}}), "its one argument is \"weight\""));
  CHECK(contains(message_of({"norm3"}), "did you mean \"norm"));
  CHECK(contains(message_of({"norm2", {{"", 1.0, {}}, {"", 1.0, {}}}}), "too many"));
  CHECK(contains(message_of({"norm2", {{"", 1.0, {}}, argument("weight", 1.0)}}), "given twice"));
  CHECK(contains(message_of({"quadratic"}), "Q is missing"));
  CHECK(contains(message_of({"norm2", {argument("weight", Vector(Vector::Ones(3)))}}), "not a number"));
  CHECK(contains(message_of({"indicator", {argument(Call{"norm2"})}}), "a set is wanted"));
  CHECK(contains(message_of({"indicator", {{"", 1.0, {}}}}), "not a set"));
}

TEST_CASE("an error has the place of the argument, or of the call that it is in") {
  Call call{"norm2", {argument("weight", -1.0)}, convex::Place{3, 7}};
  try {
    convex::make_function(call, plain);
    FAIL("a negative weight was taken");
  } catch (const InvalidInput& error) {
    REQUIRE(error.place());
    CHECK(error.place()->column == 7);
    CHECK(contains(error.what(), "norm2(weight)"));
  }
}

TEST_CASE("data of another size than the space are refused") {
  CHECK(contains(message_of({"ball2", {argument("center", Vector(Vector::Ones(2)))}}), "takes 2 entries"));
}

TEST_CASE("a call is printed with the shortest digits that read back") {
  Matrix A(2, 2);
  A << 0.1, 1e22, -1.0 / 3, 5;
  const Call call{"f",
                  {argument(Call{"g", {{"", 2.5, {}}}}), argument("A", A),
                   argument("b", Vector(Eigen::Vector2d(std::numeric_limits<double>::infinity(), -0.0)))}};
  CHECK(convex::to_text(call) == "f(g(2.5), A=[[0.1,1e+22],[-0.3333333333333333,5]], b=[inf,0])");
}
