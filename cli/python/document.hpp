#pragma once

#include <string>
#include <vector>

#include "cli/scene.hpp"

namespace python {

/// A problem as a file or a dict has it, and what messages call it.
struct Document {
  cli::Problem problem;
  std::string name;
};

/// Reads a problem file of any form, or the text of one in JSON, with what is set in it ("m=3").
Document read_document(const std::string& source, bool is_text, const std::vector<std::string>& settings,
                       const std::string& name);

}  // namespace python
