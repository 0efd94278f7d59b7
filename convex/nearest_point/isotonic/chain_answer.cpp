#include "convex/nearest_point/isotonic/chain_answer.hpp"

#include <algorithm>
#include <array>
#include <limits>

#include "convex/nearest_point/isotonic/exact_rise.hpp"
#include "convex/nearest_point/proof/decided_in_fractions.hpp"
#include "convex/zero_tolerances.hpp"

namespace convex {
namespace {

/// Members looked at together, what a member does alone by loops that vectorise; and sums kept side by side.
constexpr Index width = 128, lanes = 4;

std::size_t at(Index i) { return static_cast<std::size_t>(i); }

using Numbers = std::array<double, width>;
using Shifted = std::array<double, width + 1 + lanes>;  ///< a place for the member before, and some to spare

/// Members from `first` on. Of the row above each: factor, what it pushes with, lambda, and their product.
struct Block {
  Index first, count;
  const double *mass, *force;
  Numbers mass_list, force_list, factor, goes_on, inertia, plain_hi, plain_lo, left_hi, left_lo, pushed,
      lambda;
  Shifted x_hi, x_lo, load_hi, load_lo;
};

struct Squares {
  std::array<double, lanes> unbalanced{}, q{}, z{}, lost{};
};

/// force - mass x, and its parts.
void weigh(Block& block) {
  for (std::size_t j = 0; j < at(block.count); ++j) {
    const double mass = block.mass[j], lo = block.x_lo[j + 1];
    const DoubleDouble plain = two_product(mass, block.x_hi[j + 1]),
                       inertia = two_sum(plain.hi, plain.lo + lo * mass),
                       left = two_sum(block.force[j], -inertia.hi);
    block.plain_hi[j] = plain.hi;
    block.plain_lo[j] = plain.lo;
    block.inertia[j] = std::abs(inertia.hi);
    block.left_hi[j] = left.hi;
    block.left_lo[j] = left.lo - inertia.lo;
  }
}

/// lambda from what the rows push with.
void divide(Block& block) {
  for (std::size_t j = 0; j < at(block.count); ++j) {
    const double lambda = block.pushed[j] / block.factor[j];
    const DoubleDouble load = two_product(lambda, block.factor[j]);
    block.lambda[j] = lambda;
    block.load_hi[j + 1] = load.hi;
    block.load_lo[j + 1] = load.lo;
  }
}

/// The same where all factors are 1.
void copy(Block& block) {
  for (std::size_t j = 0; j < at(block.count); ++j) {
    block.lambda[j] = block.load_hi[j + 1] = block.pushed[j];
    block.load_lo[j + 1] = 0;
  }
}

/// The sum of n terms, in lanes that are kept apart.
void gather_sum(Index count, const Numbers& term, std::array<double, lanes>& sum) {
  Index j = 0;
  for (; j + lanes <= count; j += lanes)
    for (Index lane = 0; lane < lanes; ++lane) sum[at(lane)] += term[at(j + lane)];
  for (std::size_t lane = 0; j < count; ++j, ++lane) sum[lane] += term[at(j)];
}

/// What is out of balance as the numbers are printed, and the norms.
void judge(Block& block, Squares& squares) {
  Numbers unbalanced, q, z, lost;
  for (std::size_t j = 0; j < at(block.count); ++j) {
    const double mass = block.mass[j], force = block.force[j], x = block.x_hi[j + 1], lo = block.x_lo[j + 1];
    const DoubleDouble below = two_sum(force, block.load_hi[j]),
                       above = two_sum(below.hi, -block.load_hi[j + 1]),
                       inertia = two_sum(above.hi, -block.plain_hi[j]);
    const double small = (below.lo + block.load_lo[j]) + (above.lo - block.load_lo[j + 1]),
                 rest = inertia.hi + (small + (inertia.lo - block.plain_lo[j])), inverse = 1 / mass;
    unbalanced[j] = rest * rest * inverse;
    q[j] = x * x * mass;
    z[j] = force * force * inverse;
    lost[j] = lo * lo * mass;
  }
  gather_sum(block.count, unbalanced, squares.unbalanced);
  gather_sum(block.count, q, squares.q);
  gather_sum(block.count, z, squares.z);
  gather_sum(block.count, lost, squares.lost);
}

double root_of_sum(const std::array<double, lanes>& part) {
  return std::sqrt((part[0] + part[1]) + (part[2] + part[3]));
}

/// value x for a value that is mostly 1.
DoubleDouble exact_product(double value, double x) {
  return value == 1 ? DoubleDouble{x, 0} : two_product(value, x);
}

/// The slack of a row that carries nothing.
double slack_between(double factor, DoubleDouble low, DoubleDouble high, double s) {
  RunningSum reach;
  reach.add(negative(exact_product(factor, low.hi)));
  reach.lo -= factor * low.lo;
  reach.add(exact_product(factor, high.hi));
  reach.lo += factor * high.lo;
  return std::max(0.0, add(reach.tidy(), {-s, 0}).value());
}

template <class Order>
class Placement {
 public:
  Placement(const Chain<Order>& chain, const std::vector<int>& pools, Solution& found)
      : chain_(chain), order_(chain.order), pools_(pools), found_(found) {}

  bool run(bool careful) {
    block_.x_hi[0] = block_.x_lo[0] = block_.load_hi[0] = block_.load_lo[0] = 0;
    stand_on_floor();
    bool right = true;
    for (block_.first = 0; block_.first < chain_.n; block_.first += width) {
      block_.count = std::min(width, chain_.n - block_.first);
      right = gather() && right;
      weigh(block_);
      right = push() && right;
      if (!right && !careful) return false;
      if (order_.plain)
        copy(block_);
      else
        divide(block_);
      judge(block_, squares_);
      scatter();
    }
    found_.acceleration_norm = root_of_sum(squares_.q);
    found_.force_norm = root_of_sum(squares_.z);
    found_.rounding = root_of_sum(squares_.lost);
    found_.residuals.stationarity = root_of_sum(squares_.unbalanced);
    decide_touching();
    return true;
  }

 private:
  struct Sums {
    DoubleDouble weight, sum;
  };
  Sums sums(std::size_t pool) const {
    RunningSum weight, sum;
    const Index first = pools_[pool], end = pools_[pool + 1];
    if (chain_.offset.empty())
      for (Index k = first; k < end; ++k) {
        weight.add(chain_.mass[order_.coordinate(k)]);
        sum.add(chain_.force[order_.coordinate(k)]);
      }
    else
      for (Index k = first; k < end; ++k) {
        weight.add(chain_.mass[order_.coordinate(k)]);
        sum.add(chain_.load(k));
      }
    return {weight.tidy(), sum.tidy()};
  }

  /// Pools below the floor are lifted to it.
  void stand_on_floor() {
    const Index floor = order_.row(0);
    if (floor < 0) return;
    floor_height_ = chain_.bound(0);
    for (; lifted_ + 1 < pools_.size(); ++lifted_) {
      const Sums exact = sums(lifted_);
      if (!less(quotient(exact.sum, exact.weight), floor_height_)) break;
      push_.add(add(product_of_pairs(exact.weight, floor_height_), negative(exact.sum)));
    }
    largest_ = push_.hi;
    const double factor = order_.factor(0), lambda = std::max(0.0, push_.value() / factor);
    const DoubleDouble load = two_product(lambda, factor);
    found_.lambda[floor] = lambda;
    block_.load_hi[0] = load.hi;
    block_.load_lo[0] = load.lo;
  }

  /// Brings the members' numbers together and places them; false when means fall.
  bool gather() {
    const Index first = block_.first, end = first + block_.count;
    if (!order_.plain) {
      for (Index k = first; k < std::min(end, chain_.n - 1); ++k)
        block_.factor[at(k - first)] = order_.factor(k + 1);
      if (end == chain_.n) block_.factor[at(end - 1 - first)] = 1;
    }
    if constexpr (std::is_same_v<Order, InOrder>) {
      block_.mass = chain_.mass + first;
      block_.force = chain_.force + first;
    } else {
      for (Index k = first; k < end; ++k) {
        block_.mass_list[at(k - first)] = chain_.mass[order_.coordinate(k)];
        block_.force_list[at(k - first)] = chain_.force[order_.coordinate(k)];
      }
      block_.mass = block_.mass_list.data();
      block_.force = block_.force_list.data();
    }
    const std::size_t known = placed_;
    std::size_t begun = 0;
    for (; pools_[known + begun] < end; ++begun) {
      const Sums exact = sums(known + begun);
      weight_hi_[begun] = exact.weight.hi;
      weight_lo_[begun] = exact.weight.lo;
      sum_hi_[begun] = exact.sum.hi;
      sum_lo_[begun] = exact.sum.lo;
    }
    for (std::size_t p = 0; p < begun; ++p) {  // divisions wait for each other but here
      const DoubleDouble mean = quotient({sum_hi_[p], sum_lo_[p]}, {weight_hi_[p], weight_lo_[p]});
      mean_hi_[p] = mean.hi;
      mean_lo_[p] = mean.lo;
    }
    bool rising = true;
    std::fill_n(block_.goes_on.begin(), block_.count, 1.0);
    std::size_t p = 0;
    begun_ = known;
    for (Index k = first; k < end;) {
      if (k == pools_[placed_]) {
        const DoubleDouble mean{mean_hi_[p], mean_lo_[p]};
        rising = rising && !less(mean, mean_);
        mean_ = mean;
        ++p;
        height_ = placed_ < lifted_ ? floor_height_ : mean_;
        ++placed_;
      }
      const Index over = pools_[placed_], last = std::min<Index>(end, over);
      if (over <= end && (placed_ >= lifted_ || over == chain_.n)) block_.goes_on[at(over - 1 - first)] = 0;
      if (chain_.offset.empty())
        for (; k < last; k += lanes)  // by lanes: pools are short; what is too much the next pool replaces
          for (Index lane = 0; lane < lanes; ++lane) {
            block_.x_hi[at(k - first + lane) + 1] = height_.hi;
            block_.x_lo[at(k - first + lane) + 1] = height_.lo;
          }
      for (; k < last; ++k) {
        const DoubleDouble x = add(height_, chain_.offset[at(k)]);
        block_.x_hi[at(k - first) + 1] = x.hi;
        block_.x_lo[at(k - first) + 1] = x.lo;
      }
      k = last;
    }
    return rising;
  }

  /// What each row above pushes with, summed up from below; false when one would have to pull.
  bool push() {
    RunningSum push = push_;
    double largest = largest_;
    int wrong = 0;
    for (std::size_t j = 0; j < at(block_.count); ++j) {
      push.add(DoubleDouble{block_.left_hi[j], block_.left_lo[j]});
      largest = std::max({largest, std::abs(push.hi), block_.inertia[j]});
      const bool goes_on = block_.goes_on[j] > 0;
      push.hi = goes_on ? push.hi : 0;
      push.lo = goes_on ? push.lo : 0;
      largest = goes_on ? largest : 0;
      const double pushed = push.value(), quiet = zero_of_long_sums * largest;
      wrong |= pushed < -quiet;
      block_.pushed[j] = pushed > quiet ? pushed : 0;
    }
    push_ = push;
    largest_ = largest;
    return wrong == 0;
  }

  /// From the block to the solution, with the slacks of the rows below that carry nothing.
  void scatter() {
    const Index first = block_.first, count = block_.count, links = std::min(count, chain_.n - 1 - first);
    double *const q = found_.q.data(), *const lambda = found_.lambda.data(),
                  *const slack = found_.slack.data();
    for (Index j = 0; j < count; ++j) q[order_.coordinate(first + j)] = block_.x_hi[at(j) + 1];
    for (Index j = 0; j < links; ++j) lambda[order_.row(first + j + 1)] = block_.lambda[at(j)];
    const auto measure = [&](Index k) {
      const std::size_t j = at(k - first);
      const Index row = order_.row(k);
      if (row >= 0 && !(block_.load_hi[j] > 0))
        slack[row] = slack_between(order_.factor(k), {block_.x_hi[j], block_.x_lo[j]},
                                   {block_.x_hi[j + 1], block_.x_lo[j + 1]}, chain_.s[row]);
    };
    for (Index j = order_.row(first) < 0 ? 1 : 0; j < count; ++j) slack[order_.row(first + j)] = 0;
    // Members of a pool move together, and so do pools on the floor.
    for (std::size_t p = std::max(begun_, lifted_); p < placed_; ++p) measure(pools_[p]);
    for (Shifted* numbers : {&block_.x_hi, &block_.x_lo, &block_.load_hi, &block_.load_lo})
      (*numbers)[0] = (*numbers)[at(count)];
  }

  /// Which slacks between pools are 0, without rounding where that could hide it.
  void decide_touching() {
    constexpr double safety = 64;
    const double scale = std::max(found_.acceleration_norm, found_.force_norm);
    const double sums = safety * rounding_of_pools(chain_, scale);
    const StringMembers members = [&](Index k) {
      const Index row = order_.row(k), i = order_.coordinate(k);
      return row < 0 ? StringMember{chain_.mass[i], chain_.force[i], 1, 0}
                     : StringMember{chain_.mass[i], chain_.force[i], order_.factor(k), chain_.s[row]};
    };
    for (std::size_t p = lifted_; p + 1 < pools_.size(); ++p) {
      const Index k = pools_[p], row = order_.row(k);
      if (row < 0 || found_.lambda[row] > 0) continue;
      double& slack = found_.slack[row];
      double mass = chain_.mass[order_.coordinate(k)];
      if (k > 0) mass = std::min(mass, chain_.mass[order_.coordinate(k - 1)]);
      if (slack * slack * mass > sums * sums * order_.factor(k) * order_.factor(k)) continue;
      const std::optional<int> up = p == lifted_ && order_.row(0) >= 0
                                        ? rise_over_floor(members, 0, k, pools_[p + 1])
                                        : rise(members, pools_[p - 1], k, pools_[p + 1]);
      if (!up) found_.undecided = open_question::touched;
      slack = up && *up <= 0 ? 0 : std::max(slack, std::numeric_limits<double>::denorm_min());
    }
  }

  const Chain<Order>& chain_;
  const Order order_;
  const std::vector<int>& pools_;
  Solution& found_;
  Block block_;
  Squares squares_;
  Numbers weight_hi_, weight_lo_, sum_hi_, sum_lo_, mean_hi_, mean_lo_;  // of pools that begin in the block
  DoubleDouble floor_height_{}, height_{}, mean_{-INFINITY, 0};
  RunningSum push_;  // what the rows below push up with
  double largest_ = 0;
  std::size_t lifted_ = 0, placed_ = 0, begun_ = 0;
};

}  // namespace

template <class Order>
bool place_pools(const Chain<Order>& chain, const std::vector<int>& first, bool careful, Solution& found) {
  return Placement<Order>(chain, first, found).run(careful);
}

template <class Order>
double rounding_of_pools(const Chain<Order>& chain, double scale) {
  const double farthest = chain.farthest_offset * std::sqrt(chain.total_mass);
  return 8 * unit_roundoff * unit_roundoff * static_cast<double>(chain.n) * (scale + farthest);
}

template double rounding_of_pools(const Chain<InOrder>&, double);
template double rounding_of_pools(const Chain<Listed>&, double);
template bool place_pools(const Chain<InOrder>&, const std::vector<int>&, bool, Solution&);
template bool place_pools(const Chain<Listed>&, const std::vector<int>&, bool, Solution&);

}  // namespace convex
