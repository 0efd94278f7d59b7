#include "convex/nearest_point/block_guess.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "convex/triangular_solve.hpp"

namespace convex {
namespace {

/// Added to the diagonal of the Gram matrix, relative, so that dependent rows share their multipliers.
constexpr double ridge = 1e-9;

/// Blocks tried after the last one that reduced the number of wrong rows.
constexpr int patience = 2;

/// A row counts as violated beyond this part of the scale of the problem.
constexpr double violation = 1e-12;

/// All violated rows at once overshoot where rows interact; the deepest part of them settles in fewer blocks.
/// Up to `small` coordinates a block costs more than rows that come in needlessly, beyond it less.
constexpr Index small = 50;
constexpr double part_when_small = 0.4;
constexpr double part_when_large = 0.25;

/// Room for so many rows per coordinate; a guess that has tried more has lost its way.
constexpr Index rooms = 2;

/// So many doubles of memory, in one block, to hold `needed` of them. The allocator of glibc keeps free
/// memory up to twice the largest block that it has seen, as long as that has at most 2^22 doubles
/// (mallopt(3), M_TRIM_THRESHOLD), and gives the rest back; then the next problem pays again for every page,
/// up to three times what it costs itself. A block of a generous size is not touched where it is not needed.
Index room_for(Index needed) {
  constexpr Index least = Index{1} << 16, most = Index{1} << 21;
  return std::max({needed, std::min(2 * needed, most), least});
}

/// Rows that were active once, whitened, in the order in which they first came in (their places), with their
/// Gram matrix; and the Cholesky factor of that of the active ones, of which a change keeps what stands
/// before it.
class WhitenedRows {
 public:
  WhitenedRows(const NearestPointProblem& problem, const Vector& w_free)
      : problem_(problem),
        w_free_(w_free),
        place_(static_cast<std::size_t>(problem.rows()), -1),
        capacity_(std::min(problem.rows(), rooms * problem.dimension())),
        most_(std::min(problem.rows(), problem.dimension())),
        room_(room_for((problem.dimension() + capacity_ + 1) * capacity_ + (most_ + 1) * most_)),
        V_(room_.data(), problem.dimension(), capacity_),
        gram_(V_.data() + V_.size(), capacity_, capacity_),
        factor_(gram_.data() + gram_.size(), most_, most_),
        load_(factor_.data() + factor_.size(), capacity_),
        forward_(load_.data() + load_.size(), most_) {}

  /// False when there is no room for them.
  bool require(const std::vector<Index>& rows) {
    fresh_.clear();
    for (Index a : rows)
      if (place_[static_cast<std::size_t>(a)] < 0) {
        place_[static_cast<std::size_t>(a)] = count_ + static_cast<Index>(fresh_.size());
        fresh_.push_back(a);
      }
    if (fresh_.empty()) return true;
    const Index added = static_cast<Index>(fresh_.size()), total = count_ + added;
    if (total > capacity_) return false;
    for (Index k = 0; k < added; ++k)
      problem_.U.copy_row(fresh_[static_cast<std::size_t>(k)], V_.col(count_ + k));
    auto block = V_.middleCols(count_, added);
    problem_.A.whiten_in_place(block);
    gram_.block(0, count_, total, added).noalias() = V_.leftCols(total).transpose() * block;
    load_.segment(count_, added).noalias() = -(block.transpose() * w_free_);
    for (Index k = 0; k < added; ++k) load_[count_ + k] += problem_.s[fresh_[static_cast<std::size_t>(k)]];
    count_ = total;
    return true;
  }

  Index place(Index a) const { return place_[static_cast<std::size_t>(a)]; }

  /// The whitened rows as columns.
  Matrix columns(const std::vector<Index>& rows) const {
    Matrix chosen(problem_.dimension(), static_cast<Index>(rows.size()));
    for (std::size_t k = 0; k < rows.size(); ++k) chosen.col(static_cast<Index>(k)) = V_.col(place(rows[k]));
    return chosen;
  }

  /// Multipliers with which all rows, in the order of their places, hold with equality; w is set to the
  /// point.
  void solve(const std::vector<Index>& rows, Vector& lambda, Vector& w) {
    const Index k = static_cast<Index>(rows.size());
    Index kept = 0;
    while (kept < std::min(k, static_cast<Index>(at_.size())) &&
           at_[static_cast<std::size_t>(kept)] == place(rows[static_cast<std::size_t>(kept)]))
      ++kept;
    at_.resize(rows.size());
    for (std::size_t i = static_cast<std::size_t>(kept); i < rows.size(); ++i) at_[i] = place(rows[i]);
    factor(kept, k);
    lambda = forward_.head(k);
    solve_upper_triangle(factor_.topLeftCorner(k, k), lambda);
    weights_.setZero(count_);
    for (Index j = 0; j < k; ++j) weights_[at_[static_cast<std::size_t>(j)]] = lambda[j];
    w = w_free_;
    w.noalias() += V_.leftCols(count_) * weights_;
  }

 private:
  /// Rows kept … k of the factor L of the active rows' Gram matrix and of L⁻¹load.
  void factor(Index kept, Index k) {
    for (Index j = kept; j < k; ++j) {
      const double* from = &gram_(0, at_[static_cast<std::size_t>(j)]);
      for (Index i = 0; i <= j; ++i) factor_(i, j) = from[at_[static_cast<std::size_t>(i)]];
    }
    constexpr Index together = 16;  // columns that are brought up to date by matrix products
    for (Index first = kept; first < k; first += together) {
      const Index width = std::min(together, k - first);
      auto above = factor_.block(0, first, first, width);
      auto corner = factor_.block(first, first, width, width);
      solve_lower_triangle(factor_.topLeftCorner(first, first), above);
      corner.noalias() -= above.transpose() * above;
      double U[together]
              [together + 1];  // the corner's upper triangle and, as the last column, its right side
      for (Index i = 0; i < width; ++i) {
        for (Index j = i; j < width; ++j) U[i][j] = corner(i, j);
        const Index at = at_[static_cast<std::size_t>(first + i)];
        U[i][i] += ridge * gram_(at, at);
        U[i][width] = load_[at] - above.col(i).dot(forward_.head(first));
      }
      for (Index p = 0; p < width; ++p) {
        const Index at = at_[static_cast<std::size_t>(first + p)];
        const double pivot = std::sqrt(std::max(U[p][p], ridge * gram_(at, at)));
        for (Index j = p; j <= width; ++j) U[p][j] /= pivot;
        U[p][p] = pivot;
        for (Index i = p + 1; i < width; ++i)
          for (Index j = i; j <= width; ++j) U[i][j] -= U[p][i] * U[p][j];
      }
      for (Index p = 0; p < width; ++p) {
        for (Index j = p; j < width; ++j) corner(p, j) = corner(j, p) = U[p][j];
        forward_[first + p] = U[p][width];
        for (Index i = 0; i < first; ++i) factor_(first + p, i) = above(i, p);
      }
    }
  }

  const NearestPointProblem& problem_;
  const Vector& w_free_;
  std::vector<Index> place_;  // of row a in V_, or -1
  std::vector<Index> fresh_, at_;
  Index capacity_, most_;
  Vector room_;
  Eigen::Map<Matrix> V_, gram_, factor_;  // gram_: the upper triangle of the Gram matrix; factor_: L and Lᵀ
  Eigen::Map<Vector> load_, forward_;     // load_: s_a - v_a·w_free; forward_: L⁻¹load of the active rows
  Vector weights_;
  Index count_ = 0;
};

}  // namespace

GuessedRows guess_by_blocks(const NearestPointProblem& problem, const Vector& w_free, const Vector& row_scale,
                            std::vector<Index> active, Vector slack) {
  const Index m = problem.rows();
  const std::size_t most = static_cast<std::size_t>(std::min(m, problem.dimension()));
  std::vector<bool> two_sided(static_cast<std::size_t>(m), false), in(static_cast<std::size_t>(m), false);
  for (Index a : problem.two_sided) two_sided[static_cast<std::size_t>(a)] = true;
  WhitenedRows rows(problem, w_free);
  Vector w = w_free, lambda, q;
  std::vector<Index> best, next, entering;
  std::size_t fewest = std::numeric_limits<std::size_t>::max();
  int impatience = 0;
  bool first = active.empty();
  if (first) active = problem.two_sided;
  const auto guess = [&](std::vector<Index> chosen, bool settled) {
    std::erase_if(chosen, [&](Index a) { return two_sided[static_cast<std::size_t>(a)]; });
    return GuessedRows{chosen, rows.columns(chosen), settled};
  };
  while (true) {
    if (!first) {
      if (active.size() > most || !rows.require(active)) return guess(best, false);
      std::sort(active.begin(), active.end(),
                [&](Index a, Index b) { return rows.place(a) < rows.place(b); });
      rows.solve(active, lambda, w);
      q = w;
      problem.A.unwhiten_in_place(q);
      problem.U.times(q, slack);
      slack -= problem.s;
    }
    std::fill(in.begin(), in.end(), false);
    for (Index a : active) in[static_cast<std::size_t>(a)] = true;
    const double scale = violation * std::max(w.norm(), w_free.norm());
    next.clear();
    entering.clear();
    for (std::size_t k = 0; k < active.size(); ++k)
      if (first || two_sided[static_cast<std::size_t>(active[k])] || lambda[static_cast<Index>(k)] > 0)
        next.push_back(active[k]);
    for (Index a = 0; a < m; ++a)
      if (!in[static_cast<std::size_t>(a)] && slack[a] < -row_scale[a] * scale) entering.push_back(a);
    const std::size_t wrong = active.size() - next.size() + entering.size();
    if (wrong < fewest) {
      fewest = wrong;
      best = next;
      impatience = 0;
    } else if (!first && ++impatience > patience) {
      return guess(best, false);
    }
    if (wrong == 0) return guess(active, true);
    first = false;
    const double fraction = problem.dimension() <= small ? part_when_small : part_when_large;
    const std::size_t part = std::max<std::size_t>(
        2, static_cast<std::size_t>(std::ceil(fraction * static_cast<double>(entering.size()))));
    const std::size_t room = std::min(most - next.size(), part);
    if (entering.size() > room) {
      const auto deeper = [&](Index a, Index b) { return slack[a] * row_scale[b] < slack[b] * row_scale[a]; };
      std::nth_element(entering.begin(), entering.begin() + static_cast<std::ptrdiff_t>(room), entering.end(),
                       deeper);
      entering.resize(room);
    }
    next.insert(next.end(), entering.begin(), entering.end());
    active.swap(next);
  }
}

}  // namespace convex
