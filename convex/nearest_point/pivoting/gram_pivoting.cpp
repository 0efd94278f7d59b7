#include "convex/nearest_point/pivoting/gram_pivoting.hpp"

#include <cmath>

namespace convex::inline pivoting {
namespace {

/// Up to so many rows all are looked at from the start, and pivoting goes on in their Gram matrix alone.
constexpr Index few_rows = 32;

/// Places for rows that come in later: so many per coordinate, and for blocks of eight that are not filled.
constexpr Index rooms = 2, rooms_up_to_200 = 3, unfilled = 128;

/// Where no more than one row in so many changes, the factor is brought up to date; else it is made anew.
constexpr Index most_changes = 6;

/// Blocks that do not lower the number of wrong rows before pivoting has lost its way.
constexpr int patience = 4;

/// Up to so many rows a coordinate all rows are looked at again after each block; beyond, single steps are
/// quicker.
constexpr Index few_per_coordinate = 4;

/// The part of the violated rows that comes in at once, up to `small` coordinates and beyond.
constexpr Index small = 50;
constexpr double part_when_small = 0.4, part_when_large = 0.25;

Index places(Index n, Index m) {
  return m <= few_rows ? padded(m)
                       : std::min(padded(m), (n <= 200 ? rooms_up_to_200 : rooms) * padded(n)) + unfilled;
}

}  // namespace

GramPivoting::GramPivoting(const NearestPointProblem& problem, Arena& arena, const double* w_free,
                           const double* row_scale)
    : problem_(problem),
      kernels_(dense_kernels()),
      A_(problem.A.dense_factor()),
      n_(problem.dimension()),
      m_(problem.rows()),
      capacity_(std::min(n_, m_)),
      rows_(problem, arena, places(n_, m_), w_free),
      w_free_(w_free),
      row_scale_(row_scale),
      set_(rows_, arena, capacity_),
      target_(rows_.load()) {
  const Index most = places(n_, m_);
  lambda_ = arena.take_filled(most, 0.0);
  w_ = arena.take<double>(n_);
  q_ = arena.take<double>(n_);
  slack_ = arena.take<double>(std::max(m_, most));
  known_slack_ = arena.take<double>(most);
  load_ = arena.take<double>(capacity_);
  column_ = arena.take<double>(capacity_);
  state_ = arena.take_filled<Index>(m_, outside);
  list_ = arena.take<Index>(m_);
  entering_ = arena.take<Index>(m_);
}

Index GramPivoting::lines(Index n, Index m) {
  const Index most = places(n, m), k = std::min(n, m);
  return GramRows::lines(n, m, most) + GramFactor::lines(k) +
         (3 * most + 2 * padded(n) + 4 * padded(m) + 2 * padded(k)) / 8;
}

bool GramPivoting::all_known() const { return m_ <= few_rows; }

bool GramPivoting::start(const std::vector<Index>& guess) {
  if (static_cast<Index>(guess.size() + problem_.two_sided.size()) > capacity_) return false;
  for (Index a : problem_.two_sided) state_[a] = two_sided;
  for (Index a : guess)
    if (state_[a] == outside) state_[a] = held;
  Index count = 0;
  for (Index a = 0; a < m_; ++a)
    if (all_known() || state_[a] != outside) list_[count++] = a;
  if (!rows_.add(list_, count)) return false;
  collect();
  return true;
}

/// Lists the working set by their places.
void GramPivoting::collect() {
  set_.clear();
  for (Index p = 0; p < rows_.count(); ++p)
    if (rows_.row(p) >= 0 && holds(rows_.row(p))) set_.list(p);
}

/// Factors the Gram matrix of the working set, leaving dependent ones out; false when those have to stay.
bool GramPivoting::factor() {
  while (!set_.factor(near_dependence)) {
    const bool left = set_.leave_dependent(2 * near_dependence, [&](Index j) {
      if (state_[row(j)] != held || (firm_ >= 0 && j < firm_)) return false;
      state_[row(j)] = passed;
      by_single_steps_ = true;
      return true;
    });
    if (!left) return false;
  }
  return true;
}

/// Multipliers with which the rows of the working set hold with equality.
bool GramPivoting::find_multipliers() {
  if (!set_.is_factored() && !factor()) return false;
  for (Index j = 0; j < padded(set_.size()); ++j) load_[j] = j < set_.size() ? target_[set_.place(j)] : 0;
  set_.solve(load_);
  fill_packs(rows_.count(), 0, lambda_);
  for (Index j = 0; j < set_.size(); ++j) lambda_[set_.place(j)] = load_[j];
  find_energy();
  return true;
}

void GramPivoting::find_energy() {
  energy_ = 0;
  for (Index j = 0; j < set_.size(); ++j) energy_ += lambda_[set_.place(j)] * target_[set_.place(j)];
}

void GramPivoting::find_point(double* w, double* q) const {
  copy_packs(A_.ld, w_free_, w);
  kernels_.combine(n_, rows_.count() / 8, rows_.whitened(), lambda_, w);
  copy_packs(A_.ld, w, q);
  kernels_.backward(n_, A_.ld, A_.T, A_.inverse, q);
}

void GramPivoting::find_slacks() {
  if (all_known()) return find_known_slacks(slack_);  // row a has place a
  find_point(w_, q_);
  kernels_.slacks(m_, n_, problem_.U.dense().data(), q_, problem_.s.data(), slack_);
}

void GramPivoting::find_known_slacks(double* at_places) const {
  for (Index p = 0; p < rows_.count(); ++p) at_places[p] = -target_[p];
  kernels_.add_columns(rows_.count(), set_.size(), set_.places(), lambda_, rows_.gram(0), rows_.stride(),
                       at_places);
}

bool GramPivoting::settle(const std::vector<Index>& guess) { return start(guess) && pivot(); }

bool GramPivoting::settle_again() {
  rows_.reload();
  for (Index a = 0; a < m_; ++a)
    if (state_[a] == passed) state_[a] = outside;
  steps_ = 0;
  start_pivoting();
  return pivot_by_single_steps();  // little is wrong
}

bool GramPivoting::keep_working_set() {
  rows_.reload();
  if (!find_multipliers()) return false;
  find_point(w_, q_);
  return true;
}

void GramPivoting::point(double* w, double* q) const {
  if (all_known()) return find_point(w, q);
  copy_packs(A_.ld, w_, w);
  copy_packs(A_.ld, q_, q);
}

Index GramPivoting::block_of(Index violated) const {
  const double part = n_ <= small ? part_when_small : part_when_large;
  return std::max<Index>(2, static_cast<Index>(std::ceil(part * static_cast<double>(violated))));
}

void GramPivoting::start_pivoting() {
  contradiction_.reset();
  by_single_steps_ = false;
  z_norm_ = std::sqrt(kernels_.dot(A_.ld, w_free_, w_free_));
}

bool GramPivoting::pivot() {
  start_pivoting();
  return (m_ <= few_per_coordinate * n_ && pivot_by_blocks()) || pivot_by_single_steps();
}

/// Block pivoting (Júdice and Pires 1994): the rows whose multiplier is negative go, a block of those
/// violated comes in, until none is wrong. False when their number has not come down for some blocks.
bool GramPivoting::pivot_by_blocks() {
  Index fewest = m_ + 1;
  for (int impatience = 0; impatience <= patience;) {
    if (!find_multipliers() || by_single_steps_) return false;
    find_slacks();
    const Index count = list_violated(outside);
    // At a vertex, of which there may be many where rows just hold, single steps do not lose their way.
    if (set_.size() == n_ && has_negative()) return false;
    const Index leaving = drop_negative();
    if (leaving + count == 0) return list_violated(passed) == 0;
    impatience = leaving + count < fewest ? 0 : impatience + 1;
    fewest = std::min(fewest, leaving + count);
    const Index room = std::min(block_of(count), capacity_ - (set_.size() - leaving));
    if ((leaving == 0 && room == 0) || !take_in(choose_deepest(count, room))) return false;
  }
  return false;
}

double GramPivoting::counted_violation() const {
  return least_violation * (z_norm_ + std::sqrt(std::abs(energy_)));
}

/// Lists the rows in that state that the point found violates.
Index GramPivoting::list_violated(State state) {
  const double scale = counted_violation();
  Index count = 0;
  for (Index a = 0; a < m_; ++a)
    if (state_[a] == state && slack_[a] < -row_scale_[a] * scale) list_[count++] = a;
  return count;
}

bool GramPivoting::has_negative() const {
  for (Index j = 0; j < set_.size(); ++j)
    if (state_[row(j)] == held && lambda_[set_.place(j)] < 0) return true;
  return false;
}

/// Lets go of the one-sided rows whose multiplier is not positive; `collect` is to follow.
Index GramPivoting::drop_negative() {
  Index leaving = 0;
  for (Index j = 0; j < set_.size(); ++j) {
    if (state_[row(j)] != held || lambda_[set_.place(j)] > 0) continue;
    state_[row(j)] = outside;
    leaving += 1;
  }
  steps_ += leaving;
  return leaving;
}

/// Leaves `room` of the rows listed, those deepest below their edge.
Index GramPivoting::choose_deepest(Index count, Index room) {
  const auto deeper = [&](Index a, Index b) { return is_deeper(a, b); };
  // Whether rows are repeated is seen when a large block comes in first.
  const bool is_first = set_.size() == 0 && count >= few_rows && !all_known();
  const Index among = std::min(count, room);
  if (count > among) std::nth_element(list_, list_ + among, list_ + count, deeper);
  if (!by_single_steps_ && !is_first) return among;
  const Index kept = skip_parallel_rows(among);
  if (kept == among) return among;
  by_single_steps_ = true;
  return std::max<Index>(std::min<Index>(2, kept), kept / 2);  // others depend on each other less plainly
}

/// Holds the first `count` rows of the list, and lets go of those that count as held no more.
bool GramPivoting::take_in(Index count) {
  steps_ += count;
  std::copy_n(list_, count, entering_);
  Index fresh = 0;
  for (Index k = 0; k < count; ++k) {
    state_[list_[k]] = held;
    if (rows_.place(list_[k]) < 0) list_[fresh++] = list_[k];
  }
  const bool room = fresh == 0 || rows_.add(list_, fill_block(fresh));
  for (Index k = 0; k < fresh; ++k)
    if (rows_.place(list_[k]) < 0) state_[list_[k]] = outside;
  Index leaving = 0;
  for (Index j = 0; j < set_.size(); ++j) leaving += !holds(row(j));
  if (!room || !set_.is_factored() || most_changes * (leaving + count) > set_.size())
    collect();
  else
    change(count);
  return room;
}

/// Fills the last block of the first `fresh` rows of the list with those that are likely to come in next: not
/// looked at, and closest to their edge or farthest below. Its new length.
Index GramPivoting::fill_block(Index fresh) {
  const Index end = padded(fresh);
  Index length = fresh;
  for (Index a = 0; a < m_ && end > fresh; ++a) {
    if (rows_.place(a) >= 0 || state_[a] != outside) continue;
    if (length == end && !is_deeper(a, list_[end - 1])) continue;
    Index at = length < end ? length++ : end - 1;
    for (; at > fresh && is_deeper(a, list_[at - 1]); --at) list_[at] = list_[at - 1];
    list_[at] = a;
  }
  return length;
}

/// Brings the factor up to date, row by row, the first `count` of entering_ being new.
void GramPivoting::change(Index count) {
  for (Index j = set_.size(); j-- > 0;)
    if (!holds(row(j))) set_.remove(j);
  for (Index k = 0; k < count; ++k) {
    const Index place = rows_.place(entering_[k]);
    const double rest = set_.distance(place, column_);
    if (rest > near_dependence * rows_.square(place)) {
      set_.append(place, column_, rest);
    } else {
      state_[entering_[k]] = passed;
      by_single_steps_ = true;
    }
  }
}

}  // namespace convex::inline pivoting
