#pragma once

#include <optional>

#include "mechanics/contacts.hpp"
#include "mechanics/warning.hpp"
#include "mechanics/written_mechanism.hpp"

namespace mechanics {

/// |f| and |df/dt| within this times their scales are likely to be 0 in what was meant: a state typed with
/// five digits.
inline constexpr double near_contact_tolerance = 1e-4;

/// Warns of one-sided constraints that are not in K by little, |f| and |df/dt| within near_contact_tolerance,
/// although the answer q2 lets them go further in, u_a·q'' < s_a beyond rounding: what was meant is likely a
/// contact. None when there are none.
std::optional<Warning> near_contacts(const System&, const State&, const Contacts&, const Vector& q2);

/// The one-sided constraints of K, but for those declared to be in contact, with f or df/dt apart from 0 by
/// more than rounding: they count as closed by the contact tolerance alone, the mechanism as written has a
/// gap.
std::vector<Index> closed_by_tolerance(const WrittenMechanism&, const Contacts&);

}  // namespace mechanics
