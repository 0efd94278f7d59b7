#include "mechanics/exact_text.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "mechanics/expression/exact_jet.hpp"
#include "mechanics/expression/lagrangian_model.hpp"
#include "mechanics/expression/state_nodes.hpp"

namespace mechanics {

using namespace expression;

namespace {

using convex::ExactRows;
using convex::Fraction;
using convex::Matrix;

std::optional<ExactState> read_state_exactly(const LagrangianModel& model, const StateText& text,
                                             long precision) {
  const StateNodes nodes = state_nodes(model, text);
  const std::size_t n = nodes.q.size();
  ExactState state{{}, std::vector<Number>(n), std::vector<Number>(n)};
  const ExactState nothing;
  ExactEvaluation evaluate(nodes.tape, nothing, precision, JetPart::rates);
  const auto read = [&](NodeId node, Number& to) {
    if (node == no_node) return true;
    const auto& jet = evaluate(node);
    if (jet) to = jet->value;
    return jet.has_value();
  };
  if (!read(nodes.t, state.t)) return std::nullopt;
  for (std::size_t i = 0; i < n; ++i)
    if (!read(nodes.q[i], state.q[i]) || !read(nodes.v[i], state.v[i])) return std::nullopt;
  return state;
}

Number at(const std::vector<Number>& x, std::size_t i) { return x.empty() ? Number{} : x[i]; }

/// A, z, U and s as they come, the middle and the radius of each.
struct Collected {
  std::vector<std::vector<Fraction>> A, U;
  std::vector<Fraction> z, s;
  Matrix A_radius;
  Vector z_radius, s_radius;
  convex::RowMatrix U_radius;
  bool touches = true;  // every contact, as written
};

/// A and z: false where a function cannot be evaluated.
bool collect_motion(const LagrangianModel& model, ExactEvaluation& evaluate, Collected& found) {
  const std::size_t n = model.coordinates.size();
  if (!evaluate(model.kinetic)) return false;
  const ExactJet kinetic = *evaluate(model.kinetic);
  ExactJet potential;
  if (model.potential != no_node) {
    if (!evaluate(model.potential)) return false;
    potential = *evaluate(model.potential);
  }
  const auto size = static_cast<Index>(n);
  found.A.assign(n, std::vector<Fraction>(n));
  found.A_radius = Matrix::Zero(size, size);
  found.z_radius = Vector::Zero(size);
  for (std::size_t i = 0; i < n; ++i) {
    const auto row = static_cast<Index>(i);
    for (std::size_t j = 0; j <= i; ++j) {
      const Number entry = at(kinetic.by_vv, i * n + j);
      const auto column = static_cast<Index>(j);
      found.A[i][j] = found.A[j][i] = entry.middle();
      found.A_radius(row, column) = found.A_radius(column, row) = entry.radius();
    }
    Number z = at(kinetic.by_q, i) - at(potential.by_q, i) - at(kinetic.along_by_v, i);
    if (i < model.forces.size() && model.forces[i] != no_node) {
      const auto& force = evaluate(model.forces[i]);
      if (!force) return false;
      z = z + force->value;
    }
    found.z.push_back(z.middle());
    found.z_radius[row] = z.radius();
  }
  return true;
}

/// What the signs of f and df/dt say.
ContactVerdict verdict(const ExactJet& f, bool two_sided) {
  const auto value = f.value.sign(), rate = f.along.sign();
  if (value && rate && *value == 0 && *rate == 0) return ContactVerdict::touches;
  if (two_sided)
    return (value && *value != 0) || (rate && *rate != 0) ? ContactVerdict::violated
                                                          : ContactVerdict::undecided;
  if (value && *value > 0) return ContactVerdict::apart;
  if (value && *value < 0) return ContactVerdict::violated;
  if (value && rate) return *rate > 0 ? ContactVerdict::apart : ContactVerdict::violated;
  return ContactVerdict::undecided;
}

/// U and s.
bool collect_contacts(const LagrangianModel& model, const std::vector<Index>& contacts,
                      ExactEvaluation& evaluate, Collected& found) {
  const std::size_t n = model.coordinates.size();
  const auto m = static_cast<Index>(contacts.size());
  found.U_radius = convex::RowMatrix::Zero(m, static_cast<Index>(n));
  found.s_radius = Vector::Zero(m);
  for (Index k = 0; k < m; ++k) {
    const auto a = static_cast<std::size_t>(contacts[static_cast<std::size_t>(k)]);
    const auto& f = evaluate(model.f[a]);
    if (!f) return false;
    found.touches = found.touches && verdict(*f, model.constraints[a].two_sided) == ContactVerdict::touches;
    std::vector<Fraction> row(n);
    for (std::size_t i = 0; i < n; ++i) {
      const Number u = at(f->by_q, i);
      row[i] = u.middle();
      found.U_radius(k, static_cast<Index>(i)) = u.radius();
    }
    found.U.push_back(std::move(row));
    found.s.push_back((-f->along_twice).middle());
    found.s_radius[k] = f->along_twice.radius();
  }
  return true;
}

convex::ExactRows exact_rows_of(const std::vector<std::vector<Fraction>>& rows) {
  convex::ExactRows found;
  for (const auto& row : rows) found.push_back(convex::exact_vector(row));
  return found;
}

/// One attempt at a precision; 0: in fractions alone.
std::optional<TextProblem> attempt(const LagrangianSystem& system, const StateText& text,
                                   const std::vector<Index>& contacts, long precision) {
  const LagrangianModel& model = system.model();
  const auto state = read_state_exactly(model, text, precision);
  if (!state) return std::nullopt;
  ExactEvaluation evaluate(model.tape, *state, precision);
  Collected numbers;
  if (!collect_motion(model, evaluate, numbers) || !collect_contacts(model, contacts, evaluate, numbers))
    return std::nullopt;
  TextProblem found;
  std::vector<Index> two_sided;
  for (std::size_t k = 0; k < contacts.size(); ++k)
    if (model.constraints[static_cast<std::size_t>(contacts[k])].two_sided)
      two_sided.push_back(static_cast<Index>(k));
  found.is_exact = numbers.A_radius.isZero(0) && numbers.z_radius.isZero(0) && numbers.U_radius.isZero(0) &&
                   numbers.s_radius.isZero(0);
  found.contacts_touch = numbers.touches;
  found.precision = precision;
  convex::UncertainProblem& problem = found.problem;
  problem.middle =
      convex::exact_problem(exact_rows_of(numbers.A), convex::exact_vector(numbers.z),
                            exact_rows_of(numbers.U), convex::exact_vector(numbers.s), two_sided);
  problem.A = std::move(numbers.A_radius);
  problem.z = std::move(numbers.z_radius);
  problem.U = std::move(numbers.U_radius);
  problem.s = std::move(numbers.s_radius);
  return found;
}

}  // namespace

namespace {

/// The nearest double, and how far the number may be from it.
Rounded rounded(const Number& x) {
  if (x.sign() == 0) return 0.0;
  const Fraction middle = x.middle();
  const double number = convex::nearest_double(middle);
  const bool is_double = std::isfinite(number) && convex::fraction(number) == middle;
  return {number, widened(x.radius() + (is_double ? 0 : std::max(std::abs(number) * 0x1p-53, lost_below)))};
}

/// Digits that are asked of each of these contacts, and of all.
double most_telling(const LagrangianModel& model, const std::vector<Index>& contacts) {
  const double numbers = static_cast<double>(model.coordinates.size() + contacts.size());
  return std::min(most_telling_precision, most_telling_bits / numbers);
}

/// The verdicts that are still open, at a precision; and the least one that would tell of those that are open
/// and algebraic, 0 when there are none.
long decide_contacts(const LagrangianModel& model, const StateText& text, const std::vector<Index>& wanted,
                     long precision, std::vector<ContactVerdict>& found) {
  const auto state = read_state_exactly(model, text, precision);
  if (!state) return 0;
  ExactEvaluation evaluate(model.tape, *state, precision, JetPart::rates);
  const double most = most_telling(model, wanted);
  double telling = 0;
  for (const Index a : wanted) {
    const auto k = static_cast<std::size_t>(a);
    if (found[k] != ContactVerdict::undecided) continue;
    const auto& f = evaluate(model.f[k]);
    if (!f) continue;
    found[k] = verdict(*f, model.constraints[k].two_sided);
    if (found[k] != ContactVerdict::undecided) continue;
    for (const Number* x : {&f->value, &f->along})
      if (const auto needed = x->telling_precision(); needed && *needed <= most)
        telling = std::max(telling, *needed);
  }
  return static_cast<long>(std::ceil(telling));
}

}  // namespace

std::vector<ContactVerdict> contact_verdicts(const LagrangianSystem& system, const StateText& text,
                                             const std::vector<Index>& wanted) {
  const LagrangianModel& model = system.model();
  std::vector<ContactVerdict> found(model.f.size(), ContactVerdict::undecided);
  long telling = 0;
  for (const long precision : {0L, first_precision, last_precision})
    if (precision == 0 || Ball::why_none().empty())
      telling = decide_contacts(model, text, wanted, precision, found);
  if (telling > last_precision) decide_contacts(model, text, wanted, telling, found);
  return found;
}

std::vector<KnownNode> numbers_as_written(const LagrangianSystem& system, const StateText& text,
                                          const std::vector<NodeId>& nodes) {
  const LagrangianModel& model = system.model();
  std::vector<KnownNode> found;
  std::vector<bool> is_found(nodes.size());
  for (const long precision : {0L, first_precision}) {
    if (precision != 0 && (found.size() == nodes.size() || !Ball::why_none().empty())) break;
    const auto state = read_state_exactly(model, text, precision);
    if (!state) continue;
    ExactEvaluation evaluate(model.tape, *state, precision, JetPart::rates);
    for (std::size_t k = 0; k < nodes.size(); ++k) {
      if (is_found[k]) continue;
      const auto& jet = evaluate(nodes[k]);
      if (!jet || !jet->value.is_finite()) continue;
      is_found[k] = true;
      found.push_back({nodes[k], rounded(jet->value)});
    }
  }
  std::sort(found.begin(), found.end(), [](const auto& a, const auto& b) { return a.node < b.node; });
  return found;
}

namespace {

/// Gradients not found 0 yet, at a precision; and the least one that would tell, as in `decide_contacts`.
long find_vanishing(const LagrangianModel& model, const StateText& text, const std::vector<Index>& contacts,
                    long precision, std::vector<std::optional<Rounded>>& found) {
  const auto state = read_state_exactly(model, text, precision);
  if (!state) return 0;
  ExactEvaluation evaluate(model.tape, *state, precision);
  const double most = most_telling(model, contacts);
  double telling = 0;
  for (std::size_t k = 0; k < contacts.size(); ++k) {
    if (found[k]) continue;
    const auto& f = evaluate(model.f[static_cast<std::size_t>(contacts[k])]);
    if (!f || !f->along_twice.is_finite()) continue;
    const auto& u = f->by_q;
    if (std::all_of(u.begin(), u.end(), [](const Number& entry) { return entry.sign() == 0; }))
      found[k] = rounded(-f->along_twice);
    if (found[k] ||
        std::any_of(u.begin(), u.end(), [](const Number& entry) { return entry.sign().value_or(0) != 0; }))
      continue;
    for (const Number& entry : u)
      if (const auto needed = entry.telling_precision(); needed && *needed <= most)
        telling = std::max(telling, *needed);
  }
  return static_cast<long>(std::ceil(telling));
}

}  // namespace

std::vector<std::optional<Rounded>> where_gradients_vanish(const LagrangianSystem& system,
                                                           const StateText& text,
                                                           const std::vector<Index>& contacts) {
  std::vector<std::optional<Rounded>> found(contacts.size());
  find_vanishing(system.model(), text, contacts, 0, found);
  if (!Ball::why_none().empty()) return found;
  const long telling = find_vanishing(system.model(), text, contacts, first_precision, found);
  if (telling > first_precision) find_vanishing(system.model(), text, contacts, telling, found);
  return found;
}

std::optional<convex::ExactProblem> fractions_from_text(const LagrangianSystem& system, const StateText& text,
                                                        const std::vector<Index>& contacts) {
  if (system.model().coordinates.size() > most_exact_coordinates) return std::nullopt;
  std::optional<TextProblem> found = attempt(system, text, contacts, 0);
  if (!found || !found->contacts_touch) return std::nullopt;
  return std::move(found->problem.middle);
}

std::optional<TextProblem> problem_from_text(const LagrangianSystem& system, const StateText& text,
                                             const std::vector<Index>& contacts) {
  if (system.model().coordinates.size() > most_exact_coordinates) return std::nullopt;
  std::optional<TextProblem> found = attempt(system, text, contacts, 0);
  if (!found && Ball::why_none().empty()) {
    for (const long precision : {first_precision, last_precision}) {
      try {
        found = attempt(system, text, contacts, precision);
      } catch (const convex::InvalidInput&) {
        found.reset();  // the middle of an A that is too wide need not be positive definite
      }
      if (found) break;
    }
  }
  if (!found) return found;
  std::vector<Index> all(system.constraints().size());
  std::iota(all.begin(), all.end(), Index{0});
  found->contacts = contact_verdicts(system, text, all);
  return found;
}

}  // namespace mechanics
