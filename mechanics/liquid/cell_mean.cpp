#include "mechanics/liquid/cell_mean.hpp"

#include <algorithm>
#include <cmath>

#include "convex/infinity.hpp"

namespace mechanics::liquid {
namespace {

/// Halvings of a cell that a jump passes, by dimension; corners at the end halve the error once more.
constexpr std::array<int, 3> most_halvings{16, 6, 3};
/// What hides in a cell is looked for where it may make more than this part of the pressure.
constexpr double counted_part = 1e-4;
/// Of what is looked for, this part is left to a leaf; or this part of what the whole cell varies by: what
/// varies evenly is known by few leaves, a layer keeps its height until they are as thin as it is.
constexpr double part_of_leaf = 0.05, part_of_cell = 0.25;
/// A box of many cells is passed by if it is as quiet as this.
constexpr double part_of_boxes = 0.01;
/// So many leaves, and so many a node, are taken; intervals that stay wide take no more.
constexpr double most_leaves = 3e5, most_leaves_a_node = 10;

}  // namespace

using convex::Index;

CellMean::CellMean(const Field& field, const Domain& domain, const CutCells& cells, double pressure_scale)
    : field_(field), domain_(domain), cells_(cells), least_counted_(counted_part * pressure_scale) {
  if (!field.is_constant() && !field.is_bound()) {
    Places last{};
    for (std::size_t i = 0; i < last.size(); ++i) last[i] = cells.grid.points[i] - 1;
    halve_places({}, last, [&](const Places& from, const Places& to) { return tells(from, to); });
  }
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

/// The cells around these nodes.
Region CellMean::region_of(const Places& first, const Places& last) const {
  const Point low = cells_.at(cells_.grid.at(first[0], first[1], first[2])),
              high = cells_.at(cells_.grid.at(last[0], last[1], last[2]));
  Region made;
  for (std::size_t i = 0; i < low.size(); ++i)
    made[i] = i < domain_.dimension
                  ? expression::Range{std::max(low[i] - 0.5 * cells_.step[i], domain_.low[i]),
                                      std::min(high[i] + 0.5 * cells_.step[i], domain_.high[i])}
                  : expression::Range{0, 0};
  return made;
}

/// In p, of a cell in which the field has values as in a region: ∫ |h - mean| |s - node| is at most an eighth
/// of width times step², along the longest axis.
double CellMean::largest_hidden(const expression::Range& values) const {
  if (values.is_empty()) return convex::infinity;
  double step = 0;
  for (std::size_t i = 0; i < domain_.dimension; ++i) step = std::max(step, cells_.step[i]);
  return 0.125 * (values.high - values.low) * step * step;
}

/// Marks nodes in whose cells more may hide than counts.
bool CellMean::tells(const Places& first, const Places& last) {
  const double most = largest_hidden(field_.range(region_of(first, last)));
  if (most <= (first == last ? 1 : part_of_boxes) * least_counted_) {
    hidden_ = std::max(hidden_, most);
    return true;
  }
  if (first != last) return false;
  const Index k = cells_.grid.at(first[0], first[1], first[2]);
  if (!cells_.grid.is_unknown(k) || !std::isfinite(most)) return true;  // beside a pole nothing is known
  varies_.resize(static_cast<std::size_t>(cells_.grid.size()));
  varies_[static_cast<std::size_t>(k)] = true;
  return true;
}

/// Pieces of a cell on each of which the field varies little, or of the last depth: with the half of what it
/// varies by, where that is known to be finite.
void CellMean::gather(const Point& low, const Point& high, int halvings, double quiet,
                      std::vector<Leaf>& leaves) const {
  const std::size_t d = domain_.dimension;
  Region at{};
  Leaf leaf;
  leaf.volume = 1;
  for (std::size_t i = 0; i < at.size(); ++i) {
    at[i] = {low[i], high[i]};
    leaf.middle[i] = 0.5 * (low[i] + high[i]);
    if (i < d) leaf.volume *= high[i] - low[i];
  }
  const expression::Range values = field_.range(at);
  const double most = largest_hidden(values);
  if (halvings == 0) quiet = std::max(quiet, part_of_cell * most);
  if (most <= quiet || halvings == most_halvings[d - 1]) {
    if (domain_.level(leaf.middle) > domain_.reach()) return;
    leaf.value = field_(leaf.middle);
    leaf.spread = 0.5 * (values.high - values.low);
    if (!std::isfinite(leaf.spread)) leaf.spread = std::abs(leaf.value);
    leaves.push_back(leaf);
    return;
  }
  for (unsigned code = 0; code < 1U << d; ++code) {
    Point from = low, to = high;
    for (std::size_t i = 0; i < d; ++i) ((code >> i & 1U) != 0 ? from : to)[i] = leaf.middle[i];
    gather(from, to, halvings + 1, quiet, leaves);
  }
}

double CellMean::mean_of_leaves(Index k, const Point& x) {
  const Point node = cells_.at(k);
  Point low{}, high{};
  for (std::size_t i = 0; i < domain_.dimension; ++i) {
    low[i] = std::max(node[i] - 0.5 * cells_.step[i], domain_.low[i]);
    high[i] = std::min(node[i] + 0.5 * cells_.step[i], domain_.high[i]);
  }
  std::vector<Leaf> leaves;
  if (leaves_ > most_leaves + most_leaves_a_node * static_cast<double>(varies_.size())) {
    hidden_ = std::max(hidden_, largest_hidden(field_.range(cell_of(k))));
    return field_(x);
  }
  gather(low, high, 0, part_of_leaf * least_counted_, leaves);
  leaves_ += static_cast<double>(leaves.size());
  double total = 0, volume = 0;
  for (const Leaf& leaf : leaves) {
    total += leaf.volume * leaf.value;
    volume += leaf.volume;
  }
  if (!(volume > 0)) return field_(x);
  const double mean = total / volume;
  for (std::size_t i = 0; i < domain_.dimension; ++i) {
    double moment = 0;
    for (const Leaf& leaf : leaves)
      moment +=
          leaf.volume * (std::abs(leaf.value - mean) + leaf.spread) * std::abs(leaf.middle[i] - node[i]);
    hidden_ = std::max(hidden_, moment / cells_.face_area(i));
  }
  return mean;
}

double CellMean::operator()(Index k, const Point& x) {
  if (field_.is_bound() && field_.has_branches()) return field_.bound_in(cell_of(k));
  if (!is_at_jump(k)) {
    const bool varies = !varies_.empty() && varies_[static_cast<std::size_t>(k)];
    return varies ? mean_of_leaves(k, x) : field_(x);
  }
  const Point node = cells_.at(k);
  Point low = node, high = node;
  for (std::size_t i = 0; i < domain_.dimension; ++i) {
    low[i] = std::max(node[i] - 0.5 * cells_.step[i], domain_.low[i]);
    high[i] = std::min(node[i] + 0.5 * cells_.step[i], domain_.high[i]);
  }
  Sum sum;
  add(low, high, 0, sum);
  if (!(sum.volume > 0)) return field_(x);
  hidden_ = std::max(hidden_, largest_hidden(sum.values));
  return sum.total / sum.volume;
}

/// Where the node, its cell, and the boundary's point that stands for it are.
Region CellMean::cell_of(Index k) const {
  const Point node = cells_.at(k);
  Region made;
  for (std::size_t i = 0; i < node.size(); ++i)
    made[i] = {std::max(node[i] - cells_.step[i], std::min(node[i], domain_.low[i])),
               std::min(node[i] + cells_.step[i], std::max(node[i], domain_.high[i]))};
  return made;
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
  const double value = field_(x);
  sum.total += volume * value;
  sum.volume += volume;
  sum.values = {std::min(sum.values.low, value), std::max(sum.values.high, value)};
}

}  // namespace mechanics::liquid
