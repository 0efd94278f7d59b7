#include "mechanics/expression/lexer.hpp"

#include <charconv>
#include <cmath>
#include <string>

#include "mechanics/expression/unknown_function.hpp"

namespace mechanics::expression {
namespace {

// The language is ASCII whatever the locale.
bool is_digit(char c) { return c >= '0' && c <= '9'; }
bool begins_name(char c) { return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || c == '_'; }
bool is_space(char c) { return c == ' ' || c == '\t' || c == '\n' || c == '\r'; }

}  // namespace

Token Lexer::next() {
  using enum Token::Kind;
  const std::string_view text = source_->text.text;
  while (at_ < text.size() && is_space(text[at_])) ++at_;
  if (at_ == text.size()) return {end, at_, {}, 0};
  const char c = text[at_], after = at_ + 1 < text.size() ? text[at_ + 1] : '\0';
  if (is_digit(c) || (c == '.' && is_digit(after))) return this->number();
  const std::size_t begin = at_;
  if (begins_name(c)) {
    while (at_ < text.size() && (begins_name(text[at_]) || is_digit(text[at_]))) ++at_;
    return {name, begin, text.substr(begin, at_ - begin), 0};
  }
  const auto token = [&](Token::Kind kind, std::size_t length) {
    at_ += length;
    return Token{kind, begin, text.substr(begin, length), 0};
  };
  switch (c) {
    case '+':
      return token(plus, 1);
    case '-':
      return token(minus, 1);
    case '*':
      if (after == '*') source_->fail(begin, "\"**\" is no operator; write ^ for a power");
      return token(times, 1);
    case '/':
      return token(over, 1);
    case '^':
      return token(power, 1);
    case '\'':
      return token(prime, 1);
    case '(':
      return token(open, 1);
    case ')':
      return token(close, 1);
    case '[':
      return token(open_index, 1);
    case ']':
      return token(close_index, 1);
    case ',':
      return token(comma, 1);
    case '.':
      if (after == '.') return token(range, 2);
      break;
    case '>':
    case '<':
      if (after == '=') return token(c == '>' ? at_least : at_most, 2);
      if (c == '<' && after == '>')
        source_->fail(begin, "\"<>\" is no relation; write " + std::string(instead_of_unequal));
      return token(c == '>' ? more : less, 1);
    case '"': {
      const std::size_t close = text.find('"', begin + 1);
      if (close == std::string_view::npos)
        source_->fail(begin, "the quotation mark has no partner; write table(x, \"F.csv\")");
      at_ = close + 1;
      return {Token::Kind::quotation, begin, text.substr(begin + 1, close - begin - 1), 0};
    }
    case '=':
      if (after == '=') source_->fail(begin, "\"==\" is no relation; write =");
      if (after == '>') source_->fail(begin, "\"=>\" is no relation; write >=");
      if (after == '<') source_->fail(begin, "\"=<\" is no relation; write <=");
      return token(equal, 1);
    case '!':
      if (after == '=')
        source_->fail(begin, "\"!=\" is no relation; write " + std::string(instead_of_unequal));
      break;
    default:
      break;
  }
  const std::string_view character = character_at(text, begin);
  source_->fail(begin, "the character " + quoted(character) + " has no meaning in an expression; write " +
                           instead_of_character(character));
}

Token Lexer::number() {
  const std::string_view text = source_->text.text;
  const std::size_t begin = at_;
  const auto digits = [&] {  // an underscore may stand between two digits, as in TOML
    while (at_ < text.size() &&
           (is_digit(text[at_]) || (text[at_] == '_' && at_ > begin && is_digit(text[at_ - 1]) &&
                                    at_ + 1 < text.size() && is_digit(text[at_ + 1]))))
      ++at_;
  };
  digits();
  const bool is_range = text.substr(at_, 2) == "..";
  if (at_ < text.size() && text[at_] == '.' && !is_range) {
    ++at_;
    digits();
  }
  if (at_ < text.size() && (text[at_] == 'e' || text[at_] == 'E')) {
    std::size_t exponent = at_ + 1;
    if (exponent < text.size() && (text[exponent] == '+' || text[exponent] == '-')) ++exponent;
    const char first = exponent < text.size() ? text[exponent] : '\0';
    if (is_digit(first)) {
      at_ = exponent;
      digits();
    } else if (exponent > at_ + 1 || !begins_name(first)) {
      const std::string mantissa(text.substr(begin, at_ - begin)), letter(1, text[at_]);
      source_->fail(begin, "the number " + quoted(mantissa + letter) + " lacks its exponent; write " +
                               mantissa + "e3, or a product, " + mantissa + "*" + letter);
    }
  }
  Token token{Token::Kind::number, begin, text.substr(begin, at_ - begin), 0};
  std::string plain;
  for (const char c : token.text)
    if (c != '_') plain += c;
  const auto read = std::from_chars(plain.data(), plain.data() + plain.size(), token.number);
  if (read.ec == std::errc::result_out_of_range)
    token.number = std::strtod(plain.c_str(), nullptr);  // 0 or infinite
  if (!std::isfinite(token.number))
    source_->fail(begin, "the number " + quoted(token.text) + " is too large; write one below 1.8e308");
  return token;
}

}  // namespace mechanics::expression
