#include "mechanics/vanishing_gradient.hpp"

#include <cmath>

#include "mechanics/expression/constraint_series.hpp"
#include "mechanics/number_text.hpp"

namespace mechanics {
namespace {

using expression::Rounded;
using expression::TimeSeries;

std::vector<Index> contacts_without_gradient(const System& system, const std::vector<Index>& contacts,
                                             const convex::NearestPointProblem& problem) {
  std::vector<Index> found;
  for (std::size_t k = 0; k < contacts.size(); ++k)
    if (!system.constraints()[static_cast<std::size_t>(contacts[k])].two_sided &&
        problem.U.row(static_cast<Index>(k)).isZero(0))
      found.push_back(contacts[k]);
  return found;
}

/// q + q'τ + ½ q''τ², with what reading the state rounded.
std::vector<TimeSeries> accelerated(const WrittenMechanism& written, const Vector& q2) {
  const auto radius = [](const Vector& radii, Index i) { return radii.size() > 0 ? radii[i] : 0; };
  std::vector<TimeSeries> q(static_cast<std::size_t>(q2.size()));
  for (Index i = 0; i < q2.size(); ++i) {
    auto& c = q[static_cast<std::size_t>(i)].c;
    c[0] = {written.state.q[i], radius(written.radii.q, i)};
    c[1] = {written.state.v[i], radius(written.radii.v, i)};
    c[2] = q2[i] / 2;
  }
  return q;
}

/// The order of the first coefficient that is not 0 for all that rounding tells; 0 when none of those
/// followed is, or one does not exist.
std::size_t first_nonzero(const TimeSeries& f) {
  for (std::size_t k = 2; k < f.c.size(); ++k) {
    if (!std::isfinite(f.c[k].value + f.c[k].radius)) return 0;
    if (!f.c[k].may_be_zero()) return k;
  }
  return 0;
}

}  // namespace

std::optional<Warning> violated_at_higher_order(const WrittenMechanism& written,
                                                const std::vector<Index>& contacts,
                                                const convex::NearestPointProblem& problem,
                                                const Vector& q2) {
  const std::vector<Index> suspects = contacts_without_gradient(*written.system, contacts, problem);
  if (suspects.empty() || !q2.allFinite()) return std::nullopt;
  TimeSeries t(Rounded(written.state.t, written.radii.t));
  t.c[1] = 1;
  const expression::ConstraintSeries series(written.system->model(), suspects);
  const std::vector<TimeSeries> f = series.along(accelerated(written, q2), t, expression::most_derivatives);
  Warning warning{Warning::Kind::undecided, {}, ""};
  for (std::size_t k = 0; k < suspects.size(); ++k) {
    const std::size_t order = first_nonzero(f[k]);
    if (order == 0 || f[k].c[order].value > 0) continue;
    warning.constraints.push_back(suspects[k]);
    warning.message += (warning.message.empty() ? "" : "; ") +
                       written.system->constraints()[static_cast<std::size_t>(suspects[k])].name +
                       ": the gradient is 0 here, second derivatives do not tell what it asks for, and with "
                       "this acceleration it would be violated, f = " +
                       number_text(f[k].c[order].value) + " τ^" + std::to_string(order);
  }
  if (warning.constraints.empty()) return std::nullopt;
  warning.message += "; write it so that its gradient does not vanish, as y >= 0 for y^3 >= 0";
  return warning;
}

}  // namespace mechanics
