#include "mechanics/expression/construction.hpp"
#include "mechanics/expression/parsing_numbers.hpp"

namespace mechanics::expression {
namespace {

/// Each level writes its arguments out several times.
constexpr int deepest_vectors = 6;

}  // namespace

void Parsing::back_to(const Mark& mark) {
  lexer_ = mark.lexer;
  token_ = mark.token;
  ahead_ = mark.ahead;
}

void Parsing::refuse_vectors(bool refused, std::size_t offset, const char* what) const {
  if (!refused || is_guessed_) return;
  const std::string said = what;
  source_->fail(offset,
                said + (said.find(';') == std::string::npos ? "; a number and a vector are told apart" : ""));
}

bool Parsing::is_vector_function(const Token& name) const {
  return token_.kind == Kind::open &&
         (name.text == "dot" || name.text == "norm" || name.text == "cross" || name.text == "point");
}

/// dot(u, v), norm(u), cross(u, v), point(NAME, a, b, c): written out by components.
void Parsing::vector_function(const Token& name) {
  if (++vector_depth_ > deepest_vectors)
    source_->fail(name.offset, "vectors nested more than 6 deep; name a part under [system.definitions]");
  if (name.text == "dot") dot_product(name);
  if (name.text == "norm") length(name);
  if (name.text == "cross") cross_product(name);
  if (name.text == "point") point(name);
  --vector_depth_;
}

void Parsing::vector_component(int k) {
  const int outer = component_;
  const std::size_t begin = token_.offset;
  component_ = k;
  sum();
  component_ = outer;
  if (!is_vector_ && !is_guessed_)
    source_->fail(begin,
                  "a number where a vector stands; give a family of three members, \"r[1..3]\", by its "
                  "name alone, or a list [a, b, c]; the velocity of x is x'");
}

void Parsing::dot_product(const Token& name) {
  const Mark start = mark();
  for (int k = 1; k <= 3; ++k) {
    back_to(start);
    expect(Kind::open, "\"(\"");
    vector_component(k);
    comma_of(name, "dot(u, v)");
    vector_component(k);
    expect(Kind::close, "an operator or \")\"");
    apply(Operation::multiply, name.offset);
    if (k > 1) apply(Operation::add, name.offset);
  }
  is_vector_ = false;
}

void Parsing::length(const Token& name) {
  const Mark start = mark();
  for (int k = 1; k <= 3; ++k) {
    back_to(start);
    expect(Kind::open, "\"(\"");
    vector_component(k);
    expect(Kind::close, "an operator or \")\"; norm has one argument");
  }
  emit(Step::construct, name.offset, static_cast<std::uint32_t>(Construction::hypot)).number = 3;
  is_vector_ = false;
}

/// (u x v)_k = u_i v_j - u_j v_i for k, i, j in cyclic order.
void Parsing::component_of_cross(const Mark& start, int k) {
  const int i = k % 3 + 1, j = i % 3 + 1;
  for (const auto& [of_u, of_v] : {std::pair(i, j), std::pair(j, i)}) {
    back_to(start);
    expect(Kind::open, "\"(\"");
    vector_component(of_u);
    const std::size_t comma = token_.offset;
    expect(Kind::comma, "an operator or \",\", as in cross(u, v)");
    vector_component(of_v);
    expect(Kind::close, "an operator or \")\"");
    apply(Operation::multiply, comma);
  }
  apply(Operation::subtract, start.token.offset);
}

void Parsing::cross_product(const Token& name) {
  const Mark start = mark();
  const std::size_t before = steps_.size();
  component_of_cross(start, component_ > 0 ? component_ : 1);
  if (token_.kind != Kind::open_index) {
    if (component_ == 0)
      source_->fail(name.offset,
                    "cross(u, v) is a vector; write one of its components, cross(u, v)[1], or "
                    "dot or norm around it");
    is_vector_ = true;
    return;
  }
  steps_.resize(before);
  for (int k = 1; k <= 3; ++k) component_of_cross(start, k);
  expect(Kind::open_index, "\"[\"");
  {
    const Numbers only(*this);
    sum();
  }
  expect(Kind::close_index, "an operator or \"]\"");
  emit(Step::construct, name.offset, static_cast<std::uint32_t>(Construction::component)).number = 4;
}

/// [a, b, c], of which one component is kept.
void Parsing::vector_list(const Token& bracket) {
  const Nested nested(*this);
  const int kept = component_;
  advance();
  for (int k = 1; k <= 3; ++k) {
    const std::size_t before = steps_.size();
    {
      const Numbers only(*this);
      sum();
    }
    if (k != kept) steps_.resize(before);
    if (k < 3 && token_.kind == Kind::close_index)
      source_->fail(bracket.offset, "a vector has three components; write [a, b, c]");
    expect(k < 3 ? Kind::comma : Kind::close_index,
           k < 3 ? "an operator or \",\"" : "an operator or \"]\"; a vector has three components");
  }
  is_vector_ = true;
}

/// point(NAME, a, b, c, k), a coordinate in space of the point (a, b, c) of a body; without k the vector.
void Parsing::point(const Token& name) {
  constexpr const char* form = "point(BODY, a, b, c, k)";
  advance();
  const Token body = expect(Kind::name, "the name of a body, as in point(BODY, a, b, c, k)");
  const int kept = component_;
  for (const char* suffix : {"_x", "_y", "_z", "_e0", "_e1", "_e2", "_e3"}) {
    const Name* coordinate = names_->find(std::string(body.text) + suffix);
    if (coordinate == nullptr || coordinate->kind != Name::Kind::coordinate || coordinate->indices != 0)
      source_->fail(body.offset, quoted(body.text) + " is no body; give it a table [bodies." +
                                     std::string(body.text) + "] with mass and inertia");
    refuse_if_out_of_vocabulary(body, coordinate->kind);
    emit(Step::coordinate, body.offset, coordinate->index);
  }
  double given = 7;
  {
    const Numbers only(*this);
    for (int k = 0; k < 3; ++k, ++given) {
      comma_of(name, form);
      sum();
    }
    if (token_.kind == Kind::comma) {
      advance();
      sum();
      ++given;
    } else if (kept == 0) {
      comma_of(name, form);
    }
  }
  expect(Kind::close, "an operator or \")\"");
  is_vector_ = given < 11;
  const auto first = static_cast<std::uint32_t>(Construction::point_x);
  emit(Step::construct, name.offset,
       is_vector_ ? first + static_cast<std::uint32_t>(kept - 1)
                  : static_cast<std::uint32_t>(Construction::point))
      .number = given;
}

}  // namespace mechanics::expression
