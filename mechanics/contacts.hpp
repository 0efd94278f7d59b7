#pragma once

#include <vector>

#include "mechanics/system.hpp"

namespace mechanics {

/// |f| and |df/dt| count as zero within this times their scale (see ConstraintRates), unless told.
inline constexpr double default_contact_tolerance = 1e-9;

/// The contacts present at a state, K (Moreau 1966, section 2): one-sided constraints with f_a = 0 and
/// df_a/dt = 0 (6), and all two-sided ones. `present` holds their indices, in order.
struct Contacts {
  std::vector<Index> present;
  ConstraintRates rates;            ///< of every constraint, present or not
  std::vector<Index> closing = {};  ///< f = 0 and df/dt < 0: an impact is due; where that is allowed
};

/// Whether a state at which an impact is due is refused.
enum class Impending { refused, allowed };

/// tolerance: one number per constraint. Throws InvalidInput, naming each such constraint, its value and what
/// to do, when one is penetrated (f < 0), when an impact is due (f = 0, df/dt < 0) and that is refused, or when
/// a two-sided one does not hold.
Contacts contacts(const System&, const State&, const Vector& tolerance,
                  Impending impending = Impending::refused);

}  // namespace mechanics
