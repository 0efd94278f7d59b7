#include <doctest/doctest.h>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>
#include <sstream>

#include "cli/drawing/failure_map_drawing.hpp"
#include "cli/drawing/gnuplot.hpp"
#include "cli/measurement/stress_families.hpp"
#include "tests/cli/program.hpp"
#include "tests/cli/svg_text.hpp"

using namespace tests;
using Json = nlohmann::ordered_json;
namespace fs = std::filesystem;

namespace {

std::string picture_bytes(const std::string& path) {
  std::stringstream bytes;
  bytes << std::ifstream(path, std::ios::binary).rdbuf();
  return bytes.str();
}

/// The problems of the library that are scenes with at least two coordinates and an answer.
std::vector<std::string> drawn_problems() {
  std::vector<std::string> files;
  for (const auto& entry : fs::directory_iterator(fs::path(MOREAU_SOURCE) / "docs/problems")) {
    if (entry.path().extension() != ".toml") continue;
    const Outcome outcome = run({"solve", "--json", entry.path()});
    if (outcome.code == 1 || !Json::accept(outcome.out)) continue;
    const Json answer = Json::parse(outcome.out);
    if (answer.contains("acceleration") && answer["acceleration"].size() >= 2) files.push_back(entry.path());
  }
  std::sort(files.begin(), files.end());
  return files;
}

/// How often a name stands on its own in the texts, or in the line of those that are outside.
std::size_t times_named(const std::vector<SvgText>& texts, const std::string& name) {
  std::size_t count = 0;
  for (const SvgText& text : texts) {
    if (text.text == name) ++count;
    const std::size_t at = text.text.find("outside of the picture: ");
    if (at != std::string::npos && text.text.find(name, at) != std::string::npos) ++count;
  }
  return count;
}

/// The measurements that are kept with the page on failures.
std::vector<cli::StressTrial> kept_trials() {
  std::ifstream file(fs::path(MOREAU_SOURCE) / "docs/charts/failures.csv");
  const std::vector<cli::StressFamily> families = cli::stress_families(20, false);
  std::vector<cli::StressTrial> trials;
  std::string line;
  std::getline(file, line);
  while (std::getline(file, line)) {
    std::vector<std::string> fields;
    std::istringstream stream(line + ",");
    for (std::string field; std::getline(stream, field, ',');) fields.push_back(field);
    cli::StressTrial t;
    t.family = fields[0];
    for (const cli::StressFamily& family : families)
      if (family.name == t.family) t.knob = family.knob;
    t.difficulty = std::stod(fields[1]);
    t.trial.method = fields[4];
    t.trial.judgement.error = fields[6].empty() ? cli::unknown : std::stod(fields[6]);
    t.trial.judgement.verdict = fields[7] == "ok"        ? cli::Verdict::ok
                                : fields[7] == "gave-up" ? cli::Verdict::gave_up
                                : fields[7] == "refused" ? cli::Verdict::refused
                                : fields[7] == "wrong"   ? cli::Verdict::wrong
                                                         : cli::Verdict::too_slow;
    trials.push_back(std::move(t));
  }
  return trials;
}

}  // namespace

TEST_CASE(
    "in the picture of each scene no two labels overlap, no text leaves the page, and every contact is named "
    "once") {
  if (!cli::has_gnuplot()) return;
  const Folder folder;
  for (const std::string& file : drawn_problems()) {
    CAPTURE(file);
    const std::string picture = folder.path("a.svg");
    const Outcome outcome = run({"solve", "--json", file, "--plot", picture});
    REQUIRE(outcome.err.find("moreau: " + file) == std::string::npos);
    const std::string svg = picture_bytes(picture);
    check_legible(svg);
    const std::vector<SvgText> texts = svg_texts(svg);
    const Json answer = Json::parse(outcome.out);
    if (answer["acceleration"].size() != 2) continue;  // a plane has those contacts that act in it
    for (const auto& [name, about] : answer["constraints"].items()) {
      CAPTURE(name);
      const bool in_contact = about["state"] != "inactive";
      CHECK(times_named(texts, name) == (in_contact ? 1 : 0));
    }
  }
}

TEST_CASE("a plane of two coordinates is drawn of more, and both are named") {
  if (!cli::has_gnuplot()) return;
  const Folder folder;
  const std::string picture = folder.path("a.svg"),
                    file = fs::path(MOREAU_SOURCE) / "docs/problems/ladder_leaves_wall.toml";
  CHECK(run({"solve", "--quiet", file, "--plot", picture, "--plane", "x,a"}).code == 0);
  const std::vector<SvgText> texts = svg_texts(picture_bytes(picture));
  CHECK(std::any_of(texts.begin(), texts.end(),
                    [](const SvgText& t) { return t.text == "acceleration of x"; }));
  CHECK(std::any_of(texts.begin(), texts.end(),
                    [](const SvgText& t) { return t.text == "acceleration of a"; }));
}

TEST_CASE("a scene with [draw] is drawn with the force of each contact on it, beside the decomposition") {
  if (!cli::has_gnuplot()) return;
  const Folder folder;
  const std::string scene = point_on_floor({{14,
                                             "[draw]\npoints = { ball = [\"x\", \"y\"] }\nsegments = { "
                                             "ground = [[\"-1\", \"0\"], [\"1\", \"0\"]] }"}});
  const std::string picture = folder.path("a.svg");
  CHECK(run({"solve", "--quiet", folder.write("a.toml", scene), "--plot", picture}).code == 0);
  const std::string svg = picture_bytes(picture);
  check_legible(svg);
  const std::vector<SvgText> texts = svg_texts(svg);
  CHECK(times_named(texts, "floor 19.62") == 1);  // the arrow, m g
  CHECK(times_named(texts, "floor") == 1);        // its line in the plane of accelerations
}

TEST_CASE("a picture is written as PDF and as PNG too") {
  if (!cli::has_gnuplot()) return;
  const Folder folder;
  const std::string file = folder.write("a.toml", two_rows());
  for (const auto& [name, begin] :
       {std::pair<const char*, const char*>{"a.pdf", "%PDF"}, {"a.png", "\x89PNG"}}) {
    CHECK(run({"solve", "--quiet", file, "--plot", folder.path(name)}).code == 0);
    CHECK(picture_bytes(folder.path(name)).starts_with(begin));
  }
}

TEST_CASE("the map of failures has a digit or a mark in each cell, and its words stand apart") {
  if (!cli::has_gnuplot()) return;
  const Folder folder;
  const std::vector<cli::StressTrial> trials = kept_trials();
  REQUIRE(trials.size() > 1000);
  const std::string picture = folder.path("map.svg");
  cli::draw(picture, cli::failure_map_drawing(trials));
  const std::string svg = picture_bytes(picture);
  check_legible(svg);
  const std::vector<SvgText> texts = svg_texts(svg);
  const auto digits = std::count_if(texts.begin(), texts.end(), [](const SvgText& t) {
    return t.text == "=" || t.text.find_first_not_of("0123456789") == std::string::npos;
  });
  const auto right = std::count_if(trials.begin(), trials.end(),
                                   [](const cli::StressTrial& t) { return t.trial.is_right(); });
  CHECK(digits >= right);
}

TEST_CASE("in the chart that is kept no two words overlap, and none leaves the page") {
  check_legible(picture_bytes(fs::path(MOREAU_SOURCE) / "docs/charts/speed_accuracy.svg"));
}
