#include "convex/symbolic/term.hpp"

namespace convex::symbolic {
namespace {

using Kind = Term::Kind;

/// How tightly a term holds together: a sum least.
enum class Bond { sum, product, power };

std::string shown(const Term&, Bond, bool latex);

std::string bracketed(const std::string& inner, bool latex) {
  return latex ? "\\left(" + inner + "\\right)" : "(" + inner + ")";
}

std::string number_shown(const Fraction& value, bool latex) {
  if (!latex || value.denominator == 1) return convex::text(value);
  const bool negative = value.numerator.sign() < 0;
  const Integer top = negative ? -value.numerator : value.numerator;
  return std::string(negative ? "-" : "") + "\\frac{" + top.text() + "}{" + value.denominator.text() + "}";
}

std::string sum_shown(const Term& term, bool latex) {
  std::string text;
  for (const Term& part : term.parts) {
    std::string next = shown(part, Bond::sum, latex);
    if (text.empty())
      text = next;
    else if (next.front() == '-')
      text += " - " + next.substr(1);
    else
      text += " + " + next;
  }
  return text;
}

/// p/q a b is p a b/q.
std::string product_shown(const Term& term, bool latex) {
  std::string top, sign;
  Integer bottom = 1;
  for (const Term& part : term.parts) {
    if (part.kind == Kind::number) {
      Integer p = part.number.numerator;
      if (p.sign() < 0) {
        sign = "-";
        p = -p;
      }
      bottom = part.number.denominator;
      if (!(p == 1)) top = p.text();
      continue;
    }
    top += (top.empty() ? "" : (latex ? " " : "*")) + shown(part, Bond::product, latex);
  }
  if (bottom == 1) return sign + top;
  return latex ? sign + "\\frac{" + top + "}{" + bottom.text() + "}" : sign + top + "/" + bottom.text();
}

std::string power_shown(const Term& term, bool latex) {
  const Fraction& exponent = term.parts[1].number;
  const std::string base = shown(term.parts[0], Bond::power, latex);
  const std::string up = convex::text(exponent);
  if (latex) return base + "^{" + up + "}";
  const bool plain = exponent.denominator == 1 && exponent.numerator.sign() > 0;
  return base + "^" + (plain ? up : "(" + up + ")");
}

std::string function_shown(const Term& term, bool latex) {
  const std::string inner = shown(term.parts[0], Bond::sum, latex);
  if (!latex) return term.name + "(" + inner + ")";
  if (term.name == "exp") return "e^{" + inner + "}";
  if (term.name == "sqrt") return "\\sqrt{" + inner + "}";
  if (term.name == "abs") return "\\left|" + inner + "\\right|";
  if (term.name == "sign") return "\\operatorname{sgn}" + bracketed(inner, true);
  return (term.name == "W" ? std::string("W") : "\\log ") + bracketed(inner, true);
}

std::string root_shown(const Term& term, bool latex) {
  const std::string left = shown(term.parts[0], Bond::sum, latex),
                    right = shown(term.parts[1], Bond::sum, latex);
  const std::string above =
      term.lowest ? (latex ? ",\\ u > " : ", u > ") + number_shown(*term.lowest, latex) : std::string();
  return latex ? "\\{u : " + left + " = " + right + above + "\\}"
               : "(the u with " + left + " = " + right + above + ")";
}

std::string shown(const Term& term, Bond around, bool latex) {
  switch (term.kind) {
    case Kind::number: {
      const std::string text = number_shown(term.number, latex);
      const bool simple = term.number.denominator == 1 && term.number.numerator.sign() >= 0;
      return simple || around == Bond::sum ? text : bracketed(text, latex);
    }
    case Kind::variable:
      return term.name;
    case Kind::sum:
      return around == Bond::sum ? sum_shown(term, latex) : bracketed(sum_shown(term, latex), latex);
    case Kind::product:
      return around == Bond::power ? bracketed(product_shown(term, latex), latex)
                                   : product_shown(term, latex);
    case Kind::power:
      return around == Bond::power ? bracketed(power_shown(term, latex), latex) : power_shown(term, latex);
    case Kind::function:
      return around == Bond::power && latex && term.name == "exp"
                 ? bracketed(function_shown(term, latex), latex)
                 : function_shown(term, latex);
    case Kind::root:
      return root_shown(term, latex);
  }
  return "";
}

}  // namespace

std::string text(const Term& term) { return shown(term, Bond::sum, false); }
std::string latex(const Term& term) { return shown(term, Bond::sum, true); }

}  // namespace convex::symbolic
