#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>
#include <sstream>

#include "cli/drawing/failure_map_drawing.hpp"
#include "cli/drawing/gnuplot.hpp"
#include "cli/measurement/stress_families.hpp"
#include "cli/report/text_table.hpp"
#include "tests/cli/program.hpp"
#include "tests/cli/svg_text.hpp"
#include "tests/this_build.hpp"

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
  for (const auto& entry : fs::directory_iterator(tests::source_folder() + "docs/problems")) {
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
    for (const char* without_line : {"outside of the picture: ", "not show in this plane: "}) {
      const std::size_t at = text.text.find(without_line);
      if (at == std::string::npos) continue;
      const std::size_t begin = at + std::string(without_line).size();
      if (text.text.substr(begin, text.text.find(';', begin) - begin).find(name) != std::string::npos)
        ++count;
    }
  }
  return count;
}

/// The area of all polygons of that colour, in square pixels.
double area_of(const std::string& colour, const std::string& svg) {
  double area = 0;
  const std::string begin = "<polygon fill = '" + colour + "' points = '";
  for (std::size_t at = 0; (at = svg.find(begin, at)) != std::string::npos;) {
    at += begin.size();
    std::istringstream points(svg.substr(at, svg.find('\'', at) - at));
    std::vector<double> x, y;
    char comma = ',';
    for (double a = 0, b = 0; points >> a >> comma >> b;) x.push_back(a), y.push_back(b);
    double doubled = 0;
    for (std::size_t k = 0; k < x.size(); ++k) {
      const std::size_t next = (k + 1) % x.size();
      doubled += x[k] * y[next] - x[next] * y[k];
    }
    area += std::abs(doubled) / 2;
  }
  return area;
}

/// The measurements that are kept with the page on failures.
std::vector<cli::StressTrial> kept_trials() {
  std::ifstream file(tests::source_folder() + "docs/charts/failures.csv");
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
                    file = tests::source_folder() + "docs/problems/ladder_leaves_wall.toml";
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

TEST_CASE("normal cones are shaded whole: rays not, half-planes and planes up to the frame") {
  if (!cli::has_gnuplot()) return;
  struct Shaded {
    std::string problem;
    double least, most;  // parts of the frame
  };
  const Folder folder;
  for (const Shaded& shaded : {Shaded{"string_pendulum_taut", 0, 0}, Shaded{"trammel_stop", 0.4, 0.8},
                               Shaded{"coupled_wheels_dead_centre", 0.999, 1.001}}) {
    CAPTURE(shaded.problem);
    const std::string picture = folder.path("a.svg"),
                      file = tests::source_folder() + ("docs/problems/" + shaded.problem + ".toml");
    CHECK(run({"solve", "--quiet", file, "--plot", picture}).code == 0);
    const double part = area_of("rgb(247, 227, 207)", picture_bytes(picture)) / (580.0 * 580.0);
    CHECK(part >= shaded.least);
    CHECK(part <= shaded.most);
  }
}

TEST_CASE("a page of two pictures has larger letters than a page of one") {
  if (!cli::has_gnuplot()) return;
  const Folder folder;
  const std::string file = tests::source_folder() + "docs/tutorial/four_bar.toml",
                    picture = folder.path("a.svg");
  CHECK(run({"solve", "--quiet", file, "--plot", picture}).code == 0);
  const std::string svg = picture_bytes(picture);
  check_legible(svg);
  for (const char* name : {"along", "across"}) CHECK(times_named(svg_texts(svg), name) == 1);  // a line each
  CHECK(times_named(svg_texts(svg), "stop") == 1);  // it does not show in this plane
  CHECK(svg.find("font-size=\"15.40\"") != std::string::npos);
}

TEST_CASE("an arrow of the mechanism has the number of its force, and the heading says whole what is drawn") {
  if (!cli::has_gnuplot()) return;
  const Folder folder;
  const std::string file = tests::source_folder() + "docs/tutorial/four_bar.toml",
                    picture = folder.path("a.svg");
  const Json lambda = Json::parse(run({"solve", "--json", file, "--plot", picture}).out)["multipliers"];
  const std::vector<SvgText> texts = svg_texts(picture_bytes(picture));
  const auto is_told = [&](const std::string& words) {
    return std::any_of(texts.begin(), texts.end(), [&](const SvgText& text) { return text.text == words; });
  };
  const auto number = [&](const char* name) { return cli::number_text(lambda[name].get<double>()); };
  for (const char* name : {"along", "across"}) CHECK(is_told(std::string(name) + " " + number(name)));
  CHECK(is_told("arrows, numbers: forces, as far as they work on their place;"));
  CHECK(is_told("on no place that is drawn: stop (lambda " + number("stop") + ")"));  // a moment
  CHECK(std::any_of(texts.begin(), texts.end(), [](const SvgText& text) {
    return text.text.find("does not show in this plane: stop") != std::string::npos;
  }));
  for (const char* axis : {"across, in the units of the file", "up, in the units of the file"})
    CHECK(is_told(axis));
}

TEST_CASE(
    "accelerations of a length and of an angle are drawn to scales of their own, by the kinetic metric") {
  if (!cli::has_gnuplot()) return;
  const Folder folder;
  const std::string file = folder.write(
      "a.toml", "[projection]\nA = { diagonal = [1, 1e-4] }\nz = [-10, 0.002]\nU = [[1, 0.03]]\ns = [0]\n");
  const std::string picture = folder.path("a.svg");
  CHECK(run({"solve", "--quiet", file, "--plot", picture}).code == 0);
  const std::string svg = picture_bytes(picture);
  check_legible(svg);
  // The part of the plane that the contact allows is no sliver.
  CHECK(area_of("rgb(217, 232, 245)", svg) / (580.0 * 580.0) >= 0.15);
  CHECK(svg.find("circles: those of the kinetic metric") != std::string::npos);
}

TEST_CASE("the reaction has its name beside its arrow, also amid the ellipses") {
  if (!cli::has_gnuplot()) return;
  const Folder folder;
  const std::string file = tests::source_folder() + "docs/problems/delassus_drops_too_much.toml",
                    picture = folder.path("a.svg");
  CHECK(run({"solve", "--quiet", file, "--plot", picture}).code == 0);
  const std::vector<SvgText> texts = svg_texts(picture_bytes(picture));
  const auto named = [&](const std::string& name) {
    return *std::find_if(texts.begin(), texts.end(),
                         [&](const SvgText& text) { return text.text.rfind(name, 0) == 0; });
  };
  // The arrow goes from the free acceleration to q'', whose names stand at its ends.
  const SvgText reaction = named("A⁻¹R"), free = named("A⁻¹z"), truth = named("q''");
  const double part = (reaction.top - free.top) / (truth.top - free.top),
               arrow = free.left - 8 + part * (truth.left - free.left);
  constexpr double beside = 20;
  CHECK(std::min(std::abs(reaction.left - arrow), std::abs(reaction.right - arrow)) <= beside);
}

TEST_CASE(
    "names of thirty letters stand beside the diagrams of a sweep, a map and a motion, and on the page") {
  if (!cli::has_gnuplot()) return;
  const Folder folder;
  const std::string name = "the_left_trestle_under_the_bar",
                    file = folder.write("a.toml", point_on_floor({{9, name + " = \"y >= 0\""}})),
                    picture = folder.path("a.svg");
  for (const std::vector<std::string>& arguments :
       {std::vector<std::string>{"sweep", file, "--over", "g=-2:0.5:2"},
        {"sweep", file, "--over", "g=-2:0.5:2", "--over", "m=1:1:4"},
        {"simulate", file, "--until", "1"}}) {
    CAPTURE(arguments.size());
    std::vector<std::string> drawn = arguments;
    drawn.insert(drawn.end(), {"--quiet", "--plot", picture});
    CHECK(run(drawn).code == 0);
    const std::string svg = picture_bytes(picture);
    check_legible(svg);
    int named = 0;
    for (const SvgText& text : svg_texts(svg)) {
      if (text.text.find(name) == std::string::npos) continue;
      ++named;
      CHECK(text.left >= 500);  // where the diagrams end
    }
    CHECK(named >= 1);
  }
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

TEST_CASE("axes say whose units they have, and a sweep that its multipliers are those of least norm") {
  if (!cli::has_gnuplot()) return;
  const Folder folder;
  const std::string bead = folder.write("a.toml", point_on_floor()), picture = folder.path("a.svg");
  CHECK(run({"simulate", "--quiet", bead, "--until", "1", "--plot", picture}).code == 0);
  CHECK(picture_bytes(picture).find("x, y, in units of the file") != std::string::npos);
  const std::string table = tests::source_folder() + "docs/problems/table_off_centre.toml";
  CHECK(run({"sweep", "--quiet", table, "--over", "g=9,10", "--plot", picture}).code == 0);
  CHECK(picture_bytes(picture).find("lambda: least norm; not unique") != std::string::npos);
  CHECK(run({"sweep", "--quiet", bead, "--over", "g=9,10", "--plot", picture}).code == 0);
  CHECK(picture_bytes(picture).find("not unique") == std::string::npos);
}

TEST_CASE("cells of one printed number have one colour") {
  std::vector<cli::StressTrial> trials;
  for (const double digits : {6.6, 7.0, 7.4}) {
    cli::StressTrial t;
    t.family = "scaled";
    t.difficulty = digits;
    t.trial.method = "auto";
    t.trial.judgement.error = std::pow(10, -digits);
    t.trial.judgement.verdict = cli::Verdict::ok;
    trials.push_back(t);
  }
  const std::string script = cli::failure_map_drawing(trials).script;
  const std::size_t boxes = script.find("$boxes0 << EOD\n"), end = script.find("EOD\n", boxes + 16);
  REQUIRE(boxes != std::string::npos);
  const std::string rows = script.substr(boxes + 15, end - boxes - 15);
  CHECK(std::count(rows.begin(), rows.end(), '\n') == 1);  // neighbours of one colour are one box
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

TEST_CASE("the numbers of a chart that are kept are drawn as performance profiles too") {
  if (!cli::has_gnuplot()) return;
  const Folder folder;
  const std::string table = tests::source_folder() + "docs/charts/speed_accuracy.csv",
                    picture = folder.path("a.svg");
  CHECK(run({"chart", table, "--profile", "--output", picture}).code == 0);
  const std::string svg = picture_bytes(picture);
  check_legible(svg);
  CHECK(svg.find("Performance profiles over 11 problems") != std::string::npos);
}

TEST_CASE("in the chart that is kept no two words overlap, and none leaves the page") {
  check_legible(picture_bytes(tests::source_folder() + "docs/charts/speed_accuracy.svg"));
}
