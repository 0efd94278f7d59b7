#pragma once

#include <vector>

#include "convex/vector.hpp"

namespace convex::linear_algebra {

/// The neighbours of each of n vertices, without the vertex itself, each once, in no order.
struct Neighbours {
  std::vector<int> first, list;  ///< n + 1; those of vertex i are list[first[i]] … list[first[i + 1] - 1]

  /// edge(k, i, j) for k < edges gives the ends of edge k; edges may be repeated and turned round.
  template <class Edge>
  Neighbours(Index n, Index edges, Edge edge) : first(static_cast<std::size_t>(n) + 1, 0) {
    const auto at = [](Index i) { return static_cast<std::size_t>(i); };
    for (Index k = 0; k < edges; ++k) {
      const auto [i, j] = edge(k);
      if (i == j) continue;
      ++first[at(i) + 1];
      ++first[at(j) + 1];
    }
    for (Index i = 0; i < n; ++i) first[at(i) + 1] += first[at(i)];
    list.resize(at(first[at(n)]));
    std::vector<int> next(first.begin(), first.end() - 1);
    for (Index k = 0; k < edges; ++k) {
      const auto [i, j] = edge(k);
      if (i == j) continue;
      list[at(next[at(i)]++)] = j;
      list[at(next[at(j)]++)] = i;
    }
    drop_repeated();
  }
  Index count() const { return static_cast<Index>(first.size()) - 1; }

 private:
  void drop_repeated();
};

/// An order of elimination of a symmetric matrix and what its factor looks like.
struct Elimination {
  std::vector<int> new_place;  ///< of each vertex: approximate minimum degree, children before parents
  std::vector<int> old_place;  ///< its inverse
  std::vector<Index> parent;   ///< of each column: the first row below the diagonal in L, or -1
  std::vector<Index> count;    ///< numbers in each column of L, the diagonal included
};

/// Approximate minimum degree (Amestoy, Davis and Duff 1996), the elimination tree (Liu 1990) in postorder.
Elimination elimination_order(const Neighbours&);

}  // namespace convex::linear_algebra
