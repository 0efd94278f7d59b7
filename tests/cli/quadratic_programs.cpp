#include <doctest/doctest.h>

#include <cmath>
#include <cstdio>
#include <fstream>
#include <iterator>
#include <nlohmann/json.hpp>

#include "tests/cli/program.hpp"

using namespace tests;
using Json = nlohmann::ordered_json;

namespace {

/// A strictly convex program in QPS with its minimiser, which multipliers of the right signs prove: the rows
/// of the kinds G, L and E, ranges, bounds, free and negative variables; all numbers are dyadic, so that they
/// are exact.
struct Planted {
  std::string qps;
  std::vector<double> x;
};

std::string number(double value) {
  char digits[40];
  std::snprintf(digits, sizeof digits, "%.17g", value);
  return digits;
}

Planted planted(int k) {
  const int n = 4 + 3 * k, m = n / 2 + k % 3;
  const auto Q = [&](int i, int j) { return i == j ? 4.0 + (i * k) % 5 : std::abs(i - j) == 1 ? -1.0 : 0.0; };
  const auto G = [&](int a, int i) {
    const int first = a % n, second = (a + 1 + k) % n;
    return (i == first ? 1.0 : 0.0) + (i == second ? 0.5 : 0.0);
  };
  Planted made{"", std::vector<double>(static_cast<std::size_t>(n))};
  for (int i = 0; i < n; ++i) made.x[static_cast<std::size_t>(i)] = ((7 * i + k) % 11 - 5) / 4.0;
  const auto x = [&](int i) { return made.x[static_cast<std::size_t>(i)]; };
  std::vector<double> gradient(
      static_cast<std::size_t>(n));  // of ½ x·Qx + c·x: what the rows and bounds give
  std::string rows, right, ranges, bounds;
  for (int a = 0; a < m; ++a) {
    double Gx = 0;
    for (int i = 0; i < n; ++i) Gx += G(a, i) * x(i);
    const char kind = "GLEG"[a % 4];
    const bool is_active = kind == 'E' || a % 3 == 0;
    const double lambda = is_active ? (kind == 'L' ? -1.0 : 1.0) * (1 + a % 3) : 0;
    const double slack = is_active ? 0 : kind == 'L' ? 1 : -1;
    const std::string name = "r" + std::to_string(a);
    rows += std::string(" ") + kind + " " + name + "\n";
    right += " rhs " + name + " " + number(Gx + slack) + "\n";
    if (kind == 'G' && a % 4 == 3) ranges += " rng " + name + " " + number(2.5 - slack) + "\n";
    for (int i = 0; i < n; ++i) gradient[static_cast<std::size_t>(i)] += lambda * G(a, i);
  }
  for (int i = 0; i < n; ++i) {
    const std::string name = " bnd x" + std::to_string(i);
    if (i % 4 == 0) {  // held at its upper bound
      bounds += " MI" + name + "\n UP" + name + " " + number(x(i)) + "\n";
      gradient[static_cast<std::size_t>(i)] -= 0.75;
    } else if (i % 4 == 1) {
      bounds += " LO" + name + " " + number(x(i)) + "\n";
      gradient[static_cast<std::size_t>(i)] += 0.5;
    } else {
      bounds += " FR" + name + "\n";
    }
  }
  std::string columns, squares;
  for (int i = 0; i < n; ++i) {
    double c = gradient[static_cast<std::size_t>(i)];
    for (int j = 0; j < n; ++j) c -= Q(i, j) * x(j);
    const std::string name = " x" + std::to_string(i);
    columns += name + " cost " + number(c) + "\n";
    for (int a = 0; a < m; ++a)
      if (G(a, i) != 0) columns += name + " r" + std::to_string(a) + " " + number(G(a, i)) + "\n";
    for (int j = 0; j <= i; ++j)
      if (Q(i, j) != 0) squares += name + " x" + std::to_string(j) + " " + number(Q(i, j)) + "\n";
  }
  made.qps = "NAME PLANTED\nROWS\n N cost\n" + rows + "COLUMNS\n" + columns + "RHS\n" + right +
             (ranges.empty() ? "" : "RANGES\n" + ranges) + "BOUNDS\n" + bounds + "QUADOBJ\n" + squares +
             "ENDATA\n";
  return made;
}

void expect_minimiser(const std::string& file, const std::vector<double>& x) {
  const Outcome outcome = run({"solve", "--json", file});
  CAPTURE(outcome.err);
  REQUIRE(outcome.code == 0);
  const Json found = Json::parse(outcome.out).at("acceleration");
  REQUIRE(found.size() == x.size());
  std::size_t i = 0;
  for (const auto& [name, value] : found.items()) CHECK(std::abs(double(value) - x[i++]) <= 1e-9);
}

}  // namespace

TEST_CASE(
    "twenty quadratic programs in QPS have the minimisers that were planted, and keep them there and back") {
  const Folder folder;
  for (int k = 1; k <= 20; ++k) {
    CAPTURE(k);
    const Planted program = planted(k);
    const std::string file = folder.write("a.qps", program.qps), toml = folder.path("b.toml"),
                      back = folder.path("c.qps");
    expect_minimiser(file, program.x);
    REQUIRE(run({"convert", file, toml}).code == 0);
    REQUIRE(run({"convert", toml, back}).code == 0);
    expect_minimiser(back, program.x);
  }
}

TEST_CASE("what a form of doubles alone cannot hold is refused with its place, and nothing is rounded") {
  const Folder folder;
  const auto file = [&](const char* s) {
    return folder.write(
        "a.toml", "[projection]\nA = [[1]]\nz = [0]\nU = [[1], [-10]]\ns = [" + std::string(s) + ", -1]\n");
  };
  for (const char* form : {"b.qps", "b.mtx"}) {
    CAPTURE(std::string(form));
    for (const char* s : {"\"1/10\"", "\"0.1\"", "\"10/21\""}) {
      const Outcome refused = run({"convert", file(s), folder.path(form)});
      CHECK(refused.code == 2);
      CHECK(refused.err.find("a.toml:5:") != std::string::npos);
    }
    CHECK(run({"convert", file("\"1/16\""), folder.path(form)}).code == 0);
    expect_minimiser(folder.path(form), {0.0625});
  }
}
