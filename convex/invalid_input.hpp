#pragma once

#include <optional>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

namespace convex {

/// A place in the text that the input came from; lines and columns count from 1.
struct Place {
  int line = 1;
  int column = 1;
};

/// The input is wrong. The message reads "where: what is wrong; what to do".
/// The place is known when the input was text.
class InvalidInput : public std::runtime_error {
 public:
  explicit InvalidInput(const std::string& message, std::optional<Place> where = std::nullopt)
      : std::runtime_error(message), place_(where) {}
  InvalidInput(InvalidInput first, std::vector<InvalidInput> others) : InvalidInput(std::move(first)) {
    others_ = std::move(others);
  }
  const std::optional<Place>& place() const { return place_; }
  /// What else is wrong in the same text, in its order (convex/mistakes.hpp).
  const std::vector<InvalidInput>& others() const { return others_; }

 private:
  std::optional<Place> place_;
  std::vector<InvalidInput> others_;
};

}  // namespace convex
