#include "mechanics/lagrangian_text.hpp"

#include <algorithm>

namespace mechanics {

convex::Place Text::at(std::size_t offset) const {
  convex::Place place = begin;
  std::size_t known = 0;
  for (const TextOrigin::Jump& jump : begin.jumps)
    if (jump.offset <= offset) {
      place = jump.place;
      known = jump.offset;
    }
  for (std::size_t i = known; i < std::min(offset, text.size()); ++i) {
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
