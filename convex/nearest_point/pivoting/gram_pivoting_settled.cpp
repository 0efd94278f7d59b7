#include <algorithm>
#include <cmath>

#include "convex/nearest_point/pivoting/gram_pivoting.hpp"

namespace convex::inline pivoting {

void GramPivoting::clear_rows(double zero, const double* multipliers, const double* slacks) {
  any_close_ = false;
  for (Index j = 0; j < set_.size(); ++j)
    if (const Index a = row(j); state_[a] == held) {
      const bool is_clear = multipliers[set_.place(j)] * std::sqrt(rows_.square(set_.place(j))) > zero;
      state_[a] = is_clear ? clear : held;
      any_close_ = any_close_ || !is_clear;
    }
  for (Index p = 0; p < rows_.count(); ++p)
    if (const Index a = rows_.row(p); a >= 0 && !holds(a)) {
      const bool is_clear = slacks[a] > row_scale_[a] * zero;
      state_[a] = is_clear ? clear_outside : outside;
      any_close_ = any_close_ || !is_clear;
    }
}

bool GramPivoting::settle_rest(const double* load, double norm) {
  target_ = load;
  z_norm_ = norm;
  const bool settled = any_close_ ? descend_known() : find_multipliers();
  target_ = rows_.load();
  any_close_ = false;
  for (Index a = 0; a < m_; ++a) {
    if (state_[a] == clear_outside) state_[a] = outside;
    if (state_[a] == clear) state_[a] = held;
  }
  return settled;
}

std::vector<Index> GramPivoting::one_sided_working_set() const {
  std::vector<Index> rows;
  for (Index a = 0; a < m_; ++a)
    if (state_[a] == held || state_[a] == clear) rows.push_back(a);
  return rows;
}

bool GramPivoting::hold_also(const Index* rows, Index count) {
  firm_ = set_.size();
  for (Index k = 0; k < count && set_.size() < capacity_;) {
    while (k < count && set_.size() < capacity_) set_.list(rows_.place(rows[k++]));
    if (!factor()) return false;
  }
  return true;
}

void GramPivoting::hold_no_more() {
  if (firm_ < 0) return;
  set_.keep_first(firm_);
  firm_ = -1;
}

void GramPivoting::distances(const Index* rows, Index count, double* X, double* squared) const {
  Index places[8];
  for (Index l = 0; l < count; ++l) places[l] = rows_.place(rows[l]);
  set_.distances(places, count, X, squared);
}

double GramPivoting::inverse_norm() const {
  double square = 0;
  for (Index j = 0; j < set_.size(); ++j) {
    square += 1 / (set_.pivot(j) * set_.pivot(j));
  }
  return std::sqrt(square);
}

double GramPivoting::condition(double* x) const {
  constexpr int passes = 2;
  double largest = 0, sum = static_cast<double>(set_.size());
  for (Index j = 0; j < padded(set_.size()); ++j)
    x[j] = j < set_.size() ? (j % 2 == 0 ? 1 : -1) * std::sqrt(rows_.square(set_.place(j))) : 0;
  for (int pass = 0; pass < passes && sum > 0; ++pass) {
    const double before = std::sqrt(sum);
    for (Index j = 0; j < set_.size(); ++j) x[j] /= before;
    set_.solve(x);
    sum = 0;
    for (Index j = 0; j < set_.size(); ++j) {
      const double square = rows_.square(set_.place(j));
      sum += x[j] * x[j] * square;
      x[j] *= square;
    }
    largest = std::max(largest, std::sqrt(sum));
  }
  for (Index j = 0; j < set_.size(); ++j) {
    largest = std::max(largest, rows_.square(set_.place(j)) / (set_.pivot(j) * set_.pivot(j)));
  }
  return static_cast<double>(set_.size()) * largest;
}

}  // namespace convex::inline pivoting
