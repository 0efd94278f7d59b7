#include "convex/nearest_point/isotonic/strings.hpp"

#include <algorithm>
#include <numeric>

namespace convex::inline isotonic {
namespace {

/// What a row is to a string: from `low` up to `high`, a floor under `high` (low = -1), or nothing (high =
/// -1).
struct Link {
  int low = -1, high = -1;
};

Link link(const SparseRows& U, Index a) {
  const Index begin = U.outerIndexPtr()[a], count = U.outerIndexPtr()[a + 1] - begin;
  const int* place = U.innerIndexPtr() + begin;
  const double* value = U.valuePtr() + begin;
  if (count == 1 && value[0] > 0) return {-1, place[0]};
  if (count != 2 || value[0] != -value[1] || !(value[0] < 0 || value[0] > 0)) return {};
  return value[0] < 0 ? Link{place[0], place[1]} : Link{place[1], place[0]};
}

class StringFinder {
 public:
  explicit StringFinder(Index n) : above_(at(n), -1), below_(at(n), -1), row_(at(n), -1), other_end_(at(n)) {
    std::iota(other_end_.begin(), other_end_.end(), 0);
  }

  /// Strings two coordinates together by row a; false when one of them is taken on that side, or when a ring
  /// would close.
  bool tie(const Link& link, int a) {
    const int low = link.low, high = link.high;
    if (above_[at(low)] >= 0 || below_[at(high)] >= 0 || other_end_[at(low)] == high) return false;
    above_[at(low)] = high;
    below_[at(high)] = low;
    row_[at(high)] = a;
    const int bottom = other_end_[at(low)], top = other_end_[at(high)];
    other_end_[at(bottom)] = top;
    other_end_[at(top)] = bottom;
    return true;
  }

  /// Row a as the floor under coordinate i, once all is tied.
  bool put_under(int i, int a) {
    if (row_[at(i)] >= 0) return false;
    row_[at(i)] = a;
    return true;
  }

  void list(Strings& found) const {
    found.coordinate.reserve(row_.size());
    found.row.reserve(row_.size());
    for (std::size_t i = 0; i < row_.size(); ++i) {
      if (below_[i] >= 0) continue;
      found.first.push_back(static_cast<int>(found.coordinate.size()));
      for (int k = static_cast<int>(i); k >= 0; k = above_[at(k)]) {
        found.coordinate.push_back(k);
        found.row.push_back(row_[at(k)]);
      }
    }
    found.first.push_back(static_cast<int>(found.coordinate.size()));
  }

 private:
  std::vector<int> above_, below_, row_, other_end_;
};

}  // namespace

Strings find_strings(const NearestPointProblem& problem, Index most_border) {
  const Index n = problem.dimension();
  const Strings none{{}, {}, {0}, {}};
  if (!is_diagonal(problem.A) || !problem.U.is_sparse() || n == 0) return none;
  const SparseRows& U = problem.U.sparse();
  Strings found;
  StringFinder strings(n);
  std::vector<std::pair<int, int>> floors;
  auto next_two_sided = problem.two_sided.begin();
  for (Index a = 0; a < U.rows(); ++a) {
    const bool two_sided = next_two_sided != problem.two_sided.end() && *next_two_sided == a;
    next_two_sided += two_sided;
    const Link tied = two_sided ? Link{} : link(U, a);
    const int row = static_cast<int>(a);
    if (tied.high >= 0 && tied.low < 0)
      floors.emplace_back(tied.high, row);
    else if (tied.high < 0 || !strings.tie(tied, row))
      found.border.push_back(a);
    if (static_cast<Index>(found.border.size()) > most_border) return none;
  }
  for (const auto& [coordinate, row] : floors)
    if (!strings.put_under(coordinate, row)) found.border.push_back(row);
  if (static_cast<Index>(found.border.size()) > most_border) return none;
  std::sort(found.border.begin(), found.border.end());
  strings.list(found);
  return found;
}

}  // namespace convex::inline isotonic
