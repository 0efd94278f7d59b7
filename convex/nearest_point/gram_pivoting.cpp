#include "convex/nearest_point/gram_pivoting.hpp"

#include <cmath>

namespace convex {
namespace {

/// Up to so many rows all are looked at from the start, and pivoting goes on in their Gram matrix alone.
constexpr Index few_rows = 32;

/// Places for rows that come in later: so many per coordinate, and for blocks of eight that are not filled.
constexpr Index rooms = 2, unfilled = 64;

/// A row held of which less than this part, squared, lies outside the span of the others: nearly dependent,
/// left to the long way; or dependent as far as doubles tell, and left out of the rows held.
constexpr double near_dependence = 1e-6, dependence = 1e-13;

/// A smaller violation than this part of the scale does not count.
constexpr double violation = 1e-12;

/// Blocks that do not lower the number of wrong rows before pivoting has lost its way.
constexpr int patience = 4;

/// The part of the violated rows that comes in at once, up to `small` coordinates and beyond.
constexpr Index small = 50;
constexpr double part_when_small = 0.4, part_when_large = 0.25;

Index places(Index n, Index m) {
  return m <= few_rows ? padded(m) : std::min(padded(m), rooms * padded(n)) + unfilled;
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
      row_scale_(row_scale) {
  const Index most = places(n_, m_), k = padded(capacity_);
  lambda_ = arena.take_filled(most, 0.0);
  w_ = arena.take<double>(n_);
  q_ = arena.take<double>(n_);
  slack_ = arena.take<double>(std::max(m_, most));
  C_ = arena.take<double>(k * k);
  C_inverse_ = arena.take<double>(16 * k);
  load_ = arena.take<double>(k);
  state_ = arena.take_filled<Index>(m_, outside);
  at_ = arena.take<Index>(k);
  list_ = arena.take<Index>(m_);
}

Index GramPivoting::lines(Index n, Index m) {
  const Index most = places(n, m), k = padded(std::min(n, m));
  return GramRows::lines(n, m, most) + (2 * most + 2 * padded(n) + 3 * padded(m) + k * (k + 18)) / 8;
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

/// Lists the rows held by their places.
void GramPivoting::collect() {
  size_ = 0;
  factored_ = false;
  for (Index p = 0; p < rows_.count(); ++p)
    if (rows_.row(p) >= 0 && holds(rows_.row(p))) at_[size_++] = p;
}

/// Factors the Gram matrix of the rows held, leaving dependent ones out; false when there is doubt.
bool GramPivoting::factor() {
  while (size_ > 0) {
    const Index k = size_, ld = padded(k);
    for (Index j = 0; j < k; ++j) {
      const double* from = rows_.gram(at_[j]);
      for (Index i = j; i < k; ++i) C_[j * ld + i] = from[at_[i]];
      for (Index i = k; i < ld; ++i) C_[j * ld + i] = 0;
    }
    for (Index j = k; j < ld; ++j) {
      fill_packs(ld, 0, C_ + j * ld);
      C_[j * ld + j] = 1;
    }
    kernels_.factor(k, ld, C_, C_inverse_);
    Index j = 0;
    double part = 1;
    for (; j < k; ++j) {
      const double pivot = C_[j * ld + j];
      part = pivot * pivot / rows_.square(at_[j]);
      if (!(part > near_dependence)) break;
    }
    factored_ = j == k;
    if (factored_) return true;
    const Index a = rows_.row(at_[j]);
    if (part > dependence || state_[a] == two_sided) return false;
    state_[a] = passed;
    pass_parallel_rows(j);
    Index kept = 0;
    for (Index i = 0; i < k; ++i)
      if (state_[row(i)] != passed) at_[kept++] = at_[i];
    size_ = kept;
  }
  return true;
}

/// Where one row turns out to depend on others, as a rule others are repeated too: these are found all at
/// once.
void GramPivoting::pass_parallel_rows(Index first) {
  for (Index i = first + 1; i < size_; ++i) {
    if (state_[row(i)] == two_sided) continue;
    const double* gram = rows_.gram(at_[i]);
    const double least = (1 - dependence) * rows_.square(at_[i]);
    for (Index j = 0; j < i; ++j)
      if (gram[at_[j]] * gram[at_[j]] >= least * rows_.square(at_[j]) && state_[row(j)] != passed) {
        state_[row(i)] = passed;
        break;
      }
  }
}

void GramPivoting::solve(double* x) const {
  if (size_ == 0) return;
  kernels_.forward(size_, padded(size_), C_, C_inverse_, x);
  kernels_.backward(size_, padded(size_), C_, C_inverse_, x);
}

/// Multipliers with which the rows held hold with equality.
bool GramPivoting::find_multipliers() {
  if (!factored_ && !factor()) return false;
  for (Index j = 0; j < padded(size_); ++j) load_[j] = j < size_ ? rows_.load()[at_[j]] : 0;
  energy_ = 0;
  solve(load_);
  fill_packs(rows_.count(), 0, lambda_);
  for (Index j = 0; j < size_; ++j) {
    lambda_[at_[j]] = load_[j];
    energy_ += load_[j] * rows_.load()[at_[j]];
  }
  return true;
}

void GramPivoting::find_point(double* w, double* q) const {
  copy_packs(A_.ld, w_free_, w);
  kernels_.combine(n_, rows_.count() / 8, rows_.whitened(), lambda_, w);
  copy_packs(A_.ld, w, q);
  kernels_.backward(n_, A_.ld, A_.T, A_.inverse, q);
}

void GramPivoting::find_slacks() {
  if (!all_known()) {
    find_point(w_, q_);
    kernels_.slacks(m_, n_, problem_.U.dense().data(), q_, problem_.s.data(), slack_);
    return;
  }
  for (Index p = 0; p < rows_.count(); ++p) slack_[p] = -rows_.load()[p];  // row a has place a
  for (Index j = 0; j < size_; ++j)
    kernels_.add_multiple(rows_.count(), lambda_[at_[j]], rows_.gram(at_[j]), slack_);
}

bool GramPivoting::settle(const std::vector<Index>& guess) { return start(guess) && pivot(); }

bool GramPivoting::settle_again() {
  rows_.reload();
  for (Index a = 0; a < m_; ++a)
    if (state_[a] == passed) state_[a] = outside;
  steps_ = 0;
  return pivot();
}

void GramPivoting::point(double* w, double* q) const {
  if (all_known()) return find_point(w, q);
  copy_packs(A_.ld, w_, w);
  copy_packs(A_.ld, q_, q);
}

bool GramPivoting::pivot() {
  const double force_norm = std::sqrt(kernels_.dot(A_.ld, w_free_, w_free_));
  Index fewest = m_ + 1;
  Index* const entering = list_;
  for (int impatience = 0; impatience <= patience;) {
    if (!find_multipliers()) return false;
    find_slacks();
    const double scale = violation * (force_norm + std::sqrt(std::abs(energy_)));
    Index leaving = 0, count = 0;
    for (Index j = 0; j < size_; ++j) {
      const Index a = rows_.row(at_[j]);
      if (state_[a] == two_sided || lambda_[at_[j]] > 0) continue;
      state_[a] = outside;
      leaving += 1;
      slack_[a] = 0;  // not at once again
    }
    for (Index a = 0; a < m_; ++a)
      if (state_[a] == outside && slack_[a] < -row_scale_[a] * scale) entering[count++] = a;
    if (leaving + count == 0) return true;
    impatience = leaving + count < fewest ? 0 : impatience + 1;
    fewest = std::min(fewest, leaving + count);
    steps_ += leaving;
    const double part = n_ <= small ? part_when_small : part_when_large;
    Index room = std::max<Index>(2, static_cast<Index>(std::ceil(part * static_cast<double>(count))));
    room = std::min(room, capacity_ - (size_ - leaving));
    if (count > room) {
      const auto deeper = [&](Index a, Index b) {
        return slack_[a] * row_scale_[b] < slack_[b] * row_scale_[a];
      };
      std::nth_element(entering, entering + room, entering + count, deeper);
      count = room;
    }
    steps_ += count;
    Index fresh = 0;
    for (Index k = 0; k < count; ++k) {
      state_[entering[k]] = held;
      if (rows_.place(entering[k]) < 0) entering[fresh++] = entering[k];
    }
    if (fresh > 0 && !rows_.add(entering, fresh)) return false;
    collect();
  }
  return false;
}

double GramPivoting::inverse_norm() const {
  double square = 0;
  for (Index j = 0; j < size_; ++j) {
    const double pivot = C_[j * (padded(size_) + 1)];
    square += 1 / (pivot * pivot);
  }
  return std::sqrt(square);
}

}  // namespace convex
