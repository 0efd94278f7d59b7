#include "convex/nearest_point/isotonic/pooling.hpp"

#include <algorithm>
#include <cmath>

#include "convex/nearest_point/isotonic/chain_answer.hpp"
#include "convex/zero_tolerances.hpp"

namespace convex::inline isotonic {

Pooling::Pooling(const NearestPointProblem& problem, const Strings& strings)
    : strings_(strings),
      chain_(problem, Listed{strings, problem.U.sparse()},
             (arena_.start(Chain<Listed>::lines(problem.dimension())), arena_)),
      q_(problem.dimension()),
      lambda_(Vector::Zero(problem.rows())) {
  chain_.order.each_string(chain_.n, [&](Index first, Index) {
    floor_.push_back(chain_.order.row(first) >= 0 ? chain_.bound(first).hi : -INFINITY);
  });
  find_parts(problem);
  pools_.reserve(parts_.size());
}

Pooling::Pool Pooling::member(int k, const Vector& linear) const {
  Pool pool{k, k + 1, mass(k), linear[strings_.coordinate[at(k)]], 0};
  if (!chain_.is_level()) pool.sum -= chain_.offset_hi[k] * pool.weight;
  pool.mean = pool.sum / pool.weight;
  return pool;
}

/// Puts a pool on those from `bottom` on, and pools it with them while means do not rise.
void Pooling::put(std::vector<Pool>& pools, std::size_t bottom, Pool pool) {
  while (pools.size() > bottom && pools.back().mean >= pool.mean) {
    const Pool& last = pools.back();
    pool.begin = last.begin;
    pool.weight += last.weight;
    pool.sum += last.sum;
    pool.mean = pool.sum / pool.weight;
    pools.pop_back();
  }
  pools.push_back(pool);
}

void Pooling::find_parts(const NearestPointProblem& problem) {
  std::vector<bool> moves(strings_.coordinate.size(), false);
  for (Index a : strings_.border)
    for (SparseRows::InnerIterator it(problem.U.sparse(), a); it; ++it) moves[at(it.col())] = true;
  std::vector<Pool> between;
  const auto end_part = [&] {
    parts_.insert(parts_.end(), between.begin(), between.end());
    stays_.resize(parts_.size(), true);
    between.clear();
  };
  for (std::size_t t = 0; t + 1 < strings_.first.size(); ++t) {
    first_part_.push_back(parts_.size());
    for (int k = strings_.first[t]; k < strings_.first[t + 1]; ++k) {
      const Pool one = member(k, problem.z);
      if (!moves[at(strings_.coordinate[at(k)])]) {
        put(between, 0, one);
        continue;
      }
      end_part();
      parts_.push_back(one);
      stays_.push_back(false);
    }
    end_part();
  }
  first_part_.push_back(parts_.size());
}

void Pooling::pool(const Vector& linear) {
  pools_.clear();
  first_pool_.clear();
  for (std::size_t t = 0; t + 1 < first_part_.size(); ++t) {
    first_pool_.push_back(pools_.size());
    for (std::size_t p = first_part_[t]; p < first_part_[t + 1]; ++p)
      put(pools_, first_pool_.back(), stays_[p] ? parts_[p] : member(parts_[p].begin, linear));
  }
  first_pool_.push_back(pools_.size());
}

void Pooling::place(Vector& q) const {
  q.resize(chain_.n);
  for (std::size_t t = 0; t + 1 < first_pool_.size(); ++t)
    for (std::size_t p = first_pool_[t]; p < first_pool_[t + 1]; ++p) {
      const double level = std::max(pools_[p].mean, floor_[t]);
      for (int k = pools_[p].begin; k < pools_[p].end; ++k)
        q[strings_.coordinate[at(k)]] = chain_.is_level() ? level : level + chain_.offset_hi[k];
    }
}

bool Pooling::is_lifted(std::size_t pool) const {
  const auto string =
      std::upper_bound(first_pool_.begin(), first_pool_.end(), pool) - first_pool_.begin() - 1;
  return pools_[pool].mean < floor_[at(string)];
}

DoubleDouble Pooling::load(int k, const Vector& linear, const Vector& rest) const {
  const int i = strings_.coordinate[at(k)];
  return chain_.lowered(k, {linear[i], rest.size() > 0 ? rest[i] : 0});
}

Pooling::Sums Pooling::sums(const Pool& pool, const Vector& linear, const Vector& rest) const {
  RunningSum weight, sum;
  for (int k = pool.begin; k < pool.end; ++k) {
    weight.add(mass(k));
    sum.add(load(k, linear, rest));
  }
  Sums found{weight.tidy(), sum.tidy(), {}};
  found.mean = quotient(found.sum, found.weight);
  return found;
}

void Pooling::pool_carefully(const Vector& linear, const Vector& rest) {
  pools_.clear();
  first_pool_.clear();
  chain_.order.each_string(chain_.n, [&](Index begin, Index end) {
    first_pool_.push_back(pools_.size());
    const std::vector<int> first = convex::pool_carefully(
        chain_, begin, end, [&](Index k) { return load(static_cast<int>(k), linear, rest); });
    for (std::size_t p = 0; p + 1 < first.size(); ++p) {
      const Sums exact = sums({first[p], first[p + 1], 0, 0, 0}, linear, rest);
      pools_.push_back({first[p], first[p + 1], exact.weight.hi, exact.sum.hi, exact.mean.hi});
    }
  });
  first_pool_.push_back(pools_.size());
}

void Pooling::refine(const Vector& linear, const Vector& rest) {
  if (place_all(linear, rest, false)) return;
  pool_carefully(linear, rest);
  place_all(linear, rest, true);
}

bool Pooling::place_all(const Vector& linear, const Vector& rest, bool careful) {
  for (std::size_t t = 0; t + 1 < first_pool_.size(); ++t)
    if (!place_string(linear, rest, careful, t)) return false;
  return true;
}

/// False when the pools prove wrong: means that fall, or a negative multiplier. `careful`: then it is
/// rounding.
bool Pooling::place_string(const Vector& linear, const Vector& rest, bool careful, std::size_t string) {
  const std::size_t first = first_pool_[string], end = first_pool_[string + 1];
  const int begin = strings_.first[string], last_member = strings_.first[string + 1];
  std::size_t lifted = first;  // pools below the floor end here
  RunningSum push;             // what the rows below push up with
  double largest = 0;
  DoubleDouble least{};
  if (const Index floor = chain_.order.row(begin); floor >= 0) {
    least = chain_.bound(begin);
    for (; lifted < end; ++lifted) {
      const Sums exact = sums(pools_[lifted], linear, rest);
      if (!less(exact.mean, least)) break;
      push.add(add(product_of_pairs(exact.weight, least), negative(exact.sum)));
    }
    largest = push.hi;
    lambda_[floor] = std::max(0.0, push.value() / chain_.order.factor(begin));
  }
  DoubleDouble previous{-INFINITY, 0};
  for (std::size_t p = first; p < end; ++p) {
    const Pool& pool = pools_[p];
    DoubleDouble level = sums(pool, linear, rest).mean;
    if (!careful && less(level, previous)) return false;
    previous = level;
    if (p < lifted) level = least;
    for (int k = pool.begin; k < pool.end; ++k) {
      const int i = strings_.coordinate[at(k)];
      const DoubleDouble x = chain_.is_level() ? level : add(level, chain_.offset(k));
      q_.hi[i] = x.hi;
      q_.lo[i] = x.lo;
      const DoubleDouble inertia = product(x, mass(k));
      push.add(DoubleDouble{linear[i], rest.size() > 0 ? rest[i] : 0});
      push.add(negative(inertia));
      largest = std::max({largest, std::abs(push.hi), std::abs(inertia.hi)});
      if (k + 1 == last_member) break;
      const Index above = chain_.order.row(k + 1);
      const bool loaded = k + 1 < pool.end || p + 1 < lifted;
      const double pushed = push.value();
      if (loaded && pushed < -zero_of_long_sums * largest && !careful) return false;
      lambda_[above] =
          loaded && pushed > zero_of_long_sums * largest ? pushed / chain_.order.factor(k + 1) : 0;
    }
    if (p + 1 >= lifted) {
      push = {};
      largest = 0;
    }
  }
  return true;
}

double Pooling::rounding() const { return rounding_of_pools(chain_, 0); }

std::optional<int> Pooling::rise_below(int k, const Vector& linear, const Vector& rest) const {
  const auto begins_after = [](int place, const Pool& pool) { return place < pool.begin; };
  const auto pool = std::upper_bound(pools_.begin(), pools_.end(), k, begins_after) - 1;
  if (pool->begin != k) return 0;
  const Index first = *(std::upper_bound(strings_.first.begin(), strings_.first.end(), k) - 1);
  const bool has_floor = chain_.order.row(first) >= 0;
  const auto feels_z_alone = [&](const Pool& members) {
    for (int j = members.begin; j < members.end; ++j) {
      const int i = strings_.coordinate[at(j)];
      if (linear[i] != chain_.linear[i] || rest[i] != 0) return false;
    }
    return true;
  };
  const StringMembers member = chain_.members();
  if (!feels_z_alone(*pool)) return std::nullopt;
  if (k == first) return rise_over_floor(member, first, k, pool->end);
  const Pool& below = *(pool - 1);
  if (!feels_z_alone(below)) return std::nullopt;
  if (has_floor) {
    const auto stands = rise_over_floor(member, first, below.begin, below.end);
    if (!stands) return stands;
    if (*stands <= 0) {
      const auto up = rise_over_floor(member, first, k, pool->end);
      return up ? std::optional(std::max(0, *up)) : up;
    }
  }
  return rise(member, below.begin, k, pool->end);
}

}  // namespace convex::inline isotonic
