#pragma once

#include <optional>
#include <string_view>
#include <vector>

#include "convex/metric.hpp"

namespace mechanics::inline motions {

using convex::Index;
using convex::Vector;

/// A contact with f = 0 at an instant.
struct ImpactContact {
  Vector u;                ///< ∂f/∂q: n
  double rate = 0;         ///< df/dt before, f'(v-)
  double restitution = 0;  ///< e
  bool two_sided = false;
  double rate_scale = 0;  ///< what the rate is the sum of, if that is more than itself
};

/// What an impact does. No v+ exists when the contacts exclude each other: then `excluding` has indices of
/// contacts, `weights` w, one each, with Σ w_a u_a = 0 and -Σ w_a (1 + e_a) f'_a(v-) > 0, and the rest is
/// empty; likewise when the law does not determine v+, which `undetermined` says.
struct ImpactOutcome {
  Vector change;   ///< v+ - v-: n
  Vector impulse;  ///< P, one a contact; exactly 0 where rounding hides the difference
  Vector rate;     ///< f'(v+), one a contact; exactly 0 where rounding hides the difference
  std::vector<Index> excluding = {};
  std::vector<double> weights = {};
  std::string_view undetermined = {};
  std::string_view remark = {};  ///< what the data leave open
};

/// Laws of impact; docs/motion.md has them side by side.
enum class ImpactLaw { moreau, poisson, sequential };
inline constexpr ImpactLaw impact_laws[] = {ImpactLaw::moreau, ImpactLaw::poisson, ImpactLaw::sequential};
const char* name(ImpactLaw);
std::optional<ImpactLaw> impact_law_named(std::string_view name);

/// v+ by a law, in the kinetic metric A.
ImpactOutcome impact(const convex::Metric& A, const std::vector<ImpactContact>& contacts,
                     ImpactLaw law = ImpactLaw::moreau);

/// Moreau's law: A (v+ - v-) = Σ P_a u_a, 0 <= P_a ⟂ f'_a(v+) + e_a f'_a(v-) >= 0, where e_a counts as 0 if
/// f'_a(v-) > 0, and P free, f'(v+) = 0 for two-sided contacts. It is a nearest-point problem in the kinetic
/// metric: v+ - v- is the least change with u_a·(v+ - v-) >= -(1 + e_a) f'_a(v-), so that v+ is unique even
/// where P is not. With one e and all contacts closing, v+ = -e v- + (1 + e) proj_V v-, V = {v : f'_a(v) >=
/// 0} (Moreau 1988).
ImpactOutcome moreau_impact(const convex::Metric& A, const std::vector<ImpactContact>& contacts);

/// Poisson's law: Moreau's with e = 0 gives the impulses P_c of compression; from there 0 <= P_a - e_a P_c,a
/// ⟂ f'_a(v+) >= 0. Where P_c is not unique and the e differ, v+ is not determined.
ImpactOutcome poisson_impact(const convex::Metric& A, const std::vector<ImpactContact>& contacts);

/// One contact after the other: the one with the most negative f'_a(v)/||u_a||_(A⁻¹) strikes alone, with its
/// e and the two-sided contacts held, until none closes. Where that does not end, its limit.
ImpactOutcome sequential_impact(const convex::Metric& A, const std::vector<ImpactContact>& contacts);

}  // namespace mechanics::inline motions
