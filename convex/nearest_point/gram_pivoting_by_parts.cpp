#include <cmath>

#include "convex/nearest_point/gram_pivoting.hpp"

namespace convex {
namespace {

constexpr double infinity = std::numeric_limits<double>::infinity();

/// Blocks that do not lower the number of wrong rows before the steps of the dual method follow.
constexpr int patience = 2;

/// New rows at a time: this part of the coordinates, by eights.
constexpr double part_of_coordinates = 0.2;

/// A coefficient of a row in terms of others is 0 when its part is below this part of the row.
constexpr double noise = 1e-9;

}  // namespace

/// Many rows to a coordinate: a block of violated rows is settled among the rows looked at before all are
/// looked at again. What has been looked at only grows and its dual objective with it, so this ends.
bool GramPivoting::pivot_by_parts() {
  for (Index a = 0; a < m_; ++a)
    if (state_[a] == passed) state_[a] = outside;
  collect();
  const Index part = padded(1 + static_cast<Index>(part_of_coordinates * static_cast<double>(n_)));
  while (true) {
    if (!settle_known() && !descend_known()) return false;
    if (all_known()) return true;
    find_slacks();
    Index count = list_violated(outside);
    if (count == 0) return true;
    count = choose_deepest(count, std::min(block_of(count), part));
    for (Index k = 0; k < count; ++k)
      if (rows_.place(list_[k]) >= 0) return false;  // settled, and yet violated: doubles do not tell
    if (!rows_.add(list_, count)) return false;
    steps_ += count;
    for (Index k = 0; k < std::min(count, capacity_ - size_); ++k) state_[list_[k]] = held;
    collect();
  }
}

/// Where rows are repeated or are multiples of each other, as some have turned out to be, the first `count`
/// of the list hold them in groups, one as deep as the other: one of each is left.
Index GramPivoting::skip_parallel_rows(Index count) {
  constexpr double alike = 1e-9;  // only a choice: what is left out is looked at again
  const double* U = problem_.U.dense().data();
  const auto depth = [&](Index a) { return slack_[a] / row_scale_[a]; };
  const auto close = [](double x, double y) { return std::abs(x - y) <= alike * std::abs(x); };
  const auto parallel = [&](Index a, Index b) {
    const double *u = U + a * n_, *v = U + b * n_, ratio = row_scale_[a] / row_scale_[b];
    return std::equal(u, u + n_, v, [&](double x, double y) { return close(x, y * ratio); });
  };
  std::sort(list_, list_ + count, [&](Index a, Index b) { return depth(a) < depth(b); });
  Index kept = 0;
  for (Index k = 0; k < count; ++k) {
    bool repeats = false;
    for (Index l = kept; l-- > 0 && !repeats && close(depth(list_[l]), depth(list_[k]));)
      repeats = parallel(list_[l], list_[k]);
    if (!repeats) list_[kept++] = list_[k];
  }
  return kept;
}

void GramPivoting::find_slacks_of_known() {
  find_known_slacks(known_slack_);
  for (Index p = 0; p < rows_.count(); ++p)
    if (rows_.row(p) >= 0) slack_[rows_.row(p)] = known_slack_[p];
}

/// `list_violated` among the rows looked at.
Index GramPivoting::list_violated_known(State state) {
  const double scale = counted_violation();
  Index count = 0;
  for (Index p = 0; p < rows_.count(); ++p)
    if (const Index a = rows_.row(p); a >= 0 && state_[a] == state && slack_[a] < -row_scale_[a] * scale)
      list_[count++] = a;
  return count;
}

/// Blocks among the rows looked at until none of them is wrong.
bool GramPivoting::settle_known() {
  Index fewest = m_ + 1;
  for (int impatience = 0; impatience <= patience;) {
    if (!find_multipliers()) return false;
    find_slacks_of_known();
    const Index count = list_violated_known(outside), leaving = drop_negative();
    if (leaving + count == 0) return list_violated_known(passed) == 0;
    impatience = leaving + count < fewest ? 0 : impatience + 1;
    fewest = std::min(fewest, leaving + count);
    const Index room = std::min(block_of(count), capacity_ - (size_ - leaving));
    if (leaving == 0 && room == 0) break;
    take_in(choose_deepest(count, room));
  }
  return false;
}

/// The dual method of Goldfarb and Idnani among the rows looked at, for what blocks do not settle. False when
/// rows contradict each other or are nearly dependent.
bool GramPivoting::descend_known() {
  for (Index step = 0; step < 10 * (rows_.count() + n_); ++step) {
    const Index before = size_;
    if (!find_multipliers() || (step > 0 && size_ < before)) return false;
    for (Index p = 0; p < rows_.count(); ++p)
      if (const Index a = rows_.row(p); a >= 0 && state_[a] == passed) state_[a] = outside;
    if (drop_negative() > 0) {
      collect();
      continue;
    }
    find_slacks_of_known();
    const Index count = list_violated_known(outside);
    if (count == 0) return true;
    choose_deepest(count, 1);
    if (!raise(list_[0])) return false;
  }
  return false;
}

/// Raises the multiplier of a violated row until the row holds; rows whose multiplier comes down to 0 on the
/// way are let go.
bool GramPivoting::raise(Index a) {
  const double* gram = rows_.gram(rows_.place(a));
  const double square = rows_.square(rows_.place(a));
  for (double violation = -slack_[a];;) {
    for (Index j = 0; j < padded(size_); ++j) load_[j] = j < size_ ? gram[at_[j]] : 0;
    solve(load_);
    double rest = square;
    for (Index j = 0; j < size_; ++j) rest -= load_[j] * gram[at_[j]];
    const bool dependent = !(rest > dependence * square);
    if (!dependent && rest <= near_dependence * square) return false;
    double full = dependent ? infinity : violation / rest, partial = infinity;
    Index blocking = -1;
    for (Index j = 0; j < size_; ++j) {
      const double r = load_[j], length = std::sqrt(rows_.square(at_[j]) / square);
      if (state_[row(j)] != held || !(r * length > noise)) continue;
      const double ratio = std::max(0.0, lambda_[at_[j]]) / r;
      if (ratio < partial) {
        partial = ratio;
        blocking = j;
      }
    }
    const double t = std::min(full, partial);
    if (t == infinity) {
      contradiction_ = Vector::Zero(m_);
      (*contradiction_)[a] = 1;
      for (Index j = 0; j < size_; ++j)
        if (std::abs(load_[j]) * std::sqrt(rows_.square(at_[j]) / square) > noise)
          (*contradiction_)[row(j)] = -load_[j];
      return false;
    }
    steps_ += 1;
    if (full <= partial) break;
    for (Index j = 0; j < size_; ++j) lambda_[at_[j]] -= t * load_[j];
    if (!dependent) violation -= t * rest;
    state_[row(blocking)] = outside;
    collect();
    const Index before = size_;
    if (!factor() || size_ < before) return false;
  }
  state_[a] = held;
  collect();
  return true;
}

}  // namespace convex
