#include "cli/each_file.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cstdio>
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

void report(const Options& options, const std::string& file, const std::string& text, convex::Place place) {
  const std::string message = one_line(text);
  if (options.json) {
    JsonWriter json;
    json.begin_object().key("file").value(file).key("status").value("error").key("message").value(message);
    json.key("line").value(place.line).key("column").value(place.column).end_object();
    fmt::print("{}\n", json.text());
  }
  std::fflush(stdout);
  fmt::print(stderr, "moreau: {}:{}:{}: {}\n", file, place.line, place.column, message);
}

}  // namespace

Exit for_each_file(const Options& options, const std::function<Exit(const std::string&)>& work) {
  Exit worst = Exit::solved;
  for (const std::string& file : options.files) {
    Exit result = Exit::wrong_input;
    try {
      result = work(file);
    } catch (const convex::InvalidInput& error) {
      report(options, file, error.what(), error.place().value_or(convex::Place{}));
    } catch (const std::bad_alloc&) {
      report(options, file, "needs more memory than there is; make the problem smaller", {});
    }
    worst = std::max(worst, result);
  }
  return worst;
}

}  // namespace cli
