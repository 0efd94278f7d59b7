#include "cli/drawing/method_style.hpp"

#include <algorithm>
#include <array>

namespace cli {

std::size_t MethodStyles::place(const std::string& method) const {
  return static_cast<std::size_t>(std::find(methods_.begin(), methods_.end(), method) - methods_.begin());
}

std::string MethodStyles::colour(const std::string& method) const {
  constexpr std::array colours{"#0072b2", "#d55e00", "#009e73", "#cc79a7",
                               "#e69f00", "#56b4e9", "#5c5c5c", "#b8a900"};
  return colours[place(method) % colours.size()];
}

int MethodStyles::filled(const std::string& method) const {
  constexpr std::array markers{7, 5, 9, 11, 13};
  return markers[(place(method) / 8 + place(method)) % markers.size()];
}

}  // namespace cli
