#pragma once

#include <string>
#include <vector>

#include "mechanics/state.hpp"

namespace mechanics {

/// Something about an answer that its numbers do not show (docs/problem-files.md, `warnings`).
struct Warning {
  enum class Kind { near_contact, singular, undecided };
  Kind kind;
  std::vector<Index> constraints;
  std::string message;  ///< "what is so; what to do"
};

}  // namespace mechanics
