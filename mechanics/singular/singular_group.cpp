#include "mechanics/singular/singular_group.hpp"

#include <algorithm>

#include "convex/linear_algebra/complete_orthogonal.hpp"
#include "mechanics/singular/rounded_rows.hpp"

namespace mechanics::inline singular_states {

using expression::Rounded;
using expression::TimeSeries;

namespace {

/// Gradients closer to a dependence than this part of themselves do not tell how far away a state with f = 0
/// is.
constexpr double telling = 1e-6;

Vector chosen(const Vector& x, const std::vector<Index>& columns) {
  Vector found(static_cast<Index>(columns.size()));
  for (std::size_t i = 0; i < columns.size(); ++i) found[static_cast<Index>(i)] = x[columns[i]];
  return found;
}

}  // namespace

SingularGroup::SingularGroup(const LagrangianSystem& system, const State& state, const StateRadii& radii,
                             const Vector& unit, std::vector<Index> constraints)
    : system_(system),
      state_(state),
      radii_(radii),
      constraints_(std::move(constraints)),
      series_(system.model(), constraints_),
      columns_(series_.coordinates()),
      unit_(chosen(unit, columns_)),
      held_(static_cast<Index>(columns_.size())) {
  find_dependences();
}

Rounded SingularGroup::place(Index column) const {
  const Index i = columns_[static_cast<std::size_t>(column)];
  return {state_.q[i], radii_.q[i] + missed_place_ * unit_[column]};
}

Rounded SingularGroup::velocity(Index column) const {
  const Index i = columns_[static_cast<std::size_t>(column)];
  return {state_.v[i], radii_.v[i] + missed_velocity_ * unit_[column]};
}

std::vector<TimeSeries> SingularGroup::coordinates_along(const std::vector<Rounded>& q2) const {
  std::vector<TimeSeries> q(static_cast<std::size_t>(state_.q.size()));
  for (std::size_t k = 0; k < columns_.size(); ++k) {
    TimeSeries& coordinate = q[static_cast<std::size_t>(columns_[k])];
    coordinate.c[0] = place(static_cast<Index>(k));
    coordinate.c[1] = velocity(static_cast<Index>(k));
    if (!q2.empty()) coordinate.c[2] = q2[k] / 2.0;
  }
  return q;
}

TimeSeries SingularGroup::time_along() const {
  TimeSeries t(Rounded(state_.t, radii_.t));
  t.c[1] = 1;
  return t;
}

std::vector<TimeSeries> SingularGroup::along(const std::vector<Rounded>& q2, int order) const {
  return series_.along(coordinates_along(q2), time_along(), order);
}

/// The gradients by one coordinate: along a motion of that coordinate alone.
std::vector<TimeSeries> SingularGroup::along_column(std::size_t column, int order, bool accelerated) const {
  if (accelerated) {
    std::vector<Rounded> q2(columns_.size());
    q2[column] = 1;
    return along(q2, order);
  }
  std::vector<TimeSeries> q(static_cast<std::size_t>(state_.q.size()));
  for (std::size_t k = 0; k < columns_.size(); ++k)
    q[static_cast<std::size_t>(columns_[k])].c[0] = place(static_cast<Index>(k));
  q[static_cast<std::size_t>(columns_[column])].c[1] = 1;
  return series_.along(q, TimeSeries(Rounded(state_.t, radii_.t)), order);
}

void SingularGroup::find_dependences() {
  const std::size_t m = constraints_.size();
  std::vector<std::vector<Rounded>> U(m, std::vector<Rounded>(columns_.size()));
  for (std::size_t i = 0; i < columns_.size(); ++i) {
    const std::vector<TimeSeries> f = along_column(i, 1, false);
    for (std::size_t a = 0; a < m; ++a) {
      U[a][i] = f[a].c[1];
      if (!is_finite(U[a][i])) undecided_ = true;
    }
  }
  if (undecided_) return;
  const ScaledRows scaled(U, unit_);
  const bool by_rounding = missed_place_ == 0 && missed_velocity_ == 0;
  const std::size_t before = dependences_.size();
  held_ = RowSpace(static_cast<Index>(columns_.size()));
  dependences_.clear();
  const SplitRows split = split_rows(scaled.rows, scaled.radius, held_);
  independent_ = split.kept;
  for (std::size_t d = 0; d < split.dependent.size(); ++d) {
    Dependence dependence{split.dependent[d], std::vector<Rounded>(m), false};
    const auto main = static_cast<std::size_t>(dependence.main);
    dependence.vanishes =
        std::all_of(U[main].begin(), U[main].end(), [](Rounded u) { return u.may_be_zero(); });
    dependence.weights[main] = 1;
    double largest = 1;
    if (!dependence.vanishes)
      for (std::size_t j = 0; j < independent_.size(); ++j) {
        const auto k = static_cast<Index>(j);
        Rounded weight(-split.expansions[d].coefficients[k], split.expansions[d].radius[k]);
        if (weight.may_be_zero()) weight = {0, std::abs(weight.value) + weight.radius};
        dependence.weights[static_cast<std::size_t>(independent_[j])] = weight;
        largest = std::max(largest, std::abs(weight.value));
      }
    for (Rounded& weight : dependence.weights) weight = weight / largest;
    dependence.by_state = !by_rounding && split.dependent.size() > before;
    dependences_.push_back(std::move(dependence));
  }
  if (!by_rounding) return;
  find_what_state_misses(scaled.rows);
  if (missed_place_ > 0 || missed_velocity_ > 0) find_dependences();
}

/// The shortest moves of q and q' to f = 0 and df/dt = 0, by gradients that are not nearly dependent.
void SingularGroup::find_what_state_misses(const RowMatrix& gradients) {
  const std::vector<TimeSeries> f = along({}, 1);
  Matrix rows = gradients;
  Vector place = Vector::Zero(rows.rows()), velocity = place;
  const auto beyond_rounding = [](Rounded x) { return x.may_be_zero() ? 0.0 : x.value; };
  for (Index a = 0; a < rows.rows(); ++a) {
    const double length = rows.row(a).norm();
    if (!(length > 0)) continue;
    rows.row(a) /= length;
    place[a] = beyond_rounding(f[static_cast<std::size_t>(a)].c[0]) / length;
    velocity[a] = beyond_rounding(f[static_cast<std::size_t>(a)].c[1]) / length;
  }
  if (place.isZero(0) && velocity.isZero(0)) return;
  const convex::linear_algebra::CompleteOrthogonal factor(rows, telling);
  missed_place_ = factor.solve(place).norm();
  missed_velocity_ = factor.solve(velocity).norm();
}

std::vector<SingularGroup::Settled> SingularGroup::settled() const {
  std::vector<Settled> found;
  std::vector<TimeSeries> f;
  for (const Dependence& dependence : dependences_) {
    if (!dependence.vanishes && !dependence.by_state) continue;
    if (f.empty()) f = along({}, 2);
    const auto main = static_cast<std::size_t>(dependence.main);
    Settled settled{
        constraints_[main], {}, dependence.by_state, combined(dependence.weights, f, 2).may_be_zero()};
    for (std::size_t b = 0; b < constraints_.size(); ++b)
      if (b != main && dependence.weights[b].value != 0)
        settled.combination.emplace_back(constraints_[b],
                                         -dependence.weights[b].value / dependence.weights[main].value);
    found.push_back(std::move(settled));
  }
  return found;
}

std::vector<SingularGroup::Repeated> SingularGroup::dependent(bool is_consistent) const {
  std::vector<Repeated> found;
  const std::vector<TimeSeries> f = along({}, 2);
  for (const Dependence& dependence : dependences_) {
    if (combined(dependence.weights, f, 2).may_be_zero() != is_consistent) continue;
    Repeated& repeated = found.emplace_back();
    repeated.main = constraints_[static_cast<std::size_t>(dependence.main)];
    for (std::size_t a = 0; a < constraints_.size(); ++a)
      if (dependence.weights[a].value != 0) repeated.constraints.push_back(constraints_[a]);
  }
  return found;
}

}  // namespace mechanics::inline singular_states
