#include "convex/nearest_point/proof/exact_tableau.hpp"

#include <algorithm>

namespace convex::inline proof {

ExactTableau::ExactTableau(std::vector<Index> basic, std::vector<Fraction> value, std::vector<Index> nonbasic,
                           std::vector<std::vector<Fraction>> T, std::vector<bool> is_free)
    : basic_(std::move(basic)),
      nonbasic_(std::move(nonbasic)),
      value_(std::move(value)),
      T_(std::move(T)),
      free_(std::move(is_free)),
      unbounded_(free_.size(), false) {
  settle_free_columns();
}

std::ptrdiff_t ExactTableau::basic_row(Index a) const {
  const auto found = std::find(basic_.begin(), basic_.end(), a);
  return found == basic_.end() ? -1 : found - basic_.begin();
}

std::ptrdiff_t ExactTableau::blocking(std::size_t j, int side, std::ptrdiff_t except) const {
  std::ptrdiff_t first = -1;
  Fraction step;
  for (std::size_t k = 0; k < basic_.size(); ++k) {
    if (is_free(basic_[k]) || static_cast<std::ptrdiff_t>(k) == except) continue;
    const Fraction slope = side > 0 ? T_[k][j] : -T_[k][j];
    if (sign(slope) <= 0) continue;
    const Fraction own = value_[k] / slope;
    const bool sooner = first < 0 || own < step;
    if (!sooner && !(own == step && basic_[k] < basic_[static_cast<std::size_t>(first)])) continue;
    first = static_cast<std::ptrdiff_t>(k);
    step = own;
  }
  return first;
}

void ExactTableau::pivot(std::size_t k, std::size_t j) {
  const Fraction inverse = Fraction{1, 1} / T_[k][j];
  T_[k][j] = {1, 1};
  for (Fraction& entry : T_[k]) entry = entry * inverse;
  value_[k] = value_[k] * inverse;
  for (std::size_t r = 0; r < basic_.size(); ++r) {
    if (r == k || sign(T_[r][j]) == 0) continue;
    const Fraction slope = T_[r][j];
    T_[r][j] = {0, 1};
    for (std::size_t i = 0; i < nonbasic_.size(); ++i)
      if (sign(T_[k][i]) != 0) T_[r][i] = T_[r][i] - slope * T_[k][i];
    value_[r] = value_[r] - slope * value_[k];
  }
  std::swap(basic_[k], nonbasic_[j]);
}

/// Free multipliers enter the basis for good; one that no sign hinders moves its partners without bound.
void ExactTableau::settle_free_columns() {
  for (std::size_t j = 0; j < nonbasic_.size();) {
    if (!is_free(nonbasic_[j])) {
      ++j;
      continue;
    }
    std::ptrdiff_t row = blocking(j, 1, -1);
    if (row < 0) row = blocking(j, -1, -1);
    if (row >= 0) {
      pivot(static_cast<std::size_t>(row), j);
      continue;
    }
    unbounded_[static_cast<std::size_t>(nonbasic_[j])] = true;
    for (std::size_t k = 0; k < basic_.size(); ++k) {
      if (sign(T_[k][j]) != 0) unbounded_[static_cast<std::size_t>(basic_[k])] = true;
      T_[k].erase(T_[k].begin() + static_cast<std::ptrdiff_t>(j));
    }
    nonbasic_.erase(nonbasic_.begin() + static_cast<std::ptrdiff_t>(j));
  }
}

std::optional<Fraction> ExactTableau::highest(Index a) {
  while (true) {
    const std::ptrdiff_t own = basic_row(a);
    std::ptrdiff_t entering = -1;
    for (std::size_t j = 0; j < nonbasic_.size(); ++j) {
      const bool rises = own < 0 ? nonbasic_[j] == a : sign(T_[static_cast<std::size_t>(own)][j]) < 0;
      if (rises && (entering < 0 || nonbasic_[j] < nonbasic_[static_cast<std::size_t>(entering)]))
        entering = static_cast<std::ptrdiff_t>(j);
    }
    if (entering < 0) return value_[static_cast<std::size_t>(own)];
    const std::ptrdiff_t row = blocking(static_cast<std::size_t>(entering), 1, own);
    if (row < 0) return std::nullopt;
    pivot(static_cast<std::size_t>(row), static_cast<std::size_t>(entering));
  }
}

std::optional<Fraction> ExactTableau::lowest(Index a) {
  while (true) {
    const std::ptrdiff_t own = basic_row(a);
    if (own < 0) return Fraction{};
    std::ptrdiff_t entering = -1;
    for (std::size_t j = 0; j < nonbasic_.size(); ++j)
      if (sign(T_[static_cast<std::size_t>(own)][j]) > 0 &&
          (entering < 0 || nonbasic_[j] < nonbasic_[static_cast<std::size_t>(entering)]))
        entering = static_cast<std::ptrdiff_t>(j);
    if (entering < 0) return value_[static_cast<std::size_t>(own)];
    const std::ptrdiff_t row = blocking(static_cast<std::size_t>(entering), 1, -1);
    if (row < 0) return std::nullopt;
    pivot(static_cast<std::size_t>(row), static_cast<std::size_t>(entering));
  }
}

ExactInterval ExactTableau::range(Index a) {
  if (unbounded_[static_cast<std::size_t>(a)]) return {};
  ExactInterval found;
  found.low = lowest(a);
  found.high = highest(a);
  return found;
}

}  // namespace convex::inline proof
