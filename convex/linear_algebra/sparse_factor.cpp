#include "convex/linear_algebra/sparse_factor.hpp"

#include <algorithm>
#include <numeric>

namespace convex::linear_algebra {
namespace {

/// Columns are gathered into the panel of their parent when it stays this narrow, or when at most this part
/// of its numbers is zero: a wider panel works faster than a sparser one.
constexpr Index narrow = 8;
constexpr double zero_part = 0.15;

/// Where what a child has to add belongs.
enum class Part { panel, below };

}  // namespace

SparseFactor::SparseFactor(Index n, const std::vector<Place>& places) {
  const Neighbours graph(n, static_cast<Index>(places.size()), [&](Index k) { return places[at(k)]; });
  const Elimination order = elimination_order(graph);
  new_place_ = order.new_place;
  find_panels(order.parent, order.count);
  find_rows(graph, order.old_place);
}

void SparseFactor::find_panels(const std::vector<Index>& parent, const std::vector<Index>& count) {
  const Index n = static_cast<Index>(parent.size());
  struct Run {
    Index first, columns, rows;
    double zeros;
  };
  std::vector<Run> runs;
  for (Index j = 0; j < n; ++j) {
    Run run{j, 1, count[at(j)], 0};
    // Gathers the panel before with this one while its last column is a child of this one's first and little
    // is lost.
    while (!runs.empty()) {
      const Run& last = runs.back();
      if (parent[at(run.first - 1)] != run.first) break;
      const Index columns = last.columns + run.columns, rows = last.columns + run.rows;
      const double zeros =
          last.zeros + run.zeros + static_cast<double>(last.columns) * static_cast<double>(rows - last.rows);
      const double size = static_cast<double>(columns) * static_cast<double>(rows);
      const bool alike = rows == last.rows;
      if (!alike && !(columns <= narrow && zeros < 2 * zero_part * size) &&
          !(zeros < zero_part * size && columns <= 4 * narrow))
        break;
      run = {last.first, columns, rows, zeros};
      runs.pop_back();
      if (!alike) break;
    }
    runs.push_back(run);
  }
  panel_of_.resize(at(n));
  panels_.clear();
  Index values = 0, rows = 0;
  for (const Run& run : runs) {
    Panel panel;
    panel.first = run.first;
    panel.columns = run.columns;
    panel.rows = run.rows;
    panel.values = values;
    panel.row_list = rows;
    for (Index j = 0; j < run.columns; ++j) panel_of_[at(run.first + j)] = static_cast<int>(panels_.size());
    values += run.columns * run.rows;
    rows += run.rows;
    panels_.push_back(panel);
    longest_ = std::max(longest_, run.rows);
  }
  for (Panel& panel : panels_) {
    const Index up = parent[at(panel.first + panel.columns - 1)];
    panel.parent = up < 0 ? -1 : panel_of_[at(up)];
    const double c = static_cast<double>(panel.columns), r = static_cast<double>(panel.rows);
    flops_ += c * r * r - c * c * r + c * c * c / 3;
  }
  values_.assign(at(values + read_beyond), 0.0);
  rows_.assign(at(rows), 0);
}

void SparseFactor::find_rows(const Neighbours& graph, const std::vector<int>& old_place) {
  std::vector<std::vector<int>> children(panels_.size());
  std::vector<Index> seen(old_place.size(), -1), position(old_place.size(), 0);
  for (std::size_t p = 0; p < panels_.size(); ++p) {
    Panel& panel = panels_[p];
    const Index end = panel.first + panel.columns;
    int* list = rows_.data() + panel.row_list;
    Index used = panel.columns;
    std::iota(list, list + panel.columns, static_cast<int>(panel.first));
    const auto take = [&](int i) {
      if (i < end || seen[at(i)] == static_cast<Index>(p)) return;
      seen[at(i)] = static_cast<Index>(p);
      if (used < panel.rows) list[used] = i;
      ++used;
    };
    for (Index j = panel.first; j < end; ++j) {
      const Index vertex = old_place[at(j)];
      for (int k = graph.first[at(vertex)]; k < graph.first[at(vertex) + 1]; ++k)
        take(new_place_[at(graph.list[at(k)])]);
    }
    for (int child : children[p]) {
      const Panel& below = panels_[at(child)];
      for (Index k = below.columns; k < below.rows; ++k) take(rows_[at(below.row_list + k)]);
    }
    std::sort(list + panel.columns, list + panel.rows);
    panel.children = children[p].size();
    if (panel.parent >= 0) children[at(panel.parent)].push_back(static_cast<int>(p));
    for (Index k = 0; k < panel.rows; ++k) position[at(list[k])] = k;
    for (int child : children[p]) {
      Panel& below = panels_[at(child)];
      below.below_in_parent = static_cast<Index>(below_in_parent_.size());
      for (Index k = below.columns; k < below.rows; ++k)
        below_in_parent_.push_back(static_cast<int>(position[at(rows_[at(below.row_list + k)])]));
    }
  }
  for (std::size_t p = panels_.size(); p-- > 0;)
    if (Panel& panel = panels_[p]; panel.parent >= 0) panel.stack = 1 - panels_[at(panel.parent)].stack;
}

std::vector<Index> SparseFactor::slots(const std::vector<Place>& places) const {
  // Panel by panel, so that where a row stands in its list is looked up in a table.
  std::vector<int> first(panels_.size() + 1, 0), of_panel(places.size()), position(new_place_.size());
  const auto column = [&](const Place& place) {
    return std::min(new_place_[at(place.i)], new_place_[at(place.j)]);
  };
  for (const Place& place : places) ++first[at(panel_of_[at(column(place))]) + 1];
  for (std::size_t p = 0; p < panels_.size(); ++p) first[p + 1] += first[p];
  std::vector<int> next(first.begin(), first.end() - 1);
  for (std::size_t k = 0; k < places.size(); ++k)
    of_panel[at(next[at(panel_of_[at(column(places[k]))])]++)] = static_cast<int>(k);
  std::vector<Index> found(places.size());
  for (std::size_t p = 0; p < panels_.size(); ++p) {
    const Panel& panel = panels_[p];
    for (Index k = 0; k < panel.rows; ++k) position[at(rows_[at(panel.row_list + k)])] = static_cast<int>(k);
    for (int k = first[p]; k < first[p + 1]; ++k) {
      const Place& place = places[at(of_panel[at(k)])];
      const int row = std::max(new_place_[at(place.i)], new_place_[at(place.j)]);
      found[at(of_panel[at(k)])] =
          panel.values + (column(place) - panel.first) * panel.rows + position[at(row)];
    }
  }
  return found;
}

bool SparseFactor::factor() {
  // Children stand before their parent, so that their updates are on top of the stack.
  struct Pending {
    const Panel* panel;
    std::size_t begin;
  };
  std::array<std::vector<Pending>, 2> pending;
  std::array<std::size_t, 2> used{};
  for (const Panel& panel : panels_) {
    std::vector<Pending>& children = pending[1 - panel.stack];
    std::vector<double>& theirs = updates_[1 - panel.stack];
    std::vector<double>& own = updates_[panel.stack];
    double* values = values_.data() + panel.values;
    const auto add_children = [&](auto part, double* to, Index stride) {
      for (std::size_t c = children.size() - panel.children; c < children.size(); ++c) {
        const Panel& child = *children[c].panel;
        const int* place = below_in_parent_.data() + child.below_in_parent;
        const double* update = theirs.data() + children[c].begin;
        const Index size = child.below();
        const Index inside = std::lower_bound(place, place + size, panel.columns) - place;
        if (part == Part::panel)
          add_columns(update, size, 0, inside, place, to, stride);
        else
          add_columns(update, size, inside, size, place, to, stride);
      }
    };
    add_children(Part::panel, values, panel.rows);
    if (!factor_panel(values, panel.rows, panel.columns)) return false;
    const Index below = panel.below();
    const std::size_t begin = used[panel.stack], size = at(below * below);
    if (panel.parent >= 0) {
      if (own.size() < begin + size) own.resize(2 * (begin + size));
      double* const update = own.data() + begin;
      outer_product(update, below, values, panel.rows, panel.columns);
      add_children(Part::below, update - panel.columns * (below + 1), below);
    }
    if (panel.children > 0) used[1 - panel.stack] = children[children.size() - panel.children].begin;
    children.resize(children.size() - panel.children);
    if (panel.parent < 0) continue;
    pending[panel.stack].push_back({&panel, begin});
    used[panel.stack] += size;
  }
  return true;
}

Vector SparseFactor::pivots() const {
  Vector found(dimension());
  for (Index i = 0; i < dimension(); ++i) {
    const Index column = new_place_[at(i)];
    const Panel& panel = panels_[at(panel_of_[at(column)])];
    found[i] = values_[at(panel.values + (column - panel.first) * (panel.rows + 1))];
  }
  return found;
}

void SparseFactor::solve(Vector& x) const {
  Vector y(x.size());
  for (Index i = 0; i < x.size(); ++i) y[new_place_[at(i)]] = x[i];
  Vector local(longest_ + read_beyond);
  for (const Panel& panel : panels_) {
    const int* list = rows_.data() + panel.row_list;
    local.head(panel.columns) = y.segment(panel.first, panel.columns);
    local.segment(panel.columns, panel.below() + read_beyond).setZero();
    forward_panel(values_.data() + panel.values, panel.rows, panel.columns, local.data());
    y.segment(panel.first, panel.columns) = local.head(panel.columns);
    for (Index i = panel.columns; i < panel.rows; ++i) y[list[i]] += local[i];
  }
  for (std::size_t p = panels_.size(); p-- > 0;) {
    const Panel& panel = panels_[p];
    const int* list = rows_.data() + panel.row_list;
    for (Index i = 0; i < panel.rows; ++i) local[i] = y[list[i]];
    local.segment(panel.rows, read_beyond).setZero();
    backward_panel(values_.data() + panel.values, panel.rows, panel.columns, local.data());
    y.segment(panel.first, panel.columns) = local.head(panel.columns);
  }
  for (Index i = 0; i < x.size(); ++i) x[i] = y[new_place_[at(i)]];
}

}  // namespace convex::linear_algebra
