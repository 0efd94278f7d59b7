#pragma once

#include <span>
#include <string>
#include <vector>

#include "mechanics/expression/families.hpp"
#include "mechanics/expression/tape.hpp"
#include "mechanics/expression/total_derivative.hpp"

namespace mechanics::expression {

/// All that names stand for. Definitions: `entry_of` gives, by member, the place in `definitions`.
struct Vocabularies {
  std::vector<std::string> parameter_names;
  std::vector<Code> parameters;
  std::vector<Family> coordinate_families, definition_families;
  std::vector<Entry> definitions;
  std::vector<std::uint32_t> entry_of, family_of;  ///< by member of a definition
  TableFile table_file;                            ///< reads the tables that expressions name; may be empty
};

/// Turns code into nodes of a tape, or into numbers. Each parameter and each member of a definition is
/// expanded once, when it is first used; the calls among them are on a stack of their own, so that recursive
/// definitions may be as deep as memory allows.
class Expansion {
 public:
  Expansion(const Vocabularies& meanings, Tape& tape)
      : meanings_(&meanings), tape_(&tape), derivative_(tape) {}

  /// The node of `code` for these indices of its key.
  NodeId node(const Code& code, Tuple indices);
  /// The number of numeric code; it may use t.
  double number(const Code& code, Tuple indices, double t = 0);
  NodeId parameter(std::uint32_t p);
  /// What the parameter is, instead of its code; before it is first used.
  void give_parameter(std::uint32_t p, NodeId node);
  NodeId definition(std::uint32_t member);

 private:
  enum class Target : std::uint8_t { nothing, parameter, definition };
  struct Frame {
    const Code* code = nullptr;
    std::size_t at = 0;
    Target target = Target::nothing;
    std::uint32_t member = 0;
    std::size_t indices = 0, loops = 0;
  };
  struct Loop {
    std::size_t begin = 0;
    std::int64_t current = 0, last = 0;
    std::uint32_t slot = 0;
    bool has_sum = false;
    NodeId sum = 0;
    double number = 0, length = 0;
  };

  void call(const Code& code, Tuple indices, Target target, std::uint32_t member);
  void run(std::size_t frames);
  void step(const Instruction& instruction);
  void finish();
  void push_numeric(const Instruction& instruction);
  void push_node(const Instruction& instruction);
  void apply(const Instruction& instruction);
  void differentiate(const Instruction& instruction);
  void construct(const Instruction& instruction);
  void push_table(const Instruction& instruction);
  void check_table(const Instruction& instruction, std::span<const NodeId> arguments) const;
  void push_number(const Instruction& instruction, double number);
  void begin_sum(const Instruction& instruction);
  void end_sum(const Instruction& instruction);
  /// Pushes the memoised node, or calls the code that makes it and leaves the step to be done again.
  bool ready(Target target, std::uint32_t member, const Instruction& instruction);
  void push_parameter(const Instruction& instruction);
  void push_member(const Instruction& instruction);
  std::int64_t integer(double number, const Instruction& instruction, const char* what) const;
  [[noreturn]] void fail(const Instruction& instruction, const std::string& message) const;
  [[noreturn]] void refuse_cycle(Target target, std::uint32_t member, const Instruction& instruction) const;
  std::string name_of(Target target, std::uint32_t member) const;
  Frame& frame() { return frames_.back(); }
  std::vector<NodeId>& memo(Target target) {
    return target == Target::parameter ? parameters_ : definitions_;
  }
  Origin origin(const Instruction& instruction) const;
  double pop_number();
  NodeId pop_node();

  const Vocabularies* meanings_;
  Tape* tape_;
  TotalDerivative derivative_;
  double t_ = 0;
  std::vector<NodeId> parameters_, definitions_;  // by number: a node, `in_progress`, or no_node
  std::vector<Frame> frames_;
  std::vector<Loop> loops_;
  std::vector<std::int64_t> indices_;
  std::vector<NodeId> nodes_;
  std::vector<double> numbers_;
  double members_of_sum_ = 0;  // of the outermost sum that is running
};

}  // namespace mechanics::expression
