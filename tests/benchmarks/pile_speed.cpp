// Processor time of time-stepping on a pile of discs, neighbours as given constraints: at rest on a flat
// floor, where the set of contacts stays, and let go with gaps between them on a floor that shakes, where it
// changes in every step. Steps a second of processor time, and how many contacts come or go in a step.
//   build/tests/benchmarks/pile_speed [DISCS [STEPS] | --smoke]
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <ctime>
#include <string_view>

#include "mechanics/motion/motion.hpp"

namespace {

using convex::Index;
using convex::Vector;

/// Discs of diameter 1 in rows, each second one shifted by a half; x of disc i is coordinate 2 i.
struct Pile {
  Index columns, rows;
  double gap;  ///< between neighbours

  Index discs() const { return columns * rows; }
  double x(Index i) const {
    return (1 + gap) * (static_cast<double>(i % columns) + ((i / columns) % 2 == 0 ? 0.0 : 0.5));
  }
  double y(Index i) const { return (1 + gap) * std::sqrt(0.75) * static_cast<double>(i / columns); }
};

mechanics::LagrangianText text_of(const Pile& pile, const std::string& floor) {
  mechanics::LagrangianText text;
  text.potential = mechanics::Text{"", {}};
  const auto name = [](char axis, Index i) { return fmt::format("{}{}", axis, i); };
  for (Index i = 0; i < pile.discs(); ++i) {
    text.coordinates.push_back({name('x', i), {}});
    text.coordinates.push_back({name('y', i), {}});
    text.kinetic.text += fmt::format("{}({}'^2 + {}'^2)/2", i > 0 ? "+" : "", name('x', i), name('y', i));
    text.potential->text += fmt::format("{}9.81*{}", i > 0 ? "+" : "", name('y', i));
    const auto above = [&](const std::string& label, const std::string& f) {
      text.constraints.push_back({{label, {}}, {f, {}}});
    };
    const auto apart = [&](Index j) {
      above(fmt::format("c{}_{}", i, j), fmt::format("(({1} - {0})^2 + ({3} - {2})^2 - 1)/2 >= 0",
                                                     name('x', i), name('x', j), name('y', i), name('y', j)));
    };
    const Index column = i % pile.columns, row = i / pile.columns;
    const bool is_shifted = row % 2 == 1;
    if (row == 0) above(fmt::format("floor{}", i), name('y', i) + " >= " + floor);
    if (column == 0) above(fmt::format("left{}", i), name('x', i) + (is_shifted ? " >= 0.5" : " >= 0"));
    if (column + 1 == pile.columns)
      above(fmt::format("right{}", i), fmt::format("{} <= {:.17g}", name('x', i), pile.x(i)));
    if (column + 1 < pile.columns) apart(i + 1);
    if (row + 1 == pile.rows) continue;
    const Index up = i + pile.columns + (is_shifted ? 0 : -1);
    if (is_shifted || column > 0) apart(up);
    if (!is_shifted || column + 1 < pile.columns) apart(up + 1);
  }
  return text;
}

void run(const char* name, const Pile& pile, const std::string& floor, double speed, int steps) {
  const auto system = mechanics::lagrangian_system(text_of(pile, floor));
  mechanics::State start{0, Vector(2 * pile.discs()), Vector::Zero(2 * pile.discs())};
  std::uint32_t random = 1;
  const auto draw = [&] {
    random = random * 1664525U + 1013904223U;
    return static_cast<double>(random) / 4294967296.0 - 0.5;
  };
  for (Index i = 0; i < pile.discs(); ++i) {
    start.q[2 * i] = pile.x(i);
    start.q[2 * i + 1] = pile.y(i);
    start.v[2 * i] = speed * draw();
    start.v[2 * i + 1] = speed * draw();
  }
  mechanics::MotionOptions options;
  options.method = mechanics::MotionMethod::time_stepping;
  options.step = 1e-3;
  options.contact_tolerance = Vector::Constant(static_cast<Index>(system->constraints().size()), 1e-9);
  mechanics::Motion motion(*system, start, options);
  std::vector<bool> pushed(system->constraints().size());
  long changed = 0, pushing = 0;
  // To an end far away: all steps are then of one length to the last digit, and rest is the same problem
  // again.
  const auto advance = [&] { return motion.advance(1e3 * options.step * steps); };
  if (!advance()) fmt::print("{}: {}\n", name, motion.why());
  double seconds = 0;
  for (int k = 1; k <= steps; ++k) {
    const std::clock_t from = std::clock();
    if (!advance()) {
      fmt::print("{}: {}\n", name, motion.why());
      break;
    }
    seconds += static_cast<double>(std::clock() - from) / CLOCKS_PER_SEC;
    pushing = 0;
    for (std::size_t a = 0; a < pushed.size(); ++a) {
      const bool pushes = motion.multipliers()[static_cast<Index>(a)] > 0;
      changed += pushes != pushed[a];
      pushing += pushes;
      pushed[a] = pushes;
    }
  }
  fmt::print(
      "{:<10} {:>6} discs {:>6} rows {:>6} push, {:>8.1f} change a step: {:>8.3f} steps a second; "
      "penetration {:.1e}, energy by corrections {:.1e}\n",
      name, pile.discs(), pushed.size(), pushing, static_cast<double>(changed) / steps,
      static_cast<double>(motion.record().steps - 1) / seconds, motion.record().largest_penetration,
      motion.record().correction_energy);
  for (const auto& remark : motion.record().remarks) fmt::print("  at {}: {}\n", remark.t, remark.what);
}

}  // namespace

int main(int count, char** arguments) {
  const bool smoke = count > 1 && std::string_view(arguments[1]) == "--smoke";
  const int discs = smoke ? 100 : count > 1 ? std::max(4, std::atoi(arguments[1])) : 10'000;
  const int steps = smoke ? 5 : count > 2 ? std::max(1, std::atoi(arguments[2])) : 20;
  const auto side = static_cast<Index>(std::lround(std::sqrt(discs)));
  const std::string_view only = count > 3 ? arguments[3] : "";
  const auto wanted = [&](std::string_view name) { return only.empty() || only == name; };
  if (wanted("rest")) run("rest", {side, side, 0}, "0", 0, steps);
  if (wanted("loose")) run("loose", {side, side, 1e-3}, "0.01*sin(60*t)", 0.5, steps);
  if (wanted("close")) run("close", {side, side, 1e-6}, "0.001*(1 - cos(60*t))", 0.01, steps);
  if (wanted("packed")) run("packed", {side, side, 0}, "0.001*(1 - cos(60*t))", 0.01, steps);
}
