#pragma once

#include "mechanics/expression/lagrangian_model.hpp"
#include "mechanics/expression/time_series.hpp"

namespace mechanics::expression {

/// Chosen constraints as functions of time along a motion.
class ConstraintSeries {
 public:
  ConstraintSeries(const LagrangianModel& model, const std::vector<Index>& constraints);

  /// f_a along q(t), in the order of the constraints; coefficients 0 to `order`. q: n; t: the time itself, at
  /// the rate 0 where it stands still; `instant`: of its branches.
  std::vector<TimeSeries> along(const std::vector<TimeSeries>& q, const TimeSeries& t, int order,
                                Instant instant = Instant::now) const;

  /// The coordinates that these constraints depend on, in increasing order.
  const std::vector<Index>& coordinates() const { return coordinates_; }
  /// Operations of one pass.
  std::size_t work() const { return order_.size(); }

 private:
  const Program* program_;
  std::vector<Slot> roots_, order_;  // order_: the operations below the roots, operands first
  std::vector<std::pair<Slot, Rounded>> constants_;
  std::vector<Index> coordinates_;
};

/// The coordinates that each of these constraints depends on by its text.
std::vector<std::vector<Index>> coordinates_of(const Program& contacts,
                                               const std::vector<Index>& constraints);

}  // namespace mechanics::expression
