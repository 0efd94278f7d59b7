#include "mechanics/expression/symbolic_form.hpp"

#include "mechanics/expression/exact_root.hpp"

namespace mechanics::expression {
namespace {

const Fraction zero{}, one{1, 1};

bool is_zero(const Fraction& x) { return convex::sign(x) == 0; }

/// All of it, however long.
std::string name_of(const SymbolicForm& form) {
  std::string text = convex::text(form.constant);
  for (const auto& [name, coefficient] : form.atoms) text += "+" + convex::text(coefficient) + "*" + name;
  return text;
}

/// The form is `coefficient` times one atom.
bool is_single(const SymbolicForm& form) { return is_zero(form.constant) && form.atoms.size() == 1; }

int leading_sign(const SymbolicForm& form) {
  return form.atoms.empty() ? convex::sign(form.constant) : convex::sign(form.atoms.begin()->second);
}

/// sin(pi r) when it is a fraction; 0 <= r < 2.
std::optional<Fraction> sine_of_turn(const Fraction& r) {
  const Fraction sixths = convex::lowest_terms(r * Fraction{6, 1});
  if (!(sixths.denominator == 1)) return std::nullopt;
  switch (sixths.numerator.word()) {
    case 0:
    case 6:
      return zero;
    case 1:
    case 5:
      return Fraction{1, 2};
    case 3:
      return one;
    case 7:
    case 11:
      return Fraction{-1, 2};
    case 9:
      return -one;
    default:
      return std::nullopt;
  }
}

/// r modulo 2; none for angles of very many turns.
std::optional<Fraction> within_one_turn(const Fraction& r) {
  const convex::Integer turns = convex::truncated_quotient(r.numerator, r.denominator * 2);
  const Fraction rest = r - Fraction{turns * 2, 1};
  return convex::sign(rest) < 0 ? rest + Fraction{2, 1} : rest;
}

std::optional<Fraction> at_multiple_of_pi(const std::string& name, const Fraction& r) {
  const auto angle = within_one_turn(r), quarter_on = within_one_turn(r + Fraction{1, 2});
  if (name == "sin") return sine_of_turn(*angle);
  if (name == "cos") return sine_of_turn(*quarter_on);
  if (name != "tan") return std::nullopt;
  const Fraction quarters = convex::lowest_terms(*angle * Fraction{4, 1});
  if (!(quarters.denominator == 1)) return std::nullopt;
  const std::int64_t k = quarters.numerator.word() % 4;
  if (k == 2) return std::nullopt;
  return Fraction{k == 3 ? -1 : k, 1};
}

/// x of f(x), when it is a fraction.
std::optional<Fraction> inner_fraction(const std::string& atom) {
  const std::size_t open = atom.find('(');
  return convex::read_fraction(atom.substr(open + 1, atom.size() - open - 2));
}

/// sin or cos of asin(x) or acos(x), x a fraction.
std::optional<Fraction> of_inverse(const std::string& name, const std::string& angle) {
  const bool is_asin = angle.rfind("asin(", 0) == 0, is_acos = angle.rfind("acos(", 0) == 0;
  if ((name != "sin" && name != "cos") || (!is_asin && !is_acos)) return std::nullopt;
  const auto x = inner_fraction(angle);
  if (!x) return std::nullopt;
  if ((name == "sin") == is_asin) return x;
  return exact_root(one - *x * *x);
}

}  // namespace

SymbolicForm sum(const SymbolicForm& a, const SymbolicForm& b) {
  SymbolicForm result = a;
  result.constant = a.constant + b.constant;
  for (const auto& [name, coefficient] : b.atoms) {
    Fraction& entry = result.atoms[name];
    entry = entry + coefficient;
    if (is_zero(entry)) result.atoms.erase(name);
  }
  return result;
}

SymbolicForm scaled(const SymbolicForm& a, const Fraction& factor) {
  SymbolicForm result;
  if (is_zero(factor)) return result;
  result.constant = a.constant * factor;
  for (const auto& [name, coefficient] : a.atoms) result.atoms[name] = coefficient * factor;
  return result;
}

bool operator==(const SymbolicForm& a, const SymbolicForm& b) {
  const SymbolicForm difference = sum(a, scaled(b, -one));
  return difference.atoms.empty() && is_zero(difference.constant);
}

SymbolicForm atom(const std::string& name, const Fraction& coefficient) {
  return {zero, {{name, convex::lowest_terms(coefficient)}}};
}

SymbolicForm product(const SymbolicForm& a, const SymbolicForm& b) {
  if (a.atoms.empty()) return scaled(b, a.constant);
  if (b.atoms.empty()) return scaled(a, b.constant);
  // Constant factors in front, so that 2a b and a 2b are one.
  const Fraction in_front = a.atoms.begin()->second * b.atoms.begin()->second;
  const SymbolicForm left = scaled(a, one / a.atoms.begin()->second);
  const SymbolicForm right = scaled(b, one / b.atoms.begin()->second);
  if (is_single(left) && left == right && left.atoms.begin()->first.rfind("cos(", 0) == 0) {
    const std::string sine = "sin(" + left.atoms.begin()->first.substr(4);
    const std::string factor = name_of(atom(sine, one));
    return sum({in_front, {}}, atom("(" + factor + ")*(" + factor + ")", -in_front));
  }
  if (is_single(left) && left == right && left.atoms.begin()->first.rfind("sqrt(", 0) == 0)
    if (const auto x = inner_fraction(left.atoms.begin()->first)) return {in_front * *x, {}};
  std::string first = name_of(left), second = name_of(right);
  if (second < first) std::swap(first, second);
  return atom("(" + first + ")*(" + second + ")", in_front);
}

SymbolicForm quotient(const SymbolicForm& a, const SymbolicForm& b) {
  if (b.atoms.empty()) return scaled(a, one / b.constant);
  const Fraction below = b.atoms.begin()->second;
  if (!a.atoms.empty() && a.atoms.begin()->first == b.atoms.begin()->first) {
    const Fraction ratio = a.atoms.begin()->second / below;
    if (a == scaled(b, ratio)) return {ratio, {}};
  }
  return atom("(" + name_of(scaled(a, one / below)) + ")/(" + name_of(scaled(b, one / below)) + ")", one);
}

SymbolicForm function_form(const std::string& name, const SymbolicForm& argument) {
  const bool is_even = name == "cos" || name == "cosh";
  const bool is_odd =
      name == "sin" || name == "tan" || name == "asin" || name == "atan" || name == "sinh" || name == "tanh";
  if (leading_sign(argument) < 0 && (is_even || is_odd))
    return scaled(function_form(name, scaled(argument, -one)), is_even ? one : -one);
  if (is_single(argument)) {
    const auto& [inner, coefficient] = *argument.atoms.begin();
    if (inner == "pi")
      if (const auto value = at_multiple_of_pi(name, coefficient)) return {*value, {}};
    if (coefficient == one)
      if (const auto value = of_inverse(name, inner)) return {*value, {}};
  }
  return atom(name + "(" + name_of(argument) + ")", one);
}

std::optional<std::string> written(const SymbolicForm& form) {
  constexpr std::size_t longest = 600;
  std::string text = name_of(form);
  if (text.size() > longest) return std::nullopt;
  return text;
}

}  // namespace mechanics::expression
