#include "convex/nearest_point/structure/sparse_factor.hpp"

#include <Eigen/OrderingMethods>
#include <algorithm>
#include <numeric>

#include "convex/nearest_point/structure/front_kernels.hpp"

namespace convex {
namespace {

std::size_t at(Index i) { return static_cast<std::size_t>(i); }

/// Columns are gathered into the panel of their parent when it stays this narrow, or when at most this part
/// of its numbers is zero: a wider panel works faster than a sparser one.
constexpr Index narrow = 8;
constexpr double zero_part = 0.15;

/// The elimination tree (Liu 1990): the first row below the diagonal of each column of L, or -1. upper: for
/// each column the rows above the diagonal.
std::vector<Index> elimination_tree(const std::vector<std::vector<int>>& upper) {
  const std::size_t n = upper.size();
  std::vector<Index> parent(n, -1), ancestor(n, -1);
  for (std::size_t j = 0; j < n; ++j)
    for (int row : upper[j]) {
      Index i = row;
      while (i >= 0 && i != static_cast<Index>(j)) {
        const Index next = ancestor[at(i)];
        ancestor[at(i)] = static_cast<Index>(j);
        if (next < 0) parent[at(i)] = static_cast<Index>(j);
        i = next;
      }
    }
  return parent;
}

/// The columns in the order in which children come before parents, one subtree after the other.
std::vector<int> postorder(const std::vector<Index>& parent) {
  const std::size_t n = parent.size();
  std::vector<Index> head(n, -1), next(n, -1), stack;
  for (std::size_t k = n; k-- > 0;)
    if (parent[k] >= 0) {
      next[k] = head[at(parent[k])];
      head[at(parent[k])] = static_cast<Index>(k);
    }
  std::vector<int> order;
  order.reserve(n);
  for (std::size_t root = 0; root < n; ++root) {
    if (parent[root] >= 0) continue;
    stack.push_back(static_cast<Index>(root));
    while (!stack.empty()) {
      const Index k = stack.back();
      if (head[at(k)] >= 0) {
        stack.push_back(head[at(k)]);
        head[at(k)] = next[at(head[at(k)])];
      } else {
        order.push_back(static_cast<int>(k));
        stack.pop_back();
      }
    }
  }
  return order;
}

/// Numbers in each column of L, its diagonal included: row i of L is the part of the tree above the entries
/// of row i.
std::vector<Index> column_counts(const std::vector<std::vector<int>>& upper,
                                 const std::vector<Index>& parent) {
  const std::size_t n = upper.size();
  std::vector<Index> count(n, 1), seen(n, -1);
  for (std::size_t i = 0; i < n; ++i) {
    seen[i] = static_cast<Index>(i);
    for (int entry : upper[i])
      for (Index j = entry; seen[at(j)] != static_cast<Index>(i); j = parent[at(j)]) {
        ++count[at(j)];
        seen[at(j)] = static_cast<Index>(i);
      }
  }
  return count;
}

/// For each column the rows above the diagonal, in the order `place`.
std::vector<std::vector<int>> upper_pattern(const std::vector<SparseFactor::Place>& places,
                                            const std::vector<int>& place) {
  std::vector<std::vector<int>> upper(place.size());
  for (const auto& [i, j] : places) {
    const int a = place[at(i)], b = place[at(j)];
    if (a != b) upper[at(std::max(a, b))].push_back(std::min(a, b));
  }
  for (std::vector<int>& rows : upper) {
    std::sort(rows.begin(), rows.end());
    rows.erase(std::unique(rows.begin(), rows.end()), rows.end());
  }
  return upper;
}

std::vector<int> minimum_degree(Index n, const std::vector<SparseFactor::Place>& places) {
  std::vector<Eigen::Triplet<double>> entries;
  entries.reserve(2 * places.size() + at(n));
  for (const auto& [i, j] : places) {
    entries.emplace_back(i, j, 1.0);
    if (i != j) entries.emplace_back(j, i, 1.0);
  }
  for (Index i = 0; i < n; ++i) entries.emplace_back(static_cast<int>(i), static_cast<int>(i), 1.0);
  SparseMatrix pattern(n, n);
  pattern.setFromTriplets(entries.begin(), entries.end());
  Eigen::PermutationMatrix<Eigen::Dynamic, Eigen::Dynamic, int> old_place;
  Eigen::AMDOrdering<int>()(pattern.selfadjointView<Eigen::Lower>(), old_place);
  std::vector<int> place(at(n));
  for (Index k = 0; k < n; ++k) place[at(old_place.indices()[k])] = static_cast<int>(k);
  return place;
}

}  // namespace

SparseFactor::SparseFactor(Index n, const std::vector<Place>& places) {
  order(n, places);
  pattern_.clear();
  pattern_.shrink_to_fit();
}

void SparseFactor::order(Index n, const std::vector<Place>& places) {
  new_place_ = minimum_degree(n, places);
  std::vector<std::vector<int>> upper = upper_pattern(places, new_place_);
  const std::vector<int> old_of_new = postorder(elimination_tree(upper));
  std::vector<int> renumber(at(n));
  for (std::size_t k = 0; k < old_of_new.size(); ++k) renumber[at(old_of_new[k])] = static_cast<int>(k);
  for (int& place : new_place_) place = renumber[at(place)];
  upper = upper_pattern(places, new_place_);
  const std::vector<Index> parent = elimination_tree(upper);
  find_panels(parent, column_counts(upper, parent));
  std::vector<std::vector<int>> lower(at(n));
  for (Index j = 0; j < n; ++j)
    for (int i : upper[at(j)]) lower[at(i)].push_back(static_cast<int>(j));
  find_rows(lower);
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
  }
  for (Panel& panel : panels_) {
    const Index up = parent[at(panel.first + panel.columns - 1)];
    panel.parent = up < 0 ? -1 : panel_of_[at(up)];
    const double c = static_cast<double>(panel.columns), r = static_cast<double>(panel.rows);
    flops_ += c * r * r - c * c * r + c * c * c / 3;
  }
  values_.assign(at(values), 0.0);
  rows_.assign(at(rows), 0);
}

void SparseFactor::find_rows(const std::vector<std::vector<int>>& lower) {
  std::vector<std::vector<int>> children(panels_.size());
  std::vector<Index> seen(lower.size(), -1), position(lower.size(), 0);
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
    for (Index j = panel.first; j < end; ++j)
      for (int i : lower[at(j)]) take(i);
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
  std::vector<Index> found;
  found.reserve(places.size());
  for (const auto& [i, j] : places) {
    const int row = std::max(new_place_[at(i)], new_place_[at(j)]),
              column = std::min(new_place_[at(i)], new_place_[at(j)]);
    const Panel& panel = panels_[at(panel_of_[at(column)])];
    const int* list = rows_.data() + panel.row_list;
    const Index k = std::lower_bound(list, list + panel.rows, row) - list;
    found.push_back(panel.values + (column - panel.first) * panel.rows + k);
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
  std::vector<double> own;
  for (std::size_t p = 0; p < panels_.size(); ++p) {
    const Panel& panel = panels_[p];
    const Index below = panel.below();
    if (own.size() < at(below * below)) own.resize(at(below * below));
    for (Index j = 0; j < below; ++j) std::fill_n(own.data() + j * (below + 1), below - j, 0.0);
    for (Index c = 0; c < child_count[p]; ++c) {
      add_update(*pending.back(), updates_.data() + tops.back(), panel, own.data());
      used = tops.back();
      pending.pop_back();
      tops.pop_back();
    }
    double* values = values_.data() + panel.values;
    if (!factor_panel(values, panel.rows, panel.columns)) return false;
    if (panel.parent < 0) continue;
    subtract_outer(own.data(), below, values, panel.rows, panel.columns);
    const std::size_t size = at(below * below);
    if (updates_.size() < used + size) updates_.resize(2 * (used + size));
    for (Index j = 0; j < below; ++j)
      std::copy_n(own.data() + j * (below + 1), below - j, updates_.data() + used + at(j * (below + 1)));
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
  Vector rest;
  for (const Panel& panel : panels_) {
    const double* L = values_.data() + panel.values;
    const int* list = rows_.data() + panel.row_list;
    double* own = y.data() + panel.first;
    rest.setZero(panel.below());
    for (Index j = 0; j < panel.columns; ++j) {
      const double* column = L + j * panel.rows;
      const double value = own[j];
      for (Index i = j + 1; i < panel.columns; ++i) own[i] -= column[i] * value;
      for (Index i = 0; i < panel.below(); ++i) rest[i] += column[panel.columns + i] * value;
    }
    for (Index i = 0; i < panel.below(); ++i) y[list[panel.columns + i]] -= rest[i];
  }
  for (std::size_t p = panels_.size(); p-- > 0;) {
    const Panel& panel = panels_[p];
    const double* L = values_.data() + panel.values;
    const int* list = rows_.data() + panel.row_list;
    double* own = y.data() + panel.first;
    rest.resize(panel.below());
    for (Index i = 0; i < panel.below(); ++i) rest[i] = y[list[panel.columns + i]];
    for (Index j = panel.columns; j-- > 0;) {
      const double* column = L + j * panel.rows;
      double sum = own[j] / column[j];
      for (Index i = j + 1; i < panel.columns; ++i) sum -= column[i] * own[i];
      sum -= Eigen::Map<const Vector>(column + panel.columns, panel.below()).dot(rest);
      own[j] = sum;
    }
  }
  for (Index i = 0; i < x.size(); ++i) x[i] = y[new_place_[at(i)]];
}

}  // namespace convex
