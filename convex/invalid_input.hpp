#pragma once

#include <optional>
#include <stdexcept>
#include <string>

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
  const std::optional<Place>& place() const { return place_; }

 private:
  std::optional<Place> place_;
};

}  // namespace convex
