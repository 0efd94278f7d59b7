#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <cmath>

#include "cli/report/document.hpp"
#include "cli/report/greek_letters.hpp"
#include "cli/report/text_table.hpp"

namespace cli::inline reports {
namespace {

struct FunctionLatex {
  const char *name, *latex;
};
constexpr FunctionLatex function_latex[] = {
    {"sin", "\\sin"},     {"cos", "\\cos"},   {"tan", "\\tan"},   {"asin", "\\arcsin"}, {"acos", "\\arccos"},
    {"atan", "\\arctan"}, {"sinh", "\\sinh"}, {"cosh", "\\cosh"}, {"tanh", "\\tanh"},   {"exp", "\\exp"},
    {"log", "\\log"},     {"ln", "\\ln"},     {"min", "\\min"},   {"max", "\\max"},     {"in", "\\in"}};

/// "x" is x, "alpha" \alpha, "front_left" \mathit{front\_left}.
std::string name_latex(const std::string& name) {
  if (name.size() == 1) return name;
  if (is_greek(name)) return "\\" + name;
  for (const FunctionLatex& function : function_latex)
    if (name == function.name) return function.latex;
  std::string text;
  for (const char c : name) text += c == '_' ? std::string("\\_") : std::string(1, c);
  return "\\mathit{" + text + "}";
}

class ExpressionWriter {
 public:
  explicit ExpressionWriter(const std::string& text) : text_(text) {}

  std::string all() { return sequence('\0'); }

 private:
  bool is_name(std::size_t i) const {
    return i < text_.size() && (std::isalnum(static_cast<unsigned char>(text_[i])) != 0 || text_[i] == '_');
  }
  char peek() const { return at_ < text_.size() ? text_[at_] : '\0'; }
  void skip() {
    while (at_ < text_.size() && std::isspace(static_cast<unsigned char>(text_[at_])) != 0) ++at_;
  }

  /// Up to the closing character, which is taken.
  std::string sequence(char close) {
    std::string made;
    for (skip(); at_ < text_.size(); skip()) {
      const char c = text_[at_];
      if (c == close) {
        ++at_;
        return made;
      }
      made += c == '^' ? exponent() : is_name(at_) || c == '.' || c == '(' || c == '[' ? operand() : sign();
    }
    return made;
  }

  std::string sign() {
    const char c = text_[at_++];
    if (c == '*') {
      skip();
      return std::isdigit(static_cast<unsigned char>(peek())) != 0 ? " \\cdot " : " \\, ";
    }
    if ((c == '>' || c == '<') && peek() == '=') {
      ++at_;
      return c == '>' ? " \\ge " : " \\le ";
    }
    if (c == '.' || c == ',') return std::string(1, c);
    if (c == '\'') return "\\dot{}";
    if (c == '{' || c == '}' || c == '#' || c == '%' || c == '&' || c == '$' || c == '_')
      return std::string("\\") + c;
    if (c == '\\' || c == '~' || c == '"' || static_cast<unsigned char>(c) >= 0x80U) return "";
    return " " + std::string(1, c) + " ";
  }

  std::string exponent() {
    ++at_;
    skip();
    const bool negative = peek() == '-';
    if (negative) ++at_;
    skip();
    return "^{" + std::string(negative ? "-" : "") + operand() + "}";
  }

  std::string digits() {
    const std::size_t first = at_;
    while (at_ < text_.size() && (std::isdigit(static_cast<unsigned char>(text_[at_])) != 0 ||
                                  (text_[at_] == '.' && (at_ + 1 >= text_.size() || text_[at_ + 1] != '.'))))
      ++at_;
    std::string made = text_.substr(first, at_ - first);
    if ((peek() == 'e' || peek() == 'E') && at_ + 1 < text_.size() &&
        (std::isdigit(static_cast<unsigned char>(text_[at_ + 1])) != 0 || text_[at_ + 1] == '-' ||
         text_[at_ + 1] == '+')) {
      std::string power;
      for (++at_;
           at_ < text_.size() && (is_name(at_) || text_[at_] == '-' || text_[at_] == '+') && power.size() < 5;
           ++at_)
        if (text_[at_] != '+') power += text_[at_];
      const std::size_t sign = power.starts_with('-') ? 1 : 0;
      while (power.size() > sign + 1 && power[sign] == '0') power.erase(sign, 1);
      made += "\\cdot 10^{" + power + "}";
    }
    if (made.empty()) made = std::string(1, text_[at_++]);
    return made;
  }

  /// A number, a name with its indices, arguments and dots, or parentheses.
  std::string operand() {
    if (peek() == '(') {
      ++at_;
      const std::string inside = sequence(')');
      return derivative("(" + inside + ")");
    }
    if (peek() == '[') {
      ++at_;
      return "[" + sequence(']') + "]";
    }
    if (!is_name(at_) || std::isdigit(static_cast<unsigned char>(peek())) != 0) return digits();
    const std::size_t first = at_;
    while (is_name(at_)) ++at_;
    const std::string name = text_.substr(first, at_ - first);
    if (peek() == '(') return call(name);
    std::string index;
    if (peek() == '[') {
      ++at_;
      index = "_{" + sequence(']') + "}";
    }
    return dots(name_latex(name)) + index;
  }

  std::size_t primes() {
    std::size_t count = 0;
    for (; peek() == '\''; ++at_) ++count;
    return count;
  }

  /// Of parentheses: a dot above them would be lost.
  std::string derivative(const std::string& of) {
    const std::size_t count = primes();
    if (count == 0) return of;
    const std::string power = count > 1 ? "^{" + std::to_string(count) + "}" : "";
    const std::string made = "\\frac{\\mathrm{d}" + power + "}{\\mathrm{d}t" + power + "}" + of;
    skip();
    return peek() == '^' ? "\\Bigl(" + made + "\\Bigr)" : made;
  }

  std::string dots(const std::string& of) {
    const std::size_t count = primes();
    if (count == 0) return of;
    return std::string(count > 1 ? "\\ddot{" : "\\dot{") + of + "}";
  }

  std::string call(const std::string& name) {
    ++at_;
    if (name == "sum") {
      const std::size_t comma = text_.find(',', at_), in = text_.find(" in ", at_),
                        range = text_.find("..", at_);
      if (in < range && range < comma && comma != std::string::npos) {
        const std::string index = text_.substr(at_, in - at_),
                          low = expression_latex(text_.substr(in + 4, range - in - 4)),
                          high = expression_latex(text_.substr(range + 2, comma - range - 2));
        at_ = comma + 1;
        return "\\sum_{" + expression_latex(index) + "=" + low + "}^{" + high + "} \\bigl(" + sequence(')') +
               "\\bigr)";
      }
    }
    if (name == "dot" || name == "cross") {
      const std::string u = factor(sequence(',')), v = factor(sequence(')'));
      return "(" + u + (name == "dot" ? " \\cdot " : " \\times ") + v + ")";
    }
    const std::string inside = sequence(')');
    if (name == "norm") return "\\lVert " + inside + "\\rVert ";
    if (name == "sqrt") return "\\sqrt{" + inside + "}";
    if (name == "abs") return "\\lvert " + inside + "\\rvert ";
    std::string called = "\\operatorname{" + name + "}";
    for (const FunctionLatex& function : function_latex)
      if (name == function.name) called = function.latex;
    called.erase(std::remove(called.begin(), called.end(), '_'), called.end());
    return called + "(" + inside + ")";
  }

  /// Within parentheses where it is a sum.
  static std::string factor(const std::string& term) {
    const bool is_sum = term.find(" + ") != std::string::npos || term.find(" - ") != std::string::npos;
    return is_sum ? "(" + term + ")" : term;
  }

  const std::string& text_;
  std::size_t at_ = 0;
};

}  // namespace

std::string expression_latex(const std::string& expression) { return ExpressionWriter(expression).all(); }

Math number_math(double x) {
  const std::string plain = number_text(x);
  if (!std::isfinite(x)) return {plain, std::isnan(x) ? "\\text{nan}" : x > 0 ? "\\infty" : "-\\infty"};
  const std::size_t e = plain.find('e');
  if (e == std::string::npos) return {plain, plain};
  return {plain, fmt::format("{}\\cdot 10^{{{}}}", plain.substr(0, e), std::stoi(plain.substr(e + 1)))};
}

}  // namespace cli::inline reports
