#include <doctest/doctest.h>

#include <cmath>
#include <fstream>
#include <map>
#include <sstream>

#include "cli/drawing/branch_drawing.hpp"
#include "cli/drawing/gnuplot.hpp"
#include "tests/cli/program.hpp"

using namespace tests;

namespace {

struct Row {
  double value, period, largest;
  bool stable;
  int impacts;
  std::string event;
};

/// x'' = -x - 0.2 x' + F cos(w t + phi), with a stop at 1/2.
std::string oscillator_with_stop(const std::string& parameters, const std::string& e, const std::string& x) {
  return "[system]\ncoordinates = [\"x\"]\nkinetic = \"x'^2/2\"\npotential = "
         "\"x^2/2\"\n[system.parameters]\n" +
         parameters +
         "\n[system.forces]\nx = \"F*cos(w*t + phi) - 0.2*x'\"\n[system.constraints]\nstop = \"x <= 0.5\"\n"
         "[simulate]\nrestitution = " +
         e + "\n[state]\nposition = { x = " + x + " }\n";
}

std::vector<Row> branch(const std::string& text, const std::vector<std::string>& arguments, int code = 0) {
  const Folder folder;
  const std::string csv = folder.path("b.csv");
  std::vector<std::string> all{"orbit", folder.write("o.toml", text), "--output", csv};
  all.insert(all.end(), arguments.begin(), arguments.end());
  const Outcome outcome = run(all);
  CAPTURE(outcome.err);
  CHECK(outcome.code == code);
  std::vector<Row> rows;
  std::ifstream file(csv);
  std::string line;
  std::getline(file, line);
  while (std::getline(file, line)) {
    std::istringstream cells(line + ",");
    std::vector<std::string> cell;
    for (std::string one; std::getline(cells, one, ',');) cell.push_back(one);
    rows.push_back({std::stod(cell[0]), std::stod(cell[1]), cell[3].empty() ? 0 : std::stod(cell[3]),
                    cell[2] == "1", std::stoi(cell[4]), cell[5]});
  }
  return rows;
}

}  // namespace

TEST_CASE("a branch is followed through its folds, to the other end of the range") {
  // Duffing's oscillator: three orbits where the resonance overhangs.
  const std::string duffing =
      "[system]\ncoordinates = [\"x\"]\nkinetic = \"x'^2/2\"\npotential = \"x^2/2 + x^4/4\"\n"
      "[system.parameters]\nw = 1.3\n[system.forces]\nx = \"0.5*cos(w*t) - 0.1*x'\"\n"
      "[state]\nposition = { x = 1.1 }\n";
  const std::vector<Row> rows = branch(duffing, {"--period", "2*pi/w", "--over", "w=1.3:0.1:2.4"});
  REQUIRE(rows.size() > 20);
  CHECK(rows.back().value == doctest::Approx(2.4));
  std::vector<double> folds;
  std::map<long, int> orbits_at;
  for (const Row& row : rows) {
    CAPTURE(row.value);
    if (row.event == "fold") {
      folds.push_back(row.value);
      CHECK(std::abs(row.largest - 1) <= 0.1);
      continue;
    }
    CHECK(row.event.empty());
    ++orbits_at[std::lround(10 * row.value)];
    // Liouville: the product of the multipliers is exp(-0.1 T); a stable pair is complex.
    if (row.stable)
      CHECK(std::abs(row.largest - std::exp(-0.05 * row.period)) <= 1e-9);
    else
      CHECK(folds.size() == 1);
  }
  REQUIRE(folds.size() == 2);
  CHECK(folds[0] > 2.2);
  CHECK(folds[1] < 1.5);
  CHECK(orbits_at[18] == 3);
  CHECK(orbits_at[13] == 1);
  CHECK(orbits_at[24] == 1);
}

TEST_CASE("a branch is drawn with its unstable part and its events, and nothing but a branch") {
  const std::string duffing =
      "[system]\ncoordinates = [\"x\"]\nkinetic = \"x'^2/2\"\npotential = \"x^2/2 + x^4/4\"\n"
      "[system.parameters]\nw = 1.3\n[system.forces]\nx = \"0.5*cos(w*t) - 0.1*x'\"\n"
      "[state]\nposition = { x = 1.1 }\n";
  const Folder folder;
  const std::string file = folder.write("o.toml", duffing), picture = folder.path("b.svg");
  CHECK(run({"orbit", file, "--period", "2*pi/w", "--plot", picture}).code == 2);
  if (!cli::has_gnuplot()) return;
  branch(duffing, {"--period", "2*pi/w", "--over", "w=1.3:0.1:2.4", "--plot", picture});
  std::stringstream drawn;
  drawn << std::ifstream(picture).rdbuf();
  for (const char* words : {"x, unstable", "fold", "largest", "w"})
    CHECK_MESSAGE(drawn.str().find(words) != std::string::npos, words);
}

TEST_CASE("a velocity that jumps where an impact passes the instant of the start is not joined to itself") {
  struct Passed {
    std::vector<double> before, after;  ///< phases of impacts in a period of 2
    long interruptions;
  };
  for (const Passed& one : {Passed{{0.02}, {0.99}, 1}, Passed{{0.99}, {0.02}, 1}, Passed{{0.45}, {0.55}, 0},
                            Passed{{}, {}, 0}, Passed{{0.01, 0.5}, {0.49, 0.98}, 1},
                            Passed{{0.1, 0.5}, {0.05, 0.4}, 0}, Passed{{0.5}, {0.5, 0.6}, 0}}) {
    std::vector<cli::BranchPoint> points(2);
    for (std::size_t k = 0; k < 2; ++k) {
      mechanics::Orbit& orbit = points[k].orbit;
      points[k].value = static_cast<double>(k);
      orbit.start.t = 3;
      orbit.start.q = orbit.start.v = convex::Vector::Constant(1, static_cast<double>(k));
      orbit.period = 2;
      orbit.is_stable = true;
      orbit.multipliers = {{0.5, 0.0}};
      for (const double phase : k == 0 ? one.before : one.after) {
        orbit.impacts.emplace_back();
        orbit.impacts.back().t = orbit.start.t + orbit.period * phase;
      }
    }
    const std::string script = cli::branch_drawing(points, {"x"}, "w", "").script;
    long interruptions = 0;
    for (std::size_t at = 0; (at = script.find(" NaN ", at)) != std::string::npos; ++at) ++interruptions;
    CAPTURE(one.before.size());
    CHECK(interruptions == one.interruptions);
  }
}

TEST_CASE(
    "towards a graze the multiplier of orbits with the impact is not joined to that of orbits without it") {
  const auto point = [](double value, int impacts, double multiplier, bool is_stable, const char* event) {
    cli::BranchPoint made;
    made.value = value;
    made.orbit.start.q = made.orbit.start.v = convex::Vector::Constant(1, 1);
    made.orbit.period = 2;
    made.orbit.is_stable = is_stable;
    made.orbit.multipliers = {{multiplier, 0.0}};
    made.event = event;
    for (int k = 0; k < impacts; ++k) made.orbit.impacts.emplace_back().t = 1;
    return made;
  };
  // Without the impact, stable up to the graze; with it unstable up to a flip, and stable after it.
  const std::string script =
      cli::branch_drawing({point(1, 0, 0.4, true, ""), point(2, 0, 0.4, true, "grazing"),
                           point(3, 1, 1, false, "flip"), point(4, 1, 0.3, true, "")},
                          {"x"}, "w", "")
          .script;
  CHECK(script.find("$stable << EOD\n1 1 1 0.4\n2 1 1 0.4\n\n3 1 1 1\n4 1 1 0.3\nEOD") != std::string::npos);
  CHECK(script.find("$unstable << EOD\n2 1 1 0.4\n2 1 1 NaN\n3 1 1 1\nEOD") != std::string::npos);
}

TEST_CASE("a branch of one orbit is a mark, and a picture") {
  cli::BranchPoint only;
  only.value = 1;
  only.orbit.start.q = only.orbit.start.v = convex::Vector::Constant(1, 1);
  only.orbit.is_stable = true;
  const std::string script = cli::branch_drawing({only}, {"x"}, "w", "").script;
  CHECK(script.find("$stable << EOD\n1 1 1 NaN\nEOD") != std::string::npos);
  CHECK(script.find("with linespoints") != std::string::npos);
}

TEST_CASE("a flip is told where the multiplier of the closed form is -1") {
  // A ball on a shaken table, once a period: with the flight time T = 2 pi/w the relative speed after an
  // impact is g T/(1 + e) ... e g T/(1 + e), and the trace of the map is 1 + e^2 - (1 + e)^2 A w^2
  // sin(phase)/g.
  const double g = 9.81, e = 0.5, A = 0.01, pi = std::acos(-1.0);
  const auto cosine = [&](double w) { return (1 - e) / (1 + e) * pi * g / (A * w * w); };
  const auto gap_to_flip = [&](double w) {
    const double sine = std::sqrt(1 - cosine(w) * cosine(w));
    return 1 + e * e + (1 + e * e - (1 + e) * (1 + e) * A * w * w * sine / g);
  };
  double low = 33, high = 45;
  for (int i = 0; i < 100; ++i) (gap_to_flip(0.5 * (low + high)) > 0 ? low : high) = 0.5 * (low + high);
  const double w = 33, phase = std::acos(cosine(w)), t = phase / w,
               up = A * w * std::cos(phase) + e * g * 2 * pi / w / (1 + e);
  std::ostringstream text;
  text.precision(17);
  text << "[system]\ncoordinates = [\"y\"]\nkinetic = \"y'^2/2\"\npotential = "
          "\"9.81*y\"\n[system.parameters]\nw = 33\n"
       << "[system.constraints]\ntable = \"y >= 0.01*sin(w*t)\"\n[simulate]\nrestitution = 0.5\n[state]\nt = "
          "0.1\n"
       << "position = { y = " << A * std::sin(phase) + up * (0.1 - t) - g / 2 * (0.1 - t) * (0.1 - t)
       << " }\n"
       << "velocity = { y = " << up - g * (0.1 - t) << " }\n";
  const std::vector<Row> rows = branch(text.str(), {"--period", "2*pi/w", "--over", "w=33:0.5:39"});
  bool is_told = false;
  for (const Row& row : rows) {
    CHECK((row.event.empty() || row.event == "flip"));
    CHECK(row.impacts == 1);
    if (row.event != "flip") continue;
    is_told = true;
    CHECK(std::abs(row.value - low) <= 1e-10);
    CHECK(std::abs(row.largest - 1) <= 1e-11);
  }
  CHECK(is_told);
}

TEST_CASE("an orbit whose multipliers lie on the unit circle is not stable, and passes nothing") {
  // Without damping x = cos(w t)/(1 - w²) is an orbit with the multipliers exp(±2 pi i/w), whatever w is.
  const std::string free =
      "[system]\ncoordinates = [\"x\"]\nkinetic = \"x'^2/2\"\npotential = \"x^2/2\"\n"
      "[system.parameters]\nw = 1.2\n[system.forces]\nx = \"cos(w*t)\"\n[state]\nposition = { x = -2.2 }\n";
  for (const Row& row : branch(free, {"--period", "2*pi/w", "--over", "w=1.2:0.1:2.9"})) {
    CHECK_FALSE(row.stable);
    CHECK(row.event == "");
  }
  // Two multipliers outside the circle that meet on the real line and leave it as a pair cross nothing.
  const std::string driven =
      "[system]\ncoordinates = [\"x\"]\nkinetic = \"x'^2/2\"\npotential = \"k*x^2/2\"\n"
      "[system.parameters]\nk = 0.05\n[system.forces]\nx = \"cos(t) + 0.5*x'\"\n[state]\nposition = { x = 0 "
      "}\n";
  for (const Row& row : branch(driven, {"--period", "2*pi", "--over", "k=0.05:0.005:0.08"}))
    CHECK(row.event == "");
}

TEST_CASE("a branch goes on where an impact, a rest or a release passes the time of its start") {
  // The phase of the forcing moves the whole orbit in time: nothing else of it changes.
  for (const auto& [parameters, e] :
       {std::pair("F = 1.5\nw = 0.8\nphi = 0", "0.6"), std::pair("F = 1.6\nw = 0.8\nphi = 0", "0")}) {
    const std::vector<Row> rows =
        branch(oscillator_with_stop(parameters, e, "-1"), {"--period", "2*pi/w", "--over", "phi=0:0.3:6.3"});
    REQUIRE(rows.size() == 22);
    for (const Row& row : rows) {
      CHECK(row.event == "");
      CHECK(row.impacts == rows[0].impacts);
      CHECK(row.stable);
      CHECK(std::abs(row.largest - rows[0].largest) <= 1e-12);
    }
  }
}

TEST_CASE("a branch over the restitution has the orbits of each of its values") {
  const std::vector<Row> rows =
      branch(oscillator_with_stop("F = 1.5\nw = 0.8\nphi = 0\nr = 0.6", "\"r\"", "-1"),
             {"--period", "2*pi/w", "--over", "r=0.6:0.15:0.9"});
  REQUIRE(rows.size() == 3);
  for (const Row& row : rows) {
    const std::string e = std::to_string(row.value);
    const Row alone = branch(oscillator_with_stop("F = 1.5\nw = 0.8\nphi = 0", e, "-1"),
                             {"--period", "2*pi/w", "--over", "phi=0:1:0"})
                          .at(0);
    CAPTURE(row.value);
    // Liouville: of free flights exp(-0.2 T), and e^2 of each impact; the multipliers are a complex pair.
    CHECK(std::abs(row.largest - std::exp(-0.1 * row.period) * std::pow(row.value, row.impacts)) <= 1e-12);
    CHECK(std::abs(row.largest - alone.largest) <= 1e-12);
  }
}

TEST_CASE("a graze is told at its closed form, and the branch goes on with the impact") {
  const std::vector<Row> rows = branch(oscillator_with_stop("F = 0.05\nw = 0.7\nphi = 0", "0.8", "0"),
                                       {"--period", "2*pi/w", "--over", "F=0.05:0.1:0.5"});
  const double graze = 0.5 * std::hypot(1 - 0.49, 0.2 * 0.7);
  REQUIRE(rows.size() >= 6);
  CHECK(rows[3].event == "grazing");
  CHECK(std::abs(rows[3].value - graze) <= 1e-12);
  CHECK(rows.back().impacts == 1);
}

TEST_CASE("orbits with an impact, unstable, lead to the graze of those without, where the branch turns") {
  const std::string text =
      "[system]\ncoordinates = [\"x\"]\nkinetic = \"x'^2/2\"\npotential = \"x^2/2\"\n[system.parameters]\nd "
      "= 0\n"
      "[system.forces]\nx = \"cos(1.8*t) - 0.1*x'\"\n[system.constraints]\nstop = \"x <= d\"\n"
      "[simulate]\nrestitution = 0.8\n[state]\nposition = { x = -0.1 }\nvelocity = { x = 0.3 }\n";
  const std::vector<Row> rows = branch(text, {"--period", "2*pi/1.8", "--over", "d=0:0.05:1"});
  const double amplitude = 1 / std::hypot(1.8 * 1.8 - 1, 0.1 * 1.8);
  int folds = 0, grazes = 0;
  for (const Row& row : rows) {
    folds += row.event == "fold";
    if (row.event == "grazing") {
      ++grazes;
      CHECK(std::abs(row.value - amplitude) <= 1e-11);
    }
    CHECK(row.impacts == (grazes == 0));
  }
  CHECK(folds == 1);
  CHECK(grazes == 1);
  CHECK(rows.back().value == doctest::Approx(1));
}

TEST_CASE("a branch of twice the period ends where it meets the orbit whose flip it came from") {
  const std::string text =
      "[system]\ncoordinates = [\"x\"]\nkinetic = \"x'^2/2\"\npotential = \"x^2/2\"\n[system.parameters]\nd "
      "= 0.1\n"
      "[system.forces]\nx = \"cos(2.5*t) - 0.1*x'\"\n[system.constraints]\nstop = \"x <= d\"\n"
      "[simulate]\nrestitution = 0.8\n[state]\nposition = { x = -0.3255549131881714 }\n"
      "velocity = { x = 0.048380115709108426 }\n";
  const std::vector<Row> doubled =
      branch(text, {"--period", "2*pi/2.5", "--periods", "2", "--over", "d=0.1:-0.002:0.06"}, 3);
  REQUIRE(!doubled.empty());
  const std::vector<Row> single = branch(text, {"--period", "2*pi/2.5", "--over", "d=0.1:-0.002:0.06"});
  double flip = 0;
  for (const Row& row : single)
    if (row.event == "flip") flip = row.value;
  CHECK(doubled.back().value > flip);
  CHECK(doubled.back().value - 0.002 < flip);
}

TEST_CASE("how many bounces of an accumulation are followed is no event of a branch") {
  const std::string cam =
      "[system]\ncoordinates = [\"y\"]\nkinetic = \"y'^2/2\"\npotential = \"9.81*y + 50*(y+0.1)^2\"\n"
      "[system.parameters]\nn = 30\n[system.constraints]\nfollower = \"y >= 0.02*sin(n*t)^3\"\n"
      "[simulate]\nrestitution = 0.2\n[state]\nposition = { y = 0 }\n";
  const std::vector<Row> rows = branch(cam, {"--period", "2*pi/n", "--over", "n=32:1:36"});
  REQUIRE(rows.size() == 5);
  CHECK(rows.front().impacts != rows.back().impacts);
  for (const Row& row : rows) CHECK(row.event == "");
}

TEST_CASE("where a multiplier passes 1 and the branch does not turn is no fold") {
  // Rest at 0 between two springs, over the stiffness: its symmetry breaks at 0, where two more places of
  // rest appear.
  const std::string pitchfork =
      "[system]\ncoordinates = [\"x\"]\nkinetic = \"x'^2/2\"\npotential = \"x^4/4 - k*x^2/2\"\n"
      "[system.parameters]\nk = -0.25\n[system.forces]\nx = \"-0.5*x'\"\n[state]\nposition = { x = 0 }\n";
  const std::vector<Row> rows = branch(pitchfork, {"--period", "1", "--over", "k=-0.25:0.1:0.3"});
  REQUIRE(rows.size() == 7);
  for (const Row& row : rows) CHECK(row.event == "");
  CHECK(std::abs(rows[3].value) <= 1e-11);
  CHECK(std::abs(rows[3].largest - 1) <= 1e-11);
  const Outcome told = run_on("orbit", pitchfork);
  CHECK(told.code == 2);  // without a period
}
