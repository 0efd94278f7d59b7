#include <nlohmann/json.hpp>

#include "tests/cli/error_form.hpp"
#include "tests/this_build.hpp"

using namespace tests;
using Json = nlohmann::ordered_json;

namespace {

std::string with_settings(const std::string& lines, Changes changes = {}) {
  changes[14] = lines;
  return point_on_floor(changes);
}

}  // namespace

TEST_CASE("a tolerance that double precision cannot keep gives status inaccurate and exit three") {
  const std::string text = two_rows(
      {{2, "A = [[2, 1], [1, 3]]"}, {3, R"(z = ["1/3", "1/7"])"}, {7, "[solve]\ntolerance = 1e-300"}});
  const Outcome outcome = run_json_on("solve", text);
  CHECK(outcome.code == 3);
  const Json object = Json::parse(outcome.out);
  CHECK(object.at("status") == "inaccurate");
  for (const char* name : {"acceleration", "multipliers", "residuals", "certificate"})
    CHECK(object.contains(name));
}

TEST_CASE("the command line's tolerance and method win over the file's") {
  const Folder folder;
  const std::string file =
      folder.write("problem.toml", two_rows({{2, "A = [[2, 1], [1, 3]]"},
                                             {3, R"(z = ["1/3", "1/7"])"},
                                             {7, "[solve]\ntolerance = 1e-300\nmethod = \"unheard-of\""}}));
  CHECK(run({"solve", file}).code == 2);
  CHECK(run({"solve", "--method", "active-set", file}).code == 3);
  CHECK(run({"solve", "--method", "active-set", "--tolerance", "1e-9", file}).code == 0);
}

TEST_CASE("the method solved with is named, and auto chooses one") {
  for (const char* name : {"auto", "active-set"}) {
    const Outcome outcome = run_json_on("solve", with_settings("method = \"" + std::string(name) + "\""));
    CHECK(outcome.code == 0);
    CHECK(Json::parse(outcome.out).at("method") == "active-set");
  }
  expect_refusal({with_settings("method = \"activeset\""), "14:10", {"activeset", "active-set"}});
}

TEST_CASE("contact_tolerance decides which contacts are present, as a number or by constraint") {
  const Changes above{{11, "position = { x = 0, y = 1e-4 }"}};
  const auto state = [](const std::string& text) -> std::string {
    return Json::parse(run_json_on("solve", text).out).at("constraints").at("floor").at("state");
  };
  CHECK(state(with_settings("", above)) == "inactive");
  CHECK(state(with_settings("contact_tolerance = 1e-3", above)) == "persists");
  CHECK(state(with_settings("contact_tolerance = { floor = 1e-3 }", above)) == "persists");
  CHECK(state(with_settings("[solve.contact_tolerance]\nfloor = 1e-3", {{11, above.at(11)}, {13, ""}})) ==
        "persists");
  const Changes below{{11, "position = { x = 0, y = -1e-4 }"}};
  CHECK(run_on("solve", with_settings("", below)).code == 2);
  CHECK(run_on("solve", with_settings("contact_tolerance = 1e-3", below)).code == 0);
}

TEST_CASE("contact_tolerance may name a family, a part or one of its members") {
  const auto present = [](const std::string& tolerance) {
    const Json object = Json::parse(
        run_json_on("derive",
                    "[system]\ncoordinates = [\"x[1..3]\"]\nkinetic = \"sum(i in 1..3, x[i]'^2)\"\n"
                    "[system.constraints]\n\"gap[i in 1..2]\" = \"x[i+1] >= x[i]\"\n[state]\n"
                    "position = { \"x[i]\" = \"i/1000\" }\n[solve]\n"
                    "contact_tolerance = " +
                        tolerance + "\n")
            .out);
    return object.at("U").size();
  };
  CHECK(present("1e-9") == 0);
  CHECK(present("{ \"gap[i]\" = 0.1 }") == 2);
  CHECK(present("{ \"gap\" = 0.1 }") == 2);
  CHECK(present("{ \"gap[2]\" = 0.1 }") == 1);
  CHECK(present("{ \"gap[i]\" = 0.1, \"gap[2]\" = 1e-9 }") == 1);
  CHECK(present("{ \"gap[2]\" = 1e-9, \"gap[i]\" = 0.1 }") ==
        1);  // a member overrides its family, first or last
  CHECK(present("{ \"gap[i in 2..2]\" = 0.1 }") == 1);
  CHECK(present("{ \"gap[i in 1..2]\" = 0.1, gap = 1e-9 }") == 2);  // a part overrides its family
  CHECK(present("{ \"gap[i in 1..2]\" = 0.1, \"gap[1]\" = 1e-9 }") == 1);
}

TEST_CASE("a part of a family in contact_tolerance has integers as its ends, and holds a member") {
  expect_refusal({with_settings("contact_tolerance = { \"floor[i in 1..N]\" = 1 }"), "14:23", {"integers"}});
  expect_refusal({with_settings("contact_tolerance = { \"floor[i in 1..3]\" = 1 }"), "14:23", {"floor"}});
}

TEST_CASE("settings of the wrong kind are refused where they stand") {
  expect_refusal({with_settings("tolerance = -1"), "14:13", {"tolerance"}});
  expect_refusal({with_settings("tolerance = nan"), "14:13", {"tolerance"}});
  expect_refusal({with_settings("tolerance = [1]"), "14:13", {"tolerance"}});
  expect_refusal({with_settings("method = 3"), "14:10", {"method"}});
  expect_refusal({with_settings("contact_tolerance = 0"), "14:21", {"contact_tolerance"}});
  expect_refusal({with_settings("contact_tolerance = { flor = 1 }"), "14:23", {"flor", "floor"}});
  expect_refusal({with_settings("contact_tolerance = { floor = \"x\" }"), "14:31", {"floor"}});
  expect_refusal({point_on_floor({{1, "solve = 3\n[system]"}, {13, ""}}), "1:9", {"[solve]"}});
}

TEST_CASE("what simulate is told does not disturb solve") {
  const std::string text = with_settings(
      "[simulate]\nuntil = 3.0\nmethod = \"time-stepping\"\ntolerance = 1e-10\nstep = 1e-3\n"
      "restitution = { floor = 0.8 }\nsamples = 301");
  const auto answer = [](const std::string& file_text) {
    return Json::parse(run_json_on("solve", file_text).out).at("multipliers");
  };
  CHECK(answer(text) == answer(point_on_floor()));
}

TEST_CASE("a key that the method of a motion does not use is told, once the file chooses the method") {
  const auto told = [](const std::string& keys, const std::vector<std::string>& more = {}) {
    const Folder folder;
    std::vector<std::string> arguments{
        "simulate",
        folder.write("a.toml",
                     "[system]\ncoordinates = [\"y\"]\nkinetic = \"y'^2/2\"\n[state]\nposition = { y = 0 }\n"
                     "[simulate]\nuntil = 0.1\n" +
                         keys)};
    arguments.insert(arguments.end(), more.begin(), more.end());
    const Outcome outcome = run(arguments);
    CHECK(outcome.code == 0);
    return outcome.err;
  };
  const std::string step = "step = 1e-2\n", tolerance = "tolerance = 1e-8\n",
                    steps = "method = \"time-stepping\"\n", events = "method = \"event-driven\"\n";
  CHECK(told(step).find(": line 8: simulate.step is not used by event-driven, the default; write method = "
                        "\"time-stepping\"") != std::string::npos);
  CHECK(told(events + step).find(": line 9: simulate.step is not used by event-driven; ") !=
        std::string::npos);
  CHECK(told(steps + tolerance).find(": line 9: simulate.tolerance is not used by time-stepping") !=
        std::string::npos);
  for (const std::string& keys : {steps + step, events + tolerance, tolerance}) CHECK(told(keys).empty());
  CHECK(told("method = \"auto\"\n" + step + tolerance).find("not used") == std::string::npos);
  CHECK(told(step, {"--method", "event-driven"}).empty());
  CHECK(told(tolerance, {"--method", "time-stepping"}).empty());
}

TEST_CASE("an answer that is not solved is no truth to judge the rule of dropping by") {
  const Outcome wrong = run({"solve", "--method", "drop-negative",
                             tests::source_folder() + "docs/problems/delassus_drops_too_much.toml"});
  CHECK(wrong.code == 3);
  CHECK(wrong.out.find("NOT solved") != std::string::npos);
  CHECK(wrong.out.find("happens to be right") == std::string::npos);
  CHECK(wrong.out.find("touches") == std::string::npos);
  const Outcome right = run({"solve", tests::source_folder() + "docs/problems/delassus_drops_too_much.toml"});
  CHECK(right.code == 0);
  CHECK(right.out.find("is wrong here (Delassus 1917)") != std::string::npos);
}

TEST_CASE("fewer contacts that open than multipliers that are negative are told as the only ones") {
  const Folder folder;
  const std::string file = folder.write("three.toml",
                                        "[projection]\nA = { diagonal = [1, 1, 1] }\nz = [0, 0, 2]\n"
                                        "U = [[-2, 2, -2], [0, -1, 2], [1, 2, 0]]\ns = [0, 0, 0]\n");
  const std::string told = run({"solve", file}).out;
  CAPTURE(told);
  CHECK(told.find("c[0], c[1] and c[2] have negative multipliers, but only c[1] and c[2] open:") !=
        std::string::npos);
}

TEST_CASE("fractions that the text proves are told where they can be read") {
  const std::string told =
      run({"solve", "--certify", tests::source_folder() + "docs/problems/delassus_drops_too_much.toml"}).out;
  CHECK(told.find("\nIn fractions: y'' = 9/5, a'' = -6; lambda left 0, right 7/2.\n") != std::string::npos);
}

TEST_CASE("a tolerance below rounding is told as that, and blames no rows") {
  const std::string ladder =
      "[system]\ncoordinates = [\"x\", \"y\", \"a\"]\nkinetic = \"6*(x'^2 + y'^2) + 8*a'^2\"\npotential = "
      "\"117.72*y\"\n[system.constraints]\nfloor = \"y >= 2*cos(a)\"\nwall = \"x >= "
      "2*sin(a)\"\n[state]\nposition = { "
      "a = 0.7, x = \"2*sin(a)\", y = \"2*cos(a)\" }\nvelocity = { a = 0.9, x = \"(2*sin(a))'\", y = "
      "\"(2*cos(a))'\" "
      "}\n";
  const Folder folder;
  const Outcome outcome = run({"solve", "--tolerance", "1e-16", folder.write("a.toml", ladder)});
  CHECK(outcome.code == 3);
  CHECK(outcome.out.find("below the rounding of doubles") != std::string::npos);
  CHECK(outcome.out.find("singular") == std::string::npos);
  CHECK(outcome.out.find("depend on each other") == std::string::npos);
}
