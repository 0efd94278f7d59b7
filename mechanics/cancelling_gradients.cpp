#include "mechanics/cancelling_gradients.hpp"

#include <algorithm>
#include <cmath>
#include <random>

#include "convex/nearest_point/methods.hpp"
#include "mechanics/evaluation_error.hpp"
#include "mechanics/expression/constraint_series.hpp"
#include "mechanics/number_text.hpp"
#include "mechanics/row_space.hpp"

namespace mechanics {
namespace {

using convex::RowMatrix;
using expression::Rounded;
using expression::TimeSeries;

/// Rows that persist, in units in which coordinates compare.
struct TightRows {
  std::vector<Index> rows;  // of the problem
  std::vector<bool> two_sided;
  RowMatrix U;
  Vector radius;
};

TightRows tight_rows(const System& system, const std::vector<Index>& contacts,
                     const convex::NearestPointProblem& problem, const std::vector<Index>& tight) {
  TightRows found;
  for (const Index row : tight)
    if (row < static_cast<Index>(contacts.size())) {
      found.rows.push_back(row);
      const Index contact = contacts[static_cast<std::size_t>(row)];
      found.two_sided.push_back(system.constraints()[static_cast<std::size_t>(contact)].two_sided);
    }
  const auto count = static_cast<Index>(found.rows.size());
  const Vector unit = problem.A.diagonal().cwiseSqrt().cwiseInverse();
  found.U.resize(count, problem.dimension());
  found.radius = Vector::Zero(count);
  for (Index k = 0; k < count; ++k) {
    const Index row = found.rows[static_cast<std::size_t>(k)];
    found.U.row(k) = problem.U.row(row).cwiseProduct(unit).transpose();
    if (problem.radii) found.radius[k] = problem.radii->row[row];
  }
  return found;
}

/// Σ w_a u_a = 0, by position among the tight rows.
using Weights = std::vector<std::pair<std::size_t, Rounded>>;

/// The weights of a Farkas circuit with what rounding leaves open of them; none where its gradients may be
/// independent, or their signs are not what they are to be.
std::optional<Weights> weights_of(const TightRows& tight, std::vector<std::size_t> circuit) {
  const auto main =
      std::find_if(circuit.begin(), circuit.end(), [&](std::size_t k) { return !tight.two_sided[k]; });
  if (main == circuit.end()) return std::nullopt;
  std::iter_swap(main, circuit.end() - 1);
  RowSpace space(tight.U.cols());
  for (const std::size_t k : circuit) {
    const auto row = static_cast<Index>(k);
    const auto expansion = space.expansion(tight.U.row(row).transpose(), tight.radius[row]);
    if (k != circuit.back()) {
      if (!expansion.is_independent()) return std::nullopt;
      space.keep(tight.U.row(row).transpose(), tight.radius[row], expansion);
      continue;
    }
    if (expansion.is_independent()) return std::nullopt;
    Weights weights{{k, 1}};
    for (std::size_t j = 0; j + 1 < circuit.size(); ++j) {
      const auto entry = static_cast<Index>(j);
      weights.emplace_back(circuit[j], Rounded(-expansion.coefficients[entry], expansion.radius[entry]));
      if (!tight.two_sided[circuit[j]] && weights.back().second.value < 0) return std::nullopt;
    }
    return weights;
  }
  return std::nullopt;
}

/// Weights under which gradients cancel, until every one-sided row that has a part in such a sum is in one:
/// no d has u_a·d >= 1 on its one-sided rows and u_a·d = 0 on two-sided ones, and Farkas' weights say why.
std::vector<Weights> cancelling(const TightRows& tight) {
  std::vector<Weights> found;
  std::vector<bool> free = tight.two_sided;
  free.flip();
  for (std::size_t k = 0; k < free.size(); ++k)
    if (tight.U.row(static_cast<Index>(k)).stableNorm() <= tight.radius[static_cast<Index>(k)]) {
      if (free[k]) found.push_back({{k, 1}});
      free[k] = false;
    }
  const auto count = static_cast<Index>(free.size());
  RowMatrix unit_rows = tight.U;
  std::optional<convex::DataRadii> radii = convex::DataRadii{tight.radius, Vector::Zero(count)};
  for (Index k = 0; k < count; ++k)
    if (const double length = tight.U.row(k).stableNorm(); length > 0) {
      unit_rows.row(k) /= length;
      radii->row[k] /= length;
    }
  while (std::find(free.begin(), free.end(), true) != free.end()) {
    convex::NearestPointProblem problem{convex::Metric::identity(tight.U.cols()),
                                        Vector::Zero(tight.U.cols()),
                                        convex::ConstraintRows(unit_rows),
                                        Vector::Zero(count),
                                        {}};
    problem.radii = radii;
    for (std::size_t k = 0; k < free.size(); ++k)
      if (free[k])
        problem.s[static_cast<Index>(k)] = 1;
      else
        problem.two_sided.push_back(static_cast<Index>(k));
    const convex::Solution direction = convex::methods().front().solve(problem, {});
    if (direction.status != convex::Status::infeasible) break;
    std::vector<std::size_t> circuit;
    bool fewer = false;
    for (std::size_t k = 0; k < free.size(); ++k)
      if (direction.farkas[static_cast<Index>(k)] != 0) {
        circuit.push_back(k);
        fewer = fewer || free[k];
        free[k] = false;
      }
    if (!fewer) break;
    if (auto weights = weights_of(tight, std::move(circuit))) found.push_back(*std::move(weights));
  }
  return found;
}

/// Motions with the position, velocity and acceleration given, each with what it is known to.
class Motions {
 public:
  /// `error`: of q'', ||·||_A.
  Motions(const WrittenMechanism& written, const convex::NearestPointProblem& problem,
          const convex::Solution& answer, double error, const expression::ConstraintSeries& series)
      : series_(series),
        t_(Rounded(written.state.t, written.radii.t)),
        q_(static_cast<std::size_t>(answer.q.size())) {
    t_.c[1] = 1;
    const auto radius = [](const Vector& radii, Index i) { return radii.size() > 0 ? radii[i] : 0; };
    unit_ = problem.A.diagonal().cwiseSqrt().cwiseInverse();
    for (const Index i : series.coordinates()) {
      auto& c = q_[static_cast<std::size_t>(i)].c;
      c[0] = {written.state.q[i], radius(written.radii.q, i)};
      c[1] = {written.state.v[i], radius(written.radii.v, i)};
      // |e_i| <= sqrt((A⁻¹)_ii) ||e||_A
      const double reach = std::sqrt(problem.A.solve(Vector::Unit(answer.q.size(), i))[i]);
      c[2] = Rounded(answer.q[i], reach * error + 0x1p-53 * std::abs(answer.q[i])) / 2.0;
      size_ = std::max(size_, std::abs(answer.q[i]) / unit_[i]);
    }
  }

  std::vector<TimeSeries> with_no_more_derivatives() const {
    return series_.along(q_, t_, expression::most_derivatives, expression::Instant::after);
  }

  /// Other derivatives of q from the one of this order on.
  std::vector<TimeSeries> with_others(std::mt19937_64& random, std::size_t from) const {
    std::uniform_real_distribution<double> part(-1, 1);
    std::vector<TimeSeries> q = q_;
    for (const Index i : series_.coordinates())
      for (std::size_t k = from; k < q[static_cast<std::size_t>(i)].c.size(); ++k)
        q[static_cast<std::size_t>(i)].c[k] = part(random) * unit_[i] * (size_ > 0 ? size_ : 1);
    return series_.along(q, t_, expression::most_derivatives, expression::Instant::after);
  }
  /// Whether a coordinate of theirs has a velocity or an acceleration.
  bool moves() const {
    const auto& of = series_.coordinates();
    return std::any_of(of.begin(), of.end(), [&](Index i) {
      const auto& c = q_[static_cast<std::size_t>(i)].c;
      return !c[1].may_be_zero() || !c[2].may_be_zero();
    });
  }

 private:
  const expression::ConstraintSeries& series_;
  TimeSeries t_;
  std::vector<TimeSeries> q_;
  Vector unit_;
  double size_ = 0;  // of q''
};

/// The first coefficient, of order 2 or more, that is not 0 for all that rounding tells.
struct Leading {
  std::size_t order = 0;  // none of those followed, or one does not exist
  Rounded coefficient;
  bool exists = true;  ///< the derivatives up to that order
};

Leading leading(const Weights& weights, const std::vector<TimeSeries>& f) {
  for (std::size_t order = 2; order < f.front().c.size(); ++order) {
    Rounded sum;
    for (const auto& [k, weight] : weights) sum += weight * f[k].c[order];
    if (!std::isfinite(sum.value + sum.radius)) return {0, {}, false};
    if (!sum.may_be_zero()) return {order, sum};
  }
  return {};
}

std::string sum_text(const WrittenMechanism& written, const TightRows& tight,
                     const std::vector<Index>& contacts, const Weights& weights) {
  if (weights.size() == 1) return "f";
  std::string text;
  for (const auto& [k, weight] : weights) {
    const Index contact = contacts[static_cast<std::size_t>(tight.rows[k])];
    const double size = std::abs(weight.value);
    text += text.empty() ? "" : weight.value < 0 ? " - " : " + ";
    text += (size == 1 ? "" : number_text(size) + " ") + "f_" +
            written.system->constraints()[static_cast<std::size_t>(contact)].name;
  }
  return text;
}

}  // namespace

std::optional<Warning> violated_at_higher_order(
    const WrittenMechanism& written, const std::vector<Index>& contacts, const std::vector<AddedRow>& added,
    const convex::NearestPointProblem& problem, const std::vector<Index>& tight,
    const convex::Solution& answer, const convex::Accuracy& accuracy) {
  if (tight.size() > most_rows_looked_at || !answer.q.allFinite() || !std::isfinite(answer.error_bound))
    return std::nullopt;
  const TightRows rows = tight_rows(*written.system, contacts, problem, tight);
  const std::vector<Weights> sums = cancelling(rows);
  if (sums.empty()) return std::nullopt;
  std::vector<Index> constraints;
  for (const Index row : rows.rows) constraints.push_back(contacts[static_cast<std::size_t>(row)]);
  const expression::ConstraintSeries series(written.system->model(), constraints);
  const double as_evaluated = evaluation_error(written, contacts, added, problem, answer, accuracy);
  const Motions motions(written, problem, answer,
                        answer.error_bound + (std::isfinite(as_evaluated) ? as_evaluated : 0), series);
  std::mt19937_64 random(1966);
  constexpr std::size_t draws = 3, third = 3, velocity = 1;
  const std::vector<TimeSeries> f = motions.with_no_more_derivatives();
  std::vector<std::vector<TimeSeries>> others, beside;
  for (std::size_t draw = 0; draw < draws; ++draw) {
    others.push_back(motions.with_others(random, third));
    beside.push_back(motions.with_others(random, velocity));
  }
  const auto is_negative = [](const Leading& found) {
    return found.order > 0 && found.coefficient.value < 0;
  };
  const auto count_negative = [&](const Weights& weights, const std::vector<std::vector<TimeSeries>>& along) {
    return std::count_if(along.begin(), along.end(), [&](const std::vector<TimeSeries>& series_of_f) {
      return is_negative(leading(weights, series_of_f));
    });
  };
  Warning warning{Warning::Kind::undecided, {}, ""};
  bool by_itself = true;
  for (const Weights& weights : sums) {
    const Leading found = leading(weights, f);
    // Of one constraint by itself: higher derivatives of q that could keep it were not among those drawn; of
    // what is 0 to the last order followed, motions beside this one tell that it is not never below 0.
    const bool is_alone = weights.size() == 1;
    const Leading changed = leading(weights, others.front());
    const bool is_unchanged =
        changed.order == found.order && (changed.coefficient - found.coefficient).may_be_zero();
    const bool is_violated =
        found.order > 2 && is_negative(found) &&
        (is_unchanged || (is_alone && count_negative(weights, others) == static_cast<std::ptrdiff_t>(draws)));
    const bool is_open = is_alone && found.order == 0 && motions.moves() &&
                         (!found.exists || count_negative(weights, beside) > 0);
    if (!is_violated && !is_open) continue;
    std::string names;
    for (const auto& [k, weight] : weights) {
      warning.constraints.push_back(constraints[k]);
      names += (names.empty() ? "" : ", ") +
               written.system->constraints()[static_cast<std::size_t>(constraints[k])].name;
    }
    by_itself = by_itself && is_alone;
    warning.message +=
        (warning.message.empty() ? "" : "; ") + names +
        (is_alone
             ? ": the gradient is 0 here, second derivatives do not tell what it asks for, and with this "
               "acceleration it "
             : ": the gradients cancel here, second derivatives do not tell what they ask for together, and "
               "with this acceleration one ") +
        (is_violated ? "would be violated, " : "may be violated, ") +
        sum_text(written, rows, contacts, weights) +
        (is_violated    ? " = " + number_text(found.coefficient.value) + " τ^" + std::to_string(found.order)
         : found.exists ? " = 0 up to τ^" + std::to_string(expression::most_derivatives)
                        : " has no derivatives that tell");
  }
  if (warning.constraints.empty()) return std::nullopt;
  warning.message += by_itself ? "; write it so that its gradient does not vanish, as y >= 0 for y^3 >= 0"
                               : "; the state is a cusp or an end of what they allow: give another";
  return warning;
}

}  // namespace mechanics
