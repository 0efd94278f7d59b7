#include "convex/gamma0/call.hpp"

#include <algorithm>
#include <charconv>
#include <cmath>

namespace convex::inline gamma0 {
namespace {

void append(std::string& text, double number) {
  if (std::isinf(number)) {
    text += number > 0 ? "inf" : "-inf";
    return;
  }
  char digits[32];
  // A sum with 0 turns -0 into 0.
  const auto end = std::to_chars(digits, digits + sizeof digits, number + 0.0).ptr;
  text.append(digits, end);
}

template <class Row>
void append_row(std::string& text, const Row& row) {
  text += '[';
  for (Index i = 0; i < row.size(); ++i) {
    if (i > 0) text += ',';
    append(text, row[i]);
  }
  text += ']';
}

void append(std::string& text, const Vector& vector) { append_row(text, vector); }

void append(std::string& text, const Matrix& matrix) {
  text += '[';
  for (Index i = 0; i < matrix.rows(); ++i) {
    if (i > 0) text += ',';
    append_row(text, matrix.row(i));
  }
  text += ']';
}

void append(std::string& text, const Call& call);

void append(std::string& text, const std::shared_ptr<const Call>& call) { append(text, *call); }

void append(std::string& text, const Call& call) {
  text += call.name;
  text += '(';
  bool first = true;
  for (const NamedArgument& argument : call.arguments) {
    if (!first) text += ", ";
    first = false;
    if (!argument.key.empty()) {
      text += argument.key;
      text += '=';
    }
    std::visit([&](const auto& value) { append(text, value); }, argument.value);
  }
  text += ')';
}

}  // namespace

bool has_rounded_numbers(const Call& call) {
  if (call.unrounded) return true;
  return std::any_of(call.arguments.begin(), call.arguments.end(), [](const NamedArgument& argument) {
    const auto* nested = std::get_if<std::shared_ptr<const Call>>(&argument.value);
    return nested && has_rounded_numbers(**nested);
  });
}

std::string to_text(const Call& call) {
  std::string text;
  append(text, call);
  return text;
}

std::string to_text(double number) {
  std::string text;
  append(text, number);
  return text;
}

NamedArgument argument(Call call) { return {"", std::make_shared<const Call>(std::move(call)), {}}; }

NamedArgument argument(std::string key, Argument value) { return {std::move(key), std::move(value), {}}; }

Call indicator_call(Call set) { return {"indicator", {argument(std::move(set))}}; }

Call support_call(Call set) { return {"support", {argument(std::move(set))}}; }

}  // namespace convex::inline gamma0
