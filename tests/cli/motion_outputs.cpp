#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <fstream>
#include <nlohmann/json.hpp>
#include <sstream>

#include "cli/drawing/gnuplot.hpp"
#include "tests/cli/program.hpp"

using namespace tests;
using MotionJson = nlohmann::json;

namespace {

/// A pendulum on a rod that strikes a wall, with what is to be drawn of it. Line 16 begins [draw].
std::string pendulum(const std::string& draw, const std::string& simulate = "until = 3\nrestitution = 0.5") {
  return "title = \"A <b>pendulum</b> & a wall\"\n"
         "[system]\ncoordinates = [\"x\", \"y\"]\nkinetic = \"(x'^2 + y'^2)/2\"\npotential = \"9.81*y\"\n"
         "[system.constraints]\nrod = \"x^2 + y^2 = 1\"\nwall = \"x >= -0.5\"\n"
         "[state]\nposition = { x = 1, y = 0 }\n[simulate]\n" +
         simulate + "\n" + draw;
}

const std::string both =
    "[draw]\npoints = { tip = [\"x\", \"y\"] }\nsegments = { rod = [[\"0\", 0], [\"x\", \"y\"]] }\n"
    "circles = { bob = { centre = [\"x\", \"y\"], radius = \"0.1\" } }\n";

std::string whole(const std::string& path) {
  std::ifstream file(path);
  std::ostringstream text;
  text << file.rdbuf();
  return text.str();
}

/// The data that a page plays.
MotionJson data_of(const std::string& page) {
  const std::string begin = "id=\"motion\">", end = "</script>";
  const std::size_t from = page.find(begin) + begin.size();
  return MotionJson::parse(page.substr(from, page.find(end, from) - from));
}

std::vector<std::vector<std::string>> table(const std::string& path) {
  std::istringstream text(whole(path));
  std::vector<std::vector<std::string>> rows;
  for (std::string line; std::getline(text, line);) {
    rows.emplace_back();
    std::istringstream stream(line);
    for (std::string cell; std::getline(stream, cell, ',');) rows.back().push_back(cell);
  }
  return rows;
}

}  // namespace

TEST_CASE("an animation is one page without network, with the motion, its forces and its events") {
  const Folder folder;
  const std::string file = folder.write("p.toml", pendulum(both)), page_file = folder.path("p.html");
  const Outcome outcome = run({"simulate", "--json", file, "--animate", page_file});
  REQUIRE(outcome.code == 0);
  const std::string page = whole(page_file);
  CHECK(page.find("http") == std::string::npos);
  CHECK(page.find("src=") == std::string::npos);
  CHECK(page.find("<b>pendulum") == std::string::npos);
  const MotionJson data = data_of(page);
  CHECK(data["title"] == "A <b>pendulum</b> & a wall");
  CHECK(data["shapes"].size() == 3);
  CHECK(data["frames"].size() == 201);
  CHECK(data["events"].size() == MotionJson::parse(outcome.out)["events"]);
  for (const MotionJson& frame : data["frames"]) {
    const auto value = [&](std::size_t shape, std::size_t k) {
      return frame["values"][data["shapes"][shape]["numbers"][k].get<std::size_t>()].get<double>();
    };
    // The end of the rod, the centre of the bob and the point are one place, at 1 from the origin.
    const double x = value(0, 2), y = value(0, 3);
    CHECK(std::abs(std::hypot(x, y) - 1) <= 1e-6);
    CHECK(value(1, 0) == x);
    CHECK(value(2, 1) == y);
    CHECK(value(1, 2) == 0.1);
    // The force of the rod points along it.
    for (const MotionJson& arrow : frame["arrows"])
      if (arrow[0] == 0)
        CHECK(std::abs(arrow[3].get<double>() * y - arrow[4].get<double>() * x) <=
              1e-5 * std::hypot(arrow[3].get<double>(), arrow[4].get<double>()));
  }
  CHECK(data["frames"][100]["arrows"].size() >= 1);
}

TEST_CASE("without [draw] an animation has the coordinates as sliders") {
  const Folder folder;
  const std::string file = folder.write("p.toml", pendulum("")), page_file = folder.path("p.html");
  REQUIRE(run({"simulate", "--json", file, "--animate", page_file}).code == 0);
  const MotionJson data = data_of(whole(page_file));
  CHECK(data["shapes"].empty());
  CHECK(data["coordinates"] == MotionJson::parse("[\"x\", \"y\"]"));
  CHECK(data["frames"][0]["values"].size() == 2);
}

TEST_CASE("what is wrong in [draw] is told with its line and its key") {
  const auto refused = [](const std::string& draw, const std::vector<std::string>& words) {
    const Folder folder;
    const Outcome outcome = run({"simulate", folder.write("p.toml", pendulum(draw))});
    CHECK(outcome.code == 2);
    for (const std::string& word : words) {
      CAPTURE(outcome.err);
      CHECK(outcome.err.find(word) != std::string::npos);
    }
  };
  refused("[draw]\npoint = { tip = [\"x\", \"y\"] }\n", {":15:1:", "points"});
  refused("[draw]\npoints = { tip = [\"x\"] }\n", {":15:18:", "draw.points.tip"});
  refused("[draw]\npoints = { tip = [\"x\", \"z\"] }\n", {":15:25:", "z"});
  refused("[draw]\npoints = { tip = [\"x\", \"y +\"] }\n", {":15:"});
  refused("[draw]\npoints = { tip = [\"x\", true] }\n", {":15:24:", "draw.points.tip"});
  refused("[draw]\nsegments = { rod = [\"x\", \"y\"] }\n", {":15:", "draw.segments.rod"});
  refused("[draw]\ncircles = { bob = { centre = [\"x\", \"y\"] } }\n", {":15:13:", "radius"});
  refused("[draw]\ncircles = { bob = { center = [\"x\", \"y\"], radius = 1 } }\n", {":15:21:", "centre"});
  const Folder folder;
  const std::string shrinking =
      "[draw]\ncircles = { bob = { centre = [\"x\", \"y\"], radius = \"1 - t\" } }\n";
  const Outcome negative =
      run({"simulate", folder.write("r.toml", pendulum(shrinking)), "--animate", folder.path("r.html")});
  CHECK(negative.code == 2);
  for (const char* word : {":15:52:", "draw.circles.bob.radius", "negative"})
    CHECK_MESSAGE(negative.err.find(word) != std::string::npos, negative.err);
  const Outcome other = run({"solve", folder.write("p.toml", two_rows() + "[draw]\n")});
  CHECK(other.code == 2);
  CHECK(other.err.find("[draw]") != std::string::npos);
}

TEST_CASE("a family is drawn member by member") {
  const Folder folder;
  const std::string file = folder.write(
      "f.toml",
      "[system]\ncoordinates = [\"x[1..N]\"]\nkinetic = \"sum(i in 1..N, x[i]'^2/2)\"\n"
      "[system.parameters]\nN = 3\n[state]\nposition = { \"x[i]\" = \"i\" }\n[simulate]\nuntil = 1\n"
      "[draw.circles]\n\"ball[i in 1..N]\" = { centre = [\"x[i]\", \"i/10\"], radius = \"i/20\" }\n");
  const std::string page_file = folder.path("f.html");
  REQUIRE(run({"simulate", file, "--animate", page_file}).code == 0);
  const MotionJson data = data_of(whole(page_file));
  REQUIRE(data["shapes"].size() == 3);
  CHECK(data["shapes"][2]["name"] == "ball[3]");
  const auto number = [&](std::size_t k) {
    return data["frames"][0]["values"][data["shapes"][2]["numbers"][k].get<std::size_t>()].get<double>();
  };
  CHECK(number(0) == 3);
  CHECK(number(1) == 0.3);
  CHECK(number(2) == 0.15);
}

TEST_SUITE("chromium") {
  TEST_CASE("a browser plays the page") {
    const Folder folder;
    const std::string file = folder.write("p.toml", pendulum(both)), page_file = folder.path("p.html");
    REQUIRE(run({"simulate", file, "--animate", page_file}).code == 0);
    const std::string dump = folder.path("dump.html");
    const std::string command =
        "timeout 60 chromium --headless --no-sandbox --disable-gpu --dump-dom file://" + page_file + " > " +
        dump + " 2> /dev/null";
    REQUIRE(std::system(command.c_str()) == 0);
    const std::string dom = whole(dump);
    CHECK(dom.find("data-ready=\"yes\"") != std::string::npos);
    CHECK(dom.find("class=\"impact\"") != std::string::npos);
    CHECK(dom.find("t = 0.00000") != std::string::npos);
  }
}

TEST_CASE("a motion that is resumed from its JSON goes where the whole one goes") {
  const Folder folder;
  const std::string file = folder.write("p.toml", pendulum(""));
  const Outcome half = run({"simulate", "--json", file, "--until", "1.3"});
  REQUIRE(half.code == 0);
  const std::string state = folder.write("half.json", half.out);
  const MotionJson rest = MotionJson::parse(run({"simulate", "--json", file, "--resume", state}).out);
  const MotionJson all = MotionJson::parse(run({"simulate", "--json", file}).out);
  CHECK(rest["t"] == 3);
  for (const char* name : {"x", "y"}) {
    CHECK(std::abs(rest["position"][name].get<double>() - all["position"][name].get<double>()) <= 1e-12);
    CHECK(std::abs(rest["velocity"][name].get<double>() - all["velocity"][name].get<double>()) <= 1e-12);
  }
  CHECK(rest["impacts"].get<int>() + MotionJson::parse(half.out)["impacts"].get<int>() ==
        all["impacts"].get<int>());
  for (const std::string& text : {std::string("[1]"), std::string("{\"t\": 1}"), std::string("nonsense"),
                                  std::string("{\"t\":0,\"position\":{\"z\":0,\"x\":1},\"velocity\":{}}")}) {
    const Outcome wrong = run({"simulate", file, "--resume", folder.write("wrong.json", text)});
    CHECK(wrong.code == 2);
    CHECK(wrong.err.find("--resume") != std::string::npos);
  }
}

TEST_CASE("a strobe has a row each period, and a wheel is written between 0 and a turn") {
  const Folder folder;
  const std::string file =
      folder.write("w.toml",
                   "[system]\ncoordinates = [\"a\"]\nkinetic = \"a'^2/2\"\n[system.parameters]\nw = 4\n"
                   "[state]\nposition = { a = 1 }\nvelocity = { a = -3 }\n[simulate]\nuntil = 10\n");
  const std::string csv = folder.path("w.csv");
  REQUIRE(run({"simulate", file, "--output", csv, "--strobe", "2*pi/w", "--modulo", "a=2*pi"}).code == 0);
  const auto rows = table(csv);
  const double period = std::acos(-1.0) / 2, turn = 4 * period;
  REQUIRE(rows.size() == 1 + 7);
  for (std::size_t k = 1; k < rows.size(); ++k) {
    const double t = std::stod(rows[k][0]), a = std::stod(rows[k][1]);
    CHECK(std::abs(t - period * static_cast<double>(k - 1)) <= 1e-13);
    CHECK(a >= 0);
    CHECK(a < turn);
    CHECK(std::abs(std::remainder(a - (1 - 3 * t), turn)) <= 1e-13);
  }
  CHECK(run({"simulate", file, "--strobe", "1"}).code == 2);
  CHECK(run({"simulate", file, "--output", csv, "--strobe", "-1"}).code == 2);
  const Outcome unnamed = run({"simulate", file, "--output", csv, "--modulo", "b=1"});
  CHECK(unnamed.code == 2);
  CHECK(unnamed.err.find("no coordinate is named b") != std::string::npos);
  CHECK(run({"simulate", file, "--phase", "a"}).code == 2);
}

TEST_CASE("time-stepping writes what following events writes, as means over its steps") {
  const Folder folder;
  const std::string file = folder.write(
      "p.toml", pendulum(both, "until = 1\nrestitution = 0.5\nmethod = \"time-stepping\"\nstep = 1e-3"));
  const std::string csv = folder.path("p.csv"), events = folder.path("e.jsonl"), page = folder.path("p.html");
  const Outcome outcome =
      run({"simulate", "--json", file, "--output", csv, "--events", events, "--animate", page});
  REQUIRE(outcome.code == 0);
  const MotionJson found = MotionJson::parse(outcome.out);
  CHECK(found["method"] == "time-stepping");
  CHECK(found["steps"] == 1000);
  const MotionJson exact =
      MotionJson::parse(run({"simulate", "--json", file, "--method", "event-driven"}).out);
  CHECK(exact["method"] == "event-driven");
  CHECK(std::abs(found["position"]["x"].get<double>() - exact["position"]["x"].get<double>()) <= 1e-2);
  CHECK(found["impacts"] == exact["impacts"]);
  CHECK(table(csv).size() == 202);
  CHECK(data_of(whole(page))["frames"].size() == 201);
  std::istringstream lines(whole(events));
  std::size_t count = 0;
  for (std::string line; std::getline(lines, line); ++count) CHECK(MotionJson::parse(line).contains("kind"));
  CHECK(found["events"] == count);
}

TEST_CASE("a scene with too many contacts to follow each event is stopped at once, with the method to take") {
  const Folder folder;
  const std::string file = folder.write(
      "grid.toml",
      "[system]\ncoordinates = [\"x[1..N]\"]\nkinetic = \"sum(i in 1..N, x[i]'^2/2)\"\n"
      "[system.parameters]\nN = 6000\n[system.constraints]\n\"floor[i in 1..N]\" = \"x[i] >= 0\"\n"
      "[state]\nposition = { \"x[i]\" = 0 }\n[simulate]\nuntil = 1\nstep = 0.25\n");
  const Outcome outcome = run({"simulate", "--json", file});
  CHECK(outcome.code == 3);
  const MotionJson found = MotionJson::parse(outcome.out);
  CHECK(found["status"] == "stopped");
  CHECK(found["why"].get<std::string>().find("time-stepping") != std::string::npos);
  CHECK(run({"simulate", "--json", file, "--method", "time-stepping"}).code == 0);
}

TEST_CASE("the ordinary choice of auto is told with the motion, and is no warning") {
  const Folder folder;
  const std::string file = folder.write("p.toml", pendulum("", "until = 1\nmethod = \"auto\""));
  const Outcome told = run({"simulate", file});
  CHECK(told.err.empty());
  CHECK(told.out.find("Method auto: 1 one-sided constraints, fewer than 300: event-driven") !=
        std::string::npos);
  CHECK(MotionJson::parse(run({"simulate", "--json", file}).out)["choice"].get<std::string>().starts_with(
      "auto: "));
}

TEST_CASE("a phase curve is round within steps, and marked where it begins and ends") {
  if (!cli::has_gnuplot()) return;
  const Folder folder;
  // 200 turns of an oscillator.
  const std::string
      file = folder.write(
          "o.toml",
          "[system]\ncoordinates = [\"x\"]\nkinetic = \"x'^2/2\"\npotential = \"x^2/2\"\n[state]\nposition = "
          "{ x = 1 }\n"),
      picture = folder.path("p.svg");
  REQUIRE(run({"simulate", "--quiet", file, "--until", "400*pi", "--phase", "x", "--plot", picture}).code ==
          0);
  const std::string svg = whole(picture);
  CHECK(svg.find("begins") != std::string::npos);
  // The circle is as wide as the picture; its longest chord is a small part of that.
  const std::string curve = "<path stroke='rgb(  0, 114, 178)'";
  double longest = 0;
  std::size_t points = 0;
  for (std::size_t at = svg.find(curve); at != std::string::npos; at = svg.find(curve, at + 1)) {
    const std::size_t begin = svg.find("d='M", at) + 4;
    std::istringstream path(svg.substr(begin, svg.find('\'', begin) - begin));
    double x = 0, y = 0, next_x = 0, next_y = 0;
    char comma = ',';
    path >> x >> comma >> y;
    for (std::string mark; path >> mark;) {
      const std::size_t digits = mark.find_first_not_of("LM");
      if (digits == std::string::npos) continue;
      std::istringstream point(mark.substr(digits));
      if (!(point >> next_x >> comma >> next_y)) continue;
      if (mark[0] != 'M') longest = std::max(longest, std::hypot(next_x - x, next_y - y));
      x = next_x;
      y = next_y;
      ++points;
    }
  }
  CHECK(points >= 1000);
  CHECK(longest <= 40);
}
