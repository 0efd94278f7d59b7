#include "convex/nearest_point/block_guess.hpp"

#include <Eigen/Cholesky>
#include <algorithm>
#include <limits>

namespace convex {
namespace {

/// Added to the diagonal of the Gram matrix, relative, so that dependent rows share their multipliers.
constexpr double ridge = 1e-9;

/// Blocks tried after the last one that reduced the number of wrong rows.
constexpr int patience = 2;

/// A row counts as violated beyond this part of the scale of the problem.
constexpr double violation = 1e-12;

/// From this dimension on a block costs more than what it does too much, and the deeper half comes in, not
/// the third.
constexpr Index large = 100;

/// Rows that were active once, whitened, with their Gram matrix.
class WhitenedRows {
 public:
  WhitenedRows(const NearestPointProblem& problem, const Vector& w_free)
      : problem_(problem), w_free_(w_free), place_(static_cast<std::size_t>(problem.rows()), -1) {}

  void require(const std::vector<Index>& rows) {
    std::vector<Index> fresh;
    for (Index a : rows)
      if (place_[static_cast<std::size_t>(a)] < 0) {
        place_[static_cast<std::size_t>(a)] = count_ + static_cast<Index>(fresh.size());
        fresh.push_back(a);
      }
    if (fresh.empty()) return;
    const Index added = static_cast<Index>(fresh.size()), total = count_ + added;
    if (total > V_.cols()) {
      const Index room = std::min(problem_.rows(), std::max(total, 2 * V_.cols()));
      V_.conservativeResize(problem_.dimension(), room);
      gram_.conservativeResize(room, room);
      load_.conservativeResize(room);
    }
    for (Index k = 0; k < added; ++k)
      problem_.U.copy_row(fresh[static_cast<std::size_t>(k)], V_.col(count_ + k));
    auto block = V_.middleCols(count_, added);
    problem_.A.whiten_in_place(block);
    if (count_ > 0) gram_.block(count_, 0, added, count_).noalias() = block.transpose() * V_.leftCols(count_);
    gram_.block(count_, count_, added, added).triangularView<Eigen::Lower>() = block.transpose() * block;
    load_.segment(count_, added).noalias() = -(block.transpose() * w_free_);
    for (Index k = 0; k < added; ++k) load_[count_ + k] += problem_.s[fresh[static_cast<std::size_t>(k)]];
    count_ = total;
  }

  /// The whitened rows as columns.
  Matrix columns(const std::vector<Index>& rows) const {
    Matrix chosen(problem_.dimension(), static_cast<Index>(rows.size()));
    for (std::size_t k = 0; k < rows.size(); ++k)
      chosen.col(static_cast<Index>(k)) = V_.col(place_[static_cast<std::size_t>(rows[k])]);
    return chosen;
  }

  /// Multipliers with which all rows hold with equality; w is set to the point.
  Vector solve(const std::vector<Index>& rows, Vector& w) const {
    const Index k = static_cast<Index>(rows.size());
    std::vector<Index> at(rows.size());
    for (std::size_t i = 0; i < rows.size(); ++i) at[i] = place_[static_cast<std::size_t>(rows[i])];
    Matrix G(k, k);
    Vector lambda(k);
    for (Index j = 0; j < k; ++j) {
      const Index column = at[static_cast<std::size_t>(j)];
      for (Index i = j; i < k; ++i) {
        const Index row = at[static_cast<std::size_t>(i)];
        G(i, j) = row >= column ? gram_(row, column) : gram_(column, row);
      }
      G(j, j) *= 1 + ridge;
      lambda[j] = load_[column];
    }
    Eigen::LLT<Eigen::Ref<Matrix>> factor(G);
    factor.solveInPlace(lambda);
    Vector weights = Vector::Zero(count_);
    for (Index j = 0; j < k; ++j) weights[at[static_cast<std::size_t>(j)]] = lambda[j];
    w = w_free_;
    w.noalias() += V_.leftCols(count_) * weights;
    return lambda;
  }

 private:
  const NearestPointProblem& problem_;
  const Vector& w_free_;
  std::vector<Index> place_;  // of row a in V_, or -1
  Matrix V_, gram_;           // the lower triangle of the Gram matrix
  Vector load_;               // s_a - v_a·w_free
  Index count_ = 0;
};

}  // namespace

GuessedRows guess_by_blocks(const NearestPointProblem& problem, const Vector& w_free, const Vector& row_scale,
                            std::vector<Index> active) {
  const Index m = problem.rows();
  const std::size_t most = static_cast<std::size_t>(std::min(m, problem.dimension()));
  std::vector<bool> two_sided(static_cast<std::size_t>(m), false), in(static_cast<std::size_t>(m), false);
  for (Index a : problem.two_sided) two_sided[static_cast<std::size_t>(a)] = true;
  WhitenedRows rows(problem, w_free);
  Vector w = w_free, lambda;
  std::vector<Index> best;
  std::size_t fewest = std::numeric_limits<std::size_t>::max();
  int impatience = 0;
  bool first = active.empty();
  if (first) active = problem.two_sided;
  const auto guess = [&](std::vector<Index> chosen) {
    std::erase_if(chosen, [&](Index a) { return two_sided[static_cast<std::size_t>(a)]; });
    rows.require(chosen);
    return GuessedRows{chosen, rows.columns(chosen)};
  };
  while (true) {
    if (active.size() > most) return guess(best);
    if (!active.empty()) {
      rows.require(active);
      lambda = rows.solve(active, w);
    } else {
      w = w_free;
    }
    std::fill(in.begin(), in.end(), false);
    for (Index a : active) in[static_cast<std::size_t>(a)] = true;
    const Vector slack = problem.U.times(problem.A.unwhiten(w)) - problem.s;
    const double scale = violation * std::max(w.norm(), w_free.norm());
    std::vector<Index> next, entering;
    for (std::size_t k = 0; k < active.size(); ++k)
      if (two_sided[static_cast<std::size_t>(active[k])] || lambda[static_cast<Index>(k)] > 0)
        next.push_back(active[k]);
    for (Index a = 0; a < m; ++a)
      if (!in[static_cast<std::size_t>(a)] && slack[a] < -row_scale[a] * scale) entering.push_back(a);
    const std::size_t wrong = active.size() - next.size() + entering.size();
    if (wrong < fewest) {
      fewest = wrong;
      best = next;
      impatience = 0;
    } else if (!first && ++impatience > patience) {
      return guess(best);
    }
    if (wrong == 0) return guess(active);
    first = false;
    // All at once overshoots where rows interact strongly; the deepest part of them settles in fewer blocks.
    const std::size_t divisor = problem.dimension() < large ? 3 : 2;
    const std::size_t part = std::max<std::size_t>(2, (entering.size() + divisor - 1) / divisor);
    const std::size_t room = std::min(most - next.size(), part);
    if (entering.size() > room) {
      const auto deeper = [&](Index a, Index b) { return slack[a] * row_scale[b] < slack[b] * row_scale[a]; };
      std::nth_element(entering.begin(), entering.begin() + static_cast<std::ptrdiff_t>(room), entering.end(),
                       deeper);
      entering.resize(room);
    }
    next.insert(next.end(), entering.begin(), entering.end());
    std::sort(next.begin(), next.end());
    active = std::move(next);
  }
}

}  // namespace convex
