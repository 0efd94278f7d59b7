#include <algorithm>
#include <cmath>

#include "mechanics/motion/taylor_series.hpp"

/// Roots and powers of what is 0, whose derivatives are not finite where it does not stay 0.
namespace mechanics::inline motions {

using Kind = TaylorStep::Kind;

namespace {

/// So many derivatives of a power of what comes to 0 are 0 with it.
int orders_at_zero(double exponent) { return static_cast<int>(std::ceil(exponent)); }

}  // namespace

/// Whether the result is 0 all along, as max(-x, 0) is on the branch x > 0: derivatives of a power of it are
/// 0 then, though those of the power itself are not finite there.
bool TaylorSeries::stays_zero(const TaylorStep& step) const {
  switch (step.kind) {
    case Kind::sum:
    case Kind::difference:
      return stays_zero_[step.a] && stays_zero_[step.b];
    case Kind::product:
      return stays_zero_[step.a] || stays_zero_[step.b];
    case Kind::negative:
    case Kind::absolute:
    case Kind::share:
    case Kind::square:
    case Kind::root:
    case Kind::quotient:
      return stays_zero_[step.a];
    case Kind::power:
      return stays_zero_[step.a] && step.number > 0;
    case Kind::multiple:
      return stays_zero_[step.b];
    case Kind::where_not_negative:
      return stays_zero_[step.b] || branch(step) < 0;
    case Kind::where_negative:
      return stays_zero_[step.b] || branch(step) >= 0;
    case Kind::either:
      return branch(step) != 0 && stays_zero_[branch(step) > 0 ? step.a : step.b];
    default:
      return false;
  }
}

/// How many coefficients of the result do not hang on a derivative that has no bound.
int TaylorSeries::known(const TaylorStep& step) const {
  const int all = order_ + 1;
  switch (step.kind) {
    case Kind::sum:
    case Kind::difference:
    case Kind::product:
    case Kind::quotient:
    case Kind::angle:
      return std::min(known_[step.a], known_[step.b]);
    case Kind::arc:
      return std::min(known_[step.a], known_[step.partner]);
    case Kind::multiple:
      return known_[step.b];
    case Kind::root:
    case Kind::power: {
      const double exponent = step.kind == Kind::root ? 0.5 : step.number;
      const bool is_at_zero = exponent > 0 && base(step) == 0 && !stays_zero_[step.a];
      return is_at_zero ? std::min(known_[step.a], orders_at_zero(exponent)) : known_[step.a];
    }
    case Kind::absolute:
      return branch(step) == 0 ? all : known_[step.a];
    case Kind::sign:
      return all;
    case Kind::where_not_negative:
      return branch(step) >= 0 ? known_[step.b] : all;
    case Kind::where_negative:
      return branch(step) < 0 ? known_[step.b] : all;
    case Kind::either:
      return known_[branch(step) > 0 ? step.a : step.b];
    default:
      return known_[step.a];
  }
}

/// What a root or a power is taken of. One that counts as 0 is left what it is elsewhere: it may be a
/// velocity, which has to move on.
double TaylorSeries::base(const TaylorStep& step) const {
  const bool counts_as_zero =
      std::find(bases_at_zero_.begin(), bases_at_zero_.end(), step.a) != bases_at_zero_.end();
  return counts_as_zero ? 0 : (*this)[step.a][0];
}

/// Of a power of 0.
void TaylorSeries::differentiate_at_zero(const TaylorStep& step, double exponent, double& by,
                                         double& factor) {
  by = factor = 0;
  if (stays_zero_[step.a]) return;
  const int order = orders_at_zero(exponent);
  without_bound_ = without_bound_ == 0 ? order : std::min(without_bound_, order);
}

}  // namespace mechanics::inline motions
