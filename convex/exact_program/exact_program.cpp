#include "convex/exact_program/exact_program.hpp"

namespace convex::inline exact_programs {
namespace {

/// Σ a_j b_j over the least common denominator so far: common factors are looked for once, at the end.
class ProductSum {
 public:
  void add(const Fraction& a, const Fraction& b) {
    if (sign(a) == 0 || sign(b) == 0) return;
    const Integer own = a.denominator * b.denominator;
    const Integer product = a.numerator * b.numerator;
    if (own == denominator_) {
      numerator_ += product;
      return;
    }
    const Integer common = greatest_common_divisor(own, denominator_);
    const Integer wider = exact_quotient(own, common);
    numerator_ = numerator_ * wider + product * exact_quotient(denominator_, common);
    denominator_ *= wider;
  }
  Fraction value() const { return lowest_terms({numerator_, denominator_}); }

 private:
  Integer numerator_ = 0, denominator_ = 1;
};

}  // namespace

void add(ExactRow& a, std::size_t j, const Fraction& value) {
  if (sign(value) == 0) return;
  const auto [at, is_new] = a.try_emplace(j, value);
  if (is_new) return;
  at->second = at->second + value;
  if (sign(at->second) == 0) a.erase(at);
}

void add(ExactRow& a, const ExactRow& b, const Fraction& factor) {
  for (const auto& [j, value] : b) add(a, j, value * factor);
}

Fraction dot(const ExactRow& a, const Fractions& xi) {
  ProductSum sum;
  for (const auto& [j, value] : a) sum.add(value, xi[j]);
  return sum.value();
}

Fraction dot(const Fractions& a, const Fractions& b) {
  ProductSum sum;
  for (std::size_t i = 0; i < a.size(); ++i) sum.add(a[i], b[i]);
  return sum.value();
}

bool ExactProgram::is_polyhedral() const {
  for (const ExactRow& row : H)
    if (!row.empty()) return false;
  return true;
}

void ExactProgram::curve(std::size_t i, std::size_t j, const Fraction& value) {
  add(H[i], j, value);
  if (i != j) add(H[j], i, value);
}

Fraction half_square(const ExactProgram& f, const Fractions& xi) {
  Fraction sum;
  for (std::size_t i = 0; i < xi.size(); ++i)
    if (!f.H[i].empty() && sign(xi[i]) != 0) sum = sum + xi[i] * dot(f.H[i], xi);
  return sum * Fraction{1, 2};
}

Fraction objective(const ExactProgram& f, const Fractions& xi) {
  return half_square(f, xi) + dot(f.c, xi) + f.constant;
}

ExactProgram exact(const LinearQuadratic& f) {
  ExactProgram made(static_cast<std::size_t>(f.n), static_cast<std::size_t>(f.auxiliaries()));
  for (Index j = 0; j < f.H.outerSize(); ++j)
    for (SparseMatrix::InnerIterator entry(f.H, j); entry; ++entry)
      add(made.H[static_cast<std::size_t>(entry.row())], static_cast<std::size_t>(j),
          fraction(entry.value()));
  for (Index j = 0; j < f.variables(); ++j) made.c[static_cast<std::size_t>(j)] = fraction(f.c[j]);
  made.constant = fraction(f.constant);
  for (Index a = 0; a < f.rows(); ++a) {
    ExactRow row;
    for (SparseRows::InnerIterator entry(f.G, a); entry; ++entry)
      add(row, static_cast<std::size_t>(entry.col()), fraction(entry.value()));
    const bool two_sided = std::binary_search(f.two_sided.begin(), f.two_sided.end(), a);
    made.rows.push_back({std::move(row), fraction(f.h[a]), two_sided});
  }
  return made;
}

LinearQuadratic rounded(const ExactProgram& f) {
  LinearQuadraticBuilder form(static_cast<Index>(f.n), static_cast<Index>(f.variables() - f.n));
  for (std::size_t i = 0; i < f.variables(); ++i) {
    if (sign(f.c[i]) != 0) form.cost(static_cast<Index>(i), nearest_double(f.c[i]));
    for (const auto& [j, value] : f.H[i])
      if (j <= i) form.curve(static_cast<Index>(i), static_cast<Index>(j), nearest_double(value));
  }
  form.constant(nearest_double(f.constant));
  for (const ExactBound& bound : f.rows) {
    if (bound.two_sided)
      form.equation(nearest_double(bound.limit));
    else
      form.row(nearest_double(bound.limit));
    for (const auto& [j, value] : bound.row) form.entry(static_cast<Index>(j), nearest_double(value));
  }
  return form.finish();
}

ExactProgram substitute(const ExactProgram& f, const std::vector<ExactAffine>& maps, std::size_t n,
                        std::size_t columns) {
  ExactProgram made(n, columns - n);
  made.constant = f.constant;
  Fractions shift;
  for (const ExactAffine& map : maps) shift.push_back(map.shift);
  for (std::size_t i = 0; i < f.variables(); ++i) {
    const Fraction bent = dot(f.H[i], shift), slope = f.c[i] + bent;
    made.constant = made.constant + shift[i] * (f.c[i] + bent * Fraction{1, 2});
    for (const auto& [a, factor] : maps[i].row) {
      made.c[a] = made.c[a] + slope * factor;
      for (const auto& [j, value] : f.H[i])
        for (const auto& [b, other] : maps[j].row) add(made.H[a], b, factor * value * other);
    }
  }
  for (const ExactBound& bound : f.rows) {
    ExactRow row;
    for (const auto& [j, value] : bound.row) add(row, maps[j].row, value);
    made.rows.push_back({std::move(row), bound.limit - dot(bound.row, shift), bound.two_sided});
  }
  return made;
}

ExactProgram add_joint(ExactProgram f, const ExactProgram& g) {
  for (std::size_t i = 0; i < f.variables(); ++i) {
    add(f.H[i], g.H[i], Fraction{1});
    f.c[i] = f.c[i] + g.c[i];
  }
  f.constant = f.constant + g.constant;
  f.rows.insert(f.rows.end(), g.rows.begin(), g.rows.end());
  return f;
}

}  // namespace convex::inline exact_programs
