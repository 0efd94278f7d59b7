#include "mechanics/liquid/inequality_box.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "convex/invalid_input.hpp"

namespace mechanics::liquid {
namespace {

constexpr double far = 1e9, near = 1e-9;

double level_or_outside(const Domain& domain, const Point& x) {
  try {
    return domain.level(x);
  } catch (const convex::InvalidInput&) {
    return std::numeric_limits<double>::infinity();
  }
}

/// Steps along axes and diagonals that double after a success and halve after a failure.
Point lowest(const Domain& domain, Point x, double step) {
  double level = level_or_outside(domain, x);
  while (step > near && !(level < 0)) {
    bool better = false;
    for (int code = 0; code < 27 && !better; ++code) {
      Point y = x;
      int rest = code;
      for (std::size_t i = 0; i < domain.dimension; ++i, rest /= 3) y[i] += step * (rest % 3 - 1);
      if (const double there = level_or_outside(domain, y); there < level) {
        level = there;
        x = y;
        better = true;
      }
    }
    step *= better ? 2 : 0.5;
    if (step > far) break;
  }
  return x;
}

/// Calls found(x) for points of a grid of n cells a side.
template <class Found>
void for_grid(const Domain& domain, const Point& low, const Point& high, int n, Found found) {
  const auto axis = [&](std::size_t i) { return i < domain.dimension ? n : 0; };
  for (int a = 0; a <= axis(0); ++a)
    for (int b = 0; b <= axis(1); ++b)
      for (int c = 0; c <= axis(2); ++c) {
        const std::array<int, 3> k{a, b, c};
        Point x{};
        for (std::size_t i = 0; i < domain.dimension; ++i) x[i] = low[i] + (high[i] - low[i]) * k[i] / n;
        if (level_or_outside(domain, x) <= 0) found(x);
      }
}

/// Samples miss a thin wedge. Regions beside the box are halved until the level is proved to be above 0 in
/// them; the box grows to hold those that remain when they are small. Whether it is to be done again: regions
/// were left open, and points of the domain were met in those before them, which the box holds now.
bool take_in_what_is_beyond(Domain& domain) {
  constexpr std::size_t most_regions = 100000;
  constexpr double small = 1e-3;
  const std::size_t d = domain.dimension;
  const double width = small * domain.longest();
  std::vector<Region> open;
  for (std::size_t i = 0; i < d; ++i)
    for (const bool is_high : {false, true}) {
      Region beside{};
      for (std::size_t j = 0; j < d; ++j)
        beside[j] = j < i ? expression::Range{domain.low[j], domain.high[j]} : expression::Range{-far, far};
      beside[i] = is_high ? expression::Range{domain.high[i], far} : expression::Range{-far, domain.low[i]};
      open.push_back(beside);
    }
  std::vector<Region> remaining;
  std::vector<Point> met;
  for (std::size_t tried = 0; !open.empty(); ++tried) {
    if (tried == most_regions) {  // intervals do not tell
      for (const Point& x : met)
        for (std::size_t i = 0; i < d; ++i) {
          domain.low[i] = std::min(domain.low[i], x[i]);
          domain.high[i] = std::max(domain.high[i], x[i]);
        }
      return !met.empty();
    }
    Region here = open.back();
    open.pop_back();
    const expression::Range level = domain.condition->range(here);
    if (level.low > 0 || level.is_empty()) continue;
    std::size_t widest = 0;
    for (std::size_t i = 1; i < d; ++i)
      if (here[i].high - here[i].low > here[widest].high - here[widest].low) widest = i;
    if (here[widest].high - here[widest].low <= width) {
      remaining.push_back(here);
      continue;
    }
    const double middle = 0.5 * (here[widest].low + here[widest].high);
    Point x{};
    for (std::size_t i = 0; i < d; ++i) x[i] = 0.5 * (here[i].low + here[i].high);
    if (level_or_outside(domain, x) < 0) met.push_back(x);
    Region other = here;
    here[widest].high = middle;
    other[widest].low = middle;
    open.push_back(here);
    open.push_back(other);
  }
  for (const Region& one : remaining)
    for (std::size_t i = 0; i < d; ++i) {
      domain.low[i] = std::min(domain.low[i], one[i].low);
      domain.high[i] = std::max(domain.high[i], one[i].high);
    }
  return false;
}

}  // namespace

void find_box(Domain& domain, convex::Place place) {
  const std::size_t d = domain.dimension;
  Point inside{};
  bool is_found = false;
  for (const double step : {1.0, 1e-3, 1e3, 1e6})
    for (const double start : {0.0, 0.37, -0.41, 5.3, -7.1}) {
      if (is_found) break;
      Point x{};
      for (std::size_t i = 0; i < d; ++i) x[i] = start * (1 + 0.11 * static_cast<double>(i));
      x = lowest(domain, x, step);
      is_found = level_or_outside(domain, x) < 0;
      if (is_found) inside = x;
    }
  if (!is_found)
    throw convex::InvalidInput(
        "domain: no point fulfils the inequalities, it is empty; where there is one, give "
        "a box around it, low = [...] and high = [...]",
        place);
  const int n = d == 1 ? 400 : d == 2 ? 80 : 24;
  // The box grows until no side of it, nor a box of twice its size, meets more of the domain.
  double size = 1e-3;
  for (;; size *= 2) {
    if (size > far)
      throw convex::InvalidInput("domain: it does not end; add inequalities that bound it", place);
    Point low{}, high{};
    for (std::size_t i = 0; i < d; ++i) {
      low[i] = inside[i] - 4 * size;
      high[i] = inside[i] + 4 * size;
    }
    bool beyond = false;
    for_grid(domain, low, high, n, [&](const Point& x) {
      for (std::size_t i = 0; i < d; ++i) beyond = beyond || std::abs(x[i] - inside[i]) > size;
    });
    if (!beyond) break;
  }
  // What lies between the size and the next points of that grid is in it as well.
  Point low{}, high{};
  for (std::size_t i = 0; i < d; ++i) {
    low[i] = inside[i] - size * (1 + 8.0 / n);
    high[i] = inside[i] + size * (1 + 8.0 / n);
  }
  for (int round = 0; round < 8; ++round) {
    Point least = inside, largest = inside, cell{};
    for (std::size_t i = 0; i < d; ++i) cell[i] = (high[i] - low[i]) / n;
    for_grid(domain, low, high, n, [&](const Point& x) {
      for (std::size_t i = 0; i < d; ++i) {
        least[i] = std::min(least[i], x[i]);
        largest[i] = std::max(largest[i], x[i]);
      }
    });
    for (std::size_t i = 0; i < d; ++i) {
      low[i] = std::max(low[i], least[i] - cell[i]);
      high[i] = std::min(high[i], largest[i] + cell[i]);
    }
  }
  domain.low = low;
  domain.high = high;
  constexpr int most_rounds = 50;
  for (int round = 0; round < most_rounds && take_in_what_is_beyond(domain); ++round) {
  }
}

}  // namespace mechanics::liquid
