#include "mechanics/expression/sweeps.hpp"

#include <algorithm>

namespace mechanics::expression {

template <class Real>
std::vector<PartialsOf<Real>> first_partials(const Program& program, const ValuesOf<Real>& x) {
  std::vector<PartialsOf<Real>> p;
  p.reserve(program.end(0) - program.begin());
  for (Slot slot = program.begin(); slot < program.end(0); ++slot) p.push_back(program.partials(slot, x));
  return p;
}

template <class Real>
ValuesOf<Real> tangents(const Program& program, const std::vector<PartialsOf<Real>>& p,
                        std::span<const Real> v, std::span<const Real> v2) {
  ValuesOf<Real> tangent(program.size());
  std::copy(v.begin(), v.end(), tangent.begin());
  std::copy(v2.begin(), v2.end(), tangent.begin() + static_cast<std::ptrdiff_t>(program.coordinates()));
  tangent[program.time()] = 1;
  for (Slot slot = program.begin(); slot < program.end(0); ++slot) {
    const auto& i = program[slot];
    const PartialsOf<Real>& d = p[slot - program.begin()];
    tangent[slot] = d.a * tangent[i.a] + d.b * tangent[i.b];
  }
  return tangent;
}

template <class Real>
ValuesOf<Real> adjoints(const Program& program, const std::vector<PartialsOf<Real>>& p,
                        const std::vector<std::pair<Slot, double>>& weights) {
  ValuesOf<Real> adjoint(program.size());
  for (const auto& [slot, weight] : weights) adjoint[slot] += weight;
  for (Slot slot = program.end(0); slot-- > program.begin();) {
    const auto& i = program[slot];
    const PartialsOf<Real>& d = p[slot - program.begin()];
    adjoint[i.a] += d.a * adjoint[slot];
    adjoint[i.b] += d.b * adjoint[slot];
  }
  return adjoint;
}

template <class Real>
RatesOf<Real> rates(const Program& program, const ValuesOf<Real>& x, std::span<const Real> v,
                    const Vector* q2, const std::vector<bool>* wanted) {
  RatesOf<Real> r{ValuesOf<Real>(program.size()), {}};
  std::copy(v.begin(), v.end(), r.first.begin());
  r.first[program.time()] = 1;
  if (q2 != nullptr) {
    r.second.resize(program.size());
    std::copy(q2->begin(), q2->end(), r.second.begin());
  }
  for (Slot slot = program.begin(); slot < program.end(0); ++slot) {
    if (wanted != nullptr && !(*wanted)[slot]) continue;
    const auto& i = program[slot];
    const PartialsOf<Real> d = program.partials(slot, x);
    const Real a = r.first[i.a], b = r.first[i.b];
    r.first[slot] = d.a * a + d.b * b;
    if (q2 == nullptr) continue;
    const SecondPartialsOf<Real> dd = program.second_partials(slot, x);
    r.second[slot] =
        d.a * r.second[i.a] + d.b * r.second[i.b] + (dd.aa * a * a + 2.0 * dd.ab * a * b + dd.bb * b * b);
  }
  return r;
}

template <class Real>
const std::vector<Slot>& GradientsOf<Real>::below(Slot slot) {
  constexpr Slot operands_done = Slot{1} << 31U;
  ++request_;
  order_.clear();
  variables_.clear();
  open_.assign(1, slot);
  while (!open_.empty()) {
    const Slot next = open_.back();
    open_.pop_back();
    if ((next & operands_done) != 0) {
      order_.push_back(next & ~operands_done);
      continue;
    }
    if (seen_[next] == request_) continue;
    seen_[next] = request_;
    adjoint_[next] = 0;
    if (!program_->is_computed(next)) {
      if (!program_->is_constant(next)) variables_.push_back(next);
      continue;
    }
    open_.push_back(next | operands_done);
    open_.push_back((*program_)[next].a);
    open_.push_back((*program_)[next].b);
  }
  return order_;
}

template <class Real>
auto GradientsOf<Real>::of(Slot slot, const ValuesOf<Real>& x) -> const Gradient& {
  below(slot);
  adjoint_[slot] = 1;
  for (std::size_t k = order_.size(); k-- > 0;) {
    const auto& i = (*program_)[order_[k]];
    const PartialsOf<Real> d = program_->partials(order_[k], x);
    adjoint_[i.a] += d.a * adjoint_[order_[k]];
    adjoint_[i.b] += d.b * adjoint_[order_[k]];
  }
  std::sort(variables_.begin(), variables_.end());
  gradient_.by_q.clear();
  gradient_.by_t = 0;
  for (const Slot variable : variables_) {
    if (variable == program_->time())
      gradient_.by_t = adjoint_[variable];
    else
      gradient_.by_q.emplace_back(static_cast<Index>(variable), adjoint_[variable]);
  }
  return gradient_;
}

template std::vector<PartialsOf<double>> first_partials(const Program&, const ValuesOf<double>&);
template ValuesOf<double> tangents(const Program&, const std::vector<PartialsOf<double>>&,
                                   std::span<const double>, std::span<const double>);
template ValuesOf<double> adjoints(const Program&, const std::vector<PartialsOf<double>>&,
                                   const std::vector<std::pair<Slot, double>>&);
template RatesOf<double> rates(const Program&, const ValuesOf<double>&, std::span<const double>,
                               const Vector*, const std::vector<bool>*);
template class GradientsOf<double>;
template std::vector<PartialsOf<Rounded>> first_partials(const Program&, const ValuesOf<Rounded>&);
template ValuesOf<Rounded> tangents(const Program&, const std::vector<PartialsOf<Rounded>>&,
                                    std::span<const Rounded>, std::span<const Rounded>);
template ValuesOf<Rounded> adjoints(const Program&, const std::vector<PartialsOf<Rounded>>&,
                                    const std::vector<std::pair<Slot, double>>&);
template RatesOf<Rounded> rates(const Program&, const ValuesOf<Rounded>&, std::span<const Rounded>,
                                const Vector*, const std::vector<bool>*);
template class GradientsOf<Rounded>;

}  // namespace mechanics::expression
