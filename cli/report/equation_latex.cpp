#include "cli/report/equation_latex.hpp"

#include <fmt/format.h>

#include <cctype>
#include <cmath>

#include "cli/report/greek_letters.hpp"
#include "mechanics/expression/collected_sum.hpp"

namespace cli::inline reports {
namespace {

using convex::Fraction;
using mechanics::SymbolicEquations;
using mechanics::expression::CollectedAtom;
using mechanics::expression::CollectedSum;
using mechanics::expression::Collection;
using mechanics::expression::NodeId;
using mechanics::expression::Operation;
using mechanics::expression::Tape;

std::string escaped(const std::string& name) {
  std::string text;
  for (const char c : name) text += c == '_' ? std::string("\\_") : std::string(1, c);
  return text;
}

/// Letters without an index.
std::string stem_symbol(const std::string& stem) {
  if (is_greek(stem)) return "\\" + stem;
  return stem.size() == 1 ? stem : "\\mathit{" + escaped(stem) + "}";
}

/// A formula as terms to be joined by + and -, each with its sign in front.
struct LatexTerm {
  bool is_negative = false;
  std::string text;
};

/// Formulas of collected sums.
class LatexFormulas {
 public:
  explicit LatexFormulas(const SymbolicEquations& equations)
      : equations_(equations), collection_(equations.tape) {}

  std::vector<LatexTerm> terms(NodeId root) { return terms(collection_(root)); }

 private:
  std::vector<LatexTerm> terms(const CollectedSum& sum) const {
    std::vector<LatexTerm> made;
    for (const auto& [powers, factor] : sum)
      made.push_back({convex::sign(factor) < 0, term(powers, convex::sign(factor) < 0 ? -factor : factor)});
    if (made.empty()) made.push_back({false, "0"});
    return made;
  }

  std::string text(const CollectedSum& sum) const {
    std::string made;
    for (const LatexTerm& part : terms(sum))
      made += (part.is_negative ? (made.empty() ? "-" : " - ") : made.empty() ? "" : " + ") + part.text;
    return made;
  }

  /// A symbol or a number that stands for all of the sum.
  bool is_plain(const CollectedSum& sum) const {
    if (sum.size() != 1 || sum.begin()->first.size() > 1) return false;
    const auto& [powers, factor] = *sum.begin();
    if (powers.empty())
      return convex::sign(factor) > 0 && convex::text(factor).find('/') == std::string::npos;
    return powers[0].second == 1 && factor == Fraction{1} &&
           collection_.atom(powers[0].first).leaf != mechanics::expression::no_node;
  }

  std::string in_parentheses(const CollectedSum& sum) const { return "\\left(" + text(sum) + "\\right)"; }
  std::string argument(const CollectedSum& sum) const {
    return is_plain(sum) ? text(sum) : in_parentheses(sum);
  }

  /// p/q with numbers, parameters and pi in one fraction, then functions and variables.
  std::string term(const mechanics::expression::Powers& powers, const Fraction& factor) const {
    std::vector<std::string> over, under, behind;
    const auto [p, q] = fraction_digits(factor);
    if (p != "1") over.push_back(p);
    if (q != "1") under.push_back(q);
    for (const bool constants : {true, false})
      for (const auto& [number, exponent] : powers) {
        const CollectedAtom& atom = collection_.atom(number);
        const bool is_constant = atom.operation == Operation::parameter || atom.operation == Operation::pi;
        if (is_constant != constants) continue;
        (exponent < 0 ? under : is_constant ? over : behind).push_back(power(atom, std::abs(exponent)));
      }
    if (under.empty()) {
      over.insert(over.end(), behind.begin(), behind.end());
      return over.empty() ? "1" : joined(over);
    }
    if (over.empty() && p == "1" && q == "1") std::swap(over, behind);
    const std::string front = "\\frac{" + (over.empty() ? "1" : joined(over)) + "}{" + joined(under) + "}";
    return behind.empty() ? front : front + " \\, " + joined(behind);
  }

  static std::string joined(const std::vector<std::string>& factors) {
    std::string made;
    for (const std::string& factor : factors) {
      const bool is_number = factor[0] >= '0' && factor[0] <= '9';
      made += (made.empty() ? "" : is_number ? " \\cdot " : " \\, ") + factor;
    }
    return made;
  }

  /// Numerator and denominator; a decimal number when that is what the fraction is, and 1.
  static std::pair<std::string, std::string> fraction_digits(const Fraction& factor) {
    const double q = convex::nearest_double(Fraction{factor.denominator, 1});
    const double p = convex::nearest_double(Fraction{factor.numerator, 1});
    double without = q;
    for (const double prime : {2.0, 5.0})
      while (std::fmod(without, prime) == 0 && without > 1) without /= prime;
    constexpr double longest = 1e6, simplest = 8;
    if (p < longest && q < longest && (without > 1 || q <= simplest)) {
      const std::string digits = convex::text(factor);
      const std::size_t line = digits.find('/');
      return {digits.substr(0, line), line == std::string::npos ? "1" : digits.substr(line + 1)};
    }
    const std::string digits = fmt::format("{}", convex::nearest_double(factor));
    const std::size_t e = digits.find('e');
    if (e == std::string::npos) return {digits, "1"};
    return {fmt::format("{} \\cdot 10^{{{}}}", digits.substr(0, e), std::stoi(digits.substr(e + 1))), "1"};
  }

  std::string power(const CollectedAtom& atom, int exponent) const {
    if (exponent == 1) return of(atom);
    const std::string raised = fmt::format("^{{{}}}", exponent);
    switch (atom.operation) {
      case Operation::sin:
      case Operation::cos:
      case Operation::tan:
        return fmt::format("\\{}{} {}", symbol(atom.operation), raised, argument(atom.arguments[0]));
      case Operation::pi:
      case Operation::parameter:
      case Operation::coordinate:
      case Operation::velocity:
      case Operation::time:
      case Operation::add:
        return of(atom) + raised;
      default:
        return "\\left(" + of(atom) + "\\right)" + raised;
    }
  }

  std::string cases(const CollectedAtom& atom, const char* condition) const {
    return "\\begin{cases}" + text(atom.arguments[1]) + " & " + text(atom.arguments[0]) + condition +
           " \\\\ 0 & \\text{else}\\end{cases}";
  }

  std::string of(const CollectedAtom& atom) const {
    const Tape& tape = equations_.tape;
    const auto first = [&] { return text(atom.arguments[0]); };
    switch (atom.operation) {
      case Operation::literal:
        return "\\text{undefined}";  // no number: a table outside its range
      case Operation::pi:
        return "\\pi";
      case Operation::parameter:
        return latex_symbol(tape.text(atom.leaf));
      case Operation::coordinate:
        return latex_symbol(equations_.coordinates[tape.a(atom.leaf)]);
      case Operation::velocity: {
        const std::string name = latex_symbol(equations_.coordinates[tape.a(atom.leaf)]);
        const std::size_t index = name.find("_{");
        return "\\dot{" + name.substr(0, index) + "}" +
               (index == std::string::npos ? "" : name.substr(index));
      }
      case Operation::time:
        return "t";
      case Operation::add:
        return in_parentheses(atom.arguments[0]);
      case Operation::divide:
        return "\\frac{" + first() + "}{" + text(atom.arguments[1]) + "}";
      case Operation::power:
        if (is_half(atom.arguments[1])) return "\\sqrt{" + first() + "}";
        return argument(atom.arguments[0]) + "^{" + text(atom.arguments[1]) + "}";
      case Operation::sqrt:
        return "\\sqrt{" + first() + "}";
      case Operation::abs:
        return "\\left|" + first() + "\\right|";
      case Operation::exp:
        return "e^{" + first() + "}";
      case Operation::asin:
      case Operation::acos:
      case Operation::atan:
        return "\\arc" + std::string(symbol(atom.operation)).substr(1) + " " + argument(atom.arguments[0]);
      case Operation::sign:
        return "\\operatorname{sign} " + argument(atom.arguments[0]);
      case Operation::atan2:
        return "\\operatorname{atan2}\\left(" + first() + ", " + text(atom.arguments[1]) + "\\right)";
      case Operation::min:
      case Operation::max:
        return fmt::format("\\{}\\left({}, {}\\right)", symbol(atom.operation), first(),
                           text(atom.arguments[1]));
      case Operation::where_not_negative:
        return cases(atom, " \\ge 0");
      case Operation::where_negative:
        return cases(atom, " < 0");
      default:
        return "\\" + std::string(symbol(atom.operation)) + " " + argument(atom.arguments[0]);
    }
  }

  static bool is_half(const CollectedSum& sum) {
    return sum.size() == 1 && sum.begin()->first.empty() && sum.begin()->second == Fraction{1, 2};
  }

  const SymbolicEquations& equations_;
  Collection collection_;
};

/// About how many letters wide a formula is set.
std::size_t width(const std::string& formula) {
  std::size_t letters = 0;
  for (std::size_t i = 0; i < formula.size(); ++i) {
    if (formula[i] == '\\') {
      const std::size_t first = ++i;
      while (i < formula.size() && std::isalpha(static_cast<unsigned char>(formula[i])) != 0) ++i;
      letters += formula.compare(first, i - first, "left") == 0 || i == first ? 0 : 1;
      --i;
    } else if (std::isalnum(static_cast<unsigned char>(formula[i])) != 0 || formula[i] == '(' ||
               formula[i] == ')') {
      ++letters;
    }
  }
  return letters;
}

/// A sum, continued on another line of the align* where it gets wide.
std::string broken(const std::vector<LatexTerm>& terms) {
  constexpr std::size_t widest = 56;
  std::string made;
  std::size_t line = 0;
  for (const LatexTerm& term : terms) {
    const std::size_t more = width(term.text) + 3;
    const bool breaks = line > 0 && line + more > widest;
    if (breaks) {
      made += " \\\\\n  &\\quad ";
      line = 0;
    }
    line += more;
    if (made.empty())
      made += term.is_negative ? "-" : "";
    else
      made += breaks ? (term.is_negative ? "{} - " : "{} + ") : term.is_negative ? " - " : " + ";
    made += term.text;
  }
  return made;
}

}  // namespace

std::string latex_symbol(const std::string& name) {
  std::string stem = name, index;
  if (const std::size_t open = name.find('['); open != std::string::npos) {
    stem = name.substr(0, open);
    index = name.substr(open + 1, name.size() - open - 2);
  }
  if (const std::size_t line = stem.find('_');
      line != std::string::npos && line > 0 && line + 1 < stem.size()) {
    const std::string rest = stem.substr(line + 1);
    const std::string subscript = is_greek(rest)     ? "\\" + rest
                                  : rest.size() == 1 ? rest
                                                     : "\\mathrm{" + escaped(rest) + "}";
    index = subscript + (index.empty() ? "" : "," + index);
    stem.resize(line);
  } else if (const std::size_t digit = stem.find_first_of("0123456789");
             digit != std::string::npos && digit > 0) {
    index = stem.substr(digit) + (index.empty() ? "" : "," + index);
    stem.resize(digit);
  }
  return stem_symbol(stem) + (index.empty() ? "" : "_{" + index + "}");
}

std::string equations_in_latex(const SymbolicEquations& equations, const EquationTitle& title) {
  LatexFormulas formula(equations);
  std::vector<std::string> lines, names;
  for (const std::string& name : equations.coordinates) names.push_back(latex_symbol(name));
  const auto add = [&](const std::string& left, NodeId node) {
    const std::vector<LatexTerm> terms = formula.terms(node);
    if (terms.size() == 1 && terms[0].text == "0") return;
    lines.push_back(left + " &= " + broken(terms));
  };
  const std::size_t n = names.size();
  for (std::size_t i = 0; i < n; ++i)
    for (std::size_t j = i; j < n; ++j)
      add(fmt::format("A_{{{},{}}}", names[i], names[j]), equations.A[i][j]);
  for (std::size_t i = 0; i < n; ++i) add(fmt::format("z_{{{}}}", names[i]), equations.z[i]);
  for (std::size_t a = 0; a < equations.U.size(); ++a) {
    const std::string contact = "\\mathrm{" + escaped(title.contacts[a]) + "}";
    for (std::size_t i = 0; i < n; ++i) add(fmt::format("u_{{{},{}}}", contact, names[i]), equations.U[a][i]);
    add(fmt::format("s_{{{}}}", contact), equations.s[a]);
  }
  std::string text = fmt::format(
      "% A q'' = z + U^T lambda, u_a q'' >= s_a of {}; needs amsmath. What is not here is 0; A is "
      "symmetric.\n"
      "\\begin{{align*}}\n",
      title.function);
  for (std::size_t k = 0; k < lines.size(); ++k)
    text += "  " + lines[k] + (k + 1 < lines.size() ? ", \\\\\n" : ".\n");
  return text + "\\end{align*}\n";
}

}  // namespace cli::inline reports
