#include <algorithm>
#include <random>

#include "mechanics/singular/redundancy.hpp"
#include "mechanics/singular/rounded_rows.hpp"
#include "mechanics/singular/singular_group.hpp"

namespace mechanics::inline singular_states {

using expression::Rounded;
using expression::TimeSeries;

namespace {

Vector values(const std::vector<Rounded>& x) {
  Vector found(static_cast<Index>(x.size()));
  for (std::size_t i = 0; i < x.size(); ++i) found[static_cast<Index>(i)] = x[i].value;
  return found;
}

}  // namespace

std::vector<AddedRow> SingularGroup::test_fourth(std::size_t k, const std::vector<Rounded>& q2) {
  const Dependence& dependence = dependences_[static_cast<std::size_t>(split_.dependent[k])];
  // Σ v_j u_j + Σ ω_d row_d = 0 with ω = 1 at this dependence: then q''' drops out of
  // Σ ω_d w_d·f'''' + 4/3 Σ v_j f_j'''.
  const RowSpace::Expansion& expansion = split_.expansions[k];
  const auto of_gradients = independent_.size();
  std::vector<Rounded> fourth = dependence.weights, third(constraints_.size());
  bool alone = true;
  for (std::size_t j = 0; j < static_cast<std::size_t>(expansion.coefficients.size()); ++j) {
    const auto entry = static_cast<Index>(j);
    const Rounded coefficient(-expansion.coefficients[entry], expansion.radius[entry]);
    if (coefficient.may_be_zero()) continue;
    if (j < of_gradients) {
      third[static_cast<std::size_t>(independent_[j])] = coefficient * (Rounded(4) / Rounded(3));
      continue;
    }
    alone = false;
    const Dependence& other = dependences_[static_cast<std::size_t>(split_.kept[j - of_gradients])];
    for (std::size_t a = 0; a < fourth.size(); ++a) fourth[a] += coefficient * other.weights[a];
  }
  const auto value = [&](const std::vector<Rounded>& at) {
    const std::vector<TimeSeries> f = along(at, 4);
    return combined(fourth, f, 4) + combined(third, f, 3);
  };
  const Rounded here = value(q2);
  if (!is_finite(here)) {
    undecided_ = true;
    return {};
  }

  // Other accelerations that second and third derivatives allow.
  std::mt19937_64 random(1966);
  std::normal_distribution<double> normal;
  constexpr int most_samples = 32;
  constexpr double spreads[] = {1, 16, 256, 4096};
  std::vector<Rounded> samples;
  const Vector answer = values(q2);
  const double size = 1 + answer.cwiseQuotient(unit_).norm();
  const bool is_free = held_.size() < held_.columns();
  for (int sample = 0; is_free && sample < most_samples; ++sample) {
    Vector move(unit_.size());
    for (double& entry : move) entry = spreads[sample % 4] * size * normal(random);
    move = held_.off_span(std::move(move)).cwiseProduct(unit_);
    std::vector<Rounded> at;
    for (std::size_t i = 0; i < q2.size(); ++i)
      at.emplace_back(answer[static_cast<Index>(i)] + move[static_cast<Index>(i)],
                      q2[i].radius + 0x1p-48 * std::abs(move[static_cast<Index>(i)]));
    samples.push_back(value(at));
  }
  samples.push_back(here);
  const bool positive = std::any_of(samples.begin(), samples.end(),
                                    [](Rounded x) { return !x.may_be_zero() && x.value > 0; }),
             negative = std::any_of(samples.begin(), samples.end(),
                                    [](Rounded x) { return !x.may_be_zero() && x.value < 0; });
  if (!here.may_be_zero()) {
    if (std::vector<AddedRow> forms = linear_forms(dependence); alone && !forms.empty()) return forms;
    if (!is_free || (positive && negative))
      refuse(dependence,
             std::string("second and third derivatives do not tell the acceleration, and the fourth ones "
                         "contradict what they leave: the state has several branches; ") +
                 (state_.v(columns_).isZero(0)
                      ? "give a velocity or move off it"
                      : "give another velocity, write it so that its gradient does not vanish "
                        "(y = x for y^3 = x^3), or move off it"));
    refuse(
        dependence,
        "second and third derivatives do not see it, and the fourth ones contradict what they leave; write "
        "it so that its gradient does not vanish where it holds (y = 0 for y^2 = 0), or give a velocity or "
        "move off the state");
  }
  if (positive != negative && is_free && alone) {
    const auto motion = motion_with(dependence, q2, positive ? 1 : -1);
    if (motion && !motion->exists)
      refuse(
          dependence,
          "derivatives up to the fourth leave the acceleration that the second ones give, and those of "
          "order " +
              std::to_string(motion->order) +
              " exclude it: the state is a cusp or an end of what the constraint allows; give a velocity or "
              "move off it");
    if (!motion && linear_forms(dependence).empty()) undecided_ = true;
  }
  if (positive || negative || !is_free || !alone) return {};
  const auto redundant = holds_by_itself(dependence);
  if (!redundant) undecided_ = true;
  if (redundant && !*redundant)
    refuse(dependence,
           std::string("derivatives up to the fourth do not tell the acceleration at this state") +
               (dependence.vanishes
                    ? "; write it so that its gradient does not vanish where it holds (y = 0 for "
                      "y^4 = 0), or move off the state"
                : missed_place_ > 0 || missed_velocity_ > 0
                    ? ", at which they hold only nearly; give it with more digits, or leave out a "
                      "constraint that the others imply"
                    : "; leave out a constraint that the others imply, or move off the state"));
  return {};
}

/// By the constraints of the dependence, which are few, or by all of the group.
std::optional<bool> SingularGroup::holds_by_itself(const Dependence& dependence) const {
  std::vector<Index> few{constraints_[static_cast<std::size_t>(dependence.main)]}, others;
  for (std::size_t a = 0; a < constraints_.size(); ++a) {
    if (dependence.weights[a].value == 0 || static_cast<Index>(a) == dependence.main) continue;
    others.push_back(static_cast<Index>(few.size()));
    few.push_back(constraints_[a]);
  }
  const expression::ConstraintSeries series(system_.model(), few);
  const auto by_few = is_redundant(series, state_, series.coordinates(), 0, others);
  if (by_few && *by_few) return true;
  return is_redundant(series_, state_, columns_, dependence.main, independent_);
}

void SingularGroup::refuse(const Dependence& dependence, const std::string& what) const {
  const auto& all = system_.constraints();
  std::string names;
  int count = 0;
  for (std::size_t a = 0; a < constraints_.size(); ++a)
    if (dependence.weights[a].value != 0) {
      names += (count > 0 ? ", " : "") + all[static_cast<std::size_t>(constraints_[a])].name;
      ++count;
    }
  const Constraint& main =
      all[static_cast<std::size_t>(constraints_[static_cast<std::size_t>(dependence.main)])];
  throw convex::InvalidInput((count > 1 ? "constraints " : "constraint ") + names +
                                 (count > 1 ? ": their gradients depend on each other at this state, "
                                            : ": its gradient vanishes at this state, ") +
                                 what,
                             main.place);
}

}  // namespace mechanics::inline singular_states
