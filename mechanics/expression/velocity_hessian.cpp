#include "mechanics/expression/velocity_hessian.hpp"

#include <algorithm>

namespace mechanics::expression {
namespace {

constexpr int lanes_at_once = 4;  // two SSE2 registers, one AVX2 register

}  // namespace

VelocityHessian::VelocityHessian(const Tape& tape, const Program& program, const Degrees& degrees)
    : n_(program.coordinates()) {
  const auto depends = [&](Slot slot) {
    if (slot >= program.velocity(0) && slot < program.time()) return true;
    const NodeId node = program.node(slot);
    return node < degrees.of.size() && degrees.of[node] > 0;
  };
  std::vector<Slot> place(program.size(), 0);
  for (std::size_t i = 0; i < n_; ++i) place[program.velocity(i)] = static_cast<Slot>(1 + i);
  for (Slot slot = program.begin(); slot < program.end(0); ++slot) {
    if (!depends(slot)) continue;
    const auto& instruction = program[slot];
    const bool a = depends(instruction.a), b = arity(instruction.operation) == 2 && depends(instruction.b);
    Term term{slot, a ? place[instruction.a] : place[instruction.b], a && b ? place[instruction.b] : 0, !a};
    const bool is_square =
        instruction.operation == Operation::power && tape.constant(tape.b(program.node(slot))) == 2;
    if (is_square) term.b = term.a;
    place[slot] = static_cast<Slot>(n_ + 1 + terms_.size());
    terms_.push_back(term);
  }
  find_pattern(program, degrees);
}

void VelocityHessian::find_pattern(const Program& program, const Degrees& degrees) {
  const auto is_product = [&](const Term& term) {
    const Operation operation = program[term.slot].operation;
    return term.b != 0 && (operation == Operation::multiply || operation == Operation::power);
  };
  // A linear term's variables are listed if it is a factor or is used twice; otherwise its one user looks
  // through it.
  const Slot first_term = static_cast<Slot>(n_ + 1);
  std::vector<bool> below_product(first_term + terms_.size());
  std::vector<std::uint8_t> uses(first_term + terms_.size());
  for (std::size_t k = terms_.size(); k-- > 0;) {
    const Term& term = terms_[k];
    const bool product = is_product(term);
    if (!product && !below_product[first_term + k]) continue;
    if (degrees.of[program.node(term.slot)] == 2 && !product) continue;
    for (const Slot operand : {term.a, term.b}) {
      below_product[operand] = true;
      uses[operand] = static_cast<std::uint8_t>(product ? 2 : std::min(2, uses[operand] + 1));
    }
  }
  Sparsity sparsity(static_cast<std::uint32_t>(n_));
  std::vector<Sparsity::Set> sets(first_term + terms_.size());
  for (std::size_t i = 0; i < n_; ++i) sets[1 + i] = sparsity.single(static_cast<std::uint32_t>(i));
  std::vector<Slot> open;
  std::vector<std::uint32_t> variables;
  for (std::size_t k = 0; k < terms_.size(); ++k) {
    const Term& term = terms_[k];
    if (is_product(term)) {
      sparsity.product(sets[term.a], sets[term.b]);
      continue;
    }
    if (!below_product[first_term + k] || uses[first_term + k] < 2) continue;
    variables.clear();
    open.assign({term.a, term.b});
    while (!open.empty()) {
      const Slot operand = open.back();
      open.pop_back();
      if (operand == 0) continue;
      if (operand < first_term || uses[operand] >= 2) {
        sparsity.append(sets[operand], variables);
      } else {
        open.push_back(terms_[operand - first_term].a);
        open.push_back(terms_[operand - first_term].b);
      }
    }
    sets[first_term + k] = sparsity.set(std::move(variables));
  }
  lay_out(sparsity.pattern());
}

void VelocityHessian::lay_out(const Pattern& pattern) {
  colouring_ = colouring(pattern);
  outer_.push_back(0);
  for (const auto& column : pattern) {
    inner_.insert(inner_.end(), column.begin(), column.end());
    outer_.push_back(static_cast<int>(inner_.size()));
  }
  entries_.resize(colouring_.seeds.size());
  std::vector<std::uint32_t> next(
      pattern.size());  // by column: where its next entry of the upper triangle is
  for (std::size_t j = 0; j < pattern.size(); ++j) next[j] = static_cast<std::uint32_t>(outer_[j]);
  for (std::uint32_t j = 0; j < pattern.size(); ++j)
    for (auto at = static_cast<std::uint32_t>(outer_[j]); at < static_cast<std::uint32_t>(outer_[j + 1]);
         ++at) {
      const auto i = static_cast<std::uint32_t>(inner_[at]);
      if (i < j) continue;
      const std::uint32_t mirror =
          next[i]++;  // the rows of column i come in increasing order, and so do the j
      const bool from_row = colouring_.alone[i] && !colouring_.alone[j];
      entries_[colouring_.colour[from_row ? i : j]].push_back({from_row ? j : i, at, mirror});
    }
}

template <class Real>
auto VelocityHessian::coefficients(const Program& program, const ValuesOf<Real>& x,
                                   const ValuesOf<Real>& adjoint) const -> std::vector<Coefficients<Real>> {
  std::vector<Coefficients<Real>> result;
  result.reserve(terms_.size());
  for (const Term& term : terms_) {
    const auto& instruction = program[term.slot];
    const Real a = x[instruction.a], b = x[instruction.b];
    if (program.has_branches() && is_unused(x[term.slot])) {
      result.push_back({});
      continue;
    }
    switch (instruction.operation) {
      case Operation::where_not_negative:
      case Operation::where_negative:
        result.push_back({program.partials(term.slot, x).b, 0, 0});
        break;
      case Operation::negate:
        result.push_back({-1, 0, 0});
        break;
      case Operation::add:
        result.push_back({1, 1, 0});
        break;
      case Operation::subtract:
        result.push_back({term.second ? -1.0 : 1.0, -1, 0});
        break;
      case Operation::divide:
        result.push_back({1.0 / b, 0, 0});
        break;
      case Operation::multiply:
        if (term.b == 0)
          result.push_back({term.second ? a : b, 0, 0});
        else
          result.push_back({b, a, adjoint[term.slot]});
        break;
      default:  // a power, 1 or 2
        if (term.b == 0)
          result.push_back({1, 0, 0});
        else
          result.push_back({a, a, adjoint[term.slot]});
    }
  }
  return result;
}

namespace {

template <int lanes>
using Several = Eigen::Array<double, lanes, 1>;
template <int lanes>
double& lane(Several<lanes>& several, std::size_t k) {
  return several[static_cast<Index>(k)];
}
Rounded& lane(Rounded& one, std::size_t) { return one; }

template <int lanes>
Several<lanes> zero(const Several<lanes>*) {
  return Several<lanes>::Zero();
}
Rounded zero(const Rounded*) { return {}; }

}  // namespace

template <class Lanes, class Real>
void VelocityHessian::sweep(const std::vector<Coefficients<Real>>& c, Bundle<Lanes>& tangent,
                            Bundle<Lanes>& rate) const {
  const std::size_t first_term = n_ + 1;
  for (std::size_t k = 0; k < terms_.size(); ++k)
    tangent[first_term + k] = c[k].a * tangent[terms_[k].a] + c[k].b * tangent[terms_[k].b];
  for (std::size_t k = terms_.size(); k-- > 0;) {
    const Slot a = terms_[k].a, b = terms_[k].b;
    const Lanes mine = rate[first_term + k];
    rate[a] += c[k].a * mine + c[k].mixed * tangent[b];
    if (b != 0) rate[b] += c[k].b * mine + c[k].mixed * tangent[a];
  }
}

template <int lanes, class Lanes, class Real>
std::vector<Real> VelocityHessian::entries(const std::vector<Coefficients<Real>>& c) const {
  std::vector<Real> values(inner_.size());
  const Lanes nothing = zero(static_cast<const Lanes*>(nullptr));
  Bundle<Lanes> tangent(n_ + 1 + terms_.size(), nothing), rate = tangent;
  for (std::size_t colour = 0; colour < colours(); colour += lanes) {
    const std::size_t end = std::min(colour + lanes, colours());
    std::fill(tangent.begin(), tangent.begin() + static_cast<std::ptrdiff_t>(n_ + 1), nothing);
    std::fill(rate.begin(), rate.end(), nothing);
    for (std::size_t k = colour; k < end; ++k)
      for (const std::uint32_t j : colouring_.seeds[k]) lane(tangent[1 + j], k - colour) = 1;
    sweep(c, tangent, rate);
    for (std::size_t k = colour; k < end; ++k)
      for (const Entry& entry : entries_[k])
        values[entry.at] = values[entry.mirror] = lane(rate[1 + entry.row], k - colour);
  }
  return values;
}

convex::SparseMatrix VelocityHessian::with_entries(const std::vector<double>& values) const {
  const auto n = static_cast<Index>(n_);
  return Eigen::Map<const convex::SparseMatrix>(n, n, static_cast<Index>(inner_.size()), outer_.data(),
                                                inner_.data(), values.data());
}

convex::SparseMatrix VelocityHessian::matrix(const Program& program, const Values& x,
                                             const Values& adjoint) const {
  const std::vector<Coefficients<double>> c = coefficients(program, x, adjoint);
  return with_entries(colours() == 1 ? entries<1, Several<1>>(c)
                                     : entries<lanes_at_once, Several<lanes_at_once>>(c));
}

convex::SparseMatrix VelocityHessian::matrix_radii(const Program& program, const ValuesOf<Rounded>& x,
                                                   const ValuesOf<Rounded>& adjoint) const {
  std::vector<double> radii;
  for (const Rounded& entry : entries<1, Rounded>(coefficients(program, x, adjoint)))
    radii.push_back(entry.radius);
  return with_entries(radii);
}

template <class Real>
std::vector<Real> VelocityHessian::gradient_rate(const Program& program, const ValuesOf<Real>& x,
                                                 const ValuesOf<Real>& adjoint,
                                                 const ValuesOf<Real>& tangent) const {
  const std::size_t first_term = n_ + 1;
  std::vector<Real> rate(first_term + terms_.size());
  for (std::size_t k = terms_.size(); k-- > 0;) {
    const Term& term = terms_[k];
    const auto& instruction = program[term.slot];
    if (program.has_branches() && is_unused(x[term.slot])) continue;
    const Real mine = rate[first_term + k], above = adjoint[term.slot];
    const Real a = x[instruction.a], b = x[instruction.b], da = tangent[instruction.a],
               db = tangent[instruction.b];
    switch (instruction.operation) {
      case Operation::where_not_negative:
      case Operation::where_negative:
        rate[term.a] += mine * program.partials(term.slot, x).b;
        break;
      case Operation::negate:
        rate[term.a] -= mine;
        break;
      case Operation::add:
        rate[term.a] += mine;
        rate[term.b] += mine;
        break;
      case Operation::subtract:
        rate[term.a] += term.second ? -mine : mine;
        rate[term.b] -= mine;
        break;
      case Operation::divide:
        rate[term.a] += mine / b - (instruction.active.b ? above / b / b * db : Real(0));
        break;
      case Operation::multiply:
        if (term.b != 0) rate[term.b] += mine * a + above * da;
        rate[term.a] += term.second ? mine * a + above * da : mine * b + above * db;
        break;
      default:
        rate[term.a] += term.b == 0 ? mine : 2.0 * (mine * a + above * da);
    }
  }
  return {rate.begin() + 1, rate.begin() + 1 + static_cast<std::ptrdiff_t>(n_)};
}

template std::vector<double> VelocityHessian::gradient_rate(const Program&, const Values&, const Values&,
                                                            const Values&) const;
template std::vector<Rounded> VelocityHessian::gradient_rate(const Program&, const ValuesOf<Rounded>&,
                                                             const ValuesOf<Rounded>&,
                                                             const ValuesOf<Rounded>&) const;

}  // namespace mechanics::expression
