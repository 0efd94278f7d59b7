#pragma once

#include <memory>
#include <string>
#include <vector>

#include "cli/problem_file/toml_document.hpp"
#include "cli/scene.hpp"
#include "convex/invalid_input.hpp"

namespace python {

/// A problem as a file or a dict has it, and what messages call it.
struct Document {
  cli::Problem problem;
  std::string name;
  std::shared_ptr<const cli::TomlValue> dict = {};  ///< of a dict, whose text nobody has seen
};

/// What is wrong in a dict, by the keys where it is: "system.kinetic" and, of the others of the error,
/// theirs.
struct InvalidDict : convex::InvalidInput {
  InvalidDict(const convex::InvalidInput& error, const cli::TomlValue& dict);
  std::vector<std::string> keys;
};

/// Does the work, and tells of a dict by its keys.
template <class Work>
auto told_by_keys(const std::shared_ptr<const cli::TomlValue>& dict, const Work& work) {
  try {
    return work();
  } catch (const convex::InvalidInput& error) {
    if (dict == nullptr) throw;
    throw InvalidDict(error, *dict);
  }
}

/// Reads a problem file of any form, or the text of one in JSON, with what is set in it ("m=3").
Document read_document(const std::string& source, bool is_text, const std::vector<std::string>& settings,
                       const std::string& name);

}  // namespace python
