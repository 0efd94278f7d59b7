#include "mechanics/singular/rounded_rows.hpp"
#include "mechanics/singular/singular_group.hpp"

namespace mechanics::inline singular_states {

using expression::Rounded;
using expression::TimeSeries;

Rounded SingularGroup::third(std::size_t dependence, const std::vector<TimeSeries>& f) const {
  return combined(dependences_[dependence].weights, f, 3);
}

void SingularGroup::find_third_rows() {
  third_.resize(dependences_.size());
  const std::vector<TimeSeries> at_rest = along({}, 3);
  for (std::size_t d = 0; d < third_.size(); ++d) {
    third_[d].row.resize(columns_.size());
    third_[d].rhs = -third(d, at_rest);
    third_[d].is_finite = is_finite(third_[d].rhs);
  }
  for (std::size_t i = 0; i < columns_.size(); ++i) {
    const std::vector<TimeSeries> f = along_column(i, 3, true);
    for (std::size_t d = 0; d < third_.size(); ++d) {
      third_[d].row[i] = third(d, f) + third_[d].rhs;
      third_[d].is_finite = third_[d].is_finite && is_finite(third_[d].row[i]);
    }
  }
  std::vector<std::vector<Rounded>> rows;
  for (ThirdRow& third : third_) {
    if (!third.is_finite) {
      undecided_ = true;
      third.row.assign(columns_.size(), Rounded{});
    }
    rows.push_back(third.row);
  }
  const ScaledRows scaled(rows, unit_);
  split_ = split_rows(scaled.rows, scaled.radius, held_);
}

std::vector<AddedRow> SingularGroup::missing(const std::vector<Rounded>& q2) {
  if (third_.empty()) find_third_rows();
  std::vector<Rounded> answer;
  for (const Index i : columns_) answer.push_back(q2[static_cast<std::size_t>(i)]);
  const std::vector<TimeSeries> f = along(answer, 3);
  const auto fails = [&](Index d) {
    const Rounded left = third(static_cast<std::size_t>(d), f);
    return third_[static_cast<std::size_t>(d)].is_finite && !left.may_be_zero();
  };
  std::vector<AddedRow> found;
  for (const Index d : split_.kept) {
    ThirdRow& third = third_[static_cast<std::size_t>(d)];
    if (third.is_added || !fails(d)) continue;
    third.is_added = true;
    AddedRow row{{}, Vector::Zero(state_.q.size()), third.rhs.value};
    const Dependence& dependence = dependences_[static_cast<std::size_t>(d)];
    row.main = constraints_[static_cast<std::size_t>(dependence.main)];
    for (std::size_t a = 0; a < constraints_.size(); ++a)
      if (dependence.weights[a].value != 0)
        row.weights.emplace_back(constraints_[a], dependence.weights[a].value);
    for (std::size_t i = 0; i < columns_.size(); ++i)
      if (!third.row[i].may_be_zero()) row.row[columns_[i]] = third.row[i].value;
    row.row_radius = ScaledRows({third.row}, unit_).radius[0];
    row.rhs_radius = third.rhs.radius;
    found.push_back(std::move(row));
  }
  if (!found.empty()) return found;
  for (std::size_t k = 0; k < split_.dependent.size(); ++k) {
    const Index d = split_.dependent[k];
    if (!third_[static_cast<std::size_t>(d)].is_finite) continue;
    if (fails(d))
      refuse(dependences_[static_cast<std::size_t>(d)],
             "third derivatives contradict the second ones: no motion with these velocities passes through "
             "the state; change the velocities, or the state");
    for (AddedRow& row : test_fourth(k, answer)) found.push_back(std::move(row));
  }
  return found;
}

}  // namespace mechanics::inline singular_states
