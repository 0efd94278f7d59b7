#include <cmath>
#include <nlohmann/json.hpp>

#include "mechanics/liquid/first_change.hpp"
#include "tests/cli/program.hpp"

using namespace tests;
using mechanics::liquid::find_first_change, mechanics::liquid::RoundedValue, mechanics::liquid::SignedFamily;
using LineJson = nlohmann::json;

namespace {

std::string liquid(const std::string& names, const std::string& domain, const std::string& pull,
                   const std::string& parts) {
  return "[liquid]\ncoordinates = [" + names + "]\ndomain = \"" + domain + "\"\ndensity = 1\nforce = [" +
         pull + "]\n" + parts + "\n";
}

std::string free_everywhere(const std::string& pressure) {
  return "free = { ends = { where = \"true\", pressure = \"" + pressure + "\" } }";
}

/// Solved, with exit 0.
LineJson solved_line(const std::string& text, std::vector<std::string> options) {
  const Folder folder;
  std::vector<std::string> arguments{"solve", "--json", folder.write("liquid.toml", text)};
  arguments.insert(arguments.end(), options.begin(), options.end());
  const Outcome outcome = run(arguments);
  CAPTURE(text);
  CAPTURE(outcome.err);
  REQUIRE(outcome.code == 0);
  return LineJson::parse(outcome.out);
}

}  // namespace

TEST_CASE("a node upon the kink of a force takes one of its slopes: on a line, a plane and a disc") {
  // p'' = F' = sign(x - c)/2 and p = 1 at 0 and 1; c is hit to the bit by the middle of the line.
  for (const double c : {0.5, 0.4118, 0.25}) {
    const auto bend = [&](double x) { return 0.25 * (x - c) * std::abs(x - c); };
    const LineJson found =
        solved_line(liquid("\"x\"", "interval(low=0, high=1)", "\"abs(x - " + std::to_string(c) + ")/2\"",
                           free_everywhere("1")),
                    {"--probe", "x=0.7"});
    const double p = 1 + bend(0.7) - 0.3 * bend(0) - 0.7 * bend(1);
    CHECK(std::abs(found["probes"][0]["p"].get<double>() - p) <= 1e-13);
  }
  // Δp = ∂|x|/∂x has the solution 2 + x|x|/2.
  for (const std::string domain : {"box(low=[-1, -1], high=[1, 1])", "disc(center=[0, 0], radius=1)"}) {
    const LineJson found =
        solved_line(liquid("\"x\", \"y\"", domain, "\"abs(x)\", \"0\"", free_everywhere("2 + x*abs(x)/2")),
                    {"--probe", "x=0.5, y=0.3", "--probe", "x=0, y=-0.2"});
    CHECK(std::abs(found["probes"][0]["p"].get<double>() - 2.125) <= 1e-4);
    CHECK(std::abs(found["probes"][1]["p"].get<double>() - 2) <= 1e-4);
  }
}

TEST_CASE(
    "where h is not bounded but its integral is, as by √x at 0 or asin at 1, lines are solved and proved") {
  // p'' = F' and p = 1/100 at the ends: p = 2/3 x^(3/2) + a + b x, and 0 from l = 0.03^(2/3) on, up to the s
  // with √s - s^(3/2)/3 = 0.6566667.
  const std::string root = liquid("\"x\"", "interval(low=0, high=1)", "\"sqrt(x)\"", free_everywhere("0.01"));
  for (const bool is_proved : {false, true}) {
    std::vector<std::string> options{"--probe", "x=0", "--probe", "x=0.05"};
    if (is_proved) options.emplace_back("--certify");
    const LineJson found = solved_line(root, options);
    const double bound = found["certificate"]["error_bound"].get<double>(), edge = std::pow(0.03, 2 / 3.0);
    CHECK(found["certificate"]["level"] == (is_proved ? "enclosure" : "estimate"));
    CHECK(bound <= 1e-6);
    CHECK(std::abs(found["cavity"]["extent"]["x"][0].get<double>() - edge) <= 1e-9);
    CHECK(found["probes"][0]["p"].get<double>() == doctest::Approx(0.01).epsilon(1e-12));
    const double p = 0.01 + 2 / 3.0 * std::pow(0.05, 1.5) - std::sqrt(edge) * 0.05;
    CHECK(std::abs(found["probes"][1]["p"].get<double>() - p) <= bound);
  }
  // ∫ asin = x asin x + √(1 - x²).
  const auto bend = [](double x) { return x * std::asin(x) + std::sqrt(1 - x * x); };
  const LineJson arc =
      solved_line(liquid("\"x\"", "interval(low=-1, high=1)", "\"asin(x)\"", free_everywhere("3")),
                  {"--certify", "--probe", "x=0.3"});
  CHECK(arc["certificate"]["level"] == "enclosure");
  CHECK(arc["certificate"]["error_bound"].get<double>() <= 1e-6);
  CHECK(std::abs(arc["probes"][0]["p"].get<double>() - (3 + bend(0.3) - bend(1))) <=
        arc["certificate"]["error_bound"].get<double>());
}

TEST_CASE("a wall that is as fast as the liquid beside a cavity is not parted from") {
  const LineJson line = solved_line(liquid("\"x\"", "interval(low=0, high=1)", "\"x - 1\"",
                                           "walls = { l = { where = \"x <= 0\", acceleration = 1 }, r = { "
                                           "where = \"true\", acceleration = 0 } }"),
                                    {});
  CHECK(line["cavity"]["fraction"] == 1);
  CHECK(line["parted_walls"].empty());
  const std::string turning =
      "velocity = [\"-2*y\", \"2*x\"]\nwalls = { rim = { where = \"true\", acceleration = ";
  const auto disc = [&](const std::string& a) {
    return solved_line(
        liquid("\"x\", \"y\"", "disc(center=[0, 0], radius=1)", "\"0\", \"0\"", turning + a + " } }"), {});
  };
  CHECK(disc("0")["parted_walls"].empty());
  CHECK(disc("1e-9")["parted_walls"] == LineJson::parse(R"(["rim"])"));
}

TEST_CASE(
    "a sign that rounding may have made is no change, and a way whose values rounding hides has ended") {
  int asked = 0;
  const auto sign = [&](double w) {
    ++asked;
    return w < -50 ? -1 - w * w : 1;
  };
  SignedFamily family;
  family.value = [&](double w) { return RoundedValue{sign(w)}; };
  CHECK(find_first_change(family, -1).between.has_value());
  const int without = asked;
  family.value = [&](double w) { return RoundedValue{sign(w), w < -50 ? 2 * w * w : 1e-15}; };
  asked = 0;
  CHECK_FALSE(find_first_change(family, -1).between.has_value());
  CHECK(asked < 4 * without);
  // Of the same sign too: two such values in a row end it, and one does not.
  const auto hidden = [&](double w) { return RoundedValue{1, w > 7 && w < 7.5 ? 2 : w > 100 ? 1e3 : 1e-15}; };
  family.value = [&](double w) {
    ++asked;
    return hidden(w);
  };
  asked = 0;
  CHECK_FALSE(find_first_change(family, 1).between.has_value());
  CHECK(asked < 3 * without);
  family.value = [&](double w) { return w > 50 ? RoundedValue{-1} : hidden(w); };
  CHECK(find_first_change(family, 1).between.has_value());
  // A value that is 0 to rounding, beside values that are not, ends nothing.
  family.value = [](double w) { return RoundedValue{2 - w, 1e-15}; };
  const auto found = find_first_change(family, 1).between;
  REQUIRE(found);
  CHECK(found->first <= 2);
  CHECK(found->second >= 2);
}

TEST_CASE("a dip below 0 between values that grow by a quarter is found by the way they bend") {
  SignedFamily family;
  family.value = [](double w) { return RoundedValue{(w - 7) * (w - 7) - 1e-6}; };
  const auto found = find_first_change(family, 1).between;
  REQUIRE(found);
  CHECK(std::abs(found->second - 7) <= 1e-3);
}

TEST_CASE("a hole between the nodes of a grid is refused with its place, and one that they see is solved") {
  const Folder folder;
  const auto holed = [&](const std::string& radius) {
    return run(
        {"solve", folder.write("holed.toml",
                               liquid("\"x\", \"y\"",
                                      "{x^2 + y^2 <= 1, (x - 0.31)^2 + (y - 0.23)^2 >= " + radius + "^2}",
                                      "\"x\", \"y\"", free_everywhere("1") + "\ncells = 64"))});
  };
  const Outcome missed = holed("0.0005");
  CHECK(missed.code == 2);
  CHECK(missed.err.find("a hole or a gap at (x = 0.3") != std::string::npos);
  CHECK(holed("0.2").code != 2);
}
