#include <doctest/doctest.h>

#include <cmath>
#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>
#include <sstream>

#include "tests/cli/error_form.hpp"
#include "tests/cli/program.hpp"
#include "tests/this_build.hpp"

using namespace tests;
using Json = nlohmann::ordered_json;

namespace {

std::vector<std::string> lines(const std::string& path) {
  std::ifstream file(path);
  std::vector<std::string> found;
  for (std::string line; std::getline(file, line);) found.push_back(line);
  return found;
}

std::vector<std::string> cells(const std::string& line) {
  std::vector<std::string> found;
  std::istringstream stream(line);
  for (std::string cell; std::getline(stream, cell, ',');) found.push_back(cell);
  return found;
}

std::string ball(const std::string& simulate, const std::string& position = "1") {
  return "[system]\ncoordinates = [\"y\"]\nkinetic = \"y'^2/2\"\npotential = "
         "\"9.81*y\"\n[system.constraints]\n"
         "floor = \"y >= 0\"\n[state]\nposition = { y = " +
         position + " }\n[simulate]\n" + simulate;
}

}  // namespace

TEST_CASE("the motions of the library have the events of their closed forms, to 1e-13") {
  std::size_t count = 0;
  for (const auto& entry : std::filesystem::directory_iterator(tests::source_folder() + "docs/problems")) {
    const std::string name = entry.path().stem().string();
    if (!name.starts_with("motion_")) continue;
    ++count;
    CAPTURE(name);
    const Folder folder;
    const std::string path = folder.path("events.jsonl");
    const Outcome outcome = run({"simulate", entry.path().string(), "--json", "--events", path});
    REQUIRE(outcome.code == 0);
    const Json found = Json::parse(outcome.out);
    CHECK(found["status"] == "done");
    CHECK(found["penetration"].get<double>() <= 1e-13);
    std::vector<Json> events;
    for (const std::string& line : lines(path)) events.push_back(Json::parse(line));
    CHECK(found["events"] == events.size());
    std::ifstream expected(tests::source_folder() + "tests/cases/" + name + ".expected.json");
    REQUIRE(expected.good());
    for (const Json& wanted : Json::parse(expected)["events"]) {
      const double t = std::stod(wanted["t"].get<std::string>());
      const Json* nearest = nullptr;
      for (const Json& event : events)
        if (event["kind"] == wanted["kind"] && event["constraints"] == wanted["constraints"] &&
            std::abs(event["t"].get<double>() - t) <= 1e-13)
          nearest = &event;
      CAPTURE(t);
      REQUIRE(nearest != nullptr);
      if (!wanted.contains("velocity_after")) continue;
      for (const auto& [coordinate, v] : wanted["velocity_after"].items())
        CHECK((*nearest)["velocity_after"][coordinate].get<double>() ==
              doctest::Approx(std::stod(v.get<std::string>())).epsilon(1e-13).scale(1));
    }
  }
  CHECK(count >= 8);
}

TEST_CASE("simulate prints the end of the motion and writes evenly spaced rows") {
  const Folder folder;
  const std::string file = folder.write("ball.toml", ball("until = 1.5\nrestitution = 0.8\nsamples = 31"));
  const std::string table = folder.path("motion.csv"), events = folder.path("events.jsonl");
  const Outcome outcome = run({"simulate", file, "--json", "--output", table, "--events", events});
  REQUIRE(outcome.code == 0);
  const Json found = Json::parse(outcome.out);
  CHECK(found["status"] == "done");
  CHECK(found["t"] == 1.5);
  CHECK(found["impacts"] == 2);
  CHECK(found["position"]["y"].get<double>() == doctest::Approx(0.4028620218202980).epsilon(1e-14));
  CHECK(found["energy"].get<double>() == doctest::Approx(4.018176).epsilon(1e-14));
  for (const char* key : {"velocity", "acceleration", "multipliers", "events", "steps", "seconds", "remarks"})
    CHECK(found.contains(key));
  const std::vector<std::string> rows = lines(table);
  REQUIRE(rows.size() == 32);
  CHECK(rows[0] == "t,y,y',y'',lambda[floor],energy");
  for (std::size_t k = 1; k < rows.size(); ++k) {
    REQUIRE(cells(rows[k]).size() == 6);
    CHECK(std::stod(cells(rows[k])[0]) == doctest::Approx(0.05 * static_cast<double>(k - 1)).epsilon(1e-15));
    CHECK(std::stod(cells(rows[k])[1]) >= 0);
  }
  CHECK(std::stod(cells(rows.back())[1]) == found["position"]["y"].get<double>());
  CHECK(lines(events).size() == 2);
}

TEST_CASE("the motion is drawn with a panel for each kind of number") {
  const Folder folder;
  const std::string file = folder.write("ball.toml", ball("until = 1.5\nrestitution = 0.8"));
  const std::string picture = folder.path("motion.svg");
  const Outcome outcome = run({"simulate", file, "--quiet", "--plot", picture});
  CHECK(outcome.code == 0);
  const std::vector<std::string> drawn =
      lines(std::filesystem::exists(picture) ? picture : picture + ".gnuplot");
  REQUIRE(!drawn.empty());
  std::string all;
  for (const std::string& line : drawn) all += line + "\n";
  for (const char* word : {"floor", "T + V", "lambda"}) CHECK(all.find(word) != std::string::npos);
  CHECK(run({"simulate", file, "--plot", folder.path("motion.gif")}).code == 2);
}

TEST_CASE("a row at an event holds the state after it") {
  const Folder folder;
  // From 1 to the wall at 2, at speed 1: back at speed 1/2 from t = 1 on.
  const std::string file = folder.write(
      "wall.toml",
      "[system]\ncoordinates = [\"x\"]\nkinetic = \"x'^2/2\"\n[system.constraints]\nwall = \"x <= "
      "2\"\n[state]\n"
      "position = { x = 1 }\nvelocity = { x = 1 }\n[simulate]\nuntil = 2\nrestitution = 0.5\nsamples = 3\n");
  const std::string table = folder.path("motion.csv");
  REQUIRE(run({"simulate", file, "--output", table}).code == 0);
  const std::vector<std::string> rows = lines(table);
  REQUIRE(rows.size() == 4);
  CHECK(rows[2] == "1,2,-0.5,0,0,0.125");
  CHECK(rows[3] == "2,1.5,-0.5,0,0,0.125");
}

TEST_CASE("an impact at the start of a motion whose velocities are left out is told, and no other rest is") {
  const auto told = [](const std::string& floor, const std::string& velocity) {
    return run_on("simulate",
                  "[system]\ncoordinates = [\"y\"]\nkinetic = \"y'^2/2\"\npotential = \"9.81*y\"\n"
                  "[system.constraints]\nfloor = \"" +
                      floor + "\"\n[state]\nposition = { y = 0 }\n" + velocity + "\n[simulate]\nuntil = 1\n")
        .err;
  };
  CHECK(told("y >= 0.1*sin(3*t)", "").find("give them, be it as velocity = { y = 0 }") != std::string::npos);
  CHECK(told("y >= 0.1*sin(3*t)", "velocity = { y = 0 }").empty());
  CHECK(told("y >= 0", "").empty());
}

TEST_CASE("a restitution may be an expression in the parameters") {
  const Folder folder;
  // Free from x = 0 at speed 1 to the wall at 1, and back.
  const std::string scene =
      "[system]\ncoordinates = [\"x\"]\nkinetic = \"x'^2/2\"\n[system.parameters]\nc = 0.5\ne = \"c/2\"\n"
      "[system.looseness]\nmesh = { between = [\"x\", \"0\"], gap = 2, restitution = \"2*e\" }\n"
      "[state]\nposition = { x = 0 }\nvelocity = { x = 1 }\n[simulate]\nuntil = 2\n";
  const auto speed = [&](const std::string& rest, const std::vector<std::string>& more = {}) {
    std::vector<std::string> arguments{"simulate", folder.write("loose.toml", scene + rest), "--json"};
    arguments.insert(arguments.end(), more.begin(), more.end());
    const Outcome outcome = run(arguments);
    CAPTURE(outcome.err);
    REQUIRE(outcome.code == 0);
    return Json::parse(outcome.out)["velocity"]["x"].get<double>();
  };
  CHECK(speed("") == -0.5);
  CHECK(speed("", {"--set", "c=0.75"}) == -0.75);
  CHECK(speed("restitution = { mesh_upper = \"c^2\" }") == -0.25);
  CHECK(speed("", {"--set", "simulate.restitution.mesh_upper=1/(4*c)"}) == -0.5);
  CHECK(speed("restitution = { mesh_upper = \"e\" }", {"--set", "e=0.25"}) == -0.25);
}

TEST_CASE("constraints of looseness stand where the file has them, before or behind the others") {
  const std::string loose =
                        "[system.looseness]\nb = { between = [\"x\", \"0\"], gap = 2 }\n"
                        "a = { between = [\"x\", \"1\"], gap = 4 }\n",
                    others = "[system.constraints]\nz = \"x <= 5\"\n";
  const auto names = [](const std::string& tables) {
    const Folder folder;
    const std::string file =
        folder.write("loose.toml", "[system]\ncoordinates = [\"x\"]\nkinetic = \"x'^2/2\"\n" + tables +
                                       "[state]\nposition = { x = 0 }\n");
    std::vector<std::string> found;
    const Json answer = Json::parse(run({"solve", "--json", file}).out);
    for (const auto& [name, constraint] : answer.at("constraints").items()) found.push_back(name);
    return found;
  };
  CHECK(names(loose + others) == std::vector<std::string>{"b_lower", "b_upper", "a_lower", "a_upper", "z"});
  CHECK(names(others + loose) == std::vector<std::string>{"z", "b_lower", "b_upper", "a_lower", "a_upper"});
}

TEST_CASE("looseness is two constraints, with its own restitution unless [simulate] names them") {
  const auto energy = [](const std::string& simulate) {
    const Folder folder;
    const std::string file = folder.write(
        "pair.toml",
        "[system]\ncoordinates = [\"x\"]\nkinetic = \"x'^2/2\"\n[system.looseness]\n"
        "mesh = { between = [\"x\", \"0\"], gap = 2, restitution = 0.5 }\n[state]\nposition = { x = 0 }\n"
        "velocity = { x = 1 }\n[simulate]\nuntil = 3.5\n" +
            simulate);
    const Outcome outcome = run({"simulate", file, "--json"});
    REQUIRE(outcome.code == 0);
    const Json found = Json::parse(outcome.out);
    CHECK(found["multipliers"].contains("mesh_lower"));
    CHECK(found["multipliers"].contains("mesh_upper"));
    return found["velocity"]["x"].get<double>();
  };
  CHECK(energy("") == -0.5);
  CHECK(energy("restitution = 1") == -0.5);
  CHECK(energy("restitution = { mesh_upper = 0.75 }") == -0.75);
}

TEST_CASE("what cannot be simulated is refused with the place and what to do") {
  const auto refused = [](const std::string& text, const std::vector<std::string>& more,
                          const std::vector<std::string>& words) {
    const Folder folder;
    std::vector<std::string> arguments{"simulate", folder.write("problem.toml", text)};
    arguments.insert(arguments.end(), more.begin(), more.end());
    const Outcome outcome = run(arguments);
    CAPTURE(outcome.err);
    CHECK(outcome.code == 2);
    CHECK(outcome.out.empty());
    for (const std::string& word : words) CHECK(outcome.err.find(word) != std::string::npos);
  };
  refused(ball("until = 1", "-1"), {}, {":6:1:", "floor", "penetrated"});
  refused(ball("restitution = 0.5"), {}, {"until"});
  refused(ball("until = -1"), {}, {"until", "forward"});
  refused(ball("until = 1\nrestitution = 1.5"), {}, {":11:15:", "1.5", "0 to 1"});
  refused(ball("until = 1\nrestitution = { flor = 0.5 }"), {}, {":11:17:", "flor", "floor"});
  refused(ball("until = 1\nrestitution = \"2*9.81\""), {}, {":11:15:", "2*9.81 = 19.62", "0 to 1"});
  refused(ball("until = 1\nrestitution = { floor = \"1/k\" }"), {}, {":11:25:", "restitution.floor", "k"});
  refused(ball("until = 1\nsamples = 1"), {}, {":11:11:", "samples"});
  refused(ball("until = 1\nsamples = 2.5"), {}, {":11:11:", "samples"});
  refused(ball("until = 1\nmethod = \"euler\""), {}, {":11:10:", "euler", "event-driven"});
  refused(ball("until = 1\nmethod = \"time-stepping\"\nimpact_law = \"poisson\""), {},
          {":12:14:", "poisson", "event-driven"});
  refused(ball("until = 1\nmethod = \"time-stepping\"\nstep = 0"), {}, {":12:8:", "step"});
  refused(ball("until = 1\nimpact_law = \"newton\""), {}, {":11:14:", "newton", "moreau"});
  refused(ball("until = 1\nuntill = 2"), {}, {":11:1:", "untill", "until"});
  refused(ball("until = 1"), {"--output", "/no/such/folder/F.csv"}, {"cannot write"});
  refused("[projection]\nA = [[1]]\nz = [0]\nU = [[1]]\ns = [0]\n", {}, {"[system]"});
  const std::string loose =
      "[system]\ncoordinates = [\"x\"]\nkinetic = \"x'^2/2\"\n[system.looseness]\nmesh = ";
  const std::string rest = "\n[state]\nposition = { x = 0 }\n[simulate]\nuntil = 1\n";
  refused(loose + "{ between = [\"x\"], gap = 1 }" + rest, {}, {":5:20:", "between"});
  refused(loose + "{ between = [\"x\", \"0\"] }" + rest, {}, {":5:1:", "gap"});
  refused(loose + "{ between = [\"x\", \"0\"], gap = -1 }" + rest, {}, {"-1", "negative"});
  refused(loose + "{ between = [\"x\", \"0\"], gap = 1, e = 1 }" + rest, {}, {"\"e\""});
}

TEST_CASE("a motion that ends early keeps what it has, and says when and why") {
  const Folder folder;
  const std::string file = folder.write("ball.toml", ball("until = 10\nrestitution = 0.9\nsamples = 11"));
  const std::string table = folder.path("motion.csv");
  const Outcome stopped = run({"simulate", file, "--json", "--limit", "5", "--output", table});
  CHECK(stopped.code == 3);
  const Json found = Json::parse(stopped.out);
  CHECK(found["status"] == "stopped");
  CHECK(found["why"].get<std::string>().find("5 steps") != std::string::npos);
  CHECK(found["impacts"] == 5);
  CHECK(lines(table).size() == 5);  // t = 0, 1, 2, 3 of 3.25
  const std::string squeezed = folder.write(
      "squeeze.toml",
      "[system]\ncoordinates = [\"x\"]\nkinetic = \"x'^2/2\"\n[system.constraints]\nleft = \"x >= t\"\n"
      "right = \"x <= 2 - t\"\n[state]\nposition = { x = 1 }\n[simulate]\nuntil = 3\n");
  const Outcome infeasible = run({"simulate", squeezed, "--json"});
  CHECK(infeasible.code == 1);
  CHECK(Json::parse(infeasible.out)["constraints"] == Json({"left", "right"}));
}

TEST_CASE("a motion ends at an expression in the parameters, of the file and of the command line") {
  const Folder folder;
  const auto file = [&](const std::string& until) {
    return folder.write("a.toml",
                        "[system]\ncoordinates = [\"x\"]\nkinetic = \"x'^2/2\"\npotential = "
                        "\"w^2*x^2/2\"\n[system.parameters]\nw = 3\n[state.position]\nx = 1\n" +
                            until);
  };
  const double pi = std::acos(-1.0);
  const auto end = [](const Outcome& found) {
    CAPTURE(found.err);
    REQUIRE(found.code == 0);
    const Json told = Json::parse(found.out);
    CHECK(told["position"]["x"].get<double>() == doctest::Approx(1).epsilon(1e-9));  // whole periods
    return told["t"].get<double>();
  };
  const std::string whole = file("[simulate]\nuntil = \"4*pi/w\"\n");
  CHECK(end(run({"simulate", "--json", whole})) == doctest::Approx(4 * pi / 3).epsilon(1e-15));
  CHECK(end(run({"simulate", "--json", whole, "--until", "2*pi/w"})) ==
        doctest::Approx(2 * pi / 3).epsilon(1e-15));
  CHECK(end(run({"simulate", "--json", whole, "--set", "w=2"})) == doctest::Approx(2 * pi).epsilon(1e-15));
  const std::string unknown = file("[simulate]\nuntil = \"2*pi/u\"\n");
  const Outcome refused = run({"simulate", unknown});
  CHECK(refused.code == 2);
  CHECK(refused.err.find("a.toml:10:") != std::string::npos);
  CHECK(refused.err.find("simulate.until") != std::string::npos);
}

TEST_CASE("where events crowd, auto goes on in steps, and events say that it would") {
  const Folder folder;
  const std::string gap =
      "[system]\ncoordinates = [\"x\"]\nkinetic = \"x'^2/2\"\n[system.constraints]\n"
      "left = \"x >= 0\"\nright = \"x <= 1e-6\"\n[state]\nposition = { x = 0.0 }\nvelocity = { x = 1.0 }\n"
      "[simulate]\nuntil = 2.0\nrestitution = 1.0\n";
  const std::string file = folder.write("gap.toml", gap);
  const Outcome steps = run({"simulate", file, "--method", "auto"});
  CHECK(steps.code == 0);
  CHECK(steps.err.find("1000 events have come within 0.001") != std::string::npos);
  CHECK(steps.err.find("from there on it is followed in steps") != std::string::npos);
  const Outcome events = run({"simulate", file, "--limit", "2000"});
  CHECK(events.code == 3);
  CHECK(events.err.find("method = \"auto\" goes on in steps where events crowd") != std::string::npos);
  const Outcome few = run({"simulate", file, "--limit", "2000", "--set", "simulate.step=1e-7"});
  CHECK(few.err.find("crowd") == std::string::npos);  // a step would see no more than an event
}

TEST_CASE("a motion that magnifies the rounding of its start says so, a regular one does not") {
  const Folder folder;
  const auto pendulum = [&](const std::string& until) {
    return folder.write(
        "pendulum" + until + ".toml",
        "[system]\ncoordinates = [\"a\", \"b\"]\nkinetic = \"a'^2 + b'^2/2 + a'*b'*cos(a - b)\"\n"
        "potential = \"-9.81*(2*cos(a) + cos(b))\"\n[state]\nposition = { a = 2.0, b = 2.5 }\n"
        "[simulate]\nuntil = " +
            until + "\n");
  };
  CHECK(run({"simulate", pendulum("60.0")}).out.find("an error of one rounding at the start has grown") !=
        std::string::npos);
  CHECK(run({"simulate", pendulum("1.0")}).out.find("has grown") == std::string::npos);
}
