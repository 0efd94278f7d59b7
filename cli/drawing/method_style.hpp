#pragma once

#include <string>
#include <vector>

#include "cli/measurement/trial.hpp"

namespace cli::inline drawings {

/// An error up to here is a right answer to an engineer; the quickest such method is named above a diagram.
inline constexpr double good_error = 1e-9;

/// How a method is drawn, the same on every picture. Iterations have a colour each, which the colour-blind
/// can tell apart (Okabe and Ito 2008; two of Tol's, 2021), and a dash pattern; direct methods are darker and
/// differ by colour and by the shape of their marker; the default stands out.
struct MethodStyle {
  std::string colour;
  int marker = 7;  ///< gnuplot's number of a filled one; the one before it is the same hollow
  int dashes = 1;
  double size = 0.7;

  int hollow() const { return marker - 1; }
  /// The colour, dark enough for small letters.
  std::string text_colour() const;
};

/// The methods of a picture in their order.
class MethodStyles {
 public:
  explicit MethodStyles(const std::vector<Trial>&);
  const std::vector<std::string>& methods() const { return methods_; }
  const MethodStyle& style(const std::string& method) const;

 private:
  std::vector<std::string> methods_;
  std::vector<MethodStyle> styles_;
};

/// Values in the order in which they first occur.
template <class T, class Range, class Get>
std::vector<T> in_order(const Range& range, Get get) {
  std::vector<T> all;
  for (const auto& item : range) {
    const T value = get(item);
    bool known = false;
    for (const T& before : all) known = known || before == value;
    if (!known) all.push_back(value);
  }
  return all;
}

}  // namespace cli::inline drawings
