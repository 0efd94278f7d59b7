#pragma once

#include "convex/laws/subject.hpp"

namespace convex::inline law_checks {

/// f, which answers at once what it was asked before. The laws ask for the same proxes and values over and
/// over: each its own at z, and all of them those of the companions at every z.
Subject remembered(const Subject& f);

}  // namespace convex::inline law_checks
