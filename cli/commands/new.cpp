#include <CLI/CLI.hpp>

#include <fmt/format.h>

#include <cerrno>
#include <cstring>
#include <memory>

#include "cli/commands/command_line.hpp"
#include "cli/each_file.hpp"
#include "cli/manual/starting_files.hpp"
#include "convex/invalid_input.hpp"
#include "convex/nearest_name.hpp"

namespace cli::inline commands {
namespace {

/// What `moreau new` is told.
struct NewOptions : Printing {
  std::optional<std::string> kind, file;
};

const StartingFile& starting_file(const std::string& kind) {
  std::vector<std::string> kinds;
  for (const StartingFile& file : starting_files()) {
    if (file.name == kind) return file;
    kinds.emplace_back(file.name);
  }
  throw convex::InvalidInput("there is no starting file \"" + kind + "\"; " +
                             convex::suggestion(kind, kinds));
}

/// Writes a file that is not there yet; one that is there is never touched.
void write_new_file(const std::string& path, std::string_view text) {
  const auto close = [](std::FILE* file) { std::fclose(file); };
  const std::unique_ptr<std::FILE, decltype(close)> file(std::fopen(path.c_str(), "wx"), close);
  if (file == nullptr)
    throw convex::InvalidInput(errno == EEXIST
                                   ? "it is there already; give another name, `moreau new` overwrites nothing"
                                   : std::string("cannot be written: ") + std::strerror(errno) +
                                         "; give a name in a folder that can be written to");
  if (std::fwrite(text.data(), 1, text.size(), file.get()) != text.size() || std::fflush(file.get()) != 0)
    throw convex::InvalidInput("cannot be written whole; make room for it");
}

Exit write_starting_file(const NewOptions& options) {
  if (!options.kind) {
    for (const StartingFile& file : starting_files()) fmt::print("{:<13} {}\n", file.name, file.summary);
    return Exit::solved;
  }
  Source source{"KIND", *options.kind};
  return answered(options, source, [&] {
    const StartingFile& file = starting_file(*options.kind);
    const std::string path = options.file.value_or(*options.kind + ".toml");
    source = {path, ""};
    if (path == "-") {
      fmt::print("{}", file.text);
      return Exit::solved;
    }
    if (!path.ends_with(".toml"))
      throw convex::InvalidInput(
          "a starting file is TOML, with its comments; name it .toml, and `moreau convert` writes other "
          "forms");
    write_new_file(path, file.text);
    const bool moves = file.text.find("\n[simulate]") != std::string_view::npos;
    if (!options.quiet)
      fmt::print("{} is written; next: moreau {} {}\n", path, moves ? "simulate" : "solve", path);
    return Exit::solved;
  });
}

}  // namespace

void add_new(CLI::App& program, Work& chosen) {
  const auto options = std::make_shared<NewOptions>();
  CLI::App& command = add_command(program, "new", "writes a problem file to begin with", chosen,
                                  [options] { return write_starting_file(*options); });
  command.add_option("KIND", options->kind, "what it is to hold; without it, the kinds are listed");
  command.add_option("FILE", options->file, "the file, default KIND.toml; - is standard output");
  command.add_flag("--quiet", options->quiet, "no text; the exit code tells");
}

}  // namespace cli::inline commands
