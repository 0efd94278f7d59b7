#include "convex/invariant.hpp"

#include <cstdio>
#include <cstdlib>

namespace convex {

void invariant(bool holds, const char* claim, std::source_location where) {
  if (holds) return;
  std::fprintf(stderr, "moreau: defect in %s:%u: does not hold: %s; please report it\n", where.file_name(),
               static_cast<unsigned>(where.line()), claim);
  std::abort();
}

}  // namespace convex
