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
  void add(NodeId node, const char* what) {
    constexpr std::size_t most_told = 4;
    if (!told_.insert(node).second) return;
    if (told_.size() == most_told + 1) text_ += ", …";
    if (told_.size() > most_told) return;
    text_ += (text_.empty() ? "" : ", ") + written(model_->tape, node, model_->coordinates) + what;
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
  if (!model.tape.has_branches()) return std::nullopt;
  EdgesFound found(model, state, radii);
  found.look_through(model.motion, 1);
  found.look_through(model.contacts, model.contacts.groups());
  return found.warning();
}

}  // namespace mechanics
