#pragma once

#include <source_location>

// Included before every source of the fuzzer: clang 14 has not all of what libstdc++ 12 needs for its own.
#ifndef __cpp_lib_source_location
namespace std {

class source_location {
 public:
  static constexpr source_location current(const char* file = __builtin_FILE(),
                                           unsigned line = __builtin_LINE()) {
    source_location made;
    made.file_ = file;
    made.line_ = line;
    return made;
  }
  constexpr const char* file_name() const { return file_; }
  constexpr unsigned line() const { return line_; }

 private:
  const char* file_ = "";
  unsigned line_ = 0;
};

}  // namespace std
#endif
