#include "mechanics/expression/sweeps.hpp"

#include <algorithm>

namespace mechanics::expression {

std::vector<Partials> first_partials(const Program& program, const Values& x) {
  std::vector<Partials> p;
  p.reserve(program.end(0) - program.begin());
  for (Slot slot = program.begin(); slot < program.end(0); ++slot) p.push_back(program.partials(slot, x));
  return p;
}

Values tangents(const Program& program, const std::vector<Partials>& p, const Vector& v) {
  Values tangent(program.size());
  std::copy(v.begin(), v.end(), tangent.begin());
  tangent[program.time()] = 1;
  for (Slot slot = program.begin(); slot < program.end(0); ++slot) {
    const auto& i = program[slot];
    const Partials& d = p[slot - program.begin()];
    tangent[slot] = d.a * tangent[i.a] + d.b * tangent[i.b];
  }
  return tangent;
}

Values adjoints(const Program& program, const std::vector<Partials>& p,
                const std::vector<std::pair<Slot, double>>& weights) {
  Values adjoint(program.size());
  for (const auto& [slot, weight] : weights) adjoint[slot] += weight;
  for (Slot slot = program.end(0); slot-- > program.begin();) {
    const auto& i = program[slot];
    const Partials& d = p[slot - program.begin()];
    adjoint[i.a] += d.a * adjoint[slot];
    adjoint[i.b] += d.b * adjoint[slot];
  }
  return adjoint;
}

Rates rates(const Program& program, const Values& x, const Vector& v, const Vector* q2,
            const std::vector<bool>* wanted) {
  Rates r{Values(program.size()), {}};
  std::copy(v.begin(), v.end(), r.first.begin());
  r.first[program.time()] = 1;
  if (q2 != nullptr) {
    r.second.resize(program.size());
    std::copy(q2->begin(), q2->end(), r.second.begin());
  }
  for (Slot slot = program.begin(); slot < program.end(0); ++slot) {
    if (wanted != nullptr && !(*wanted)[slot]) continue;
    const auto& i = program[slot];
    const Partials d = program.partials(slot, x);
    const double a = r.first[i.a], b = r.first[i.b];
    r.first[slot] = d.a * a + d.b * b;
    if (q2 == nullptr) continue;
    const SecondPartials dd = program.second_partials(slot, x);
    r.second[slot] =
        d.a * r.second[i.a] + d.b * r.second[i.b] + (dd.aa * a * a + 2 * dd.ab * a * b + dd.bb * b * b);
  }
  return r;
}

const std::vector<Slot>& Gradients::below(Slot slot) {
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

const Gradients::Gradient& Gradients::of(Slot slot, const Values& x) {
  below(slot);
  adjoint_[slot] = 1;
  for (std::size_t k = order_.size(); k-- > 0;) {
    const auto& i = (*program_)[order_[k]];
    const Partials d = program_->partials(order_[k], x);
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

}  // namespace mechanics::expression
