#include <algorithm>
#include <cmath>
#include <iterator>

#include "cli/report/atlas_report.hpp"
#include "convex/exact/fraction_arithmetic.hpp"

namespace cli::inline reports {

using convex::atlas::Probability;
using convex::atlas::Wall;

namespace {

/// The root of a fraction >= 0 that no double need be near.
double root(convex::Fraction square) {
  int halvings = 0;
  constexpr int step = 200;
  const convex::Fraction factor = convex::fraction(std::ldexp(1, 2 * step));
  for (; std::isinf(convex::nearest_double(square)); halvings += step) square = square / factor;
  for (; sign(square) > 0 && convex::nearest_double(square) < 1 / std::ldexp(1, 2 * step); halvings -= step)
    square = square * factor;
  return std::ldexp(std::sqrt(convex::nearest_double(square)), halvings);
}

}  // namespace

std::vector<std::string> SolvedAtlas::names(const convex::atlas::Cell& cell) const {
  std::vector<std::string> found;
  for (const std::size_t a : cell.rows) found.push_back(contacts[a]);
  return found;
}

std::vector<std::size_t> SolvedAtlas::culprits() const {
  std::vector<std::size_t> found;
  for (std::size_t a = 0; a < farkas.size(); ++a)
    if (!farkas[a].is_zero()) found.push_back(a);
  return found;
}

Probability SolvedAtlas::sum() const {
  Probability total;
  for (const Probability& p : probabilities) add(total, 1, p);
  return total;
}

bool SolvedAtlas::is_accurate() const {
  return std::all_of(probabilities.begin(), probabilities.end(),
                     [this](const Probability& p) { return p.error <= tolerance; });
}

std::vector<AtlasMargin> margins(const SolvedAtlas& solved) {
  std::vector<AtlasMargin> found;
  if (solved.here.empty()) return found;
  const std::size_t here = solved.here.front();
  const auto& cells = solved.atlas.cells;
  for (const std::size_t w : cells[here].walls) {
    const Wall& wall = solved.atlas.walls[w];
    AtlasMargin margin;
    margin.cell = wall.tighter == here ? wall.looser : wall.tighter;
    const convex::Fraction side = convex::atlas::side(wall, solved.z);
    margin.distance = root(side * side / wall.squared_length);
    const auto &now = cells[here].rows, &then = cells[margin.cell].rows;
    std::set_difference(then.begin(), then.end(), now.begin(), now.end(), std::back_inserter(margin.closing));
    std::set_difference(now.begin(), now.end(), then.begin(), then.end(), std::back_inserter(margin.opening));
    found.push_back(std::move(margin));
  }
  std::stable_sort(found.begin(), found.end(),
                   [](const AtlasMargin& a, const AtlasMargin& b) { return a.distance < b.distance; });
  return found;
}

}  // namespace cli::inline reports
