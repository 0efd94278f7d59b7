#pragma once

#include <doctest/doctest.h>

#include <string>
#include <vector>

#include "tests/cli/program.hpp"

namespace tests {

/// A wrong file, the place "line:column" that its error must name, and words that must be in the message.
struct Wrong {
  std::string text;
  std::string place;
  std::vector<std::string> words;
};

/// Checks that `solve` refuses the file: exit 2, nothing on standard output, and one line
/// `moreau: FILE:LINE:COLUMN: what is wrong; what to do` on standard error.
inline void expect_refusal(const Wrong& wrong) {
  const Folder folder;
  const std::string file = folder.write("problem.toml", wrong.text);
  const Outcome outcome = run({"solve", file});
  CAPTURE(wrong.text.substr(0, 2000));
  CAPTURE(outcome.err);
  CHECK(outcome.code == 2);
  CHECK(outcome.out.empty());
  CHECK(outcome.err.starts_with("moreau: " + file + ":" + wrong.place + ": "));
  CHECK(outcome.err.find('\n') == outcome.err.size() - 1);
  CHECK(outcome.err.find("; ") != std::string::npos);
  for (const std::string& word : wrong.words) {
    CAPTURE(word);
    CHECK(outcome.err.find(word) != std::string::npos);
  }
}

/// The lines on standard error behind "moreau: FILE:", of a file that is refused.
inline std::vector<std::string> told(const std::string& text) {
  const Folder folder;
  const std::string file = folder.write(text.starts_with("{") ? "a.json" : "a.toml", text);
  const Outcome outcome = run({"solve", file});
  CAPTURE(outcome.err);
  CHECK(outcome.code == 2);
  CHECK(outcome.out.empty());
  std::vector<std::string> lines;
  const std::string before = "moreau: " + file + ":";
  for (std::size_t at = 0; at < outcome.err.size();) {
    const std::size_t end = outcome.err.find('\n', at);
    const std::string line = outcome.err.substr(at, end - at);
    CHECK(line.starts_with(before));
    CHECK(line.find("; ") != std::string::npos);
    lines.push_back(line.substr(before.size()));
    at = end + 1;
  }
  return lines;
}

/// Checks that these are the lines, by their beginnings behind "moreau: FILE:".
inline void check_told(const std::string& text, const std::vector<std::string>& beginnings) {
  const std::vector<std::string> lines = told(text);
  CAPTURE(text);
  REQUIRE(lines.size() == beginnings.size());
  for (std::size_t k = 0; k < lines.size(); ++k) {
    CAPTURE(lines[k]);
    CAPTURE(beginnings[k]);
    CHECK(lines[k].starts_with(beginnings[k]));
  }
}

}  // namespace tests
