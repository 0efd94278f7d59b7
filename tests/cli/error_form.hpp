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

}  // namespace tests
