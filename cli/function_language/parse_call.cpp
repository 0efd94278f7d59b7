#include "cli/function_language/parse_call.hpp"

#include <cmath>

#include "cli/function_language/cursor.hpp"
#include "cli/function_language/read_list.hpp"
#include "cli/function_language/read_number.hpp"
#include "cli/problem_file/keys.hpp"
#include "convex/catalogue/catalogue.hpp"
#include "convex/mistakes.hpp"

namespace cli::inline function_language {
namespace {

using convex::Argument;
using convex::Call;
using convex::NamedArgument;
using convex::Place;

constexpr const char* form = "name(arguments), such as norm1(weight=2); `moreau functions` lists the names";

constexpr const char* vector_example = "a vector, such as [1, -2, 1/3]";

class Parser {
 public:
  explicit Parser(Cursor& cursor) : cursor_(cursor) {}

  Call only_call() {
    cursor_.skip_spaces();
    const Place place = cursor_.place();
    if (!number_begins(cursor_) && !begins_name(cursor_.peek())) {
      if (cursor_.at_end()) cursor_.fail(std::string("empty; write ") + form, place);
      fail_no_name();
    }
    Call call = sum_from(term(1), place, 1);
    require_end();
    return call;
  }

  /// What stands alone must end the text.
  void require_end() const {
    if (cursor_.at_end()) return;
    std::string advice = "a call ends with its )";
    if (cursor_.peek() == '-')
      advice = "a difference of convex functions need not be convex; give one that is";
    if (cursor_.peek() == '/') advice = "a multiple of a function is written before it, 1/2*norm1()";
    cursor_.fail(cursor_.shown_next() + " behind the end; " + advice);
  }

 private:
  /// The call whose name has been taken.
  Call call_of(std::string_view name, Place place, int depth) {
    if (depth > deepest_call)
      cursor_.fail("calls are nested more than " + std::to_string(deepest_call) + " deep; write less deep",
                   place);
    cursor_.skip_spaces();
    if (!cursor_.take('(')) fail_bare(name, place);
    Call call{std::string(name), {}, place};
    if (cursor_.take(')')) return call;
    while (true) {
      if (cursor_.at_end()) fail_open(name, place);
      call.arguments.push_back(argument(depth));
      if (cursor_.take(')')) return call;
      if (cursor_.at_end()) fail_open(name, place);
      if (!cursor_.take(','))
        cursor_.fail(cursor_.shown_next() + " in the arguments of " + shown(call.name) +
                     "; separate arguments by commas and end with )");
    }
  }

  /// 2*f(), f()*2 or f(), as scale(f(), alpha=2) or f().
  Call term(int depth) {
    const Place place = cursor_.place();
    if (number_begins(cursor_)) {
      return multiple(take_number(cursor_), place, depth);
    }
    const std::string_view name = cursor_.take_name();
    if (name.empty()) fail_no_name();
    return scaled_behind(call_of(name, place, depth), place);
  }

  /// The rest of alpha * f(), from the * on.
  Call multiple(const WrittenNumber& alpha, Place place, int depth) {
    cursor_.skip_spaces();
    if (!cursor_.take('*'))
      cursor_.fail(
          "a number where a function should be; write 2*norm1() for a multiple, constant(2) for the constant",
          place);
    const Place begin = cursor_.place();
    const std::string_view name = cursor_.take_name();
    if (name.empty()) fail_no_name();
    return scaled(call_of(name, begin, depth), alpha, place);
  }

  Call scaled_behind(Call f, Place place) {
    if (!cursor_.take('*')) return f;
    if (!number_begins(cursor_))
      cursor_.fail("a product of functions; only multiples by a number are convex, 2*norm1()", place);
    const WrittenNumber alpha = take_number(cursor_);
    cursor_.skip_spaces();
    return scaled(std::move(f), alpha, place);
  }

  static Call scaled(Call f, const WrittenNumber& alpha, Place place) {
    return Call{
        "scale",
        {{"", std::make_shared<const Call>(std::move(f)), place}, {"", alpha.value, place, {alpha.text}}},
        place};
  }

  /// f(), or sum(f(), g(), …) where + follows.
  Call sum_from(Call first, Place place, int depth) {
    if (cursor_.peek() != '+') return first;
    Call sum{"sum", {}, place};
    sum.arguments.push_back({"", std::make_shared<const Call>(std::move(first)), place});
    while (cursor_.take('+')) {
      const Place begin = cursor_.place();
      sum.arguments.push_back({"", std::make_shared<const Call>(term(depth)), begin});
    }
    return sum;
  }

  NamedArgument argument(int depth) {
    const Place place = cursor_.place();
    if (number_begins(cursor_)) return named("", value(depth), place);
    const std::string_view name = cursor_.take_name();
    if (name.empty()) return named("", value(depth), place);
    cursor_.skip_spaces();
    if (!cursor_.take('=')) return {"", nested(name, place, depth), place};
    return named(std::string(name), value(depth), place);
  }

  static NamedArgument named(std::string key, WrittenList read, Place place) {
    return {std::move(key), std::move(read.value), place, std::move(read.written)};
  }

  WrittenList value(int depth) {
    const Place place = cursor_.place();
    if (cursor_.peek() == '[') return take_list(cursor_);
    if (number_begins(cursor_)) {
      const WrittenNumber number = take_number(cursor_);
      cursor_.skip_spaces();
      if (cursor_.peek() != '*') return {number.value, {number.text}};
      return {std::make_shared<const Call>(sum_from(multiple(number, place, depth + 1), place, depth + 1)),
              {}};
    }
    const std::string_view name = cursor_.take_name();
    if (name.empty())
      cursor_.fail(cursor_.shown_next() +
                   " where an argument should be; write a number, a vector [1, 2], a matrix [[1, 2], [3, 4]] "
                   "or name(arguments)");
    return {nested(name, place, depth), {}};
  }

  Argument nested(std::string_view name, Place place, int depth) {
    Call f = scaled_behind(call_of(name, place, depth + 1), place);
    return std::make_shared<const Call>(sum_from(std::move(f), place, depth + 1));
  }

  [[noreturn]] void fail_no_name() const {
    if (cursor_.peek() == '-')
      cursor_.fail(
          "\"-\" where a function should be; a negative multiple of a convex function is none, give f "
          "itself");
    cursor_.fail(cursor_.shown_next() + " where a function's name should be; write " + form);
  }

  [[noreturn]] void fail_bare(std::string_view name, Place place) const {
    const std::string quoted = shown(std::string(name));
    if (name == "nan" || name == "NaN")
      cursor_.fail(quoted + " is no number; write one, or inf or -inf", place);
    if (name == "Inf" || name == "INF" || name == "infinity" || name == "Infinity")
      cursor_.fail(quoted + " is no name; an infinite number is inf or -inf", place);
    constexpr std::size_t longest_variable = 2;
    if (name.size() <= longest_variable && convex::find_entry(name) == nullptr && cursor_.peek() != '\0')
      cursor_.fail("\"" + quoted +
                       "\": functions are written without their variable; give numbers, vectors, matrices or "
                       "other functions, or nothing, as in norm1()",
                   place);
    cursor_.fail(
        "\"" + quoted + "\" has no parentheses; write " + quoted + "(), with its arguments between them",
        place);
  }

  [[noreturn]] void fail_open(std::string_view name, Place place) const {
    cursor_.fail("no ) closes " + shown(std::string(name)) + "(; add it", place);
  }

  Cursor& cursor_;
};

WrittenList only_list(std::string_view text, std::string_view what, Place begin, const char* example) {
  Cursor cursor(text, what, begin);
  cursor.skip_spaces();
  if (cursor.peek() != '[') cursor.fail(cursor.shown_next() + " where a [ should be; write " + example);
  WrittenList list = take_list(cursor);
  if (!cursor.at_end()) cursor.fail(cursor.shown_next() + " behind the end; write " + std::string(example));
  return list;
}

/// What is wrong with the names of a call and of those within it, and with the names of their arguments.
void gather_wrong_names(const Call& call, convex::Mistakes& mistakes) {
  mistakes.gather([&] {
    const convex::CatalogueEntry* entry = convex::find_entry(call.name);
    if (entry == nullptr) throw convex::InvalidInput(convex::unknown_entry(call.name), call.place);
    const convex::Space any{convex::Metric::identity(1)};
    const convex::Arguments checked(*entry, call, any);
  });
  for (const NamedArgument& argument : call.arguments)
    if (const auto* nested = std::get_if<std::shared_ptr<const Call>>(&argument.value))
      gather_wrong_names(**nested, mistakes);
}

}  // namespace

Call parse_call(std::string_view text, std::string_view what, Place begin) {
  Cursor cursor(text, what, begin);
  return Parser(cursor).only_call();
}

Call parse_known_call(std::string_view text, std::string_view what, Place begin) {
  Call call = parse_call(text, what, begin);
  convex::Mistakes mistakes;
  gather_wrong_names(call, mistakes);
  mistakes.tell();
  return call;
}

convex::Vector parse_vector(std::string_view text, std::string_view what, Place begin) {
  const Argument list = only_list(text, what, begin, vector_example).value;
  if (const auto* x = std::get_if<convex::Vector>(&list)) return *x;
  throw convex::InvalidInput(std::string(what) + ": a matrix; write " + vector_example, begin);
}

convex::Vector parse_point(std::string_view text, std::string_view what) {
  const WrittenList list = only_list(text, what, {}, vector_example);
  const auto* x = std::get_if<convex::Vector>(&list.value);
  const auto refuse = [&](const std::string& message, Place place = {}) {
    throw convex::InvalidInput(std::string(what) + ": " + message, place);
  };
  if (x == nullptr) refuse(std::string("a matrix; write ") + vector_example);
  if (x->size() == 0) refuse("empty; give at least one number");
  for (std::size_t i = 0; i < list.written.size(); ++i)
    if (!std::isfinite((*x)[static_cast<convex::Index>(i)]))
      refuse(list.written[i] + " is not finite; give finite numbers", list.places[i]);
  return *x;
}

std::vector<convex::Fraction> written_numbers(std::string_view list) {
  std::vector<convex::Fraction> numbers;
  for (const std::string& text : only_list(list, "list", {}, "[1, 2]").written)
    numbers.push_back(convex::read_fraction(text).value());
  return numbers;
}

}  // namespace cli::inline function_language
