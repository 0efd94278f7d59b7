#include "mechanics/expression/sparsity.hpp"

#include <algorithm>
#include <limits>
#include <numeric>

namespace mechanics::expression {

Sparsity::Set Sparsity::set(std::vector<std::uint32_t> variables) {
  std::sort(variables.begin(), variables.end());
  variables.erase(std::unique(variables.begin(), variables.end()), variables.end());
  if (variables.size() == 1) return variables.front();
  std::uint64_t hash = 0xCBF29CE484222325ULL;  // FNV-1a
  for (const std::uint32_t v : variables) hash = (hash ^ v) * 0x100000001B3ULL;
  const auto [first, last] = by_hash_.equal_range(hash);
  for (auto known = first; known != last; ++known)
    if (this->variables(known->second) == variables) return known->second;
  const auto set = static_cast<Set>(variables_ + sets_.size());
  sets_.push_back(std::move(variables));
  by_hash_.emplace(hash, set);
  return set;
}

void Sparsity::append(Set set, std::vector<std::uint32_t>& to) const {
  if (set < variables_)
    to.push_back(set);
  else
    to.insert(to.end(), variables(set).begin(), variables(set).end());
}

void Sparsity::product(Set x, Set y) {
  products_.insert(std::uint64_t{std::min(x, y)} << 32U | std::max(x, y));
}

void Sparsity::add_cliques(Pattern& rows) const {
  std::vector<Set> cliques;
  for (const std::uint64_t pair : products_)
    if (pair >> 32U == (pair & 0xFFFFFFFFU) && (pair >> 32U) >= variables_)
      cliques.push_back(static_cast<Set>(pair >> 32U));
  std::sort(cliques.begin(), cliques.end(), [&](Set x, Set y) {
    return std::pair(variables(y).size(), x) < std::pair(variables(x).size(), y);  // the largest first
  });
  constexpr Set none = std::numeric_limits<Set>::max();
  std::vector<Set> covered_by(variables_, none);
  for (const Set clique : cliques) {
    const auto& members = variables(clique);
    const Set larger = covered_by[members.front()];
    if (larger != none &&
        std::includes(variables(larger).begin(), variables(larger).end(), members.begin(), members.end()))
      continue;
    for (const std::uint32_t i : members) {
      if (covered_by[i] == none) covered_by[i] = clique;
      rows[i].insert(rows[i].end(), members.begin(), members.end());
    }
  }
}

Pattern Sparsity::pattern() const {
  Pattern rows(variables_);
  for (std::uint32_t i = 0; i < variables_; ++i) rows[i].push_back(i);
  add_cliques(rows);
  std::vector<std::uint32_t> x, y;
  for (const std::uint64_t pair : products_) {
    if (pair >> 32U == (pair & 0xFFFFFFFFU)) continue;
    x.clear();
    y.clear();
    append(static_cast<Set>(pair >> 32U), x);
    append(static_cast<Set>(pair & 0xFFFFFFFFU), y);
    for (const std::uint32_t i : x) rows[i].insert(rows[i].end(), y.begin(), y.end());
    for (const std::uint32_t j : y) rows[j].insert(rows[j].end(), x.begin(), x.end());
  }
  for (auto& row : rows) {
    std::sort(row.begin(), row.end());
    row.erase(std::unique(row.begin(), row.end()), row.end());
    row.shrink_to_fit();
  }
  return rows;
}

namespace {

/// How many of the fullest columns are best alone: a colour for each, and then at least as many as the
/// fullest other row has nonzeros.
std::vector<bool> columns_alone(const Pattern& pattern) {
  std::vector<std::uint32_t> order(pattern.size());
  std::iota(order.begin(), order.end(), 0U);
  std::stable_sort(order.begin(), order.end(),
                   [&](auto i, auto j) { return pattern[i].size() > pattern[j].size(); });
  std::size_t best = 0, fewest = std::numeric_limits<std::size_t>::max();
  for (std::size_t k = 0; k < order.size() && k < fewest; ++k)
    if (k + pattern[order[k]].size() < fewest) {
      fewest = k + pattern[order[k]].size();
      best = k;
    }
  std::vector<bool> alone(pattern.size(), false);
  for (std::size_t k = 0; k < best; ++k) alone[order[k]] = true;
  return alone;
}

}  // namespace

Colouring colouring(const Pattern& pattern) {
  const auto n = static_cast<std::uint32_t>(pattern.size());
  Colouring result{{}, std::vector<std::uint32_t>(n), columns_alone(pattern)};
  for (std::uint32_t j = 0; j < n; ++j) {
    if (!result.alone[j]) continue;
    result.colour[j] = static_cast<std::uint32_t>(result.seeds.size());
    result.seeds.push_back({j});
  }
  const auto first = result.seeds.size();
  const auto others = n - first;
  const bool is_full = std::any_of(pattern.begin(), pattern.end(), [&](const auto& row) {
    return first == 0 && row.size() == others;  // all columns meet: no search
  });
  std::vector<std::uint32_t> taken_by;  // by colour: the last column that may not have it
  for (std::uint32_t j = 0; j < n; ++j) {
    if (result.alone[j]) continue;
    std::size_t colour = first;
    if (is_full) {
      colour = result.seeds.size();
    } else {
      for (const std::uint32_t i : pattern[j])
        if (!result.alone[i])
          for (const std::uint32_t k : pattern[i])
            if (k < j && !result.alone[k]) taken_by[result.colour[k]] = j;
      while (colour < result.seeds.size() && taken_by[colour] == j) ++colour;
    }
    if (colour == result.seeds.size()) result.seeds.emplace_back();
    taken_by.resize(result.seeds.size(), n);
    result.seeds[colour].push_back(j);
    result.colour[j] = static_cast<std::uint32_t>(colour);
  }
  return result;
}

}  // namespace mechanics::expression
