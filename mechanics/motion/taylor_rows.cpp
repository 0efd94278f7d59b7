#include "mechanics/motion/taylor_rows.hpp"

namespace mechanics::inline motions {
namespace {

using expression::Slot;
using Kind = TaylorStep::Kind;
using Form = std::vector<TaylorRows::Term>;

/// A step of two operands that is linear, with numbers as coefficients: (by a, by b).
struct LinearStep {
  bool is_linear = false;
  double a = 0, b = 0;
};

LinearStep linear(const TaylorStep& step) {
  switch (step.kind) {
    case Kind::sum:
      return {true, 1, 1};
    case Kind::difference:
      return {true, 1, -1};
    case Kind::negative:
      return {true, -1, 0};
    case Kind::multiple:
      return {true, 0, step.number};
    case Kind::share:
      return {true, 1 / step.number, 0};
    default:
      return {};
  }
}

bool has_two_operands(Kind kind) {
  return kind == Kind::product || kind == Kind::quotient || kind == Kind::angle || kind == Kind::either;
}
bool reads_second(Kind kind) {
  return has_two_operands(kind) || kind == Kind::where_not_negative || kind == Kind::where_negative;
}
bool reads_first(Kind kind) {
  return kind != Kind::where_not_negative && kind != Kind::where_negative && kind != Kind::sign;
}
bool reads_partner(Kind kind) { return kind == Kind::arc || kind == Kind::angle; }

class Rows {
 public:
  Rows(const TaylorSteps& from, const TaylorRows::Asked& asked, TaylorRows& to)
      : steps_(from),
        to_(to),
        is_kept_(from.series),
        is_constant_(from.series),
        uses_(from.series),
        form_(from.series),
        depends_(from.series) {
    for (const auto& [slot, value] : from.constants) is_constant_[slot] = true;
    for (const auto* all : {&asked.series, &asked.of_order, &asked.at_rest})
      for (const Slot slot : *all) is_kept_[slot] = true;
    for (const Switch& one : from.switches) is_kept_[one.argument] = true;
    for (const std::size_t s : from.by_velocity) depends_[from.steps[s].out] = true;
    for (const TaylorStep& step : from.steps) count_uses(step);
    to_.series = from.series;
    to_.zero = static_cast<Slot>(to_.series++);
  }

  void write() {
    std::size_t s = 0;
    for (const std::size_t end : steps_.ends) {
      for (; s < end; ++s) {
        to_.row_of_step.push_back(TaylorRows::none);
        write(steps_.steps[s]);
      }
      to_.ends.push_back({to_.rows.size(), to_.products.size()});
    }
  }

 private:
  void count_uses(const TaylorStep& step) {
    const LinearStep by = linear(step);
    if (by.is_linear) {
      if (by.a != 0) ++uses_[step.a];
      if (by.b != 0) ++uses_[step.b];
      return;
    }
    if (reads_first(step.kind)) is_kept_[step.a] = true;
    if (reads_second(step.kind)) is_kept_[step.b] = true;
    if (reads_partner(step.kind)) is_kept_[step.partner] = true;
  }

  void add_to(Form& form, Slot operand, double c) {
    if (c == 0 || is_constant_[operand]) return;
    if (form_[operand].empty()) {
      form.push_back({operand, c});
      return;
    }
    if (form.empty() && uses_[operand] == 1) {
      form = std::move(form_[operand]);
      for (auto& term : form) term.c *= c;
      return;
    }
    for (const auto& term : form_[operand]) form.push_back({term.series, c * term.c});
  }

  void write_linear(const TaylorStep& step, const LinearStep& by) {
    Form form;
    add_to(form, step.a, by.a);
    add_to(form, step.b, by.b);
    if (!form.empty() && !is_kept_[step.out] && (uses_[step.out] <= 1 || form.size() == 1)) {
      form_[step.out] = std::move(form);
      return;
    }
    begin_row(step.out);
    for (const auto& term : form) to_.terms.push_back(term);
    end_row();
  }

  void begin_row(Slot out) {
    const auto first = static_cast<std::uint32_t>(to_.terms.size());
    const auto product = static_cast<std::uint32_t>(to_.products.size());
    to_.rows.push_back({out, first, first, product, product});
  }
  void end_row() {
    TaylorRows::Row& row = to_.rows.back();
    row.end = static_cast<std::uint32_t>(to_.terms.size());
    if (depends_[row.out] && to_.ends.empty())
      to_.by_velocity.push_back(static_cast<std::uint32_t>(to_.rows.size() - 1));
  }
  void row(Slot out, std::initializer_list<Slot> terms,
           std::initializer_list<TaylorRows::Product> products = {}) {
    begin_row(out);
    for (const Slot slot : terms) to_.terms.push_back({slot, 0});
    end_row();
    to_.products.insert(to_.products.end(), products);
    to_.rows.back().end_product = static_cast<std::uint32_t>(to_.products.size());
  }

  void write(const TaylorStep& step) {
    if (const LinearStep by = linear(step); by.is_linear) return write_linear(step, by);
    to_.row_of_step.back() = static_cast<std::uint32_t>(to_.rows.size());
    const Slot f = step.out, p = step.partner, a = step.a, b = step.b;
    switch (step.kind) {
      case Kind::product:
        return row(f, {a, b}, {{a, b, 1, false}});
      case Kind::square:
        return row(f, {a}, {{a, a, 1, false}});
      case Kind::quotient:
        return row(f, {a, b}, {{b, f, 1, false}});
      case Kind::root:
        return row(f, {a}, {{f, f, 1, false}});
      case Kind::exponential:
        return row(f, {a}, {{a, f, 1, true}});
      case Kind::logarithm:
        return row(f, {a}, {{f, a, 1, true}});
      case Kind::sine:
      case Kind::sinh:
        row(f, {a}, {{a, p, 1, true}});
        return row(p, {a}, {{a, f, 1, true}});
      case Kind::tangent:
      case Kind::tanh:
        row(f, {a}, {{a, p, 1, true}});
        return row(p, {f}, {{f, f, 1, false}});
      case Kind::arc:
        return row(f, {a}, {{f, p, 1, true}});
      case Kind::angle:
        return row(f, {a, b}, {{a, b, 1, true}, {b, a, -1, true}, {f, p, -1, true}});
      case Kind::power:
        return row(f, {a}, {{a, f, step.number, true}, {f, a, -1, true}});
      case Kind::sign:
        return row(f, {});
      case Kind::absolute:
        return row(f, {a});
      default:  // a choice of branches
        return row(f, {to_.zero});
    }
  }

  const TaylorSteps& steps_;
  TaylorRows& to_;
  std::vector<bool> is_kept_, is_constant_;
  std::vector<int> uses_;   // by linear steps
  std::vector<Form> form_;  // of linear series without a row
  std::vector<bool> depends_;
};

}  // namespace

TaylorRows::TaylorRows(const TaylorSteps& steps, const Asked& asked) {
  Rows(steps, asked, *this).write();
  std::vector<bool> is_read(series);
  for (const Product& product : products) is_read[product.x] = is_read[product.y] = true;
  for (const auto* all : {&asked.series, &asked.of_order})
    for (const Slot slot : *all) is_read[slot] = true;
  for (const Switch& one : steps.switches) is_read[one.argument] = true;
  for (const TaylorStep& step : steps.steps)  // branches, which may come to be read
    if (step.kind == Kind::either || step.kind == Kind::where_not_negative ||
        step.kind == Kind::where_negative)
      is_read[step.a] = is_read[step.b] = true;
  for (std::size_t row = rows.size(); row-- > 0;)
    for (std::uint32_t t = rows[row].first; is_read[rows[row].out] && t < rows[row].end; ++t)
      is_read[terms[t].series] = true;
  for (const std::uint32_t r : by_velocity)
    if (is_read[rows[r].out]) after_velocity.push_back(r);
}

}  // namespace mechanics::inline motions
