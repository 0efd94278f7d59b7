#include "cli/report/equation_code.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>

namespace cli::inline reports {
namespace {

using mechanics::SymbolicEquations;
using mechanics::expression::is_where;
using mechanics::expression::NodeId;
using mechanics::expression::Operation;
using mechanics::expression::Tape;

enum class Language { c, python };

/// How tightly the outermost operator of a piece of code binds.
enum class Binding { choice, sum, product, sign, atom };

struct CodePiece {
  std::string text;
  Binding binding = Binding::atom;
};

/// Code for the nodes of a tape: those that are used more than once, or lie deep, have variables.
class EquationCode {
 public:
  EquationCode(const SymbolicEquations& equations, Language language)
      : tape_(equations.tape), language_(language), uses_(tape_.size()), text_(tape_.size()) {
    for (const auto& row : equations.A) need(row);
    need(equations.z);
    for (const auto& row : equations.U) need(row);
    need(equations.s);
    count_uses();
    std::vector<int> depth(tape_.size());
    for (NodeId node = 0; node < tape_.size(); ++node) {
      if (uses_[node] == 0) continue;
      const int operands = arity(tape_.operation(node));
      if (operands >= 1) depth[node] = depth[tape_.a(node)] + 1;
      if (operands == 2) depth[node] = std::max(depth[node], depth[tape_.b(node)] + 1);
      constexpr int deepest = 24;
      CodePiece piece = written(node);
      if (operands >= 1 && (uses_[node] > 1 || depth[node] > deepest)) {
        const std::string name = fmt::format("x{}", ++variables_);
        lines_ += language == Language::c ? fmt::format("  const double {} = {};\n", name, piece.text)
                                          : fmt::format("        {} = {}\n", name, piece.text);
        piece = {name, Binding::atom};
        depth[node] = 0;
      }
      text_[node] = std::move(piece);
    }
  }

  const std::string& lines() const { return lines_; }
  const std::string& of(NodeId node) const { return text_[node].text; }

 private:
  void need(const std::vector<NodeId>& roots) {
    for (const NodeId root : roots) ++uses_[root];
  }

  /// How often the code of a node is written.
  void count_uses() {
    for (NodeId node = static_cast<NodeId>(tape_.size()); node-- > 0;) {
      if (uses_[node] == 0) continue;
      const Operation operation = tape_.operation(node);
      const bool twice = is_square(node) || operation == Operation::sign || operation == Operation::min ||
                         operation == Operation::max;
      if (arity(operation) >= 1) uses_[tape_.a(node)] += twice ? 2 : 1;
      if (arity(operation) == 2) uses_[tape_.b(node)] += twice ? 2 : 1;
    }
  }

  bool is_square(NodeId node) const {
    return tape_.operation(node) == Operation::power &&
           tape_.operation(tape_.b(node)) == Operation::literal && tape_.constant(tape_.b(node)) == 2;
  }

  std::string within(NodeId node, Binding least) const {
    const CodePiece& piece = text_[node];
    return piece.binding < least ? "(" + piece.text + ")" : piece.text;
  }

  CodePiece infix(NodeId node, const char* sign, Binding own) const {
    // The order of the operations is kept: what stands on the right binds more tightly.
    const auto tighter = static_cast<Binding>(static_cast<int>(own) + 1);
    return {within(tape_.a(node), own) + sign + within(tape_.b(node), tighter), own};
  }

  CodePiece call(const std::string& function, NodeId node) const {
    const std::string prefix = language_ == Language::c ? "" : "np.";
    std::string arguments = text_[tape_.a(node)].text;
    if (arity(tape_.operation(node)) == 2) arguments += ", " + text_[tape_.b(node)].text;
    return {prefix + function + "(" + arguments + ")", Binding::atom};
  }

  CodePiece number(double x) const {
    if (!std::isfinite(x)) return {language_ == Language::c ? "NAN" : "np.nan", Binding::atom};
    std::string digits = fmt::format("{}", x);
    if (digits.find_first_of(".e") == std::string::npos) digits += ".0";
    return {digits, Binding::atom};
  }

  CodePiece choice(const std::string& condition, const std::string& then,
                   const std::string& otherwise) const {
    if (language_ == Language::c) return {condition + " ? " + then + " : " + otherwise, Binding::choice};
    return {then + " if " + condition + " else " + otherwise, Binding::choice};
  }

  CodePiece written(NodeId node) const {
    const Operation operation = tape_.operation(node);
    const bool is_c = language_ == Language::c;
    switch (operation) {
      case Operation::literal:
      case Operation::pi:
        return number(tape_.constant(node));
      case Operation::parameter:
        return text_[tape_.a(node)];
      case Operation::coordinate:
        return {fmt::format("q[{}]", tape_.a(node)), Binding::atom};
      case Operation::velocity:
        return {fmt::format("v[{}]", tape_.a(node)), Binding::atom};
      case Operation::time:
        return {"t", Binding::atom};
      case Operation::negate:
        return {"-" + within(tape_.a(node), Binding::sign), Binding::sum};
      case Operation::add:
        return infix(node, " + ", Binding::sum);
      case Operation::subtract:
        return infix(node, " - ", Binding::sum);
      case Operation::multiply:
        return infix(node, "*", Binding::product);
      case Operation::divide:
        return infix(node, "/", Binding::product);
      case Operation::power: {
        if (is_square(node))
          return {within(tape_.a(node), Binding::atom) + "*" + within(tape_.a(node), Binding::atom),
                  Binding::product};
        return call(is_c ? "pow" : "power", node);
      }
      case Operation::abs:
        return call(is_c ? "fabs" : "abs", node);
      case Operation::asin:
      case Operation::acos:
      case Operation::atan: {
        const std::string name(symbol(operation));
        return call(is_c ? name : "arc" + name.substr(1), node);
      }
      case Operation::atan2:  // -0 is 0
        return {std::string(is_c ? "atan2(" : "np.arctan2(") + within(tape_.a(node), Binding::sum) +
                    " + 0.0, " + within(tape_.b(node), Binding::sum) + " + 0.0)",
                Binding::atom};
      case Operation::sign: {
        const std::string a = within(tape_.a(node), Binding::sum);
        const CodePiece below = choice(a + " < 0.0", "-1.0", is_c ? "NAN" : "np.nan");
        return choice(a + " > 0.0", "1.0", "(" + below.text + ")");
      }
      case Operation::min:
      case Operation::max: {
        const std::string a = within(tape_.a(node), Binding::sum), b = within(tape_.b(node), Binding::sum);
        return choice(a + (operation == Operation::min ? " <= " : " >= ") + b, a, b);
      }
      case Operation::where_not_negative:
      case Operation::where_negative:
        return choice(within(tape_.a(node), Binding::sum) +
                          (operation == Operation::where_negative ? " < 0.0" : " >= 0.0"),
                      within(tape_.b(node), Binding::sum), "0.0");
      default:
        return call(std::string(symbol(operation)), node);
    }
  }

  const Tape& tape_;
  Language language_;
  std::vector<unsigned> uses_;
  std::vector<CodePiece> text_;
  std::string lines_;
  int variables_ = 0;
};

std::string listed_names(const std::vector<std::string>& names) {
  std::string text;
  for (const std::string& name : names) text += (text.empty() ? "" : ", ") + name;
  return text.empty() ? "none" : text;
}

/// A name that C and Python have for something else.
bool is_taken(const std::string& name) {
  static constexpr std::array words{
      "auto",   "break",    "case",     "char",     "const",    "continue", "default", "do",     "double",
      "else",   "enum",     "extern",   "float",    "for",      "goto",     "if",      "inline", "int",
      "long",   "register", "restrict", "return",   "short",    "signed",   "sizeof",  "static", "struct",
      "switch", "typedef",  "union",    "unsigned", "void",     "volatile", "while",   "main",   "sin",
      "cos",    "tan",      "exp",      "log",      "sqrt",     "pow",      "fabs",    "and",    "as",
      "assert", "class",    "def",      "del",      "elif",     "except",   "finally", "from",   "global",
      "import", "in",       "is",       "lambda",   "nonlocal", "not",      "or",      "pass",   "raise",
      "try",    "with",     "yield",    "np",       "gamma",    "j0",       "j1",      "jn",     "y0",
      "y1",     "yn"};
  return std::find(words.begin(), words.end(), name) != words.end();
}

}  // namespace

std::string function_name(const std::string& file) {
  if (file == "-") return "moreau_system";
  std::string stem = file.substr(file.find_last_of('/') + 1);
  if (const std::size_t dot = stem.find_last_of('.'); dot != std::string::npos && dot > 0) stem.resize(dot);
  std::string name;
  for (const char c : stem) {
    const auto byte = static_cast<unsigned char>(c);
    const bool is_letter = (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z'), is_digit = c >= '0' && c <= '9';
    if ((byte & 0xC0U) == 0x80U) continue;  // the rest of a character of several bytes
    if (is_digit && name.empty()) name += '_';
    name += is_letter || is_digit ? c : '_';
  }
  return is_taken(name) ? name + "_" : name;
}

std::string equations_in_c(const SymbolicEquations& equations, const EquationTitle& title) {
  const EquationCode code(equations, Language::c);
  std::string text = fmt::format(
      "/* A q'' = z + U^T lambda, U q'' >= s of {}, made by moreau derive --c.\n"
      "   q = ({}), v = dq/dt. Rows of U: {}. A and U are stored row by row. C99. */\n"
      "#include <math.h>\n\n"
      "void {}(const double *q, const double *v, double t, double *A, double *z, double *U, double *s) {{\n",
      title.function, listed_names(equations.coordinates), listed_names(title.contacts), title.function);
  text += code.lines();
  const std::size_t n = equations.coordinates.size();
  const auto entries = [&](const char* name, const std::vector<std::vector<NodeId>>& rows) {
    for (std::size_t i = 0; i < rows.size(); ++i)
      for (std::size_t j = 0; j < n; ++j)
        text += fmt::format("  {}[{}] = {};\n", name, i * n + j, code.of(rows[i][j]));
  };
  const auto numbers = [&](const char* name, const std::vector<NodeId>& of) {
    for (std::size_t i = 0; i < of.size(); ++i)
      text += fmt::format("  {}[{}] = {};\n", name, i, code.of(of[i]));
  };
  entries("A", equations.A);
  numbers("z", equations.z);
  entries("U", equations.U);
  numbers("s", equations.s);
  return text + "  (void)q;\n  (void)v;\n  (void)t;\n  (void)U;\n  (void)s;\n}\n";
}

std::string equations_in_python(const SymbolicEquations& equations, const EquationTitle& title) {
  const EquationCode code(equations, Language::python);
  std::string text = fmt::format(
      "# A q'' = z + U^T lambda, U q'' >= s of {}, made by moreau derive --python.\n"
      "import numpy as np\n\n\n"
      "def {}(q, v, t):\n"
      "    \"\"\"q = ({}), v = dq/dt. Returns A, z, U, s; rows of U: {}.\"\"\"\n"
      "    q, v, t = np.asarray(q, float), np.asarray(v, float), np.float64(t)\n"
      "    with np.errstate(all=\"ignore\"):\n",
      title.function, title.function, listed_names(equations.coordinates), listed_names(title.contacts));
  text += code.lines();
  const auto row = [&](const std::vector<NodeId>& of) {
    std::string list;
    for (const NodeId node : of) list += (list.empty() ? "" : ", ") + code.of(node);
    return "[" + list + "]";
  };
  const auto rows = [&](const std::vector<std::vector<NodeId>>& of) {
    std::string list;
    for (const auto& one : of) list += (list.empty() ? "" : ",\n                      ") + row(one);
    return "[" + list + "]";
  };
  const std::size_t n = equations.coordinates.size();
  text += fmt::format("        A = np.array({}, float)\n        z = np.array({}, float)\n", rows(equations.A),
                      row(equations.z));
  text += fmt::format("        U = np.array({}, float).reshape({}, {})\n        s = np.array({}, float)\n",
                      rows(equations.U), equations.U.size(), n, row(equations.s));
  return text + "    return A, z, U, s\n";
}

}  // namespace cli::inline reports
