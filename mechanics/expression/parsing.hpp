#pragma once

#include <optional>
#include <set>
#include <string>
#include <vector>

#include "convex/mistakes.hpp"
#include "mechanics/expression/construction.hpp"
#include "mechanics/expression/lexer.hpp"
#include "mechanics/expression/parser.hpp"

namespace mechanics::expression {

/// The state of one recursive descent: two tokens, the indices in scope, the code so far.
class Parsing {
 public:
  Parsing(const Source& source, const Scope& scope);

  Code expression();
  Relation relation();
  Key key(bool declares_ranges);
  KeyName key_name();

 private:
  class Nested;
  using Kind = Token::Kind;
  using Step = Instruction::Step;

  void advance();
  Token expect(Kind kind, const char* wanted);
  bool accept(Kind kind);
  [[noreturn]] void unexpected(const char* wanted) const;
  Instruction& emit(Step step, std::size_t offset, std::uint32_t operand = 0);
  void apply(Operation operation, std::size_t offset);

  bool both_sides();
  void sum();
  void product();
  void unary();
  void power();
  void postfix();
  void primary();
  void named(const Token& name);
  void call(Operation function, const Token& name);
  void construct(Construction what, const Token& name);
  void conditional(const Token& name);
  void table(const Token& name);
  double list(const Token& name);
  void comma_of(const Token& name, const char* form);
  void indexed_sum(const Token& name);

  struct Mark {  // where the parsing stood
    Lexer lexer;
    Token token, ahead;
  };
  class Numbers;
  Mark mark() const { return {lexer_, token_, ahead_}; }
  void back_to(const Mark& mark);
  bool is_vector_function(const Token& name) const;
  void vector_function(const Token& name);
  void vector_component(int k);
  void dot_product(const Token& name);
  void length(const Token& name);
  void cross_product(const Token& name);
  void component_of_cross(const Mark& start, int k);
  void point(const Token& name);
  void vector_list(const Token& bracket);
  void refuse_vectors(bool refused, std::size_t offset, const char* what) const;
  bool at_index_declaration() const;
  void member(const Name& meaning, const Token& name);
  void number_in(Vocabulary vocabulary, void (Parsing::*part)());
  [[noreturn]] void refuse_behind_name(const char* wanted) const;
  void refuse_if_out_of_vocabulary(const Token& name, Name::Kind kind) const;
  [[noreturn]] void refuse_unknown(const Token& name) const;
  void unknown(const Token& name);
  void arguments_of_unknown();
  /// What `check` refuses of a name is told with what else is wrong in the text.
  template <class Check>
  void guess(const Check& check) {
    if (mistakes_.gather(check)) return;
    is_guessed_ = true;
    constexpr int most_told = 20;  // of one text; nobody corrects more before the next run
    if (++told_ >= most_told) mistakes_.tell();
  }
  std::optional<std::uint32_t> slot(std::string_view index) const;
  std::uint32_t declare_index(const Token& name);

  Key named_key(bool declares_ranges);
  KeyIndex key_index(bool declares_ranges);
  Code number_of_key();
  Code take();

  const Source* source_;
  const Names* names_;
  Vocabulary vocabulary_;
  std::vector<std::pair<std::string, std::uint32_t>> scope_;  // indices in scope, with their slots
  std::uint32_t key_slots_ = 0, slots_ = 0;
  Lexer lexer_;
  Token token_, ahead_;
  int depth_ = 0, branches_ = 0, vector_depth_ = 0;
  int component_ = 0;       // within a vector: which of its components is written out; 0: numbers
  bool is_vector_ = false;  // what was read last
  std::vector<Instruction> steps_;
  convex::Mistakes mistakes_;
  std::set<std::string_view> unknown_;  // names told as unknown
  int told_ = 0;
  bool is_guessed_ = false;  // a name is not what it has to be: what hangs on it is not judged
};

}  // namespace mechanics::expression
