#include <cmath>

#include "cli/report/explanation.hpp"
#include "cli/report/readable_numbers.hpp"
#include "cli/report/text_table.hpp"
#include "mechanics/lagrangian_system.hpp"

namespace cli::inline reports {
namespace {

using convex::Index;
using convex::Vector;
using mechanics::LagrangianText;
using mechanics::State;

/// The right side of Lagrange's equations, term by term: n each.
struct Terms {
  Vector forces, potential, velocities, frame;
};

Vector right_side(const LagrangianText& text, const State& state) {
  return mechanics::lagrangian_system(text)->inertia(state).z;
}

/// Each term is what z gains by it; T alone gives what the velocities and the moving frame add.
Terms terms_of(const LagrangianText& text, const State& state) {
  LagrangianText kinetic = text;
  kinetic.potential.reset();
  kinetic.forces.clear();
  kinetic.constraints.clear();
  State at_rest = state;
  at_rest.v.setZero();
  const Vector moving = right_side(kinetic, state), frame = right_side(kinetic, at_rest);
  Terms terms{Vector::Zero(state.q.size()), Vector::Zero(state.q.size()), moving - frame, frame};
  if (text.potential) {
    LagrangianText with = kinetic;
    with.potential = text.potential;
    terms.potential = right_side(with, state) - moving;
  }
  if (!text.forces.empty()) {
    LagrangianText with = kinetic;
    with.forces = text.forces;
    terms.forces = right_side(with, state) - moving;
  }
  for (Index i = 0; i < state.q.size(); ++i) {
    const double scale =
        std::abs(moving[i]) + std::abs(frame[i]) + std::abs(terms.forces[i]) + std::abs(terms.potential[i]);
    for (Vector* term : {&terms.forces, &terms.potential, &terms.velocities, &terms.frame})
      (*term)[i] = without_rounding((*term)[i], scale);
  }
  return terms;
}

/// p = ∂T/∂q' = A q' + b, b from T at the velocities ±1 of each coordinate alone (T is quadratic).
Vector momenta(const Scene& scene) {
  Vector p = scene.problem.A.multiply(scene.state.v);
  State one = scene.state;
  for (Index i = 0; i < p.size(); ++i) {
    one.v.setZero();
    one.v[i] = 1;
    const double forth = scene.system->kinetic_energy(one);
    one.v[i] = -1;
    p[i] += (forth - scene.system->kinetic_energy(one)) / 2;
  }
  return p;
}

Math quantity(const std::string& letter, const std::string& expression) {
  return {letter + " = " + expression, letter + " = " + expression_latex(expression)};
}

}  // namespace

void explain_mechanism(Document& document, const SolvedScene& solved, const SystemProblem& text) {
  const Scene& scene = solved.scene;
  auto& blocks = document.blocks;
  blocks.emplace_back(Heading{"Kinetic energy and momenta"});
  blocks.emplace_back(Formula{quantity("T", text.system.kinetic.text)});
  if (text.system.potential) blocks.emplace_back(Formula{quantity("V", text.system.potential->text)});
  for (const mechanics::NamedText& force : text.system.forces) {
    const std::string name = force.name.text;
    const Math of = indexed("Q", "Q", name);
    blocks.emplace_back(Formula{
        Math{of.plain + " = " + force.value.text, of.latex + " = " + expression_latex(force.value.text)}});
  }
  blocks.emplace_back(
      Paragraph{{"At ", Math{"t = " + number_text(scene.state.t), "t = " + number_math(scene.state.t).latex},
                 ", with the positions and velocities of the table, T = ",
                 number_math(scene.system->kinetic_energy(scene.state)), ". The momenta are ",
                 Math{"p = ∂T/∂q'", "p = \\partial T/\\partial \\dot q"}, "."}});
  const auto shown = std::min(static_cast<Index>(most_rows), scene.problem.dimension());
  const Vector p = momenta(scene);
  const Terms terms = terms_of(text.system, scene.state);
  Table states{{{"coordinate"}, {Math{"q", "q"}}, {Math{"q'", "\\dot q"}}, {Math{"p", "p"}}}, {}};
  for (Index i = 0; i < shown; ++i)
    states.rows.push_back({{Name{scene.coordinates[static_cast<std::size_t>(i)]}},
                           {number_math(scene.state.q[i])},
                           {number_math(scene.state.v[i])},
                           {number_math(p[i])}});
  blocks.emplace_back(std::move(states));

  blocks.emplace_back(Heading{"What z gathers"});
  blocks.emplace_back(Paragraph{
      {"Lagrange's equations read ",
       Math{"A q'' = z + Σ lambda_a u_a", "A\\ddot q = z + \\sum_a \\lambda_a u_a"},
       " (equations (4) to (8) of the paper). All that does not depend on the accelerations and is no "
       "reaction is z: the forces Q, the potential, what the velocities make of T, and what T's own "
       "dependence on time does."}});
  Table gathered{{{"coordinate"},
                  {Math{"Q", "Q"}},
                  {Math{"-∂V/∂q", "-\\partial V/\\partial q"}},
                  {"velocities"},
                  {"moving frame"},
                  {Math{"z", "z"}}},
                 {}};
  for (Index i = 0; i < shown; ++i)
    gathered.rows.push_back({{Name{scene.coordinates[static_cast<std::size_t>(i)]}},
                             {number_math(terms.forces[i])},
                             {number_math(terms.potential[i])},
                             {number_math(terms.velocities[i])},
                             {number_math(terms.frame[i])},
                             {number_math(scene.problem.z[i])}});
  blocks.emplace_back(std::move(gathered));
  if (shown < scene.problem.dimension())
    blocks.emplace_back(Paragraph{
        {std::to_string(scene.problem.dimension() - shown) + " more coordinates are left out here."}});
}

}  // namespace cli::inline reports
