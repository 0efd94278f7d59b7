#include "convex/nearest_point/isotonic/chain_answer.hpp"

#include <algorithm>
#include <limits>
#include <tuple>
#include <utility>

#include "convex/nearest_point/isotonic/chain_kernels.hpp"
#include "convex/nearest_point/proof/decided_in_fractions.hpp"
#include "convex/zero_tolerances.hpp"

namespace convex::inline isotonic {
namespace {

using namespace chain_kernels;

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

  std::optional<double> run(bool careful) {
    block_.x_hi[0] = block_.x_lo[0] = block_.load_hi[0] = block_.load_lo[0] = 0;
    stand_on_floor();
    bool right = true;
    for (block_.first = 0; block_.first < chain_.n; block_.first += width) {
      block_.count = std::min(width, chain_.n - block_.first);
      right = gather() && right;
      weigh(block_);
      right = push() && right;
      if (!right && !careful) return std::nullopt;
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
    return most_;
  }

 private:
  struct Sums {
    DoubleDouble weight, sum;
  };
  Sums sums(std::size_t pool) {
    RunningSum weight, sum;
    Index k = pools_[pool];
    const Index end = pools_[pool + 1];
    for (; k < end && chain_.is_level(); ++k) {
      weight.add(chain_.mass[order_.coordinate(k)]);
      sum.add(chain_.linear[order_.coordinate(k)]);
    }
    while (k < end) {
      if (k < lowered_ || k >= lowered_end_) lower_from(k);
      for (const Index last = std::min(end, lowered_end_); k < last; ++k) {
        weight.add(chain_.mass[order_.coordinate(k)]);
        sum.add(DoubleDouble{lowered_hi_[at(k - lowered_)], lowered_lo_[at(k - lowered_)]});
      }
    }
    return {weight.tidy(), sum.tidy()};
  }

  /// Linear terms of the members from k on in the coordinates that pools have in common.
  void lower_from(Index k) {
    lowered_ = k;
    lowered_end_ = std::min(k + width, chain_.n);
    const auto [mass, linear] = numbers(k, lowered_end_ - k, lowered_mass_, lowered_linear_);
    lower(lowered_end_ - k, mass, linear, chain_.offset_hi + k, chain_.offset_lo + k, lowered_hi_.data(),
          lowered_lo_.data());
  }

  /// Masses and linear terms of members from k on, as they stand or brought together.
  std::pair<const double*, const double*> numbers(Index k, Index count, Numbers& mass,
                                                  Numbers& linear) const {
    if constexpr (std::is_same_v<Order, InOrder>) return {chain_.mass + k, chain_.linear + k};
    for (Index j = 0; j < count; ++j) {
      mass[at(j)] = chain_.mass[order_.coordinate(k + j)];
      linear[at(j)] = chain_.linear[order_.coordinate(k + j)];
    }
    return {mass.data(), linear.data()};
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
    found_.lambda[floor] = most_ = lambda;
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
    std::tie(block_.mass, block_.linear) = numbers(first, block_.count, block_.mass_list, block_.linear_list);
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
    Eigen::Map<Vector>(block_.goes_on.data(), block_.count).setOnes();
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
      for (; k < last; k += lanes)  // by lanes: pools are short; what is too much the next pool replaces
        for (Index lane = 0; lane < lanes; ++lane) {
          block_.x_hi[at(k - first + lane) + 1] = height_.hi;
          block_.x_lo[at(k - first + lane) + 1] = height_.lo;
        }
      k = last;
    }
    if (!chain_.is_level()) lift(block_, chain_.offset_hi + first, chain_.offset_lo + first);
    return rising;
  }

  /// What each row above pushes with, summed up from below; false when one would have to pull.
  bool push() {
    RunningSum push = push_;
    double largest = largest_;
    for (std::size_t j = 0; j < at(block_.count); ++j) {
      push.add(DoubleDouble{block_.left_hi[j], block_.left_lo[j]});
      largest = std::max(largest, std::max(std::abs(push.hi), block_.inertia[j]));
      const bool goes_on = block_.goes_on[j] > 0;
      push.hi = goes_on ? push.hi : 0;
      push.lo = goes_on ? push.lo : 0;
      largest = goes_on ? largest : 0;
      block_.pushed[j] = push.value();
      block_.largest[j] = largest;
    }
    push_ = push;
    largest_ = largest;
    return drop_rounding(block_) == 0;
  }

  /// From the block to the solution, with the slacks of the rows below that carry nothing.
  void scatter() {
    const Index first = block_.first, count = block_.count, links = std::min(count, chain_.n - 1 - first);
    double *const q = found_.q.data(), *const lambda = found_.lambda.data(),
                  *const slack = found_.slack.data();
    for (Index j = 0; j < count; ++j) q[order_.coordinate(first + j)] = block_.x_hi[at(j) + 1];
    for (Index j = 0; j < links; ++j) lambda[order_.row(first + j + 1)] = block_.lambda[at(j)];
    if (links > 0) most_ = std::max(most_, Eigen::Map<const Vector>(block_.lambda.data(), links).maxCoeff());
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
    const StringMembers members = chain_.members();
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
      if (!up) found_.undecided = open_question::degenerate_rows;
      slack = up && *up <= 0 ? 0 : std::max(slack, std::numeric_limits<double>::denorm_min());
    }
  }

  const Chain<Order>& chain_;
  const Order order_;
  const std::vector<int>& pools_;
  Solution& found_;
  Block block_;
  Squares squares_;
  Numbers lowered_mass_, lowered_linear_, lowered_hi_, lowered_lo_;  // of the members from lowered_ on
  Index lowered_ = 0, lowered_end_ = 0;
  Numbers weight_hi_, weight_lo_, sum_hi_, sum_lo_, mean_hi_, mean_lo_;  // of pools that begin in the block
  DoubleDouble floor_height_{}, height_{}, mean_{-INFINITY, 0};
  RunningSum push_;                // what the rows below push up with
  double largest_ = 0, most_ = 0;  // of what is summed, and of lambda
  std::size_t lifted_ = 0, placed_ = 0, begun_ = 0;
};

}  // namespace

template <class Order>
std::optional<double> place_pools(const Chain<Order>& chain, const std::vector<int>& first, bool careful,
                                  Solution& found) {
  return Placement<Order>(chain, first, found).run(careful);
}

template <class Order>
double rounding_of_pools(const Chain<Order>& chain, double scale) {
  const double farthest = chain.farthest_offset * std::sqrt(chain.total_mass);
  return 8 * unit_roundoff * unit_roundoff * static_cast<double>(chain.n) * (scale + farthest);
}

template double rounding_of_pools(const Chain<InOrder>&, double);
template double rounding_of_pools(const Chain<Listed>&, double);
template std::optional<double> place_pools(const Chain<InOrder>&, const std::vector<int>&, bool, Solution&);
template std::optional<double> place_pools(const Chain<Listed>&, const std::vector<int>&, bool, Solution&);

}  // namespace convex::inline isotonic
