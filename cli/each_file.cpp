#include "cli/each_file.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cstdio>
#include <filesystem>
#include <new>

#include "cli/json_writer.hpp"
#include "convex/invalid_input.hpp"

namespace cli {
namespace {

/// One line without control characters, whatever the file made the message quote.
std::string one_line(std::string message) {
  for (char& c : message)
    if (static_cast<unsigned char>(c) < 0x20U || c == 0x7F) c = ' ';
  return message;
}

/// The text with a caret under a column, for a text short enough to be seen at once.
std::string with_caret(const std::string& text, convex::Place place) {
  constexpr std::size_t longest = 100;
  if (text.empty() || text.size() > longest || one_line(text) != text || place.line != 1) return "";
  return "  " + text + "\n  " + std::string(static_cast<std::size_t>(place.column - 1), ' ') + "^\n";
}

void report(const Printing& printing, const Source& source, const std::string& text, convex::Place place) {
  const std::string message = one_line(text);
  if (printing.json) {
    JsonWriter json;
    json.begin_object().key("file").value(source.name).key("status").value("error");
    json.key("message").value(message).key("line").value(place.line).key("column").value(place.column);
    fmt::print("{}\n", json.end_object().text());
  }
  std::fflush(stdout);
  fmt::print(stderr, "moreau: {}:{}:{}: {}\n{}", source.name, place.line, place.column, message,
             with_caret(source.text, place));
}

}  // namespace

Exit answered(const Printing& printing, const Source& source, const std::function<Exit()>& work) {
  try {
    return work();
  } catch (const convex::InvalidInput& error) {
    report(printing, source, error.what(), error.place().value_or(convex::Place{}));
  } catch (const std::filesystem::filesystem_error& error) {
    report(printing, source,
           "cannot write " + error.path1().string() + ", " + error.code().message() +
               "; check its folder and permissions",
           {});
  } catch (const std::bad_alloc&) {
    report(printing, source, "needs more memory than there is; make the problem smaller", {});
  }
  return Exit::wrong_input;
}

Exit for_each_file(const FileOptions& options, const std::function<Exit(const std::string&)>& work) {
  Exit worst = Exit::solved;
  for (const std::string& file : options.files)
    worst = std::max(worst, answered(options, {file, ""}, [&] { return work(file); }));
  return worst;
}

Exit print_for_each_file(const FileOptions& options, const std::function<Answer(const std::string&)>& work) {
  bool first = true;
  return for_each_file(options, [&](const std::string& file) {
    const Answer answer = work(file);
    if (options.json || !options.quiet) fmt::print("{}{}", first || options.json ? "" : "\n", answer.text);
    first = false;
    std::fflush(stdout);
    for (const std::string& warning : answer.warnings)
      fmt::print(stderr, "moreau: warning: {}: {}\n", file, one_line(warning));
    return answer.exit;
  });
}

}  // namespace cli
