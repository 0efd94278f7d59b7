#pragma once

#include <string>
#include <vector>

namespace cli {

/// One colour and one marker for each method, the same on every picture: Okabe and Ito's palette (2008),
/// which the colour-blind can tell apart, and another marker for each eight.
class MethodStyles {
 public:
  explicit MethodStyles(std::vector<std::string> methods) : methods_(std::move(methods)) {}
  const std::vector<std::string>& methods() const { return methods_; }
  std::string colour(const std::string& method) const;
  /// gnuplot's number of the filled marker, and of the same one hollow.
  int filled(const std::string& method) const;
  int hollow(const std::string& method) const { return filled(method) - 1; }

 private:
  std::size_t place(const std::string& method) const;
  std::vector<std::string> methods_;
};

}  // namespace cli
