#include "convex/linear_algebra/elimination_order.hpp"

#include <Eigen/OrderingMethods>

namespace convex::linear_algebra {
namespace {

/// Visits the rows above the diagonal of column j in the order given.
template <class Visit>
void above_diagonal(const Neighbours& graph, const Elimination& order, Index j, Visit visit) {
  const int vertex = order.old_place[at(j)];
  for (int k = graph.first[at(vertex)]; k < graph.first[at(vertex) + 1]; ++k) {
    const Index row = order.new_place[at(graph.list[at(k)])];
    if (row < j) visit(row);
  }
}

std::vector<Index> elimination_tree(const Neighbours& graph, const Elimination& order) {
  std::vector<Index> parent(order.old_place.size(), -1), ancestor(order.old_place.size(), -1);
  for (Index j = 0; j < graph.count(); ++j)
    above_diagonal(graph, order, j, [&](Index i) {
      while (i >= 0 && i != j) {
        const Index next = ancestor[at(i)];
        ancestor[at(i)] = j;
        if (next < 0) parent[at(i)] = j;
        i = next;
      }
    });
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

/// Row i of L is the part of the tree above the entries of row i.
std::vector<Index> column_counts(const Neighbours& graph, const Elimination& order) {
  std::vector<Index> count(order.parent.size(), 1);
  std::vector<Index> seen(order.parent.size(), -1);
  for (Index i = 0; i < graph.count(); ++i) {
    seen[at(i)] = i;
    above_diagonal(graph, order, i, [&](Index j) {
      for (; seen[at(j)] != i; j = order.parent[at(j)]) {
        ++count[at(j)];
        seen[at(j)] = i;
      }
    });
  }
  return count;
}

std::vector<int> minimum_degree(const Neighbours& graph) {
  const Index n = graph.count();
  SparseMatrix pattern(n, n);  // lower triangle
  pattern.resizeNonZeros(static_cast<Index>(graph.list.size()) / 2 + n);
  Index used = 0;
  for (Index j = 0; j < n; ++j) {
    pattern.outerIndexPtr()[j] = static_cast<int>(used);
    pattern.innerIndexPtr()[used++] = static_cast<int>(j);
    for (int k = graph.first[at(j)]; k < graph.first[at(j) + 1]; ++k)
      if (graph.list[at(k)] > j) pattern.innerIndexPtr()[used++] = graph.list[at(k)];
  }
  pattern.outerIndexPtr()[n] = static_cast<int>(used);
  std::fill_n(pattern.valuePtr(), used, 1.0);
  Eigen::PermutationMatrix<Eigen::Dynamic, Eigen::Dynamic, int> old_place;
  Eigen::AMDOrdering<int>()(pattern.selfadjointView<Eigen::Lower>(), old_place);
  return {old_place.indices().data(), old_place.indices().data() + n};
}

void place(Elimination& order, std::vector<int> old_place) {
  order.old_place = std::move(old_place);
  order.new_place.resize(order.old_place.size());
  for (std::size_t k = 0; k < order.old_place.size(); ++k)
    order.new_place[at(order.old_place[k])] = static_cast<int>(k);
}

}  // namespace

void Neighbours::drop_repeated() {
  std::vector<int> seen(static_cast<std::size_t>(count()), -1);
  int used = 0;
  for (int i = 0; i < static_cast<int>(count()); ++i) {
    const int begin = first[at(i)], end = first[at(i) + 1];
    first[at(i)] = used;
    for (int k = begin; k < end; ++k) {
      const int j = list[at(k)];
      if (seen[at(j)] == i) continue;
      seen[at(j)] = i;
      list[at(used++)] = j;
    }
  }
  first.back() = used;
  list.resize(at(used));
}

Elimination elimination_order(const Neighbours& graph) {
  Elimination order;
  place(order, minimum_degree(graph));
  const std::vector<int> after = postorder(elimination_tree(graph, order));
  std::vector<int> old_place(after.size());
  for (std::size_t k = 0; k < after.size(); ++k) old_place[k] = order.old_place[at(after[k])];
  place(order, std::move(old_place));
  order.parent = elimination_tree(graph, order);
  order.count = column_counts(graph, order);
  return order;
}

}  // namespace convex::linear_algebra
