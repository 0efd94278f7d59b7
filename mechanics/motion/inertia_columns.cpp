#include "mechanics/motion/inertia_columns.hpp"

#include <algorithm>
#include <iterator>

namespace mechanics::inline motions {

using convex::Index;
using expression::Slot;

namespace {

/// Columns found in one sweep.
constexpr std::size_t lanes_at_once = 8;

}  // namespace

bool InertiaColumns::find() {
  if (!is_begun_ || branches_ != series_.branches()) find_structure();
  bool is_new = !is_begun_;
  is_begun_ = true;
  for (std::size_t k = 0; k < terms_.size(); ++k) {
    const double c = series_.terms()[terms_[k].number].c;
    is_new = is_new || !(partials_[k] == c);
    partials_[k] = c;
  }
  if (!is_new) return false;
  const std::size_t lanes = std::min(lanes_at_once, colours_);
  change_.assign(series_.series() * lanes, 0.0);
  for (std::size_t first = 0; first < colours_; first += lanes) sweep(first, lanes);
  return true;
}

/// Which velocities each series depends on.
void InertiaColumns::find_structure() {
  is_begun_ = false;
  branches_ = series_.branches();
  const auto n = static_cast<std::uint32_t>(equations_.coordinates());
  std::vector<std::vector<std::uint32_t>> columns(series_.series());
  for (std::uint32_t j = 0; j < n; ++j) columns[equations_.program.velocity(j)] = {j};
  rows_.clear();
  terms_.clear();
  const TaylorRows& all = series_.rows();
  for (const std::uint32_t r : all.by_velocity) {
    const TaylorRows::Row& row = all.rows[r];
    std::vector<std::uint32_t>& found = columns[row.out];
    for (std::uint32_t t = row.first; t < row.end; ++t) {
      const Slot series = series_.terms()[t].series;
      if (columns[series].empty()) continue;
      terms_.push_back({series, t});
      std::vector<std::uint32_t> both;
      std::set_union(found.begin(), found.end(), columns[series].begin(), columns[series].end(),
                     std::back_inserter(both));
      found = std::move(both);
    }
    rows_.push_back({row.out, terms_.size()});
  }
  partials_.assign(terms_.size(), 0.0);
  std::vector<std::vector<std::uint32_t>> of_row;
  entries_.clear();
  for (std::size_t i = 0; i < n; ++i) {
    of_row.push_back(columns[equations_.momentum[i]]);
    for (const std::uint32_t j : of_row.back())
      entries_.push_back({static_cast<Index>(i), static_cast<Index>(j), 0});
  }
  colour(of_row);
}

/// Each column takes the first colour that no column has with which it shares a row.
void InertiaColumns::colour(const std::vector<std::vector<std::uint32_t>>& columns_of_row) {
  constexpr std::size_t none = ~std::size_t{0};
  const std::size_t n = columns_of_row.size();
  std::vector<std::vector<std::size_t>> rows_of_column(n);
  for (std::size_t i = 0; i < n; ++i)
    for (const std::uint32_t j : columns_of_row[i]) rows_of_column[j].push_back(i);
  colour_.assign(n, none);
  colours_ = 0;
  std::vector<std::size_t> taken(n + 1, none);  // by which column last
  for (std::size_t j = 0; j < n; ++j) {
    for (const std::size_t i : rows_of_column[j])
      for (const std::uint32_t other : columns_of_row[i])
        if (colour_[other] != none) taken[colour_[other]] = j;
    std::size_t free = 0;
    while (taken[free] == j) ++free;
    colour_[j] = free;
    colours_ = std::max(colours_, free + 1);
  }
}

/// The colours from `first` on, one a lane.
void InertiaColumns::sweep(std::size_t first, std::size_t lanes) {
  const auto seed = [&](double one) {
    for (std::size_t j = 0; j < colour_.size(); ++j)
      if (colour_[j] >= first && colour_[j] < first + lanes)
        change_[equations_.program.velocity(j) * lanes + colour_[j] - first] = one;
  };
  seed(1);
  std::size_t t = 0;
  for (const Row& row : rows_) {
    double* f = change_.data() + row.out * lanes;
    std::fill(f, f + lanes, 0.0);
    for (; t < row.end; ++t) {
      const double* a = change_.data() + terms_[t].series * lanes;
      for (std::size_t l = 0; l < lanes; ++l) f[l] += partials_[t] * a[l];
    }
  }
  for (Entry& entry : entries_)
    if (const std::size_t colour = colour_[static_cast<std::size_t>(entry.column)];
        colour >= first && colour < first + lanes)
      entry.value =
          change_[equations_.momentum[static_cast<std::size_t>(entry.row)] * lanes + colour - first];
  seed(0);
}

}  // namespace mechanics::inline motions
