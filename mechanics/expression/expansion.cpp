#include "mechanics/expression/expansion.hpp"

#include <cmath>

#include "mechanics/expression/construction.hpp"

namespace mechanics::expression {
namespace {

constexpr NodeId in_progress = no_node - 1;
constexpr std::size_t most_nodes = std::size_t{1} << 26U;  // about 2.5 GB of tape
constexpr double largest_index = 0x1p53;                   // beyond, doubles are no longer all the integers

}  // namespace

NodeId Expansion::node(const Code& code, Tuple indices) {
  const std::size_t depth = frames_.size();
  call(code, indices, Target::nothing, 0);
  run(depth);
  return pop_node();
}

double Expansion::number(const Code& code, Tuple indices, double t) {
  t_ = t;
  const std::size_t depth = frames_.size();
  call(code, indices, Target::nothing, 0);
  run(depth);
  return pop_number();
}

NodeId Expansion::parameter(std::uint32_t p) {
  parameters_.resize(meanings_->parameters.size(), no_node);
  if (parameters_[p] == no_node) {
    call(meanings_->parameters[p], {}, Target::parameter, p);
    run(frames_.size() - 1);
  }
  return parameters_[p];
}

void Expansion::give_parameter(std::uint32_t p, NodeId node) {
  parameters_.resize(meanings_->parameters.size(), no_node);
  parameters_[p] = node;
}

NodeId Expansion::definition(std::uint32_t member) {
  definitions_.resize(meanings_->entry_of.size(), no_node);
  if (definitions_[member] == no_node) {
    const Family& family = meanings_->definition_families[meanings_->family_of[member]];
    call(meanings_->definitions[meanings_->entry_of[member]].value, family.members[member - family.first],
         Target::definition, member);
    run(frames_.size() - 1);
  }
  return definitions_[member];
}

void Expansion::call(const Code& code, Tuple indices, Target target, std::uint32_t member) {
  frames_.push_back({&code, 0, target, member, indices_.size(), loops_.size()});
  indices_.insert(indices_.end(), indices.begin(), indices.end());
  indices_.resize(frame().indices + std::max<std::size_t>(code.slots, indices.size()));
  if (target != Target::nothing) memo(target)[member] = in_progress;
}

void Expansion::run(std::size_t frames) {
  while (frames_.size() > frames) {
    if (frame().at == frame().code->steps.size()) {
      finish();
    } else {
      const Instruction& instruction = frame().code->steps[frame().at];
      ++frame().at;
      step(instruction);
      if (tape_->size() > most_nodes)
        fail(instruction, "the expressions expand to more than 67 million operations; use smaller families");
    }
  }
}

void Expansion::finish() {
  const Frame done = frame();
  indices_.resize(done.indices);
  frames_.pop_back();
  if (done.target == Target::nothing) return;
  NodeId node = pop_node();
  if (done.target == Target::parameter) {
    const std::string& name = meanings_->parameter_names[done.member];
    node = tape_->parameter(name, node, tape_->origin(node));
    if (!std::isfinite(tape_->constant(node)))
      done.code->source->fail(
          0, "the value of " + quoted(name) + " is not a finite number; correct its expression");
  }
  memo(done.target)[done.member] = node;
}

void Expansion::step(const Instruction& instruction) {
  using enum Instruction::Step;
  switch (instruction.step) {
    case apply:
      return this->apply(instruction);
    case differentiate:
      return this->differentiate(instruction);
    case construct:
      return this->construct(instruction);
    case table_file:
      return push_table(instruction);
    case repeat:
      return begin_sum(instruction);
    case repeat_end:
      return end_sum(instruction);
    case parameter:
      return push_parameter(instruction);
    case coordinate:
    case definition:
      return push_member(instruction);
    default:
      return instruction.numeric ? push_numeric(instruction) : push_node(instruction);
  }
}

Origin Expansion::origin(const Instruction& instruction) const {
  return {frames_.back().code->source->id, instruction.offset};
}

double Expansion::pop_number() {
  const double number = numbers_.back();
  numbers_.pop_back();
  return number;
}

NodeId Expansion::pop_node() {
  const NodeId node = nodes_.back();
  nodes_.pop_back();
  return node;
}

void Expansion::push_numeric(const Instruction& instruction) {
  using enum Instruction::Step;
  switch (instruction.step) {
    case literal:
      return numbers_.push_back(instruction.number);
    case pi:
      return numbers_.push_back(tape_->constant(tape_->pi(origin(instruction))));
    case time:
      return numbers_.push_back(t_);
    default:
      return numbers_.push_back(static_cast<double>(indices_[frame().indices + instruction.operand]));
  }
}

void Expansion::push_node(const Instruction& instruction) {
  using enum Instruction::Step;
  const Origin at = origin(instruction);
  switch (instruction.step) {
    case literal: {
      const std::string_view text = frame().code->source->text.text;
      return nodes_.push_back(
          tape_->literal(text.substr(instruction.offset, instruction.operand), instruction.number, at));
    }
    case pi:
      return nodes_.push_back(tape_->pi(at));
    case time:
      return nodes_.push_back(tape_->time(at));
    default: {
      const std::int64_t i = indices_[frame().indices + instruction.operand];
      return nodes_.push_back(tape_->literal(std::to_string(i), static_cast<double>(i), at));
    }
  }
}

void Expansion::apply(const Instruction& instruction) {
  const bool binary = arity(instruction.operation) == 2;
  if (instruction.numeric) {
    const double b = binary ? pop_number() : 0, a = pop_number();
    push_number(instruction, value(instruction.operation, a, b));
  } else {
    const NodeId last = pop_node(), a = binary ? pop_node() : last;
    if (instruction.operation == Operation::power && tape_->is_constant(last) && tape_->constant(last) == 2)
      if (const NodeId squares = squared_length(*tape_, a); squares != no_node)
        return nodes_.push_back(squares);
    const bool of_absolute = instruction.operation == Operation::power && tape_->is_constant(last) &&
                             tape_->constant(last) > 1 && tape_->operation(a) == Operation::abs;
    nodes_.push_back(of_absolute ? absolute_power(*tape_, tape_->a(a), last, origin(instruction))
                                 : tape_->apply(instruction.operation, a, last, origin(instruction)));
  }
}

/// A branch that is not taken may have any value.
void Expansion::push_number(const Instruction& instruction, double number) {
  const bool in_branch = instruction.count == 1;
  if (!std::isfinite(number) && !in_branch)
    fail(instruction,
         "the value of " +
             quoted(instruction.step == Instruction::Step::apply ? symbol(instruction.operation)
                                                                 : std::string_view("if or table")) +
             " is not finite here; correct the expression");
  numbers_.push_back(number);
}

void Expansion::differentiate(const Instruction& instruction) {
  const NodeId node = pop_node();
  if ((tape_->depends(node) & on_velocities) != 0)
    fail(instruction,
         "second derivatives are not allowed; what the \"'\" applies to already contains a velocity");
  nodes_.push_back(derivative_.of(node));
}

void Expansion::push_parameter(const Instruction& instruction) {
  parameters_.resize(meanings_->parameters.size(), no_node);
  if (!ready(Target::parameter, instruction.operand, instruction)) return;
  const NodeId node = parameters_[instruction.operand];
  if (instruction.numeric)
    numbers_.push_back(tape_->constant(node));
  else
    nodes_.push_back(node);
}

bool Expansion::ready(Target target, std::uint32_t member, const Instruction& instruction) {
  const NodeId known = memo(target)[member];
  if (known == in_progress) refuse_cycle(target, member, instruction);
  if (known != no_node) return true;
  --frame().at;  // the step is done again when the callee has finished
  if (target == Target::parameter) {
    call(meanings_->parameters[member], {}, target, member);
  } else {
    const Family& family = meanings_->definition_families[meanings_->family_of[member]];
    call(meanings_->definitions[meanings_->entry_of[member]].value, family.members[member - family.first],
         target, member);
  }
  return false;
}

void Expansion::push_member(const Instruction& instruction) {
  const bool is_coordinate = instruction.step == Instruction::Step::coordinate;
  const auto& families = is_coordinate ? meanings_->coordinate_families : meanings_->definition_families;
  const Family& family = families[instruction.operand];
  if (instruction.number == 3 &&
      (family.members.size() != 3 || family.members.low(0) != 1 || family.members.high(0) != 3))
    fail(instruction, quoted(family.name) + " is no vector, it runs over " + family.name + "[" +
                          (family.members.size() == 0 ? "" : family.members.range()) +
                          "]; a vector has the members 1, 2 and 3");
  std::int64_t tuple[8];
  const std::size_t first = numbers_.size() - instruction.count;
  for (std::size_t k = 0; k < instruction.count; ++k)
    tuple[k] = integer(numbers_[first + k], instruction, "the index");
  const auto member = family.members.find({tuple, instruction.count});
  if (!member) {
    const std::string range = family.members.size() == 0
                                  ? "has no members"
                                  : "runs over " + family.name + "[" + family.members.range() + "]";
    fail(instruction, member_name(family.name, {tuple, instruction.count}) + " does not exist, the family " +
                          range + "; correct the index or the range");
  }
  const std::uint32_t number = family.first + *member;
  if (!is_coordinate) {
    definitions_.resize(meanings_->entry_of.size(), no_node);
    if (!ready(Target::definition, number, instruction)) return;
  }
  numbers_.resize(first);
  nodes_.push_back(is_coordinate ? tape_->coordinate(number, origin(instruction)) : definitions_[number]);
}

std::int64_t Expansion::integer(double number, const Instruction& instruction, const char* what) const {
  if (!(std::abs(number) <= largest_index) || number != std::floor(number))
    fail(instruction, std::string(what) + " " + count_text(number) + " is not an integer; correct it");
  return static_cast<std::int64_t>(number);
}

void Expansion::begin_sum(const Instruction& instruction) {
  const double upper = pop_number(), lower = pop_number();
  const std::int64_t first = integer(lower, instruction, "the bound"),
                     last = integer(upper, instruction, "the bound");
  const double length = std::max(0.0, upper - lower + 1);
  double product =
      length;  // of the lengths of the enclosing sums, where these determine the number of members
  if (loops_.size() == frame().loops) members_of_sum_ = 0;
  if (instruction.count == 1)
    for (std::size_t k = frame().loops; k < loops_.size(); ++k) product *= loops_[k].length;
  members_of_sum_ += length;
  if (std::max(product, members_of_sum_) > most_members)
    fail(instruction,
         "a sum of " + count_text(std::max(product, members_of_sum_)) + " members; at most 1e7 are allowed");
  if (length == 0) {
    if (instruction.numeric)
      numbers_.push_back(0);
    else
      nodes_.push_back(tape_->literal("0", 0, origin(instruction)));
    frame().at += static_cast<std::size_t>(instruction.number);
    return;
  }
  loops_.push_back({frame().at, first, last, instruction.operand, false, 0, 0, length});
  indices_[frame().indices + instruction.operand] = first;
}

void Expansion::end_sum(const Instruction& instruction) {
  Loop& loop = loops_.back();
  if (instruction.numeric) {
    loop.number += pop_number();
  } else {
    const NodeId node = pop_node();
    loop.sum = loop.has_sum ? tape_->apply(Operation::add, loop.sum, node, origin(instruction)) : node;
    loop.has_sum = true;
  }
  if (loop.current < loop.last) {
    indices_[frame().indices + loop.slot] = ++loop.current;
    frame().at = loop.begin;
    return;
  }
  if (instruction.numeric)
    numbers_.push_back(loop.number);
  else
    nodes_.push_back(loop.sum);
  loops_.pop_back();
}

void Expansion::fail(const Instruction& instruction, const std::string& message) const {
  const Frame& here = frames_.back();
  const bool names_its_member = here.target == Target::definition && here.code->slots > 0;
  here.code->source->fail(
      instruction.offset,
      (names_its_member ? "in " + name_of(here.target, here.member) + ": " : "") + message);
}

std::string Expansion::name_of(Target target, std::uint32_t member) const {
  if (target == Target::parameter) return meanings_->parameter_names[member];
  const Family& family = meanings_->definition_families[meanings_->family_of[member]];
  return member_name(family.name, family.members[member - family.first]);
}

void Expansion::refuse_cycle(Target target, std::uint32_t member, const Instruction& instruction) const {
  std::size_t first = frames_.size();
  while (frames_[first - 1].target != target || frames_[first - 1].member != member) --first;
  constexpr std::size_t most_named = 8;
  std::string cycle;
  for (std::size_t k = first - 1; k < frames_.size(); ++k) {
    if (k - (first - 1) == most_named) cycle += "… -> ";
    if (k - (first - 1) >= most_named) continue;
    cycle += name_of(frames_[k].target, frames_[k].member) + " -> ";
  }
  fail(instruction, "a cycle, " + cycle + name_of(target, member) + "; break it");
}

}  // namespace mechanics::expression
