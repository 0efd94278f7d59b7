#include "cli/manual/manual_page.hpp"

#include <fmt/format.h>

#include "cli/manual/help_topics.hpp"

namespace cli::inline manual {
namespace {

/// Text as roff prints it: hyphens that can be typed again, and no line that is taken for a request.
std::string roff(std::string_view written) {
  std::string text(written), out;
  constexpr std::string_view ellipsis = "…";
  for (std::size_t at; (at = text.find(ellipsis)) != std::string::npos;)
    text.replace(at, ellipsis.size(), "...");
  bool first_in_line = true;
  for (const char c : text) {
    if (first_in_line && (c == '.' || c == '\'')) out += "\\&";
    if (c == '\\')
      out += "\\e";
    else if (c == '-')
      out += "\\-";
    else if (c == '\'')
      out += "\\(aq";
    else if (c == '^')
      out += "\\(ha";
    else if (c == '`')
      out += "\\(ga";
    else if (c == '~')
      out += "\\(ti";
    else
      out += c;
    first_in_line = c == '\n';
  }
  return out;
}

std::string upper_case(std::string text) {
  for (char& c : text) {
    if (c >= 'a' && c <= 'z') c = static_cast<char>(c - 'a' + 'A');
    if (c == '-') c = ' ';
  }
  return text;
}

std::string bold_names(const HelpLine& line) {
  std::string text;
  for (const std::string& name : line.names) text += (text.empty() ? "\\fB" : ", \\fB") + roff(name) + "\\fR";
  return line.value.empty() ? text : text + " \\fI" + roff(line.value) + "\\fR";
}

std::string command_section(const CommandLines& command) {
  std::string text = ".SS moreau " + roff(command.name);
  for (const HelpLine& argument : command.arguments) {
    const std::string name = roff(argument.names.front()) + (argument.repeats ? "..." : "");
    text += argument.required ? " " + name : " [" + name + "]";
  }
  text += "\n" + roff(command.help) + "\n";
  for (const HelpLine& line : command.arguments)
    text += ".TP\n\\fI" + roff(line.names.front()) + "\\fR\n" + roff(line.help) + "\n";
  for (const HelpLine& line : command.options)
    text += ".TP\n" + bold_names(line) + "\n" + roff(line.help) + "\n";
  return text;
}

}  // namespace

std::string manual_page(const CommandTable& table, const std::string& version) {
  std::string text = ".TH MOREAU 1 \"\" \"" + roff(version) + "\" \"User Commands\"\n";
  const std::size_t colon = table.help.find(": ");
  text +=
      ".SH NAME\nmoreau \\- " + roff(table.help.substr(colon == std::string::npos ? 0 : colon + 2)) + "\n";
  text +=
      ".SH SYNOPSIS\n.B moreau\n.I COMMAND\n[\\fIARGUMENT\\fR]...\n.br\n.B moreau help\n[\\fITOPIC\\fR]\n";
  text += ".SH COMMANDS\n";
  for (const CommandLines& command : table.commands) text += command_section(command);
  for (const HelpTopic& topic : help_topics())
    text += ".SH " + roff(upper_case(std::string(topic.name))) + "\n" + roff(topic.summary) +
            ".\n.PP\n.nf\n" + roff(topic.text) + ".fi\n";
  return text +
         ".SH SEE ALSO\nJ. J. Moreau, Quadratic programming in mechanics: dynamics of one\\-sided "
         "constraints, SIAM J. Control 4 (1966), doi:10.1137/0304014.\n";
}

}  // namespace cli::inline manual
