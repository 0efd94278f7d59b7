#pragma once

#include <map>
#include <utility>

#include "convex/invalid_input.hpp"

namespace convex {

/// What is wrong in parts of a text that can be read without each other, to be told at once.
class Mistakes {
 public:
  /// Does the work, and keeps what it refuses. Whether it refused nothing.
  template <class Work>
  bool gather(const Work& work) {
    try {
      work();
      return true;
    } catch (const InvalidInput& error) {
      add(error);
      return false;
    }
  }
  /// Keeps an error and those told with it; one of a place already found says nothing new.
  void add(const InvalidInput& error);
  bool none() const { return found_.empty(); }
  /// Throws the first in the order of the text, with the others; does nothing when there is none.
  void tell() const;

 private:
  std::map<std::pair<int, int>, InvalidInput> found_;  // by line and column
};

}  // namespace convex
