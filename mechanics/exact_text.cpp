#include "mechanics/exact_text.hpp"

#include <algorithm>

#include "mechanics/expression/assignment.hpp"
#include "mechanics/expression/exact_jet.hpp"
#include "mechanics/expression/lagrangian_model.hpp"

namespace mechanics {

using namespace expression;

namespace {

using convex::ExactRows;
using convex::Fraction;

/// The values of a table of the state; false where one is no fraction. What is missing stays.
bool read_values(const LagrangianModel& model, const std::vector<NamedText>& texts, const std::string& table,
                 const Fraction& t, std::vector<Fraction>& values) {
  Sources sources;
  Tape tape;
  Expansion expansion(model.meanings, tape);
  const auto& families = model.meanings.coordinate_families;
  // As nodes, not as numbers; what may stand in a state has been checked when the doubles were read.
  const Assignment given = assign_to_coordinates(texts, table, table + " of ", model.names, families,
                                                 Vocabulary::system, sources, expansion);
  const ExactState instant{t, {}, {}};
  for (const Family& family : families)
    for (std::uint32_t member = 0; member < family.members.size(); ++member) {
      const std::uint32_t entry = given.entry_of[family.first + member];
      if (entry == no_entry) continue;
      const NodeId node = expansion.node(given.entries[entry].value, family.members[member]);
      ExactEvaluation evaluate(tape, instant);
      const auto& jet = evaluate(node);
      if (!jet) return false;
      values[family.first + member] = jet->value;
    }
  return true;
}

std::optional<ExactState> read_state_exactly(const LagrangianModel& model, const StateText& text) {
  const std::size_t n = model.coordinates.size();
  ExactState state{{}, std::vector<Fraction>(n), std::vector<Fraction>(n)};
  if (text.t) {
    Sources sources;
    Tape tape;
    Expansion expansion(model.meanings, tape);
    const Source& source = sources.add(*text.t, "t of the state");
    const NodeId node = expansion.node(parse_expression(source, {&model.names, Vocabulary::system, {}}), {});
    const ExactState nothing;
    ExactEvaluation evaluate(tape, nothing);
    const auto& jet = evaluate(node);
    if (!jet) return std::nullopt;
    state.t = jet->value;
  }
  if (!read_values(model, text.position, "position", state.t, state.q) ||
      !read_values(model, text.velocity, "velocity", state.t, state.v))
    return std::nullopt;
  return state;
}

Fraction at(const std::vector<Fraction>& x, std::size_t i) { return x.empty() ? Fraction{} : x[i]; }

}  // namespace

std::optional<ExactTextProblem> exact_from_text(const LagrangianSystem& system, const StateText& text,
                                                const std::vector<Index>& contacts) {
  const LagrangianModel& model = system.model();
  const std::size_t n = model.coordinates.size();
  if (n > most_exact_coordinates) return std::nullopt;
  const auto state = read_state_exactly(model, text);
  if (!state) return std::nullopt;
  ExactEvaluation evaluate(model.tape, *state);

  if (!evaluate(model.kinetic)) return std::nullopt;
  const ExactJet kinetic = *evaluate(model.kinetic);
  ExactJet potential;
  if (model.potential != no_node) {
    if (!evaluate(model.potential)) return std::nullopt;
    potential = *evaluate(model.potential);
  }
  ExactRows A;
  std::vector<Fraction> z(n);
  for (std::size_t i = 0; i < n; ++i) {
    std::vector<Fraction> row(n);
    for (std::size_t j = 0; j < n; ++j) row[j] = at(kinetic.by_vv, i * n + j);
    A.push_back(convex::exact_vector(row));
    z[i] = at(kinetic.by_q, i) - at(potential.by_q, i) - at(kinetic.along_by_v, i);
    if (i >= model.forces.size() || model.forces[i] == no_node) continue;
    const auto& force = evaluate(model.forces[i]);
    if (!force) return std::nullopt;
    z[i] = z[i] + force->value;
  }

  ExactTextProblem found;
  ExactRows U;
  std::vector<Fraction> s;
  std::vector<Index> two_sided;
  for (std::size_t k = 0; k < contacts.size(); ++k) {
    const auto a = static_cast<std::size_t>(contacts[k]);
    const auto& f = evaluate(model.f[a]);
    if (!f) return std::nullopt;
    found.contacts_hold = found.contacts_hold && convex::sign(f->value) == 0 && convex::sign(f->along) == 0;
    std::vector<Fraction> row(n);
    for (std::size_t i = 0; i < n; ++i) row[i] = at(f->by_q, i);
    U.push_back(convex::exact_vector(row));
    s.push_back(-f->along_twice);
    if (model.constraints[a].two_sided) two_sided.push_back(static_cast<Index>(k));
  }
  found.problem = convex::exact_problem(A, convex::exact_vector(z), U, convex::exact_vector(s), two_sided);
  return found;
}

}  // namespace mechanics
