#pragma once

#include <optional>
#include <string>

#include "cli/options.hpp"

namespace CLI {
class App;
}

namespace cli::inline commands {

/// `moreau check --map` and `--table`: is a map the prox of some function?
struct MapOptions {
  std::optional<std::string> map;    ///< expressions of its components
  std::optional<std::string> table;  ///< a file of points and images
  std::optional<std::string> metric;
  std::optional<std::string> box;   ///< "low:high", of every coordinate
  std::optional<std::string> data;  ///< the function on a grid, to a file
  bool is_given() const { return map || table; }
  /// Which option says something of a map where there is none, and what to do; null when none does.
  const char* given_amiss() const;
};

void add_map(CLI::App& command, MapOptions&);

Exit check_map(const MapOptions&, const Printing&);

}  // namespace cli::inline commands
