#include <CLI/CLI.hpp>

#include "cli/commands/command_line.hpp"
#include "cli/each_file.hpp"
#include "cli/problem_file/documents.hpp"
#include "cli/problem_file/keys.hpp"
#include "cli/problem_file/settings.hpp"
#include "cli/scene.hpp"

namespace cli::inline commands {
namespace {

/// What `moreau convert` is told.
struct ConvertOptions : Printing, Overrides {
  std::string in, out;
};

Exit convert(const ConvertOptions& options) {
  TomlValue document = read_document(options.in);
  apply_settings(document, parsed_settings(options.settings));
  read_problem(document, directory_of(options.in));  // refuses what is wrong before it is written
  write_matrices_out(document, directory_of(options.in));
  switch (form_of(options.out)) {
    case DocumentForm::json:
      write_file(options.out, json_text(document));
      break;
    case DocumentForm::qps: {
      const TomlValue* title = document.find("title");
      std::string name = title == nullptr ? "moreau" : title->text;
      for (char& c : name)
        if (static_cast<unsigned char>(c) <= 0x20U) c = '_';
      write_file(options.out, qps_text(document, name));
      break;
    }
    case DocumentForm::matrix_market:
      write_matrix_folder(document, options.out);
      break;
    case DocumentForm::toml:
      if (options.out.size() < 5 || options.out.compare(options.out.size() - 5, 5, ".toml") != 0)
        throw convex::InvalidInput("the form of " + shown(options.out) +
                                   " is not known; its name ends with .toml, .json, .qps or .mtx");
      write_file(options.out, toml_text(document));
  }
  return Exit::solved;
}

}  // namespace

void add_convert(CLI::App& program, Work& chosen) {
  const auto options = std::make_shared<ConvertOptions>();
  CLI::App& command =
      add_command(program, "convert", "a problem file in another form: .toml, .json, .qps, or a folder .mtx",
                  chosen, [options] {
                    return answered(*options, {options->in, ""}, [&] { return convert(*options); });
                  });
  command.add_option("IN", options->in, "a problem file")->required();
  command.add_option("OUT", options->out, "what to write; its ending tells the form")->required();
  add_overrides(command, *options);
  add_printing(command, *options);
}

}  // namespace cli::inline commands
