#include <doctest/doctest.h>

#include <filesystem>
#include <fstream>

#include "tests/cli/program.hpp"
#include "tests/this_build.hpp"

using namespace tests;

namespace {

/// A row of mistakes.txt: a command line, what is changed in the file of a point on a floor, the message.
struct Mistake {
  std::vector<std::string> arguments;
  std::string file, message;
};

/// The words of a command line, in quotation marks where they hold spaces.
std::vector<std::string> words_of(const std::string& line) {
  std::vector<std::string> words(1);
  bool quoted = false;
  for (const char c : line) {
    if (c == '"')
      quoted = !quoted;
    else if (c == ' ' && !quoted)
      words.emplace_back();
    else
      words.back() += c;
  }
  return words;
}

std::string with_line_breaks(const std::string& text) {
  std::string made;
  for (std::size_t k = 0; k < text.size(); ++k) {
    const bool is_break = text.compare(k, 2, "\\n") == 0;
    made += is_break ? '\n' : text[k];
    if (is_break) ++k;
  }
  return made;
}

/// "6 m = 2.0 kg": the file with this as its line 6; "= text": the text.
std::string file_of(const std::string& change) {
  if (change.empty()) return point_on_floor();
  if (change[0] == '=') return with_line_breaks(change.substr(std::min<std::size_t>(2, change.size())));
  const std::size_t space = std::min(change.find(' '), change.size());
  return point_on_floor(
      {{std::stoi(change), with_line_breaks(change.substr(std::min(space + 1, change.size())))}});
}

std::vector<Mistake> mistakes() {
  std::ifstream table(tests::source_folder() + "tests/cli/mistakes.txt");
  std::vector<Mistake> rows;
  std::string change;
  for (std::string line; std::getline(table, line);) {
    if (line.empty() || line[0] == '#') continue;
    if (line[0] != ' ')
      rows.push_back({words_of(line), point_on_floor(), ""});
    else if (line.rfind("  -> ", 0) == 0)
      rows.back().message = line.substr(5);
    else
      rows.back().file = file_of(line.substr(2));
  }
  return rows;
}

}  // namespace

TEST_CASE(
    "each mistake of the table is answered with where it is, what is wrong and what to do, in one line") {
  const std::vector<Mistake> rows = mistakes();
  CHECK(rows.size() > 250);
  const Folder folder;
  const std::filesystem::path before = std::filesystem::current_path();
  std::filesystem::current_path(folder.path(""));
  for (const Mistake& mistake : rows) {
    folder.write("a.toml", mistake.file);
    const Outcome outcome = run(mistake.arguments);
    CAPTURE(mistake.arguments.front());
    CAPTURE(mistake.message);
    CAPTURE(outcome.err);
    CHECK(outcome.code == 2);
    CHECK(outcome.out.empty());
    const std::string line = outcome.err.substr(0, outcome.err.find('\n'));
    CHECK(line == "moreau: " + mistake.message);
    CHECK(line.find("; ") != std::string::npos);  // what to do
    constexpr std::size_t longest = 300;          // a line that is read
    CHECK(line.size() < longest);
  }
  std::filesystem::current_path(before);
}
