#include "convex/nearest_point/reductions/islands.hpp"

#include <algorithm>
#include <numeric>

namespace convex::inline reductions {
namespace {

/// Below this many coordinates, or with more than this part of the entries there, dense is faster.
constexpr Index small_island = 64;
constexpr double sparse_island_part = 0.25;

/// Sets of coordinates, merged two by two; the least coordinate stands for its set.
class DisjointSets {
 public:
  explicit DisjointSets(Index n) : parent_(at(n)), count_(n) {
    std::iota(parent_.begin(), parent_.end(), Index{0});
  }
  Index count() const { return count_; }
  Index find(Index i) {
    while (parent_[at(i)] != i) {
      Index& up = parent_[at(i)];
      up = parent_[at(up)];
      i = up;
    }
    return i;
  }
  void merge(Index i, Index j) {
    i = find(i);
    j = find(j);
    if (i == j) return;
    parent_[at(std::max(i, j))] = std::min(i, j);
    --count_;
  }

 private:
  std::vector<Index> parent_;
  Index count_;
};

void merge_through_A(const Metric& A, DisjointSets& sets) {
  if (A.kind() == MetricKind::dense) {
    const Matrix& W = A.dense_gram();
    for (Index j = 0; j < W.cols() && sets.count() > 1; ++j)
      for (Index i = j + 1; i < W.rows(); ++i)
        if (W(i, j) != 0) sets.merge(i, j);
  } else if (A.kind() == MetricKind::sparse) {
    const SparseMatrix& W = A.sparse_gram();
    for (Index j = 0; j < W.cols() && sets.count() > 1; ++j)
      for (SparseMatrix::InnerIterator it(W, j); it && it.row() < j; ++it)
        if (it.value() != 0) sets.merge(it.row(), j);
  }
}

/// Merges the coordinates of each row; first: one coordinate of each, -1 for none.
void merge_through_rows(const ConstraintRows& U, DisjointSets& sets, std::vector<Index>& first) {
  for (Index a = 0; a < U.count(); ++a) {
    Index& seen = first[at(a)];
    const auto take = [&](Index i, double value) {
      if (value == 0) return;
      if (seen < 0)
        seen = i;
      else
        sets.merge(seen, i);
    };
    if (U.is_sparse()) {
      for (SparseRows::InnerIterator it(U.sparse(), a); it; ++it) take(it.col(), it.value());
    } else {
      for (Index i = 0; i < U.dimension(); ++i) {
        take(i, U.dense()(a, i));
        if (seen >= 0 && sets.count() == 1) break;
      }
    }
  }
}

Metric metric_block(const Metric& A, const std::vector<Index>& coordinates, const std::vector<Index>& place) {
  const Index n = static_cast<Index>(coordinates.size());
  if (A.kind() == MetricKind::dense) {
    Matrix block(n, n);
    for (Index j = 0; j < n; ++j)
      for (Index i = 0; i < n; ++i) block(i, j) = A.dense_gram()(coordinates[at(i)], coordinates[at(j)]);
    // Nothing is coupled to others, so that the rows of its factor are those of the whole.
    const DenseFactor factor = A.dense_factor();
    Matrix L = Matrix::Zero(n, n);
    for (Index j = 0; j < n; ++j)
      for (Index i = j; i < n; ++i) L(i, j) = factor.T[coordinates[at(i)] + coordinates[at(j)] * factor.ld];
    return Metric::dense(block, L);
  }
  if (A.kind() == MetricKind::sparse) {
    std::vector<Eigen::Triplet<double>> entries;
    for (Index j = 0; j < n; ++j)
      for (SparseMatrix::InnerIterator it(A.sparse_gram(), coordinates[at(j)]); it; ++it)
        if (it.value() != 0)
          entries.emplace_back(static_cast<int>(place[at(it.row())]), static_cast<int>(j), it.value());
    SparseMatrix block(n, n);
    block.setFromTriplets(entries.begin(), entries.end());
    const double all = static_cast<double>(n) * static_cast<double>(n);
    const bool dense = block.nonZeros() > n && (n <= small_island || static_cast<double>(block.nonZeros()) >
                                                                         sparse_island_part * all);
    return dense ? Metric::dense(Matrix(block)) : Metric::sparse(block);
  }
  Vector diagonal(n);
  for (Index i = 0; i < n; ++i) diagonal[i] = A.diagonal()[coordinates[at(i)]];
  return A.kind() == MetricKind::identity ? Metric::identity(n) : Metric::diagonal(diagonal);
}

ConstraintRows row_block(const ConstraintRows& U, const std::vector<Index>& coordinates,
                         const std::vector<Index>& rows, const std::vector<Index>& place) {
  const Index n = static_cast<Index>(coordinates.size()), m = static_cast<Index>(rows.size());
  if (!U.is_sparse() || n <= small_island) {
    RowMatrix block = RowMatrix::Zero(m, n);
    for (Index k = 0; k < m; ++k) {
      const Index a = rows[at(k)];
      if (U.is_sparse())
        U.for_each_entry(a, [&](Index i, double u) { block(k, place[at(i)]) = u; });
      else
        for (Index i = 0; i < n; ++i) block(k, i) = U.dense()(a, coordinates[at(i)]);
    }
    return ConstraintRows(std::move(block));
  }
  std::vector<Eigen::Triplet<double>> entries;
  for (Index k = 0; k < m; ++k)
    U.for_each_entry(rows[at(k)], [&](Index i, double u) {
      entries.emplace_back(static_cast<int>(k), static_cast<int>(place[at(i)]), u);
    });
  SparseRows block(m, n);
  block.setFromTriplets(entries.begin(), entries.end());
  return ConstraintRows(std::move(block));
}

}  // namespace

Islands find_islands(const NearestPointProblem& problem) {
  const Index n = problem.dimension();
  DisjointSets sets(n);
  Islands found;
  found.of_row.assign(at(problem.rows()), -1);
  merge_through_A(problem.A, sets);
  merge_through_rows(problem.U, sets, found.of_row);
  found.of_coordinate.resize(at(n));
  for (Index i = 0; i < n; ++i) {
    const Index root = sets.find(i);  // the least of its set, so numbered already unless it is i
    found.of_coordinate[at(i)] = root == i ? found.count++ : found.of_coordinate[at(root)];
  }
  for (Index& island : found.of_row)
    if (island >= 0) island = found.of_coordinate[at(island)];
  return found;
}

IslandLists list_islands(const Islands& islands) {
  IslandLists lists;
  lists.coordinates.resize(at(islands.count));
  lists.rows.resize(at(islands.count));
  for (std::size_t i = 0; i < islands.of_coordinate.size(); ++i)
    lists.coordinates[at(islands.of_coordinate[i])].push_back(static_cast<Index>(i));
  for (std::size_t a = 0; a < islands.of_row.size(); ++a)
    if (islands.of_row[a] >= 0) lists.rows[at(islands.of_row[a])].push_back(static_cast<Index>(a));
  return lists;
}

NearestPointProblem island_problem(const NearestPointProblem& whole, const std::vector<Index>& coordinates,
                                   const std::vector<Index>& rows, std::vector<Index>& place) {
  const Index n = static_cast<Index>(coordinates.size()), m = static_cast<Index>(rows.size());
  place.resize(at(whole.dimension()));
  for (Index i = 0; i < n; ++i) place[at(coordinates[static_cast<std::size_t>(i)])] = i;
  NearestPointProblem part{metric_block(whole.A, coordinates, place),
                           Vector(n),
                           row_block(whole.U, coordinates, rows, place),
                           Vector(m),
                           {},
                           select(whole.radii, rows)};
  for (Index i = 0; i < n; ++i) part.z[i] = whole.z[coordinates[at(i)]];
  for (Index k = 0; k < m; ++k) {
    const Index a = rows[at(k)];
    part.s[k] = whole.s[a];
    if (whole.is_two_sided(a)) part.two_sided.push_back(k);
  }
  return part;
}

}  // namespace convex::inline reductions
