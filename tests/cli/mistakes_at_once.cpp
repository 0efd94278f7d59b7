#include <doctest/doctest.h>

#include <nlohmann/json.hpp>

#include "cli/problem_file/toml_document.hpp"
#include "tests/cli/error_form.hpp"

using Json = nlohmann::ordered_json;
using namespace tests;

TEST_CASE("mistakes of a file that do not hang on each other are told at once, in the order of the file") {
  check_told(point_on_floor({{4, "potential = \"m*g*sinn(y)\""},
                             {9, "floor = \"y > 0\""},
                             {12, "velocity = { z = 0.0 }"},
                             {13, "[simulate]\nuntill = 2\nsample = 3"}}),
             {"4:18: potential: \"sinn\" is no function; did you mean \"sin\"?", "9:12: constraint floor: ",
              "12:14: velocity: \"z\" is no coordinate; ", "14:1: unknown key \"untill\" in [simulate]; ",
              "15:1: unknown key \"sample\" in [simulate]; "});
  check_told(point_on_floor({{4, "potental = \"m*g*y\""}, {6, "m = \"2 kg\""}}),
             {"4:1: unknown key \"potental\" in [system]; ", "6:8: parameter m: "});
  check_told(point_on_floor({{11, "position = { x = \"0.0*\", y = \"q\" }"}}),
             {"11:23: position of x: ", "11:31: position of y: "});
  // The state, the settings and the other keys of a table are read without what is wrong in [system].
  check_told(point_on_floor({{2, "coordinate = [\"x\", \"y\"]"},
                             {4, "potential = true"},
                             {12, "velocities = { x = 0.0 }"},
                             {13, "in_contact = 3\n[simulate]\nuntil = false\nstep = -1"}}),
             {"2:1: unknown key \"coordinate\" in [system]; ",
              "4:13: system.potential: ", "12:1: unknown key \"velocities\" in [state]; ",
              "13:14: state.in_contact: ", "15:9: simulate.until: ", "16:8: simulate.step: "});
  check_told(point_on_floor({{13, "[draw]\npoint = 1\npoints = { a = 1, b = [0] }\nsegments = 2"}}),
             {"14:1: unknown key \"point\" in [draw]; ",
              "15:16: draw.points.a: ", "15:23: draw.points.b: ", "16:12: draw.segments: "});
  check_told(point_on_floor({{11, "position = { x = \"0.0*\", y = 0.0 }"}, {12, "velocities = { x = 0.0 }"}}),
             {"11:23: position of x: ", "12:1: unknown key \"velocities\" in [state]; "});
  check_told("[decomposition]\nz = [1, \"two\"]\nf = \"norm1(\"\n", {"2:9: ", "3:"});
  check_told(
      "[liquid]\ncoordinates = [\"x\", \"y\"]\ndomain = \"disk(center=[0, 0], radius=1)\"\ndensity = 0\n"
      "force = [\"0\", \"-gg\"]\nfree = { top = { where = \"true\", pressure = \"p0\" } }\n",
      {"3:11: domain: ", "4:11: density: ", "5:17: force: ", "6:46: free.top.pressure: "});
}

TEST_CASE("a slip in a key hides nothing of what stands in the file beside it") {
  const std::pair<int, const char*> floor{9, "floor = \"y > 0\""};
  const std::string wrong_floor = "9:12: constraint floor: ";
  check_told(point_on_floor({{2, "coordinate = [\"x\", \"y\"]"}, floor}),
             {"2:1: unknown key \"coordinate\" in [system]; ", wrong_floor});
  check_told(point_on_floor({{3, "T = \"m/2*(x'^2 + y'^2)\""}, floor}),
             {"3:1: unknown key \"T\" in [system]; ", wrong_floor});
  check_told(point_on_floor({{5, "[system.paramters]"}, floor}),
             {"5:9: unknown key \"paramters\" in [system]; ", wrong_floor});
  check_told(point_on_floor({{8, "[system.constraint]"}, floor}),
             {"8:9: unknown key \"constraint\" in [system]; ", wrong_floor});
  check_told(point_on_floor({floor, {10, "[stat]"}}), {wrong_floor, "10:2: unknown key \"stat\"; "});
  check_told(point_on_floor({floor, {13, "[slve]\ntolerance = 1e-9"}}),
             {wrong_floor, "13:2: unknown key \"slve\"; "});
  check_told(point_on_floor({floor, {13, "[system.looseness]\nplay = { betwen = [\"x\", \"y\"], gap = 1 }"}}),
             {wrong_floor, "14:10: unknown key \"betwen\" in [system.looseness.play]; "});
}

TEST_CASE("mistakes within one expression are told at once, a name that is unknown in it once") {
  const std::string y = "4:15: potential: \"yy\" is unknown; did you mean \"y\"?";
  check_told(point_on_floor({{4, "potential = \"(yy*xx + sinn(gg*yy))*yy\""}}),
             {y, "4:18: potential: \"xx\" is unknown; ", "4:23: potential: \"sinn\" is no function; ",
              "4:28: potential: \"gg\" is unknown; "});
  check_told(point_on_floor({{4, "potential = \"(yy + y y\""}}), {y, "4:22: potential: got \"y\"; "});
  check_told(point_on_floor({{6, "m = \"x' + t + k\""}}),
             {"6:6: parameter m: \"x\" is a coordinate; ", "6:11: parameter m: \"t\" may not be used here; ",
              "6:15: parameter m: \"k\" is unknown; "});
  check_told(point_on_floor({{9, "floor = \"yy >= hh\""}, {11, "position = { x = \"a + b\", y = 0 }"}}),
             {"9:10: constraint floor: ", "9:16: constraint floor: ", "11:19: position of x: ",
              "11:23: position of x: "});
  check_told(point_on_floor({{2, R"(coordinates = ["x", "y", "r[1..N, 1..M]"])"}}),
             {"2:32: coordinates: \"N\"", "2:38: coordinates: \"M\""});
}

TEST_CASE("of one expression no more mistakes are told than anybody corrects at once") {
  std::string potential = "potential = \"0";
  for (int k = 0; k < 1000; ++k) potential += " + q" + std::to_string(k);
  CHECK(told(point_on_floor({{4, potential + "\""}})).size() == 20);
}

TEST_CASE("what hangs on an unknown name is not told as another mistake") {
  const auto with_r = [](const std::string& potential) {
    return point_on_floor(
        {{2, R"(coordinates = ["x", "y", "r[1..3]"])"}, {4, "potential = \"" + potential + "\""}});
  };
  check_told(with_r("dot(uu, r) + norm(2*vv)"), {"4:18: potential: \"uu\"", "4:34: potential: \"vv\""});
  check_told(with_r("dot(uu*r, r) + uu[k]*r[1]"), {"4:18: potential: \"uu\"", "4:32: potential: \"k\""});
  check_told(with_r("crosss(r, r)[1] + yy"), {"4:14: potential: \"crosss\"", "4:32: potential: \"yy\""});
  check_told(with_r("summ(i in 1..3, r[i]) + iff(x >= 0, vv, 1)"),
             {"4:14: potential: \"summ\"", "4:38: potential: \"iff\"", "4:50: potential: \"vv\""});
}

TEST_CASE("mistakes of numbers are told at once: of [projection], [decomposition] and [cone]") {
  check_told(
      "[projection]\nA = [[2, 0], [\"a\", 1]]\nforce = 3\nz = [0, true]\nU = [[0, 1], [1]]\ns = [\"b\"]\n"
      "two_sided = [-1, 2, \"c\"]\n",
      {"2:15: A[1][0]: ", "3:1: unknown key \"force\"", "4:9: z[1]: ", "5:14: U[1]: 1 entry; ", "6:5: s: 1 ",
       "6:6: s[0]: ", "7:14: two_sided: -1 ", "7:18: two_sided: 2 ", "7:21: two_sided: c "});
  check_told("[projection]\nA = [[2, \"a\"], [0, 1]]\nz = 3\nU = [[0, 1], [1]]\ns = [0, 1, 2]\n",
             {"2:10: A[0][1]: ", "3:5: z: not a list; ", "4:14: U[1]: 1 entry; ", "5:5: s: 3 entries; "});
  check_told("[projection]\nA = [[2, 0], [0, 1]]\nforce = [1, 2]\ns = [true]\n",
             {"3:1: unknown key \"force\"", "4:6: s[0]: "});
  check_told("[decomposition]\nz = [1, \"a\", \"b\"]\nfun = \"norm1(\"\nmetrics = [[1, \"c\"], [0]]\n",
             {"2:9: z[1]: ", "2:14: z[2]: ", "3:1: unknown key \"fun\"", "4:1: unknown key \"metrics\"",
              "4:12: metric[0]: 2 entries; ", "4:16: metric[0][1]: ", "4:22: metric[1]: 1 entry; "});
  check_told(
      "[cone]\ngenerators = [[1, \"a\"], [1]]\nlins = [[1]]\nz = [1, 2, true]\nmetric = [[1, 0], [0, "
      "\"b\"]]\ndimension = 4\n",
      {"2:19: generators[0][1]: ", "2:25: generators[1]: ", "3:1: unknown key \"lins\"", "3:9: lines[0]: ",
       "4:5: z: 3 entries; ", "4:12: z[2]: ", "5:23: metric[1][1]: ", "6:13: dimension: 4; "});
}

TEST_CASE("wrong names within one function are told at once, with what is wrong beside it") {
  check_told(
      "[decomposition]\nz = [1, true]\nf = \"norm1(wieght=2) + 2*nom2() + envelope(nrm1(), gama=1)\"\n",
      {"2:9: z[1]: ", "3:12: norm1: there is no argument \"wieght\"; ",
       "3:26: there is no set, function or operation \"nom2\"; ",
       "3:44: there is no set, function or operation \"nrm1\"; ",
       "3:52: envelope: there is no argument \"gama\"; "});
}

TEST_CASE("wrong values within one function are told at once, each at the argument that it is of") {
  check_told(
      "[decomposition]\nz = [1, 2]\n"
      "f = \"sum(norm1(-1), 2*ball2(center=0, radius=-2), huber(mu=0), elastic_net(-1, -1))\"\n",
      {"3:16: norm1(weight): negative; ", "3:39: ball2(radius): negative; ",
       "3:57: huber(mu): not positive; ", "3:76: elastic_net(l1): negative; ",
       "3:80: elastic_net(l2): negative; "});
  // Blocks, images and conjugates are in spaces of their own.
  check_told(
      "[decomposition]\nz = [1, 2]\nf = \"separable(conjugate(huber(-1)), 1, precompose(norm2(-3), [[1]]), "
      "1)\"\n",
      {"3:32: huber(mu): not positive; ", "3:58: norm2(weight): negative; "});
  // What a stand-in may have made is not told: with all of space for the ball the sum would be improper.
  check_told("[decomposition]\nz = [1]\nf = \"inf_convolution(ball2(radius=-1), linear([1]))\"\n",
             {"3:28: ball2(radius): negative; "});
}

TEST_CASE("a name that no method has is told beside what else is wrong") {
  const std::string wrong = "unknown method \"activ-set\"; did you mean \"active-set\"?";
  check_told(
      point_on_floor({{3, "kinetics = \"m/2*(x'^2 + y'^2)\""}, {13, "[solve]\nmethod = \"activ-set\""}}),
      {"3:1: unknown key \"kinetics\" in [system]; ", "14:10: " + wrong});
  check_told("[projection]\nA = [[1]]\n[solve]\nmethod = \"activ-set\"\n",
             {"1:1: projection: z is missing; ", "4:10: " + wrong});
}

TEST_CASE("what bodies add to a system has no name in a message") {
  const std::string body = "[bodies.b]\nmass = 2\ninertia = [\"2*m\", \"2*m\", \"2*k\"]\n";
  check_told("[system]\npotential = \"qqqqqq\"\nparameters = { m = 1 }\n" + body + "[state]\nposition = {}\n",
             {"2:14: potential: \"qqqqqq\" is unknown; known are m, b_x, ",
              "6:29: bodies.b.inertia: \"k\" is unknown"});
}

TEST_CASE("mistakes in the keys of [liquid] are told at once") {
  check_told(
      "[liquid]\ncoordinates = [\"x\", \"y\"]\ndomain = 3\ndensty = 1\nvelocity = [\"x\"]\ncells = 0\n"
      "free = 3\nparameters = { k = true }\n",
      {"3:10: liquid.domain: ", "4:1: unknown key \"densty\"", "5:12: liquid.velocity: 1 ",
       "6:9: liquid.cells: ", "7:8: liquid.free: ", "8:20: liquid.parameters.k: "});
}

TEST_CASE("what hangs on a z that is a matrix, or on bodies without names, is not told as another mistake") {
  check_told("[projection]\nA = [[2, 0], [0, 1]]\nz = [[0, 1]]\nU = [[0, 1]]\ns = [0]\n", {"3:6: z[0]: "});
  check_told("[system]\n[bodies]\nmass = 2\ninertia = [1, 1, 1]\n[state]\nposition = { b_x = 0 }\n",
             {"3:1: bodies.mass: no body; "});
}

TEST_CASE("rows of one wrong length are one mistake") {
  check_told("[projection]\nA = [[2], [0, 1, 1], [3]]\nz = [0, 1, 2]\n", {"2:6: A[0]: 1 entry; give 3"});
  check_told("[projection]\nA = [[2], [0, 1], [3]]\nz = [0, 1, 2]\n",
             {"2:6: A[0]: 1 entry; give 3", "2:11: A[1]: 2 entries; give 3"});
}

TEST_CASE("a wrong value of a parameter, a body or a looseness hides nothing behind it") {
  check_told(point_on_floor({{4, "potential = \"m*g*yy\""},
                             {6, "m = true"},
                             {9,
                              "floor = [1]\n[system.forces]\nx = false\n[bodies.b]\nmas = 2\n"
                              "inertia = [-1, \"2*\", true]\n[bodies.c]\nmass = -1\ninertia = 3"}}),
             {"4:18: potential: \"yy\" is unknown; did you mean \"y\"?",
              "6:5: system.parameters.m: ", "9:9: system.constraints.floor: ", "11:5: system.forces.x: ",
              "13:1: unknown key \"mas\" in [bodies.b]; ", "14:12: bodies.b.inertia: -1 is not positive",
              "14:19: bodies.b.inertia: ", "14:22: bodies.b.inertia: neither a number nor an expression; ",
              "16:8: bodies.c.mass: -1 is not positive; ", "17:11: bodies.c.inertia: not three moments; "});
  check_told(point_on_floor({{3, "kinetic = [1]"},
                             {13,
                              "[system.looseness]\na = { between = [\"x\", \"yy\"], gap = \"gg\" }\n"
                              "b = { between = [\"x\", true], gap = -1, restitution = 3 }\nc = 3"}}),
             {"3:11: system.kinetic: ", "14:24: constraint a_lower: \"yy\" is unknown; ",
              "14:37: constraint a_lower: \"gg\" is unknown; ",
              "15:23: system.looseness.b.between: ", "15:36: system.looseness.b.gap: -1 is negative; ",
              "15:54: system.looseness.b.restitution: ", "16:5: system.looseness.c: not a table; "});
}

TEST_CASE("all constraints that do not hold at a state are told at once") {
  check_told(point_on_floor({{9, "floor = \"y >= 1\"\nrod = \"x = 2\"\nwall = \"x >= 0\"\nsun = \"y <= 9\""},
                             {12, "velocity = { x = -3 }"}}),
             {"9:1: constraint floor: penetrated, f = -1 < 0; ",
              "10:1: constraint rod: two-sided, but f = -2 ", "11:1: constraint wall: an impact is due, "});
}

TEST_CASE("a place behind an escape or a continued line is that in the file") {
  check_told(point_on_floor({{4, R"x(potential = "m*g\u002ay\t+ sinn(y)")x"}}), {"4:28: potential: "});
  check_told(point_on_floor({{4, "potential = \"\"\"m*g*y \\\n   + \\\n\n  sinn(y)\"\"\""}}),
             {"7:3: potential: "});
  check_told(point_on_floor({{4, "potential = \"\"\"\n\\\n m*g*y +\n sinn(y)\"\"\""}}), {"7:2: potential: "});
  check_told(point_on_floor({{4, "potential = 'm*g*y + sinn(y)'"}}), {"4:22: potential: "});
}

TEST_CASE("a place within a key in quotation marks is that in the file") {
  const char* const family = "\"gap[i in 1..NN]\" = \"x >= -i\"";
  check_told(point_on_floor({{9, family}}), {"9:14: constraints: \"NN\" is unknown; "});
  check_told(point_on_floor({{9, R"("gap[\u0069 in 1..NN]" = "x >= -i")"}}), {"9:19: constraints: \"NN\" "});
  check_told(
      R"({"system": {"coordinates": ["x"], "kinetic": "x'^2", "constraints": {"gap[\u0069 in 1..N]": "x>=0"}},)"
      R"("state": {"position": {"x": 0}}})",
      {"1:88: constraints: \"N\" is unknown; "});
}

TEST_CASE("a place behind an escape of JSON is that in the file, and columns count characters") {
  const auto of_kinetic = [](const std::string& kinetic) {
    return "{\"title\": \"\u00e9\", \"system\": {\"coordinates\": [\"x\"], \"kinetic\": \"" + kinetic +
           "\"},\n\"state\": {\"position\": {\"x\": 0, \"y\": 0}}}";
  };
  const std::string no_y = "2:32: position: \"y\" is no coordinate; ";
  check_told(of_kinetic("x'^2 + yy"), {"1:68: kinetic: \"yy\" is unknown; ", no_y});
  check_told(of_kinetic("x\\u0027^2 +\\tyy\\u002azz"),
             {"1:74: kinetic: \"yy\" is unknown; ", "1:82: kinetic: \"zz\" is unknown; ", no_y});
}

TEST_CASE("a backslash in a literal string is no escape, whatever the line breaks of the file are") {
  for (const char* text :
       {"a = '\\t+\\n'", "a = '''\\t+\\n'''", "a = '''\n\\t+\\n'''", "a = '''\r\n\\t+\\n'''"}) {
    CAPTURE(text);
    const cli::TomlValue table = cli::parse_toml(text);
    CHECK(table.table[0].value.text == "\\t+\\n");
    CHECK(table.table[0].value.content.jumps.empty());
  }
  CHECK(cli::parse_toml("a = \"\"\"\r\n\\t+\\n\"\"\"").table[0].value.content.jumps.size() == 2);
}

TEST_CASE("what is looked at of a constraint that is a power is told with what is wrong of it") {
  check_told(point_on_floor({{9, "floor = \"y^2 = 0\""}, {12, "velocity = { x = 1.0, y = 2.0 }"}}),
             {"9:1: constraint floor: two-sided, and read as y = 0, of which it is a power, but df/dt = 2 "});
}

TEST_CASE("what follows from a mistake is not told as another one") {
  // Names and tables that stand below a key with a wrong name are missed by nothing.
  check_told(point_on_floor({{5, "[system.paramters]"}}), {"5:9: unknown key \"paramters\" in [system]; "});
  check_told(point_on_floor({{10, "[stat]"}}), {"10:2: unknown key \"stat\"; "});
  check_told(point_on_floor({{1, "[sistem]"}, {5, "[sistem.parameters]"}, {8, "[sistem.constraints]"}}),
             {"1:2: unknown key \"sistem\"; "});
  check_told(point_on_floor({{2, "coordinate = [\"x\", \"y\"]"}}),
             {"2:1: unknown key \"coordinate\" in [system]; "});
  check_told(point_on_floor({{6, "\"m-1\" = 2.0"}}), {"6:3: "});
}

TEST_CASE("the object of an error has the first one, and all of them as a list") {
  const Outcome outcome =
      run_json_on("solve", point_on_floor({{4, "potential = \"m*g*yy\""}, {14, "untill = 2"}}));
  CHECK(outcome.code == 2);
  const Json error = Json::parse(outcome.out);
  CHECK(error.at("status") == "error");
  CHECK(error.at("line") == 4);
  REQUIRE(error.at("errors").size() == 2);
  CHECK(error.at("errors")[0].at("message") == error.at("message"));
  CHECK(error.at("errors")[1].at("line") == 14);
  std::string many = "[system]\ncoordinates = [\"x\"]\nkinetic = \"x'^2\"\n[state]\nposition = { x = 0 }\n";
  for (int k = 0; k < 30; ++k) many += "key" + std::to_string(k) + " = 1\n";
  const Outcome crowd = run_json_on("solve", many);
  CHECK(Json::parse(crowd.out).at("errors").size() == 20);
  CHECK(crowd.err.find(": and 10 more; ") != std::string::npos);
}
