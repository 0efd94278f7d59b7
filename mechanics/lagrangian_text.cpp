#include "mechanics/lagrangian_text.hpp"

#include <algorithm>

namespace mechanics {

convex::Place Text::at(std::size_t offset) const {
  convex::Place place = begin;
  for (std::size_t i = 0; i < std::min(offset, text.size()); ++i) {
    const bool continues_a_character = (static_cast<unsigned char>(text[i]) & 0xC0U) == 0x80U;
    if (text[i] == '\n') {
      ++place.line;
      place.column = 1;
    } else if (!continues_a_character) {
      ++place.column;
    }
  }
  return place;
}

}  // namespace mechanics
