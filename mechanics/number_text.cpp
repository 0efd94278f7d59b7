#include "mechanics/number_text.hpp"

#include <array>
#include <charconv>

namespace mechanics {

std::string number_text(double x) {
  std::array<char, 32> buffer{};
  const auto end =
      std::to_chars(buffer.data(), buffer.data() + buffer.size(), x, std::chars_format::general, 6).ptr;
  return std::string(buffer.data(), end);
}

}  // namespace mechanics
