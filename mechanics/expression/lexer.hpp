#pragma once

#include <cstdint>
#include <string_view>

#include "mechanics/expression/source.hpp"

namespace mechanics::expression {

struct Token {
  enum class Kind : std::uint8_t {
    number,
    name,
    plus,
    minus,
    times,
    over,
    power,
    prime,
    open,
    close,
    open_index,
    close_index,
    comma,
    range,
    at_least,
    at_most,
    equal,
    more,
    less,
    quotation,  ///< in quotation marks, which do not belong to `text`
    end,
  };
  Kind kind = Kind::end;
  std::size_t offset = 0;
  std::string_view text;  ///< into the source
  double number = 0;      ///< of a number
};

/// Cuts a text into tokens, one at a time. A character that begins no token is InvalidInput.
class Lexer {
 public:
  explicit Lexer(const Source& source) : source_(&source) {}
  Token next();

 private:
  Token number();
  const Source* source_;
  std::size_t at_ = 0;
};

}  // namespace mechanics::expression
