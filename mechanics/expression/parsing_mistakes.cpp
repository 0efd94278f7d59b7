#include <cctype>
#include <tuple>
#include <utility>

#include "mechanics/expression/parsing_numbers.hpp"
#include "mechanics/expression/unknown_function.hpp"

namespace mechanics::expression {
namespace {

bool is_comparison(Token::Kind kind) {
  using enum Token::Kind;
  return kind == at_least || kind == at_most || kind == more || kind == less || kind == equal;
}

}  // namespace

void Parsing::unexpected(const char* wanted) const {
  if (token_.kind == Kind::more || token_.kind == Kind::less) {
    const std::string sign(token_.text);
    source_->fail(token_.offset, "\"" + sign + "\" is no relation; write " + sign + "=");
  }
  const std::string got = token_.kind == Kind::end ? "the end" : quoted(token_.text);
  const bool is_factor =
      token_.kind == Kind::name || token_.kind == Kind::number || token_.kind == Kind::open;
  const char* hint = "";
  if (std::string_view(wanted).starts_with("an operator")) {
    if (is_factor) hint = ": a product is written with *, and numbers carry no units";
    const bool is_decimal =
        ahead_.kind == Kind::number && token_.offset > 0 &&
        std::isdigit(static_cast<unsigned char>(source_->text.text[token_.offset - 1])) != 0;
    if (token_.kind == Kind::comma)
      hint =
          is_decimal ? ": a decimal is written with a point, 0.5" : ": one expression stands under one name";
    if (token_.kind == Kind::name && (token_.text == "and" || token_.text == "or"))
      hint = ": one expression stands under one name, and all constraints hold";
  }
  source_->fail(token_.offset, "got " + got + "; expected " + wanted + hint);
}

/// What stands behind a name that is to stand alone.
void Parsing::refuse_behind_name(const char* wanted) const {
  if (token_.kind == Kind::prime)
    source_->fail(token_.offset, "a name has no prime here; a velocity goes by the name of its coordinate");
  if (token_.kind == Kind::comma || token_.kind == Kind::name || token_.kind == Kind::number)
    source_->fail(token_.offset,
                  "got " + quoted(token_.text) +
                      " behind a name of letters, digits and _; write one word, or each name in "
                      "quotation marks of its own");
  unexpected(wanted);
}

void Parsing::refuse_if_out_of_vocabulary(const Token& name, Name::Kind kind) const {
  if (kind == Name::Kind::parameter) return;
  const std::string it = quoted(name.text) + " is " + std::string(article_and_kind(kind));
  if (kind == Name::Kind::constraint) source_->fail(name.offset, it + "; a constraint is no value");
  if (vocabulary_ == Vocabulary::parameters)
    source_->fail(name.offset, it + "; a parameter may use numbers and other parameters only");
  if (vocabulary_ == Vocabulary::index)
    source_->fail(name.offset, it + "; an index may use numbers, parameters and indices only");
  if (vocabulary_ != Vocabulary::system)
    source_->fail(name.offset, it + "; a value of the state may use numbers, parameters and t only");
}

void Parsing::refuse_unknown(const Token& name) const {
  using enum Name::Kind;
  if (token_.kind == Kind::open)
    source_->fail(name.offset, quoted(name.text) + " is no function; " + instead_of_function(name.text));
  std::vector<std::string> indices;
  for (const auto& [index, place] : scope_)
    if (!index.empty()) indices.push_back(index);
  std::vector<Name::Kind> kinds{parameter};
  if (vocabulary_ == Vocabulary::system) kinds = {coordinate, parameter, definition};
  const std::string is_unknown = quoted(name.text) + " is unknown";
  if (name.text == "e") source_->fail(name.offset, is_unknown + "; write exp(x) for e^x");
  for (const std::string& other : names_behind_velocity(name.text))
    if (const Name* meaning = names_->find(other); meaning != nullptr && meaning->kind == coordinate)
      source_->fail(name.offset, is_unknown + "; the velocity of " + other + " is " + other + "'");
  source_->fail(name.offset, is_unknown + names_->suggestion(name.text, kinds, indices, true));
}

/// A name without a meaning is told once, and what stands behind it is read on.
void Parsing::unknown(const Token& name) {
  if (unknown_.insert(name.text).second) guess([&] { refuse_unknown(name); });
  while (token_.kind == Kind::open || token_.kind == Kind::open_index) arguments_of_unknown();
}

/// What is wrong in the parentheses or brackets behind an unknown name is told where they can be read without
/// it; otherwise they are passed over.
void Parsing::arguments_of_unknown() {
  const Mark start = mark();
  const Kind close = token_.kind == Kind::open ? Kind::close : Kind::close_index;
  const auto [indices, vocabulary, component] = std::tuple(scope_.size(), vocabulary_, component_);
  const auto [branches, vectors] = std::pair(branches_, vector_depth_);
  convex::Mistakes outside;
  std::swap(outside, mistakes_);
  const bool are_read = mistakes_.gather([&] {
    const Nested nested(*this);
    do {
      advance();
      sum();
    } while (token_.kind == Kind::comma || is_comparison(token_.kind));
    expect(close, close == Kind::close ? "an operator or \")\"" : "an operator or \"]\"");
  });
  if (are_read) outside.gather([&] { mistakes_.tell(); });
  std::swap(outside, mistakes_);
  if (are_read) return;
  back_to(start);
  scope_.resize(indices);
  vocabulary_ = vocabulary;
  component_ = component;
  branches_ = branches;
  vector_depth_ = vectors;
  int open = 0;
  do {
    if (token_.kind == Kind::open || token_.kind == Kind::open_index) ++open;
    if (token_.kind == Kind::close || token_.kind == Kind::close_index) --open;
    if (token_.kind == Kind::end)
      unexpected(close == Kind::close ? "an operator or \")\"" : "an operator or \"]\"");
    advance();
  } while (open > 0);
}

}  // namespace mechanics::expression
