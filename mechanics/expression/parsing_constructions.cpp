#include "mechanics/expression/construction.hpp"
#include "mechanics/expression/parsing.hpp"

namespace mechanics::expression {

/// What comes after the name of a function that is written out: if, sign, step, hypot, table.
void Parsing::construct(Construction what, const Token& name) {
  if (what == Construction::if_at_least) return conditional(name);
  if (what == Construction::table) return table(name);
  advance();
  double given = 0;
  do {
    ++given;
    sum();
  } while (accept(Kind::comma));
  const bool is_hypot = what == Construction::hypot;
  if (token_.kind == Kind::close && (is_hypot ? given < 2 : given != 1))
    source_->fail(token_.offset, std::string(name.text) + (given > 1 ? " has too many" : " has too few") +
                                     " arguments; it takes " + (is_hypot ? "at least 2" : "1"));
  expect(Kind::close, "an operator or \")\"");
  emit(Step::construct, name.offset, static_cast<std::uint32_t>(what)).number = given;
}

void Parsing::comma_of(const Token& name, const char* form) {
  if (token_.kind == Kind::close)
    source_->fail(token_.offset, std::string(name.text) + " has too few arguments; write " + form);
  expect(Kind::comma, "an operator or \",\"");
}

/// if(a >= b, c, d), and with >, <=, <.
void Parsing::conditional(const Token& name) {
  constexpr const char* form = "if(a >= b, c, d)";
  advance();
  sum();
  Construction what = Construction::if_at_least;
  switch (token_.kind) {
    case Kind::at_least:
      break;
    case Kind::more:
      what = Construction::if_more;
      break;
    case Kind::at_most:
      what = Construction::if_at_most;
      break;
    case Kind::less:
      what = Construction::if_less;
      break;
    default:
      source_->fail(token_.offset, std::string("no comparison by >=, >, <= or < here; write ") + form);
  }
  advance();
  sum();
  comma_of(name, form);
  ++branches_;
  sum();
  comma_of(name, form);
  sum();
  --branches_;
  if (token_.kind == Kind::comma)
    source_->fail(token_.offset, std::string("if has too many arguments; write ") + form);
  expect(Kind::close, "an operator or \")\"");
  emit(Step::construct, name.offset, static_cast<std::uint32_t>(what)).number = 4;
}

/// [a, b, …]; how many there are.
double Parsing::list(const Token&) {
  expect(Kind::open_index, "a list, [x1, x2, …]");
  double given = 0;
  do {
    ++given;
    sum();
  } while (accept(Kind::comma));
  expect(Kind::close_index, "an operator, \",\" or \"]\"");
  return given;
}

/// table(x, [x1, …], [y1, …]) and table(x, "F.csv").
void Parsing::table(const Token& name) {
  constexpr const char* form = "table(x, [x1, x2], [y1, y2]) or table(x, \"F.csv\")";
  advance();
  sum();
  comma_of(name, form);
  if (token_.kind == Kind::quotation) {
    const Token file = token_;
    advance();
    expect(Kind::close, "\")\"");
    emit(Step::table_file, file.offset, static_cast<std::uint32_t>(file.text.size()));
    return;
  }
  const double knots = list(name);
  comma_of(name, form);
  const double values = list(name);
  expect(Kind::close, "\")\"");
  if (knots != values)
    source_->fail(name.offset, "table has " + count_text(knots) + " points and " + count_text(values) +
                                   " values; give as many of the one as of the other");
  emit(Step::construct, name.offset, static_cast<std::uint32_t>(Construction::table)).number =
      1 + knots + values;
}

}  // namespace mechanics::expression
