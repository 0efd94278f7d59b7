#include "convex/nearest_point/sparse/sparse_factor.hpp"

#include <algorithm>
#include <numeric>

namespace convex::inline sparse {
namespace {

std::size_t at(Index i) { return static_cast<std::size_t>(i); }

/// Columns are gathered into the panel of their parent when it stays this narrow, or when at most this part
/// of its numbers is zero: a wider panel works faster than a sparser one.
constexpr Index narrow = 8;
constexpr double zero_part = 0.15;

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
    if (panel.parent >= 0) children[at(panel.parent)].push_back(static_cast<int>(p));
    for (Index k = 0; k < panel.rows; ++k) position[at(list[k])] = k;
    for (int child : children[p]) {
      Panel& below = panels_[at(child)];
      below.below_in_parent = static_cast<Index>(below_in_parent_.size());
      for (Index k = below.columns; k < below.rows; ++k)
        below_in_parent_.push_back(static_cast<int>(position[at(rows_[at(below.row_list + k)])]));
    }
  }
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

void SparseFactor::add_update(const Panel& child, const double* update, const Panel& parent,
                              double* parent_update) {
  const int* place = below_in_parent_.data() + child.below_in_parent;
  const Index size = child.below(), below = parent.below();
  double* panel = values_.data() + parent.values;
  for (Index j = 0; j < size; ++j) {
    const double* from = update + j * size;
    const Index column = place[j];
    if (column < parent.columns) {
      double* to = panel + column * parent.rows;
      for (Index i = j; i < size; ++i) to[place[i]] += from[i];
    } else {
      double* to = parent_update + (column - parent.columns) * below - parent.columns;
      for (Index i = j; i < size; ++i) to[place[i]] += from[i];
    }
  }
}

bool SparseFactor::factor() {
  // Children stand right before their parent, so their updates are on top of the stack.
  std::vector<std::size_t> tops;  // where each update begins
  std::vector<const Panel*> pending;
  std::vector<Index> child_count(panels_.size(), 0);
  for (const Panel& panel : panels_)
    if (panel.parent >= 0) ++child_count[at(panel.parent)];
  std::size_t used = 0;
  for (std::size_t p = 0; p < panels_.size(); ++p) {
    const Panel& panel = panels_[p];
    const Index below = panel.below();
    const std::size_t size = at(below * below);
    if (updates_.size() < used + size) updates_.resize(2 * (used + size));
    double* const own = updates_.data() + used;
    for (Index j = 0; j < below; ++j) std::fill_n(own + j * (below + 1), below - j, 0.0);
    for (Index c = 0; c < child_count[p]; ++c) {
      used = tops.back();
      add_update(*pending.back(), updates_.data() + used, panel, own);
      pending.pop_back();
      tops.pop_back();
    }
    double* values = values_.data() + panel.values;
    if (!factor_panel(values, panel.rows, panel.columns)) return false;
    if (panel.parent < 0) continue;
    subtract_outer(own, below, values, panel.rows, panel.columns);
    double* const into = updates_.data() + used;  // where those of its children were
    for (Index j = 0; j < below && into != own; ++j)
      std::copy_n(own + j * (below + 1), below - j, into + j * (below + 1));
    tops.push_back(used);
    pending.push_back(&panel);
    used += size;
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

}  // namespace convex::inline sparse
