#include <algorithm>
#include <cmath>

#include "convex/infinity.hpp"
#include "convex/nearest_point/pivoting/gram_pivoting.hpp"
#include "convex/zero_tolerances.hpp"

namespace convex::inline pivoting {
namespace {

/// Steps in which multipliers are brought up to date before they are solved for anew.
constexpr Index most_steps_since = 16;

/// So many violated rows come in, the deepest first, before the slacks of all are found anew.
constexpr Index most_in_turn = 4;
/// The part of its violation that a row has to keep meanwhile.
constexpr double still_deep = 0.5;

/// Whether numbers and rows repeat each other, as far as a choice of rows needs: those left out are looked at
/// again. `is_multiple`: whether u is v times a positive number, n entries.
bool are_alike(double x, double y) {
  constexpr double alike = 1e-9;
  return std::abs(x - y) <= alike * std::abs(x);
}

bool is_multiple(Index n, const double* u, const double* v) {
  const Index first = std::find_if(v, v + n, [](double x) { return x != 0; }) - v;
  const double ratio = first < n ? u[first] / v[first] : 0;
  return ratio > 0 && std::equal(u, u + n, v, [&](double x, double y) { return are_alike(x, y * ratio); });
}

}  // namespace

/// The dual method on all rows, those that are violated eight at a time: what has been looked at is settled
/// before all are looked at again. It only grows and its dual objective with it, so this ends.
bool GramPivoting::pivot_by_single_steps() {
  by_single_steps_ = true;
  Index count_held = 0, kept = 0;
  for (Index a = 0; a < m_; ++a) {
    if (state_[a] == passed) state_[a] = outside;
    count_held += holds(a);
  }
  for (Index j = 0; j < set_.size(); ++j) kept += holds(row(j));
  if (kept < count_held || kept < set_.size() || !set_.is_factored()) collect();
  while (descend_known()) {
    if (all_known()) return true;
    find_slacks();
    Index count = list_violated(outside);
    if (count == 0) return true;
    count = choose_deepest(count, 8);
    for (Index k = 0; k < count; ++k)
      if (rows_.place(list_[k]) >= 0) return false;  // settled, and yet violated: doubles do not tell
    steps_ += count;
    if (!rows_.add(list_, fill_up(count))) return false;
  }
  return false;
}

/// Where rows are repeated or are multiples of each other, as some have turned out to be, the first `count`
/// of the list hold them in groups, one as deep as the other: one of each is left.
Index GramPivoting::skip_parallel_rows(Index count) {
  const double* U = problem_.U.dense().data();
  const auto depth = [&](Index a) { return slack_[a] / row_scale_[a]; };
  std::sort(list_, list_ + count, [&](Index a, Index b) { return is_deeper(a, b); });
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

/// The dual method of Goldfarb and Idnani (1983) among the rows looked at, for what blocks do not settle:
/// a violated row comes in, its multiplier raised until it holds; on the way those whose multiplier comes
/// down to 0 go. Each row that has come in raises the dual objective, so that no set of rows returns. False
/// when rows contradict each other or are nearly dependent.
bool GramPivoting::descend_known() {
  if (!find_multipliers()) return false;
  Index steps_since = 0;  // the multipliers were those of the factor
  for (Index step = 0; step < 10 * (rows_.count() + n_); ++step) {
    if (steps_since == 0 && drop_most_negative()) {
      if (!find_multipliers()) return false;
      continue;
    }
    find_known_slacks(known_slack_);
    const double scale = counted_violation();
    Index count = 0;
    for (Index p = 0; p < rows_.count(); ++p) {
      const Index a = rows_.row(p);
      if (a < 0) continue;
      slack_[a] = known_slack_[p];
      if (state_[a] == passed) state_[a] = outside;
      list_[count] = a;
      count += state_[a] == outside && slack_[a] < -row_scale_[a] * scale;
    }
    if (count == 0) return true;
    if (!raise_in_turn(count)) return false;
    find_energy();
    steps_since = steps_since >= most_steps_since ? 0 : steps_since + std::min(count, most_in_turn);
    if (steps_since == 0 && !find_multipliers()) return false;
  }
  return false;
}

bool GramPivoting::drop_most_negative() {
  Index worst = -1;
  double lowest = 0;
  for (Index j = 0; j < set_.size(); ++j) {
    const Index place = set_.place(j);
    if (!(lambda_[place] < 0) || state_[row(j)] != held) continue;
    const double push = lambda_[place] * std::sqrt(rows_.square(place));
    if (!(push < lowest)) continue;
    lowest = push;
    worst = j;
  }
  if (worst < 0) return false;
  state_[row(worst)] = outside;
  set_.remove(worst);
  steps_ += 1;
  return true;
}

/// Takes in the deepest row of the list, then those next that stay deep while it comes in.
bool GramPivoting::raise_in_turn(Index count) {
  const double scale = counted_violation();
  const Index turns = std::min(count, most_in_turn);
  std::partial_sort(list_, list_ + turns, list_ + count, [&](Index a, Index b) { return is_deeper(a, b); });
  for (Index k = 0; k < turns; ++k) {
    const Index a = list_[k];
    const double before = slack_[a];
    if (k > 0) slack_[a] = slack_at_place(rows_.place(a));
    if (slack_[a] <= still_deep * before && slack_[a] < -row_scale_[a] * scale && !raise(a)) return false;
  }
  return true;
}

double GramPivoting::slack_at_place(Index place) const {
  const double* const gram = rows_.gram(place);
  double slack = -target_[place];
  for (Index j = 0; j < set_.size(); ++j) slack += gram[set_.place(j)] * lambda_[set_.place(j)];
  return slack;
}

/// Raises the multiplier of a violated row until the row holds; rows whose multiplier comes down to 0 on the
/// way are let go.
bool GramPivoting::raise(Index a) {
  const Index place = rows_.place(a);
  const double square = rows_.square(place);
  double raised = 0;
  for (double violation = -slack_[a];; steps_ += 1) {
    double* const r = load_;  // u_a = Σ r_j u_j + what the rows of the working set do not span
    const double rest = set_.distance(place, column_);
    const bool dependent = set_.size() == capacity_ || !(rest > dependence * square);
    if (!dependent && rest <= near_dependence * square) return false;
    std::copy_n(column_, padded(set_.size()), r);
    set_.solve_upper(r);
    const double full = dependent ? infinity : violation / rest;
    double partial = infinity;
    Index blocking = -1;
    for (Index j = 0; j < set_.size(); ++j) {
      const double above = std::max(0.0, lambda_[set_.place(j)]);
      if (!((r[j] > 0) & (above < partial * r[j]))) continue;
      // r_j ||u_j|| is no more than rounding beside ||u_a||
      if (state_[row(j)] != held ||
          !(r[j] * r[j] * rows_.square(set_.place(j)) > zero_coefficient * zero_coefficient * square))
        continue;
      partial = above / r[j];
      blocking = j;
    }
    if (full <= partial && !dependent) {
      for (Index j = 0; j < set_.size(); ++j) lambda_[set_.place(j)] -= full * r[j];
      lambda_[place] = raised + full;
      state_[a] = held;
      set_.append(place, column_, rest);
      return true;
    }
    if (blocking < 0) {
      contradiction_ = Vector::Zero(m_);
      (*contradiction_)[a] = 1;
      for (Index j = 0; j < set_.size(); ++j)
        if (std::abs(r[j]) * std::sqrt(rows_.square(set_.place(j)) / square) > zero_coefficient)
          (*contradiction_)[row(j)] = -r[j];
      return false;
    }
    for (Index j = 0; j < set_.size(); ++j) lambda_[set_.place(j)] -= partial * r[j];
    raised += partial;
    if (!dependent) violation -= partial * rest;
    state_[row(blocking)] = outside;
    lambda_[set_.place(blocking)] = 0;
    set_.remove(blocking);
  }
}

}  // namespace convex::inline pivoting
