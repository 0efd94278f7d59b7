#include "cli/manual/shell_completions.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

namespace cli::inline manual {
namespace {

std::string words(const std::vector<std::string>& list) { return fmt::format("{}", fmt::join(list, " ")); }

/// Every name of every option.
std::string option_names(const CommandLines& command) {
  std::vector<std::string> names;
  for (const HelpLine& option : command.options)
    names.insert(names.end(), option.names.begin(), option.names.end());
  return words(names);
}

/// The text with a backslash before each of `special`.
std::string escaped(const std::string& text, const std::string& special) {
  std::string out;
  for (const char c : text) {
    if (special.find(c) != std::string::npos) out += '\\';
    out += c;
  }
  return out;
}

/// The text between single quotation marks, for bash and zsh.
std::string quoted(const std::string& text) {
  std::string out = "'";
  for (const char c : text) out += c == '\'' ? "'\\''" : std::string(1, c);
  return out + "'";
}

/// The same for fish, where a backslash stands before a quotation mark within them.
std::string quoted_for_fish(const std::string& text) { return "'" + escaped(text, "'\\") + "'"; }

bool takes_files(const HelpLine& line) {
  const std::string& what = line.value.empty() ? line.names.front() : line.value;
  return what == "FILE" || what == "IN" || what == "OUT" || what == "DIR" || what == "F" ||
         what.find('.') != std::string::npos;
}

/// What zsh offers for an argument: words, files, or nothing but its name.
std::string zsh_action(const HelpLine& line, const std::string& name) {
  if (!line.choices.empty()) return ":" + name + ":(" + words(line.choices) + ")";
  return ":" + name + ":" + (takes_files(line) ? "_files" : "");
}

std::string zsh_option(const HelpLine& option) {
  std::string lines;
  const std::string action =
      option.value.empty() ? "" : zsh_action(option, fmt::format("{}", fmt::join(option.names, "")));
  for (const std::string& name : option.names)
    lines += "        " +
             quoted((option.repeats ? "*" : "") + name + "[" + escaped(option.help, "[]:\\") + "]" + action) +
             " \\\n";
  return lines;
}

}  // namespace

std::string bash_completions(const CommandTable& table) {
  std::string names, values, options, arguments;
  for (const CommandLines& command : table.commands) {
    names += command.name + " ";
    options += fmt::format("    {}) words=\"{}\" ;;\n", command.name, option_names(command));
    for (const HelpLine& option : command.options) {
      if (option.value.empty()) continue;
      std::string pattern;
      for (const std::string& name : option.names)
        pattern += (pattern.empty() ? "" : "|") + command.name + ":" + name;
      const std::string offer =
          !option.choices.empty()
              ? fmt::format("COMPREPLY=($(compgen -W \"{}\" -- \"$word\"))", words(option.choices))
          : takes_files(option) ? "compopt -o filenames; COMPREPLY=($(compgen -f -- \"$word\"))"
                                : ":";
      values += fmt::format("    {}) {}; return ;;\n", pattern, offer);
    }
    for (const HelpLine& argument : command.arguments)
      if (!argument.choices.empty())
        arguments += fmt::format("    {}) words=\"{}\" ;;\n", command.name, words(argument.choices));
  }
  return "# Completion of moreau for bash; `moreau completions bash` wrote it.\n"
         "_moreau() {\n"
         "  local word=${COMP_WORDS[COMP_CWORD]} before=${COMP_WORDS[COMP_CWORD-1]} words=\n"
         "  COMPREPLY=()\n"
         "  if [ \"$COMP_CWORD\" -eq 1 ]; then\n"
         "    COMPREPLY=($(compgen -W \"" +
         names +
         "--help --version\" -- \"$word\"))\n"
         "    return\n"
         "  fi\n"
         "  case ${COMP_WORDS[1]}:$before in\n" +
         values +
         "  esac\n"
         "  if [[ $word == -* ]]; then\n"
         "    case ${COMP_WORDS[1]} in\n" +
         options +
         "    esac\n"
         "    COMPREPLY=($(compgen -W \"$words\" -- \"$word\"))\n"
         "    return\n"
         "  fi\n"
         "  case ${COMP_WORDS[1]} in\n" +
         arguments +
         "    *)\n"
         "      compopt -o filenames\n"
         "      COMPREPLY=($(compgen -f -- \"$word\"))\n"
         "      return ;;\n"
         "  esac\n"
         "  COMPREPLY=($(compgen -W \"$words\" -- \"$word\"))\n"
         "}\n"
         "complete -F _moreau moreau\n";
}

std::string zsh_completions(const CommandTable& table) {
  std::string text =
      "#compdef moreau\n"
      "# Completion of moreau for zsh; `moreau completions zsh` wrote it.\n"
      "_moreau() {\n"
      "  local -a commands\n"
      "  commands=(\n";
  for (const CommandLines& command : table.commands)
    text += "    " + quoted(command.name + ":" + escaped(command.help, ":\\")) + "\n";
  text +=
      "  )\n"
      "  if (( CURRENT == 2 )); then\n"
      "    _describe command commands\n"
      "    return\n"
      "  fi\n"
      "  shift words\n"
      "  (( CURRENT-- ))\n"
      "  case $words[1] in\n";
  for (const CommandLines& command : table.commands) {
    text += "    " + command.name + ")\n      _arguments \\\n";
    for (const HelpLine& option : command.options) text += zsh_option(option);
    for (const HelpLine& argument : command.arguments)
      text += "        " +
              quoted((argument.repeats ? "*" : "") + zsh_action(argument, argument.names.front())) + " \\\n";
    text += "        && return ;;\n";
  }
  return text +
         "  esac\n"
         "}\n"
         "_moreau \"$@\"\n";
}

std::string fish_completions(const CommandTable& table) {
  std::string text = "# Completion of moreau for fish; `moreau completions fish` wrote it.\n";
  for (const CommandLines& command : table.commands) {
    text += fmt::format("complete -c moreau -f -n __fish_use_subcommand -a {} -d {}\n", command.name,
                        quoted_for_fish(command.help));
    const std::string here = "complete -c moreau -n '__fish_seen_subcommand_from " + command.name + "'";
    for (const HelpLine& option : command.options) {
      std::string names;
      for (const std::string& name : option.names)
        names += name.rfind("--", 0) == 0 ? " -l " + name.substr(2) : " -s " + name.substr(1);
      const std::string takes = option.value.empty()      ? ""
                                : !option.choices.empty() ? " -x -a '" + words(option.choices) + "'"
                                : takes_files(option)     ? " -r -F"
                                                          : " -x";
      text += here + names + takes + " -d " + quoted_for_fish(option.help) + "\n";
    }
    for (const HelpLine& argument : command.arguments)
      if (!argument.choices.empty()) text += here + " -f -a '" + words(argument.choices) + "'\n";
  }
  return text;
}

}  // namespace cli::inline manual
