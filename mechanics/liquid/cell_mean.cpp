#include "mechanics/liquid/cell_mean.hpp"

#include <algorithm>

namespace mechanics::liquid {
namespace {

/// Halvings of a cell that a jump passes, by dimension; corners at the end halve the error once more.
constexpr std::array<int, 3> most_halvings{16, 6, 3};

}  // namespace

using convex::Index;

CellMean::CellMean(const Field& field, const Domain& domain, const CutCells& cells)
    : field_(field), domain_(domain), cells_(cells) {
  if (!field.has_branches()) return;
  const auto& n = cells.grid.points;
  branches_.assign(static_cast<std::size_t>(cells.grid.size()), 0);
  for (Index c = 0; c < n[2]; ++c)
    for (Index b = 0; b < n[1]; ++b)
      for (Index a = 0; a < n[0]; ++a) {
        const Index k = cells.grid.at(a, b, c);
        branches_[static_cast<std::size_t>(k)] = field.branches(cells.at(k));
      }
}

bool CellMean::is_at_jump(Index k) const {
  if (branches_.empty()) return false;
  const convex::CutGrid& grid = cells_.grid;
  const std::array<Index, 3> middle = cells_.place(k);
  std::array<Index, 3> low{}, high{};
  for (std::size_t i = 0; i < grid.dimension; ++i) {
    low[i] = std::max<Index>(0, middle[i] - 1);
    high[i] = std::min<Index>(grid.points[i] - 1, middle[i] + 1);
  }
  const std::uint64_t here = branches_[static_cast<std::size_t>(k)];
  for (Index c = low[2]; c <= high[2]; ++c)
    for (Index b = low[1]; b <= high[1]; ++b)
      for (Index a = low[0]; a <= high[0]; ++a)
        if (branches_[static_cast<std::size_t>(grid.at(a, b, c))] != here) return true;
  return false;
}

double CellMean::operator()(Index k, const Point& x) const {
  if (!is_at_jump(k)) return field_(x);
  const Point node = cells_.at(k);
  Point low = node, high = node;
  for (std::size_t i = 0; i < domain_.dimension; ++i) {
    low[i] = std::max(node[i] - 0.5 * cells_.step[i], domain_.low[i]);
    high[i] = std::min(node[i] + 0.5 * cells_.step[i], domain_.high[i]);
  }
  Sum sum;
  add(low, high, 0, sum);
  return sum.volume > 0 ? sum.total / sum.volume : field_(x);
}

void CellMean::add(const Point& low, const Point& high, int halvings, Sum& sum) const {
  const std::size_t d = domain_.dimension;
  const unsigned corners = 1U << d;
  const auto corner = [&](unsigned code) {
    Point x{};
    for (std::size_t i = 0; i < d; ++i) x[i] = (code >> i & 1U) != 0 ? high[i] : low[i];
    return x;
  };
  Point middle{};
  double volume = 1;
  for (std::size_t i = 0; i < d; ++i) {
    middle[i] = 0.5 * (low[i] + high[i]);
    volume *= high[i] - low[i];
  }
  const std::uint64_t here = field_.branches(middle);
  bool is_one = true;
  for (unsigned code = 0; code < corners && is_one; ++code) is_one = field_.branches(corner(code)) == here;
  if (is_one) return offer(middle, volume, sum);
  if (halvings == most_halvings[d - 1]) {
    for (unsigned code = 0; code < corners; ++code) offer(corner(code), volume / corners, sum);
    return;
  }
  for (unsigned code = 0; code < corners; ++code) {
    Point from = low, to = high;
    for (std::size_t i = 0; i < d; ++i) ((code >> i & 1U) != 0 ? from : to)[i] = middle[i];
    add(from, to, halvings + 1, sum);
  }
}

void CellMean::offer(const Point& x, double volume, Sum& sum) const {
  if (domain_.level(x) > domain_.reach()) return;
  sum.total += volume * field_(x);
  sum.volume += volume;
}

}  // namespace mechanics::liquid
