#include "mechanics/branch_edges.hpp"

#include <set>

#include "mechanics/expression/lagrangian_model.hpp"
#include "mechanics/expression/rounded_nodes.hpp"

namespace mechanics {

using namespace expression;

namespace {

/// The texts of what lies on an edge, each once, in the order of evaluation.
class EdgesFound {
 public:
  EdgesFound(const LagrangianModel& model, const State& state, const StateRadii& radii)
      : model_(&model), constants_(rounded_nodes(model.tape)), at_(rounded_state(state, radii)) {}

  /// `forces_from`: the first group whose values alone are used.
  void look_through(const Program& program, std::size_t forces_from) {
    if (program.groups() == 0) return;
    const std::size_t last = program.groups() - 1;
    const ValuesOf<Rounded> x = program.rounded_values(at_, last, constants_);
    const std::vector<bool> used = program.in_use(x, last);
    for (Slot slot = program.begin(); slot < program.end(last); ++slot) {
      if (!used[slot]) continue;
      const auto& i = program[slot];
      if (is_where(i.operation)) {
        if (model_->tape.is_edge(program.node(i.a)) && x[i.a].may_be_zero()) add(program.node(i.a), " = 0");
      } else if (is_branch(i.operation) && (forces_from == 0 || slot < program.end(forces_from - 1))) {
        if ((x[i.a] - x[i.b]).may_be_zero()) add(program.node(slot), ", a tie");
      } else if (is_at_cut(i.operation, x[i.a], x[i.b])) {
        add(program.node(slot), " at its jump");
      }
    }
  }

  std::optional<Warning> warning() const {
    if (text_.empty()) return std::nullopt;
    return Warning{Warning::Kind::undecided,
                   {},
                   "between two branches at this state: " + text_ +
                       ". Derivatives are those of the branch that is taken; move the state to one side if "
                       "the other is meant"};
  }

 private:
  /// atan2(y, x) jumps where y = 0 > x.
  static bool is_at_cut(Operation operation, Rounded y, Rounded x) {
    return operation == Operation::atan2 && y.may_be_zero() && x.value < 0;
  }
  void add(NodeId node, const char* what) {
    constexpr std::size_t most_told = 4;
    const Tape& tape = model_->tape;
    if (tape.operation(node) == Operation::negate && tape.is_edge(node))
      node = tape.a(node);  // sign(x) asks -x too
    if (!told_.insert(node).second) return;
    if (told_.size() == most_told + 1) text_ += ", …";
    if (told_.size() > most_told) return;
    text_ += (text_.empty() ? "" : ", ") + written(tape, node, model_->coordinates) + what;
  }

  const LagrangianModel* model_;
  std::vector<Rounded> constants_;
  RoundedState at_;
  std::set<NodeId> told_;
  std::string text_;
};

}  // namespace

std::optional<Warning> branch_edges(const LagrangianSystem& system, const State& state,
                                    const StateRadii& radii) {
  const LagrangianModel& model = system.model();
  bool may_jump = model.tape.has_branches();
  for (NodeId node = 0; node < model.tape.size() && !may_jump; ++node)
    may_jump = model.tape.operation(node) == Operation::atan2;
  if (!may_jump) return std::nullopt;
  EdgesFound found(model, state, radii);
  found.look_through(model.motion, 1);
  found.look_through(model.contacts, model.contacts.groups());
  return found.warning();
}

}  // namespace mechanics
