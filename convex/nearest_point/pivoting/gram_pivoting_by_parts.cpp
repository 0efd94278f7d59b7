#include <algorithm>
#include <cmath>

#include "convex/nearest_point/pivoting/gram_pivoting.hpp"

namespace convex::inline pivoting {
namespace {

/// New rows at a time: this part of the coordinates, by eights.
constexpr double part_of_coordinates = 0.2;

}  // namespace

/// Many rows to a coordinate: a block of violated rows is settled among the rows looked at before all are
/// looked at again. What has been looked at only grows and its dual objective with it, so this ends.
bool GramPivoting::pivot_by_parts() {
  Index count_held = 0, kept = 0;
  for (Index a = 0; a < m_; ++a) {
    if (state_[a] == passed) state_[a] = outside;
    count_held += holds(a);
  }
  for (Index j = 0; j < set_.size(); ++j) kept += holds(row(j));
  if (kept < count_held || kept < set_.size() || !set_.is_factored()) collect();
  const Index part = padded(1 + static_cast<Index>(part_of_coordinates * static_cast<double>(n_)));
  while (true) {
    if ((by_single_steps_ || !pivot_by_blocks(Among::known)) && !descend_known()) return false;
    if (all_known()) return true;
    find_slacks();
    Index count = list_violated(outside, Among::all);
    if (count == 0) return true;
    count = choose_deepest(count, by_single_steps_ ? 8 : std::min(block_of(count), part));
    for (Index k = 0; k < count; ++k)
      if (rows_.place(list_[k]) >= 0) return false;  // settled, and yet violated: doubles do not tell
    steps_ += count;
    if (by_single_steps_) {
      if (!rows_.add(list_, fill_up(count))) return false;
      continue;
    }
    if (!rows_.add(list_, count)) return false;
    for (Index k = 0; k < std::min(count, capacity_ - set_.size()); ++k) state_[list_[k]] = held;
    collect();
  }
}

/// Where rows are repeated or are multiples of each other, as some have turned out to be, the first `count`
/// of the list hold them in groups, one as deep as the other: one of each is left.
Index GramPivoting::skip_parallel_rows(Index count) {
  const double* U = problem_.U.dense().data();
  const auto depth = [&](Index a) { return slack_[a] / row_scale_[a]; };
  std::sort(list_, list_ + count, [&](Index a, Index b) { return depth(a) < depth(b); });
  Index kept = 0;
  for (Index k = 0; k < count; ++k) {
    bool repeats = false;
    for (Index l = kept; l-- > 0 && !repeats && are_alike(depth(list_[l]), depth(list_[k]));)
      repeats = is_multiple(n_, U + list_[l] * n_, U + list_[k] * n_);
    if (!repeats) list_[kept++] = list_[k];
  }
  return kept;
}

/// Fills the list up to a whole block with rows that have not been looked at. Its new length.
Index GramPivoting::fill_up(Index count) {
  const Index chosen = count;
  for (Index a = 0; a < m_ && count % 8 != 0; ++a)
    if (rows_.place(a) < 0 && std::find(list_, list_ + chosen, a) == list_ + chosen) list_[count++] = a;
  return count;
}

void GramPivoting::find_slacks_of_known() {
  find_known_slacks(known_slack_);
  for (Index p = 0; p < rows_.count(); ++p)
    if (rows_.row(p) >= 0) slack_[rows_.row(p)] = known_slack_[p];
}

}  // namespace convex::inline pivoting
