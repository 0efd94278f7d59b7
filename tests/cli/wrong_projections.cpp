#include "tests/cli/error_form.hpp"

using namespace tests;

namespace {

std::string A(const std::string& value) { return two_rows({{2, "A = " + value}}); }
std::string z(const std::string& value) { return two_rows({{3, "z = " + value}}); }

}  // namespace

TEST_CASE("sizes that do not fit are refused with both sizes") {
  const std::vector<Wrong> table{
      {A("[[2, 0]]"), "2:5", {"1 row", "2"}},
      {A("[[2], [0]]"), "2:6", {"A[0]", "1", "2"}},
      {A("[[2, 0], [0, 1, 3]]"), "2:14", {"A[1]", "3", "2"}},
      {A("{ diagonal = [1, 2, 3] }"), "2:18", {"A.diagonal", "3", "2"}},
      {two_rows({{4, "U = [[0, 1], [1]]"}}), "4:14", {"U[1]", "1", "2"}},
      {two_rows({{5, "s = [0]"}}), "5:5", {"s", "1", "2"}},
      {two_rows({{5, ""}}), "4:5", {"s", "2"}},
      {two_rows({{4, ""}}), "5:5", {"s", "2", "0"}},
      {two_rows({{6, "two_sided = [2]"}}), "6:14", {"two_sided", "2"}},
      {two_rows({{6, "two_sided = [-1]"}}), "6:14", {"two_sided", "-1"}},
      {two_rows({{6, "two_sided = [0.5]"}}), "6:14", {"two_sided", "0.5"}},
      {two_rows({{6, "two_sided = [1, 0, 1]"}}), "6:13", {"two_sided", "1 twice"}},
      {two_rows({{2, ""}}), "1:1", {"A"}},
      {two_rows({{3, ""}}), "1:1", {"z"}},
  };
  for (const Wrong& wrong : table) expect_refusal(wrong);
}

TEST_CASE("an A that is not symmetric is refused with the entries that differ") {
  expect_refusal({A("[[2, 1], [0, 1]]"), "2:5", {"not symmetric", "A[0][1]", "A[1][0]"}});
}

TEST_CASE("an A that is not positive definite is refused") {
  for (const std::string indefinite :
       {"[[1, 2], [2, 1]]", "[[-1, 0], [0, -1]]", "[[0, 0], [0, 0]]", "{ diagonal = [1, 0] }",
        "{ diagonal = [1, -1] }", "[[1, 1], [1, 1]]", "[[2, 2], [2, 2]]", "[[9, 21], [21, 49]]",
        R"([["1/3", "1/3"], ["1/3", "1/3"]])"}) {
    CAPTURE(indefinite);
    expect_refusal({A(indefinite), "2:5", {"not positive definite"}});
  }
}

TEST_CASE("a number that is none, or not finite, is refused where it stands") {
  for (const std::string value :
       {"nan", "inf", "-inf", "true", "\"abc\"", "\"\"", "\".\"", "\"1/0\"", "\"1/2/3\"", "\"1 0\"",
        "\"1_0\"", "\"inf\"", "\"nan\"", "\"0x10\"", "\"1e\"", "\"--1\"", "\"1/\"", "[1]"}) {
    CAPTURE(value);
    expect_refusal({z("[" + value + ", 0]"), "3:6", {"z[0]"}});
  }
}

TEST_CASE("a number too large for a double is called too large") {
  expect_refusal({z("[0, \"1e999\"]"), "3:9", {"z[1]", "too large"}});
  expect_refusal({z("[0, \"1e999999999999\"]"), "3:9", {"z[1]", "too large"}});
}

TEST_CASE("an entry of A too small for a double is called too small, not 0") {
  expect_refusal({A("[[\"1e-1000\", 0], [0, 1]]"), "2:7", {"A[0][0]", "1e-1000", "too small"}});
  expect_refusal({A("{ diagonal = [1, \"1/1e1000\"] }"), "2:22", {"A.diagonal[1]", "too small"}});
}

TEST_CASE("A by two descriptions, or by none, is refused") {
  expect_refusal(
      {A("{ diagonal = [1, 1], matrix_market = \"A.mtx\" }"), "2:5", {"diagonal", "matrix_market"}});
  expect_refusal({A("{ }"), "2:5", {"diagonal", "matrix_market"}});
}
