#pragma once

#include <algorithm>
#include <vector>

#include "mechanics/motion/taylor_series.hpp"

namespace mechanics::inline motions {

/// What the coefficients of a series are the sums of: the same recurrences with the absolute values of all
/// terms, and a function of a with |f'(a)| |a| beside |f|. Where terms cancel, this is much larger than
/// |c_k|; rounding moves c_k by about so many roundings of it as operations lead to it (Higham 2002, section
/// 3.1).
class TaylorMagnitude {
 public:
  using Slot = expression::Slot;

  explicit TaylorMagnitude(const TaylorSeries& series);

  /// A variable that was as large as this on the way has roundings of that size, however small it is now.
  void reach(Slot variable, double size) { reach_[variable] = std::max(reach_[variable], size); }

  /// Order 0 of all series, at the state of the series. at_least: by variable, how large it is taken to be.
  void begin(std::span<const double> at_least = {});
  /// Order k of the series of a group, from those of the variables and from lower orders.
  void find(std::size_t group, int k);
  double& at(Slot series, int k) { return m_[series * width() + static_cast<std::size_t>(k)]; }
  /// Coefficient k >= 1 itself, to be given of the variables.
  double& value(Slot series, int k) { return c_[series * width() + static_cast<std::size_t>(k)]; }

 private:
  std::size_t width() const { return static_cast<std::size_t>(of_.order_) + 1; }
  void begin_step(const TaylorStep& step, std::uint32_t row);
  void amplify(const TaylorStep& step, std::uint32_t row);
  double size(Slot series, int k);
  struct Rest {
    double value = 0, magnitude = 0;
  };
  Rest rest(const TaylorRows::Row& row, int k);

  const TaylorSeries& of_;
  std::vector<double> m_;       // by series and order
  std::vector<double> c_;       // likewise, the coefficients above 0
  std::vector<double> reach_;   // by variable
  std::vector<double> slopes_;  // what stands for |c| in each term of the rows
};

}  // namespace mechanics::inline motions
