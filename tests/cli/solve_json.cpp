#include <doctest/doctest.h>

#include <nlohmann/json.hpp>

#include "tests/cli/program.hpp"

using namespace tests;
using Json = nlohmann::ordered_json;

namespace {

/// Two contacts and a wall away, written in an order that is no alphabet's.
const std::string corner =
    "[system]\ncoordinates = [\"y\", \"x\", \"a\"]\nkinetic = \"(x'^2 + y'^2 + a'^2)/2\"\n"
    "potential = \"y - x/3 + a/7\"\n[system.constraints]\nwall = \"x <= 1\"\nfloor = \"y >= 0\"\n"
    "stop = \"x + y >= 0\"\nrod = \"a = 0\"\n[state]\nposition = { a = 0, x = 0, y = 0 }\n";

Json solved(const std::string& text) { return Json::parse(run_json_on("solve", text).out); }

std::vector<std::string> keys(const Json& object) {
  std::vector<std::string> names;
  for (const auto& [name, value] : object.items()) names.push_back(name);
  return names;
}

}  // namespace

TEST_CASE("the object of a solved problem has every key of the contract, of the right type") {
  for (const std::string& text : {corner, two_rows()}) {
    const Json object = solved(text);
    for (const char* name : {"file", "kind", "status", "method"}) CHECK(object.at(name).is_string());
    for (const char* name : {"acceleration", "multipliers", "multiplier_ranges", "reaction", "two_sided",
                             "hypothesis", "residuals", "constraints", "certificate"})
      CHECK(object.at(name).is_object());
    CHECK(object.at("active").is_array());
    CHECK(object.at("multipliers_unique").is_boolean());
    CHECK(object.at("gauss").is_number());
    CHECK(object.at("seconds").is_number());
    CHECK(keys(object.at("two_sided")) ==
          std::vector<std::string>{"consistent", "acceleration", "multipliers"});
    CHECK(keys(object.at("hypothesis")) == std::vector<std::string>{"accepted", "drop_negative_is_right"});
    CHECK(keys(object.at("residuals")) ==
          std::vector<std::string>{"feasibility", "complementarity", "stationarity", "duality_gap"});
    for (const auto& [name, constraint] : object.at("constraints").items())
      CHECK(keys(constraint) == std::vector<std::string>{"state", "f", "df", "ddf"});
    CHECK(object.at("certificate").at("level") == "estimate");
    CHECK(object.at("certificate").at("error_bound").is_number());
  }
}

TEST_CASE("every object keeps the order of the file") {
  const Json object = solved(corner);
  const std::vector<std::string> coordinates{"y", "x", "a"}, constraints{"wall", "floor", "stop", "rod"},
      contacts{"floor", "stop", "rod"};
  for (const char* name : {"acceleration", "reaction"}) CHECK(keys(object.at(name)) == coordinates);
  for (const char* name : {"multipliers", "multiplier_ranges", "constraints"})
    CHECK(keys(object.at(name)) == constraints);
  CHECK(keys(object.at("two_sided").at("acceleration")) == coordinates);
  CHECK(keys(object.at("two_sided").at("multipliers")) == contacts);
  CHECK(object.at("active") == Json{"floor", "rod"});
}

TEST_CASE("the states and numbers of a point in a corner are those found by hand") {
  const Json object = solved(corner);  // x'' = 1/3, floor carries 1, rod 1/7, stop opens
  CHECK(object.at("status") == "solved");
  CHECK(object.at("acceleration").at("x").get<double>() == doctest::Approx(1.0 / 3));
  CHECK(object.at("multipliers").at("floor").get<double>() == doctest::Approx(1));
  CHECK(object.at("multipliers").at("rod").get<double>() == doctest::Approx(1.0 / 7));
  CHECK(object.at("multipliers").at("wall") == 0);
  CHECK(object.at("constraints").at("wall").at("state") == "inactive");
  CHECK(object.at("constraints").at("stop").at("state") == "opens");
  CHECK(object.at("constraints").at("rod").at("state") == "persists");
  CHECK(object.at("gauss").get<double>() == doctest::Approx(-1.0 / 18));
  CHECK(object.at("two_sided").at("multipliers").at("stop").get<double>() == doctest::Approx(-1.0 / 3));
  CHECK(object.at("hypothesis").at("accepted") == false);
  CHECK(object.at("hypothesis").at("drop_negative_is_right") == true);
}

TEST_CASE("the same input gives the same bytes but for the seconds") {
  const Folder folder;
  const std::string file = folder.write("problem.toml", corner);
  const auto bytes = [&] {
    Json object = Json::parse(run({"solve", "--json", file}).out);
    object["seconds"] = 0;
    return object.dump();
  };
  CHECK(bytes() == bytes());
  for (const char* command : {"solve", "derive"}) CHECK(run({command, file}).out == run({command, file}).out);
  CHECK(run({"derive", "--json", file}).out == run({"derive", "--json", file}).out);
}

TEST_CASE("numbers read back to the double that they came from") {
  for (const std::string digits :
       {"0.1", "0.30000000000000004", "1e-300", "1.7976931348623157e+100", "5e-324", "123456789.125", "1e22",
        "-0.0001", "4.35", "9007199254740993"}) {
    CAPTURE(digits);
    const Json z = Json::parse(run_json_on("derive", two_rows({{3, "z = [0, " + digits + "]"}})).out).at("z");
    CHECK(z.at("q[1]").get<double>() == std::strtod(digits.c_str(), nullptr));
  }
}

TEST_CASE("an infinite range is the word inf, and a multiplier that is not unique has the least norm") {
  const Json twice = solved(two_rows({{4, "U = [[0, 1], [0, 1]]"}}));
  CHECK(twice.at("multipliers_unique") == false);
  CHECK(twice.at("multipliers").at("c[0]").get<double>() == doctest::Approx(4.905));
  CHECK(twice.at("multiplier_ranges").at("c[1]").at(1).get<double>() == doctest::Approx(9.81));
  const Json clamped = solved(two_rows({{4, "U = [[1, 0], [-1, 0]]"}}));
  CHECK(clamped.at("multiplier_ranges").at("c[0]") == Json{0, "inf"});
}

TEST_CASE("a problem without a solution gives weights that prove it") {
  const Json object = solved(two_rows({{4, "U = [[1, 0], [-1, 0]]"}, {5, "s = [1, 2]"}}));
  CHECK(object.at("status") == "infeasible");
  CHECK(keys(object.at("farkas")) == std::vector<std::string>{"c[0]", "c[1]"});
  const double first = object.at("farkas").at("c[0]"), second = object.at("farkas").at("c[1]");
  CHECK(first == doctest::Approx(second));
  CHECK(first > 0);
}

TEST_CASE("a two-sided hypothesis that is inconsistent has empty objects") {
  const Json object = solved(two_rows({{4, "U = [[0, 1], [0, 2]]"}, {5, "s = [0, 1]"}}));
  CHECK(object.at("status") == "solved");
  CHECK(object.at("two_sided").at("consistent") == false);
  CHECK(object.at("two_sided").at("acceleration") == Json::object());
  CHECK(object.at("two_sided").at("multipliers") == Json::object());
  CHECK(object.at("hypothesis").at("accepted") == false);
  CHECK(object.at("hypothesis").at("drop_negative_is_right").is_null());
}

TEST_CASE("an answer that rests on the rows an iteration showed says that it is polished, others do not") {
  CHECK_FALSE(solved(two_rows()).contains("polished"));
  CHECK(solved(two_rows() + "\n[solve]\nmethod = \"proximal-point\"\n").at("polished") == true);
}
