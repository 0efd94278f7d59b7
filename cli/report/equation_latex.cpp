#include "cli/report/equation_latex.hpp"

#include <fmt/format.h>

#include "cli/report/greek_letters.hpp"

namespace cli::inline reports {
namespace {

using mechanics::SymbolicEquations;
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

enum class Tightness { sum, product, power, atom };

struct LatexFormula {
  std::string text;
  Tightness tightness = Tightness::atom;
};

/// Formulas of the nodes of a tape.
class LatexFormulas {
 public:
  explicit LatexFormulas(const SymbolicEquations& equations)
      : tape_(equations.tape), equations_(equations), known_(equations.tape.size()) {}

  std::string operator()(NodeId root) { return at(root).text; }

 private:
  const LatexFormula& at(NodeId node) {
    if (known_[node].text.empty()) known_[node] = made(node);
    return known_[node];
  }
  std::string within(NodeId node, Tightness least) {
    const LatexFormula& part = at(node);
    return part.tightness < least ? "\\left(" + part.text + "\\right)" : part.text;
  }
  bool is_literal(NodeId node, double value) const {
    return tape_.operation(node) == Operation::literal && tape_.constant(node) == value;
  }
  bool begins_with_digit(const std::string& text) const { return text[0] >= '0' && text[0] <= '9'; }

  LatexFormula number(double x) const {
    std::string digits = fmt::format("{}", x);
    const std::size_t e = digits.find('e');
    if (e == std::string::npos) return {digits, Tightness::atom};
    const int exponent = std::stoi(digits.substr(e + 1));
    return {fmt::format("{} \\cdot 10^{{{}}}", digits.substr(0, e), exponent), Tightness::product};
  }

  LatexFormula power(NodeId node) {
    const NodeId a = tape_.a(node), b = tape_.b(node);
    if (is_literal(b, 0.5)) return {"\\sqrt{" + at(a).text + "}", Tightness::atom};
    static constexpr std::array trigonometric{Operation::sin, Operation::cos, Operation::tan};
    for (const Operation function : trigonometric)
      if (tape_.operation(a) == function)
        return {fmt::format("\\{}^{{{}}} {}", symbol(function), at(b).text, argument(tape_.a(a))),
                Tightness::product};
    return {within(a, Tightness::atom) + "^{" + at(b).text + "}", Tightness::power};
  }

  /// sin θ, sin(θ + φ).
  std::string argument(NodeId node) {
    const LatexFormula& part = at(node);
    const bool is_plain = tape_.operation(node) == Operation::coordinate ||
                          tape_.operation(node) == Operation::parameter ||
                          tape_.operation(node) == Operation::time;
    return is_plain ? part.text : "\\left(" + part.text + "\\right)";
  }

  LatexFormula function(const std::string& name, NodeId node) {
    return {name + " " + argument(tape_.a(node)), Tightness::product};
  }

  LatexFormula cases(const std::string& then, const std::string& condition) const {
    return {"\\begin{cases}" + then + " & " + condition + " \\\\ 0 & \\text{else}\\end{cases}",
            Tightness::product};
  }

  LatexFormula made(NodeId node) {
    const Operation operation = tape_.operation(node);
    const NodeId a = tape_.a(node), b = tape_.b(node);
    switch (operation) {
      case Operation::literal:
        return number(tape_.constant(node));
      case Operation::pi:
        return {"\\pi", Tightness::atom};
      case Operation::parameter:
        return {latex_symbol(tape_.text(node)), Tightness::atom};
      case Operation::coordinate:
        return {latex_symbol(equations_.coordinates[a]), Tightness::atom};
      case Operation::velocity: {
        const std::string symbol = latex_symbol(equations_.coordinates[a]);
        const std::size_t index = symbol.find("_{");
        return {"\\dot{" + symbol.substr(0, index) + "}" +
                    (index == std::string::npos ? "" : symbol.substr(index)),
                Tightness::atom};
      }
      case Operation::time:
        return {"t", Tightness::atom};
      case Operation::negate:
        return {"-" + within(a, Tightness::product), Tightness::sum};
      case Operation::add:
        return {at(a).text + " + " + at(b).text, Tightness::sum};
      case Operation::subtract:
        return {at(a).text + " - " + within(b, Tightness::product), Tightness::sum};
      case Operation::multiply: {
        const std::string left = within(a, Tightness::product), right = within(b, Tightness::product);
        return {left + (begins_with_digit(right) ? " \\cdot " : " \\, ") + right, Tightness::product};
      }
      case Operation::divide:
        return {"\\frac{" + at(a).text + "}{" + at(b).text + "}", Tightness::product};
      case Operation::power:
        return power(node);
      case Operation::sqrt:
        return {"\\sqrt{" + at(a).text + "}", Tightness::atom};
      case Operation::abs:
        return {"\\left|" + at(a).text + "\\right|", Tightness::atom};
      case Operation::exp:
        return {"e^{" + at(a).text + "}", Tightness::power};
      case Operation::asin:
      case Operation::acos:
      case Operation::atan:
        return function("\\arc" + std::string(symbol(operation)).substr(1), node);
      case Operation::sign:
        return function("\\operatorname{sign}", node);
      case Operation::atan2:
        return {"\\operatorname{atan2}\\left(" + at(a).text + ", " + at(b).text + "\\right)",
                Tightness::atom};
      case Operation::min:
      case Operation::max:
        return {fmt::format("\\{}\\left({}, {}\\right)", symbol(operation), at(a).text, at(b).text),
                Tightness::atom};
      case Operation::where_not_negative:
        return cases(at(b).text, at(a).text + " \\ge 0");
      case Operation::where_negative:
        return cases(at(b).text, at(a).text + " < 0");
      default:
        return function("\\" + std::string(symbol(operation)), node);
    }
  }

  const Tape& tape_;
  const SymbolicEquations& equations_;
  std::vector<LatexFormula> known_;
};

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
    const Tape& tape = equations.tape;
    if (tape.operation(node) == Operation::literal && tape.constant(node) == 0) return;
    lines.push_back(left + " &= " + formula(node));
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
