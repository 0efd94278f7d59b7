#pragma once

#include <functional>
#include <string>

#include "cli/options.hpp"
#include "cli/report/answer.hpp"

namespace cli {

/// Where an input came from, for messages: a file, or an argument of the command line with its text.
struct Source {
  std::string name;
  std::string text;  ///< of an argument; "" of a file
};

/// Does the work and returns its exit code. This is the one place where InvalidInput becomes a message:
/// `moreau: NAME:LINE:COLUMN: what is wrong; what to do` on standard error, with a caret under the place in
/// an argument, and a JSON object under --json. `source` may be changed by the work as it goes on reading.
Exit answered(const Printing& options, const Source& source, const std::function<Exit()>& work);

/// Does `work` for every file, each answered, and returns the largest exit code.
Exit for_each_file(const FileOptions& options, const std::function<Exit(const std::string& file)>& work);

/// The same for work that returns what is to be printed: texts are set apart by an empty line, objects are a
/// line each; --quiet keeps texts back. Warnings follow on standard error, `moreau: warning: FILE: …`.
Exit print_for_each_file(const FileOptions& options,
                         const std::function<Answer(const std::string& file)>& work);

}  // namespace cli
