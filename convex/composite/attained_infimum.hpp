#pragma once

#include "convex/composite/graph_form.hpp"

namespace convex::inline composite {

/// f with the infimum over w attained, where it is not for functions of one entry that only come near to a
/// line far out, as 1/u to 0 and log(1 + e^u) to u.
///
/// Let F be the sum of the terms and d a direction of w with F∞(0, d) = 0, F∞ the recession function. F does
/// not increase along d (Rockafellar 1970, Theorem 8.6), so that it may be replaced by its limit there: the
/// infimum over w is the same for every x. Of a term that is lim f(u + t M d) - t f∞(M d), the sum of the
/// lines s_i u_i - f_i*(s_i), s_i the slope that f_i has far out, over the entries that move, and of the
/// other f_i as they are; of the epigraph of such an f whose height moves by f∞, the epigraph of that. A
/// program that goes after such an infimum ends far out with a value that is not the limit. The dual has the
/// same optimum without a point inside of all its domains: this is its reduction to their common face
/// (Borwein and Wolkowicz 1981).
///
/// d is found in fractions among those along which norms and other functions without a program stand still.
GraphForm with_attained_infimum(GraphForm f);

}  // namespace convex::inline composite
