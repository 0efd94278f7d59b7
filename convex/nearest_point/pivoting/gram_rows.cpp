#include "convex/nearest_point/pivoting/gram_rows.hpp"

#include <algorithm>

namespace convex::inline pivoting {

GramRows::GramRows(const NearestPointProblem& problem, Arena& arena, Index most, const double* w_free)
    : problem_(problem),
      n_(problem.dimension()),
      most_(padded(most)),
      w_free_(w_free),
      raw_(arena.take<double>(n_ * most_)),
      whitened_(arena.take<double>(n_ * most_)),
      gram_(arena.take<double>(most_ * most_)),
      s_(arena.take<double>(most_)),
      load_(arena.take<double>(most_)),
      row_(arena.take<Index>(most_)),
      place_(arena.take_filled<Index>(problem.rows(), -1)) {}

void GramRows::load(Index first) {
  dense_kernels().dots(n_, whitened_ + first * n_, w_free_, load_ + first);
  for (Index place = first; place < first + 8; ++place) {
    s_[place] = row_[place] < 0 ? 0 : problem_.s[row_[place]];
    load_[place] = s_[place] - load_[place];
  }
}

void GramRows::reload() {
  for (Index first = 0; first < count_; first += 8) load(first);
}

bool GramRows::add(const Index* rows, Index count) {
  const DenseKernels& kernels = dense_kernels();
  const DenseFactor factor = problem_.A.dense_factor();
  for (Index first = 0; first < count; first += 8) {
    if (count_ == most_) return false;
    const Index fresh = std::min<Index>(8, count - first);
    double* const raw = raw_ + count_ * n_;
    double* const whitened = whitened_ + count_ * n_;
    kernels.side_by_side(n_, problem_.rows(), problem_.U.dense().data(), rows + first, fresh, raw);
    copy_packs(8 * n_, raw, whitened);
    kernels.forward_pack(n_, factor.ld, factor.T, factor.inverse, whitened);
    for (Index k = 0; k < 8; ++k) {
      row_[count_ + k] = k < fresh ? rows[first + k] : -1;
      if (k < fresh) place_[rows[first + k]] = count_ + k;
    }
    load(count_);
    for (Index other = 0; other <= count_; other += 8) {
      kernels.gram(n_, whitened_ + other * n_, whitened, gram_ + count_ * most_ + other, most_);
      if (other < count_)
        for (Index k = 0; k < 8; ++k)
          for (Index l = 0; l < 8; ++l)
            gram_[(other + k) * most_ + count_ + l] = gram_[(count_ + l) * most_ + other + k];
    }
    count_ += 8;
  }
  return true;
}

}  // namespace convex::inline pivoting
