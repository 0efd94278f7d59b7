#include <doctest/doctest.h>

#include <cmath>
#include <fstream>
#include <nlohmann/json.hpp>
#include <sstream>

#include "convex/nearest_point/gallery/gallery.hpp"
#include "tests/cli/program.hpp"

using namespace tests;
using Json = nlohmann::ordered_json;

TEST_CASE("an instance of any family, written as a file, is solved to its known answer") {
  const Folder folder;
  const Json families = Json::parse(run({"gallery", "--json"}).out)["families"];
  CHECK(families.size() == convex::gallery().size());
  for (const Json& entry : families) {
    const std::string name = entry["name"];
    CAPTURE(name);
    const std::string file = folder.path(name + ".toml");
    REQUIRE(run({"gallery", name, "--size", "16", "--seed", "3", "--output", file}).code == 0);
    const Outcome outcome = run({"solve", "--json", file});
    const Json answer = Json::parse(outcome.out);
    const convex::GalleryFamily& family = *convex::find_family(name);
    const convex::GalleryInstance instance = convex::gallery_instance(family, 16, family.usual, 3);
    CHECK(answer["status"] == (instance.feasible ? "solved" : "infeasible"));
    CHECK(outcome.code == (instance.feasible ? 0 : 1));
    if (!instance.feasible) continue;
    const double scale = instance.solution.hi.cwiseAbs().maxCoeff();
    convex::Index i = 0;
    for (const auto& [coordinate, value] : answer["acceleration"].items())
      CHECK(std::abs(value.get<double>() - instance.solution.hi[i++]) <= 1e-11 * scale);
    CHECK(i == instance.solution.size());
  }
}

TEST_CASE("a file of the gallery on standard output is the one that --output writes") {
  const Folder folder;
  const std::string file = folder.path("tall.toml");
  REQUIRE(run({"gallery", "tall", "--output", file}).code == 0);
  std::stringstream written;
  written << std::ifstream(file).rdbuf();
  CHECK(written.str() == run({"gallery", "tall"}).out);
}

TEST_CASE("a family, a setting or a place that does not exist is refused with what there is") {
  for (const auto& [arguments, words] : std::vector<std::pair<std::vector<std::string>, std::string>>{
           {{"gallery", "redundent"}, "did you mean \"redundant\""},
           {{"gallery", "chain"}, "give --output"},
           {{"gallery", "tall", "--difficulty", "-1"}, "give one from 2 to 1000"},
           {{"gallery", "tall", "--size", "0"}, "give a number of coordinates from 4"},
           {{"gallery", "tall", "--output", "no/such/folder/x.toml"}, "cannot write"}}) {
    const Outcome outcome = run(arguments);
    CHECK(outcome.code == 2);
    CHECK(outcome.out.empty());
    CHECK_MESSAGE(outcome.err.find(words) != std::string::npos, outcome.err);
  }
}
