#include <fmt/format.h>

#include <algorithm>
#include <cstdio>

#include "cli/commands.hpp"
#include "cli/json_writer.hpp"
#include "convex/nearest_point/methods.hpp"

namespace cli {

Exit methods_command(const Options& options) {
  if (options.json) {
    JsonWriter json;
    json.begin_object().key("methods").begin_array();
    for (const convex::Method& method : convex::methods())
      json.begin_object()
          .key("name")
          .value(method.name)
          .key("kind")
          .value(name(method.kind))
          .key("summary")
          .value(method.summary)
          .end_object();
    json.end_array().end_object();
    fmt::print("{}\n", json.text());
    return Exit::solved;
  }
  std::size_t width = 0;
  for (const convex::Method& method : convex::methods()) width = std::max(width, method.name.size());
  for (const convex::Method& method : convex::methods())
    fmt::print("{:<{}} {:<14} {}\n", method.name, width, name(method.kind), method.summary);
  return Exit::solved;
}

}  // namespace cli
