#include <doctest/doctest.h>

#include <nlohmann/json.hpp>

#include "tests/cli/program.hpp"

using namespace tests;

TEST_CASE(
    "a channel between two boxes that no node sees is refused with its place, and a wider one is solved") {
  // Walls but at the two ends: p is linear along the channel, and nearly constant in both boxes where it is
  // long and narrow.
  const Folder folder;
  const auto boxes = [&](const std::string& low, const std::string& high) {
    return run(
        {"solve", "--json", "--probe", "x=-0.5, y=0", "--probe", "x=0.5, y=0",
         folder.write(
             "boxes.toml",
             "[liquid]\ncoordinates = [\"x\", \"y\"]\ndomain = \"polygon(vertices=[[-1, -0.5], [-0.4, -0.5], "
             "[-0.4, " +
                 low + "], [0.4, " + low + "], [0.4, -0.5], [1, -0.5], [1, 0.5], [0.4, 0.5], [0.4, " + high +
                 "], [-0.4, " + high +
                 "], [-0.4, 0.5], [-1, 0.5]])\"\ndensity = 1\ncells = 128\nfree = { left = { where = \"x "
                 "<= -1\", pressure = 1 }, right = { where = \"x >= 1\", pressure = 3 } }\nwalls = { rest = "
                 "{ "
                 "where = \"true\", acceleration = 0 } }\n")});
  };
  const Outcome missed = boxes("0.1001", "0.1011");
  CHECK(missed.code == 2);
  CHECK(missed.err.find("a hole or a gap at (x = ") != std::string::npos);
  const Outcome seen = boxes("0.08", "0.13");
  const auto json = nlohmann::json::parse(seen.out);
  const double left = json["probes"][0]["p"], right = json["probes"][1]["p"];
  CHECK(left + right == doctest::Approx(4).epsilon(1e-3));
  CHECK(right - left > 1.8);  // 2 less what the boxes and the mouths of the channel take
  CHECK(right - left < 2);
}
