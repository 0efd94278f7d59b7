#include <CLI/CLI.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <cstdio>

#include "cli/commands/command_line.hpp"
#include "cli/json_writer.hpp"
#include "convex/nearest_point/methods.hpp"

namespace cli::inline commands {

namespace {

Exit list_methods(const Printing& options) {
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

}  // namespace

void add_methods(CLI::App& program, Work& chosen) {
  const auto options = std::make_shared<Printing>();
  CLI::App& command = add_command(program, "methods", "the methods of solution that a file can name", chosen,
                                  [options] { return list_methods(*options); });
  add_printing(command, *options);
}

}  // namespace cli::inline commands
