#include <doctest/doctest.h>

#include <fstream>
#include <iterator>
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

TEST_CASE(
    "a picture of three dimensions shows the plane that is asked for, or that in which p differs, and names "
    "what is not drawn") {
  // Hydrostatic: p = 1 + 10 (1 - z), the same for all x and y.
  const Folder folder;
  const std::string file = folder.write("box.toml",
                                        "[liquid]\ncoordinates = [\"x\", \"y\", \"z\"]\ndomain = "
                                        "\"box(low=[0, 0, 0], high=[2, 3, 1])\"\ndensity = "
                                        "1\nforce = [0, 0, -10]\ncells = 16\nfree = { top = { where = \"z >= "
                                        "1\", pressure = 1 } }\nwalls = { rest = { "
                                        "where = \"true\", acceleration = 0 } }\n");
  const std::string picture = folder.path("p.svg");
  const auto drawn = [&](const std::string& plane) {
    std::vector<std::string> words{"solve", "--plot", picture, file};
    if (!plane.empty()) words.insert(words.end(), {"--plane", plane});
    const Outcome outcome = run(words);
    CHECK(outcome.code == 0);
    std::ifstream stream(picture);
    return std::string(std::istreambuf_iterator<char>(stream), {});
  };
  CHECK(drawn("").find("section y = 1.5") != std::string::npos);
  CHECK(drawn("x,y").find("section z = 0.5") != std::string::npos);
  CHECK(drawn("x,z").find("section y = 1.5") != std::string::npos);
  CHECK(drawn("y,z").find("section x = 1") != std::string::npos);
  const Outcome wrong = run({"solve", "--plot", picture, "--plane", "x,w", file});
  CHECK(wrong.code == 2);
  CHECK(wrong.err.find("--plane x,w: no coordinate \"w\"") != std::string::npos);
}

TEST_CASE(
    "of a liquid in three dimensions a section's arrows are what runs along it, and the heading says so") {
  // u = (y z, 0, 0) crosses the planes of x, and runs along those of y.
  const Folder folder;
  const std::string file =
      folder.write("box.toml",
                   "[liquid]\ncoordinates = [\"x\", \"y\", \"z\"]\ndomain = "
                   "\"box(low=[0, 0, 0], high=[2, 2, 1])\"\ndensity = 1\ncells = 16\n"
                   "velocity = [\"y*z\", \"0\", \"0\"]\nforce = [0, 0, -10]\nfree = { top = "
                   "{ where = \"z >= 1\", pressure = 1 } }\nwalls = { rest = { where = "
                   "\"true\", acceleration = 0 } }\n");
  const std::string picture = folder.path("p.svg");
  const auto drawn = [&](const std::string& plane) {
    CHECK(run({"solve", "--velocity", "--plot", picture, "--plane", plane, file}).code <= 1);
    std::ifstream stream(picture);
    return std::string(std::istreambuf_iterator<char>(stream), {});
  };
  CHECK(drawn("y,z").find("no velocity along the section") != std::string::npos);
  CHECK(drawn("x,z").find("arrows: the velocity along the section, the longest ") != std::string::npos);
}

TEST_CASE("a part of no boundary point is told by its name, and one that takes what is left is not") {
  const Folder folder;
  const auto solved = [&](const std::string& coordinates, const std::string& domain, const std::string& top) {
    return run(
        {"solve", "--json",
         folder.write("tank.toml", "[liquid]\ncoordinates = " + coordinates + "\ndomain = \"" + domain +
                                       "\"\ndensity = 1\ncells = 8\nfree = { top = { where = \"" + top +
                                       "\", pressure = 1 } }\nwalls = { rest = { where = \"true\", "
                                       "acceleration = 0 } }\n")});
  };
  for (const auto& [coordinates, domain] : {std::pair{"[\"x\", \"z\"]", "box(low=[0, 0], high=[1, 1])"},
                                            {"[\"z\"]", "interval(low=0, high=1)"}}) {
    const Outcome wrong = solved(coordinates, domain, "z >= 2"),
                  right = solved(coordinates, domain, "z >= 1"), all = solved(coordinates, domain, "z >= -1");
    const auto json = nlohmann::json::parse(wrong.out);
    REQUIRE(json["warnings"].size() == 1);
    CHECK(json["warnings"][0]["part"] == "top");
    CHECK(wrong.err.find("warning: ") != std::string::npos);
    CHECK(nlohmann::json::parse(right.out)["warnings"].empty());
    CHECK(nlohmann::json::parse(all.out)["warnings"].empty());
    CHECK(all.err.empty());
  }
}
