#include "mechanics/expression/parsing.hpp"

#include <algorithm>

#include "mechanics/expression/parsing_numbers.hpp"

namespace mechanics::expression {

Parsing::Parsing(const Source& source, const Scope& scope)
    : source_(&source), names_(scope.names), vocabulary_(scope.vocabulary), lexer_(source) {
  for (const std::string& index : scope.indices) scope_.emplace_back(index, slots_++);
  key_slots_ = slots_;
  token_ = lexer_.next();
  ahead_ = token_.kind == Kind::end ? token_ : lexer_.next();
}

void Parsing::advance() {
  token_ = ahead_;
  if (ahead_.kind != Kind::end) ahead_ = lexer_.next();
}

bool Parsing::accept(Kind kind) {
  if (token_.kind != kind) return false;
  advance();
  return true;
}

Token Parsing::expect(Kind kind, const char* wanted) {
  if (token_.kind != kind) unexpected(wanted);
  const Token token = token_;
  advance();
  return token;
}

Instruction& Parsing::emit(Step step, std::size_t offset, std::uint32_t operand) {
  Instruction& instruction = steps_.emplace_back();
  instruction.step = step;
  instruction.numeric = vocabulary_ != Vocabulary::system && vocabulary_ != Vocabulary::parameters;
  instruction.operand = operand;
  instruction.offset = static_cast<std::uint32_t>(offset);
  instruction.count = branches_ > 0 ? 1 : 0;
  return instruction;
}

void Parsing::apply(Operation operation, std::size_t offset) {
  emit(Step::apply, offset).operation = operation;
}

Code Parsing::take() { return {source_, std::move(steps_), slots_}; }

Code Parsing::expression() {
  mistakes_.gather([&] {
    sum();
    if (token_.kind == Kind::at_least || token_.kind == Kind::at_most || token_.kind == Kind::equal)
      source_->fail(token_.offset, "a relation stands here; only a constraint has one");
    if (token_.kind != Kind::end) unexpected("an operator or the end");
  });
  mistakes_.tell();
  return take();
}

Relation Parsing::relation() {
  bool two_sided = false;
  mistakes_.gather([&] { two_sided = both_sides(); });
  mistakes_.tell();
  return {take(), two_sided};
}

/// f of the relation; whether it is two-sided.
bool Parsing::both_sides() {
  sum();
  const Token sign = token_;
  if (sign.kind == Kind::end)
    source_->fail(0, "a constraint has no relation here; write a >= b, a <= b or a = b");
  if (sign.kind != Kind::at_least && sign.kind != Kind::at_most && sign.kind != Kind::equal)
    unexpected("an operator or one of >=, <=, =");
  advance();
  const auto left_end = static_cast<std::ptrdiff_t>(steps_.size());
  sum();
  if (token_.kind == Kind::at_least || token_.kind == Kind::at_most || token_.kind == Kind::equal)
    source_->fail(token_.offset, "a second relation; a constraint has exactly one, split it into two");
  if (token_.kind != Kind::end) unexpected("an operator or the end");
  if (sign.kind == Kind::at_most) std::rotate(steps_.begin(), steps_.begin() + left_end, steps_.end());
  apply(Operation::subtract, sign.offset);
  return sign.kind == Kind::equal;
}

void Parsing::sum() {
  product();
  while (token_.kind == Kind::plus || token_.kind == Kind::minus) {
    const Token sign = token_;
    const bool was_vector = is_vector_;
    advance();
    product();
    refuse_vectors(is_vector_ != was_vector, sign.offset, "the sum of a vector and a number");
    apply(sign.kind == Kind::plus ? Operation::add : Operation::subtract, sign.offset);
  }
}

void Parsing::product() {
  unary();
  while (token_.kind == Kind::times || token_.kind == Kind::over) {
    const Token sign = token_;
    const bool was_vector = is_vector_;
    advance();
    unary();
    const bool divides = sign.kind == Kind::over && is_vector_;
    refuse_vectors(
        divides || (is_vector_ && was_vector), sign.offset,
        divides ? "a division by a vector" : "a product of two vectors; write dot(u, v) or cross(u, v)");
    is_vector_ = is_vector_ || was_vector;
    apply(sign.kind == Kind::times ? Operation::multiply : Operation::divide, sign.offset);
  }
}

void Parsing::unary() {
  if (token_.kind != Kind::plus && token_.kind != Kind::minus) return power();
  const Nested nested(*this);
  const Token sign = token_;
  advance();
  unary();
  if (sign.kind == Kind::minus) apply(Operation::negate, sign.offset);
}

void Parsing::power() {
  postfix();
  if (token_.kind != Kind::power) return;
  const Nested nested(*this);
  const Token sign = token_;
  const bool was_vector = is_vector_;
  advance();
  unary();
  refuse_vectors(is_vector_ || was_vector, sign.offset, "a power of a vector; norm(u)^2 is dot(u, u)");
  apply(Operation::power, sign.offset);
}

void Parsing::postfix() {
  primary();
  for (; token_.kind == Kind::prime; advance()) {
    if (vocabulary_ != Vocabulary::system && !is_guessed_)
      source_->fail(token_.offset, "a time derivative has no meaning here; what stands here does not move");
    emit(Step::differentiate, token_.offset);
  }
}

void Parsing::primary() {
  const Token token = token_;
  is_vector_ = false;
  if (token.kind == Kind::open_index && component_ > 0) return vector_list(token);
  if (token.kind == Kind::number) {
    advance();
    emit(Step::literal, token.offset, static_cast<std::uint32_t>(token.text.size())).number = token.number;
  } else if (token.kind == Kind::name) {
    advance();
    named(token);
  } else if (token.kind == Kind::open) {
    const Nested nested(*this);
    advance();
    sum();
    expect(Kind::close, "an operator or \")\"");
  } else {
    unexpected("a number, a name or \"(\"");
  }
}

void Parsing::named(const Token& name) {
  if (name.text == "sum") return indexed_sum(name);
  if (const auto function = function_named(name.text);
      function && (token_.kind == Kind::open || is_reserved(name.text))) {
    const Numbers only(*this);
    return call(*function, name);
  }
  if (const auto what = construction_named(name.text); what && token_.kind == Kind::open) {
    const Numbers only(*this);
    return construct(*what, name);
  }
  if (is_vector_function(name)) return vector_function(name);
  if (name.text == "pi") return void(emit(Step::pi, name.offset));
  if (name.text == "in") source_->fail(name.offset, "\"in\" belongs to sum(i in a..b, …); it is no value");
  if (name.text == "t") {
    if (vocabulary_ != Vocabulary::system && vocabulary_ != Vocabulary::state)
      guess([&] { source_->fail(name.offset, "\"t\" may not be used here; this must not depend on time"); });
    return void(emit(Step::time, name.offset));
  }
  if (const auto known = slot(name.text)) return void(emit(Step::index, name.offset, *known));
  const Name* meaning = names_->find(name.text);
  if (meaning == nullptr) return unknown(name);
  guess([&] { refuse_if_out_of_vocabulary(name, meaning->kind); });
  if (meaning->kind == Name::Kind::parameter) {
    if (token_.kind == Kind::open_index)
      source_->fail(token_.offset,
                    "the parameter " + quoted(name.text) + " has no index; make it a definition");
    return void(emit(Step::parameter, name.offset, meaning->index));
  }
  member(*meaning, name);
}

void Parsing::call(Operation function, const Token& name) {
  const Nested nested(*this);
  if (token_.kind != Kind::open)
    source_->fail(name.offset, quoted(name.text) + " is a function; write " + std::string(name.text) + "(…)");
  advance();
  const bool any_number = function == Operation::min || function == Operation::max;
  int given = 0;
  do {
    if (++given > arity(function) && !any_number)
      source_->fail(token_.offset, std::string(name.text) + " has too many arguments; it takes " +
                                       std::to_string(arity(function)));
    sum();
    if (any_number && given > 1) apply(function, name.offset);
  } while (accept(Kind::comma));
  if (token_.kind == Kind::close && given < arity(function))
    source_->fail(token_.offset, std::string(name.text) + " has too few arguments; it takes " +
                                     (any_number ? "at least " : "") + std::to_string(arity(function)));
  expect(Kind::close, "an operator or \")\"");
  if (!any_number) apply(function, name.offset);
}

void Parsing::number_in(Vocabulary vocabulary, void (Parsing::*part)()) {
  const Vocabulary outer = vocabulary_;
  const Numbers only(*this);
  vocabulary_ = vocabulary;
  (this->*part)();
  vocabulary_ = outer;
}

void Parsing::member(const Name& meaning, const Token& name) {
  std::uint32_t given = 0;
  const bool is_vector = component_ > 0 && meaning.indices == 1 && token_.kind != Kind::open_index;
  if (is_vector) {
    Instruction& k = emit(Step::literal, name.offset);
    k.number = component_;
    k.numeric = true;
    given = 1;
  } else if (token_.kind == Kind::open_index) {
    const Nested nested(*this);
    advance();
    do {
      if (++given > meaning.indices) break;
      number_in(Vocabulary::index, &Parsing::sum);
    } while (accept(Kind::comma));
    if (given == meaning.indices) expect(Kind::close_index, "an operator or \"]\"");
  }
  if (given != meaning.indices) {
    const std::string counts =
        meaning.indices == 0   ? " has no index; write it without [ ]"
        : meaning.indices == 1 ? " is a family; write one of its members, " + std::string(name.text) + "[i]"
                               : " is a family; give it " + std::to_string(meaning.indices) + " indices";
    source_->fail(name.offset, quoted(name.text) + counts);
  }
  const bool is_coordinate = meaning.kind == Name::Kind::coordinate;
  Instruction& push = emit(is_coordinate ? Step::coordinate : Step::definition, name.offset, meaning.index);
  push.count = static_cast<std::uint8_t>(given);
  push.number = is_vector ? 3 : 0;
  is_vector_ = is_vector;
}

bool Parsing::at_index_declaration() const {
  return token_.kind == Kind::name && ahead_.kind == Kind::name && ahead_.text == "in";
}

void Parsing::indexed_sum(const Token& name) {
  const Nested nested(*this);
  expect(Kind::open, "\"(\" after sum");
  const std::size_t outer_indices = scope_.size();
  std::vector<std::size_t> repeats;
  if (!at_index_declaration()) source_->fail(name.offset, "this sum has no index; write sum(i in 1..N, …)");
  while (at_index_declaration()) {
    const Token index = token_;
    advance();
    advance();
    const std::size_t bounds = steps_.size();
    number_in(Vocabulary::index, &Parsing::sum);
    expect(Kind::range, "an operator or \"..\"");
    number_in(Vocabulary::index, &Parsing::sum);
    expect(Kind::comma, "an operator or \",\"");
    const bool fixed =
        std::none_of(steps_.begin() + static_cast<std::ptrdiff_t>(bounds), steps_.end(),
                     [&](const auto& s) { return s.step == Step::index && s.operand >= key_slots_; });
    repeats.push_back(steps_.size());
    emit(Step::repeat, name.offset, declare_index(index)).count = fixed ? 1 : 0;
  }
  sum();
  expect(Kind::close, "an operator or \")\"");
  for (; !repeats.empty(); repeats.pop_back()) {
    steps_[repeats.back()].number = static_cast<double>(steps_.size() - repeats.back());
    emit(Step::repeat_end, name.offset);
  }
  scope_.resize(outer_indices);
}

std::optional<std::uint32_t> Parsing::slot(std::string_view index) const {
  for (const auto& [name, place] : scope_)
    if (name == index) return place;
  return std::nullopt;
}

std::uint32_t Parsing::declare_index(const Token& name) {
  if (is_reserved(name.text))
    source_->fail(name.offset, "the name " + quoted(name.text) +
                                   " belongs to the language of expressions; choose another index");
  if (slot(name.text))
    source_->fail(name.offset, "the index " + quoted(name.text) + " is already in use here; choose another");
  if (const Name* meaning = names_->find(name.text))
    source_->fail(name.offset, "the name " + quoted(name.text) + " is taken, it is already " +
                                   std::string(article_and_kind(meaning->kind)) + "; choose another index");
  scope_.emplace_back(name.text, slots_);
  return slots_++;
}

}  // namespace mechanics::expression
