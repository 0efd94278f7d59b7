#include "cli/problem_file/kinds.hpp"

#include <algorithm>
#include <string>

namespace cli::inline problem_files {

bool ProblemKind::has(const std::string& key) const {
  return std::find(keys->begin(), keys->end(), key) != keys->end();
}

const ProblemKind* kind_of(const TomlValue& document) {
  for (const TomlEntry& entry : document.table)
    for (const ProblemKind& kind : problem_kinds)
      if (entry.key == kind.name) return &kind;
  const ProblemKind* found = nullptr;
  std::ptrdiff_t most = 0;
  for (const ProblemKind& kind : problem_kinds) {
    const auto keys = std::count_if(document.table.begin(), document.table.end(),
                                    [&](const TomlEntry& entry) { return kind.has(entry.key); });
    if (keys == most) found = nullptr;
    if (keys <= most) continue;
    most = keys;
    found = &kind;
  }
  return found;
}

}  // namespace cli::inline problem_files
