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

constexpr std::size_t most_told = 20;  // a screen of them

void report(const Printing& printing, const Source& source, const convex::InvalidInput& error) {
  std::vector<const convex::InvalidInput*> told{&error};
  for (const convex::InvalidInput& other : error.others())
    if (told.size() < most_told) told.push_back(&other);
  const auto place_of = [](const convex::InvalidInput& one) { return one.place().value_or(convex::Place{}); };
  if (printing.json) {
    JsonWriter json;
    const auto add = [&](const convex::InvalidInput& one) {
      json.key("message").value(one_line(one.what()));
      json.key("line").value(place_of(one).line).key("column").value(place_of(one).column);
    };
    json.begin_object().key("file").value(source.name).key("status").value("error");
    add(error);
    if (told.size() > 1) {
      json.key("errors").begin_array();
      for (const convex::InvalidInput* one : told) {
        json.begin_object();
        add(*one);
        json.end_object();
      }
      json.end_array();
    }
    fmt::print("{}\n", json.end_object().text());
  }
  std::fflush(stdout);
  for (const convex::InvalidInput* one : told) {
    const convex::Place place = place_of(*one);
    fmt::print(stderr, "moreau: {}:{}:{}: {}\n{}", source.name, place.line, place.column,
               one_line(one->what()), with_caret(source.text, place));
  }
  if (const std::size_t more = error.others().size() + 1 - told.size(); more > 0)
    fmt::print(stderr, "moreau: {}: and {} more; correct these first\n", source.name, more);
}

}  // namespace

Exit answered(const Printing& printing, const Source& source, const std::function<Exit()>& work) {
  try {
    return work();
  } catch (const convex::InvalidInput& error) {
    report(printing, source, error);
  } catch (const std::filesystem::filesystem_error& error) {
    report(printing, source,
           convex::InvalidInput("cannot write " + error.path1().string() + ", " + error.code().message() +
                                "; check its folder and permissions"));
  } catch (const std::bad_alloc&) {
    report(printing, source,
           convex::InvalidInput("needs more memory than there is; make the problem smaller"));
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
