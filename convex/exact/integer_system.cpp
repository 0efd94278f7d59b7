#include "convex/exact/integer_system.hpp"

#include <gmp.h>

#include <cmath>

#include "convex/exact/modular.hpp"
#include "convex/invariant.hpp"

namespace convex::inline exact_arithmetic {
namespace {

using Word = ModularField::Word;
using Wide = ModularField::Wide;

/// An mpz that clears itself.
class Big {
 public:
  Big() { mpz_init(value_); }
  explicit Big(const Integer& a) {
    if (a.fits_word())
      mpz_init_set_si(value_, a.word());
    else
      mpz_init_set(value_, static_cast<mpz_srcptr>(a.gmp()));
  }
  Big(const Big& other) { mpz_init_set(value_, other.value_); }
  Big(Big&& other) noexcept {
    mpz_init(value_);
    mpz_swap(value_, other.value_);
  }
  Big& operator=(Big other) noexcept {
    mpz_swap(value_, other.value_);
    return *this;
  }
  ~Big() { mpz_clear(value_); }
  operator mpz_ptr() { return value_; }           // NOLINT: this is what it is for
  operator mpz_srcptr() const { return value_; }  // NOLINT
  std::size_t bits() const { return mpz_sizeinbase(value_, 2); }

 private:
  mpz_t value_;
};

struct Entry {
  std::size_t column;
  Big value;
};
using SparseRow = std::vector<Entry>;

/// So many bits to spare make a fraction read off modulo p^k no accident.
constexpr std::size_t spare_bits = 64;

/// Fractions are tried for at lengths that grow by this factor.
constexpr double growth = 1.4;

/// The fraction numerator / denominator = x modulo `modulus` with the shortest numbers (Wang 1981): the first
/// remainder of Euclid's algorithm below the root of the modulus. Whether it has `spare_bits` to spare.
bool read_fraction_modulo(const Big& x, const Big& modulus, Big& numerator, Big& denominator) {
  Big r0 = modulus, r1 = x, t0, t1, quotient;
  mpz_set_ui(t1, 1);
  const std::size_t half = modulus.bits() / 2;
  while (r1.bits() > half) {
    mpz_tdiv_qr(quotient, r0, r0, r1);
    mpz_submul(t0, quotient, t1);
    mpz_swap(r0, r1);
    mpz_swap(t0, t1);
  }
  if (mpz_sgn(static_cast<mpz_srcptr>(t1)) < 0) {
    mpz_neg(t1, t1);
    mpz_neg(r1, r1);
  }
  mpz_set(numerator, r1);
  mpz_set(denominator, t1);
  return numerator.bits() + denominator.bits() + spare_bits < modulus.bits();
}

/// Brings x into (-modulus/2, modulus/2].
void centre(Big& x, const Big& modulus) {
  mpz_fdiv_r(x, x, modulus);
  Big twice;
  mpz_mul_2exp(twice, x, 1);
  if (mpz_cmp(twice, modulus) > 0) mpz_sub(x, x, modulus);
}

/// log2 of a bound on the numbers of Cramer's rule (Hadamard 1893).
double cramer_bits(const std::vector<SparseRow>& rows, const std::vector<Big>& b) {
  double bits = 2;
  for (std::size_t i = 0; i < rows.size(); ++i) {
    std::size_t longest = b[i].bits();
    for (const Entry& entry : rows[i]) longest = std::max(longest, entry.value.bits());
    bits += static_cast<double>(longest) + 0.5 * std::log2(static_cast<double>(rows[i].size()) + 1);
  }
  return bits;
}

}  // namespace

struct IntegerSystem::Data {
  std::size_t n;
  ModularField field;
  std::vector<Word> inverse;
  std::vector<SparseRow> rows;
};

namespace {

/// The entry at that column of the last row of a system, or of a row that becomes it.
void append_entry(SparseRow& row, std::size_t column, const Integer& value) {
  if (!value.is_zero()) row.push_back({column, Big(value)});
}

std::vector<Word> modulo(const IntegerVector& numbers, const ModularField& field) {
  std::vector<Word> held;
  for (const Integer& number : numbers) held.push_back(field.from(number));
  return held;
}

}  // namespace

IntegerSystem::Data& IntegerSystem::own() {
  if (data_.use_count() > 1) data_ = std::make_shared<Data>(*data_);
  return *data_;
}

bool IntegerSystem::append(const IntegerVector& row, const IntegerVector& column) {
  const ModularField& field = data_->field;
  auto inverse = bordered_inverse(data_->inverse, modulo(column, field), modulo(row, field), 0, field);
  if (!inverse) return false;
  Data& data = own();
  data.inverse = std::move(*inverse);
  SparseRow last;
  for (std::size_t i = 0; i < data.n; ++i) {
    append_entry(data.rows[i], data.n, column[i]);
    append_entry(last, i, row[i]);
  }
  data.rows.push_back(std::move(last));
  ++data.n;
  return true;
}

bool IntegerSystem::remove(std::size_t k) {
  auto inverse = inverse_without(data_->inverse, data_->n, k, data_->field);
  if (!inverse) return false;
  Data& data = own();
  data.inverse = std::move(*inverse);
  data.rows.erase(data.rows.begin() + static_cast<std::ptrdiff_t>(k));
  for (SparseRow& row : data.rows) {
    std::erase_if(row, [&](const Entry& entry) { return entry.column == k; });
    for (Entry& entry : row) entry.column -= entry.column > k;
  }
  --data.n;
  return true;
}

std::optional<IntegerSystem> IntegerSystem::prepared(const IntegerRows& M) {
  for (const Word prime : large_primes) {
    const ModularField field(prime);
    auto inverse = modular_inverse(M, field);
    if (!inverse) continue;
    auto data = std::make_shared<Data>(Data{M.size(), field, std::move(*inverse), {}});
    for (const IntegerVector& row : M) {
      SparseRow entries;
      for (std::size_t j = 0; j < row.size(); ++j) append_entry(entries, j, row[j]);
      data->rows.push_back(std::move(entries));
    }
    return IntegerSystem(std::move(data));
  }
  return std::nullopt;
}

namespace {

/// The digits of x = M⁻¹b modulo p, p², … one after the other.
class Lifting {
 public:
  Lifting(const std::vector<SparseRow>& rows, const std::vector<Word>& inverse, const ModularField& field,
          const std::vector<Big>& b)
      : rows_(rows), inverse_(inverse), field_(field), rest_(b), x_(b.size()) {
    mpz_set_ui(modulus_, 1);
  }

  const Big& modulus() const { return modulus_; }
  const std::vector<Big>& x() const { return x_; }

  void lift() {
    const std::size_t n = rows_.size();
    std::vector<Word> modular(n), digit(n);
    for (std::size_t i = 0; i < n; ++i) modular[i] = mpz_fdiv_ui(rest_[i], field_.prime());
    for (std::size_t i = 0; i < n; ++i) {
      Wide sum = 0;
      for (std::size_t j = 0; j < n; ++j) sum = field_.accumulate(sum, inverse_[i * n + j], modular[j]);
      digit[i] = field_.reduce(sum);
    }
    for (std::size_t i = 0; i < n; ++i) {
      for (const Entry& entry : rows_[i]) mpz_submul_ui(rest_[i], entry.value, digit[entry.column]);
      mpz_divexact_ui(rest_[i], rest_[i], field_.prime());
      mpz_addmul_ui(x_[i], modulus_, digit[i]);
    }
    mpz_mul_ui(modulus_, modulus_, field_.prime());
  }

 private:
  const std::vector<SparseRow>& rows_;
  const std::vector<Word>& inverse_;
  const ModularField& field_;
  std::vector<Big> rest_, x_;
  Big modulus_;
};

/// The common denominator and the numerators of x modulo `modulus`; false when they are not to be seen yet.
bool read_fractions(const std::vector<Big>& x, const Big& modulus, std::vector<Big>& numerators,
                    Big& denominator) {
  mpz_set_ui(denominator, 1);
  numerators = x;
  for (std::size_t i = 0; i < x.size(); ++i) {
    mpz_mul(numerators[i], x[i], denominator);
    centre(numerators[i], modulus);
    if (numerators[i].bits() + denominator.bits() + spare_bits < modulus.bits()) continue;
    Big numerator, factor, rest;
    mpz_fdiv_r(rest, numerators[i], modulus);
    if (!read_fraction_modulo(rest, modulus, numerator, factor)) return false;
    mpz_mul(denominator, denominator, factor);
    for (std::size_t j = 0; j < i; ++j) mpz_mul(numerators[j], numerators[j], factor);
    mpz_swap(numerators[i], numerator);
  }
  return true;
}

bool satisfies(const std::vector<SparseRow>& rows, const std::vector<Big>& numerators, const Big& denominator,
               const std::vector<Big>& b) {
  Big sum;
  for (std::size_t i = 0; i < rows.size(); ++i) {
    mpz_mul(sum, b[i], denominator);
    for (const Entry& entry : rows[i]) mpz_submul(sum, entry.value, numerators[entry.column]);
    if (mpz_sgn(static_cast<mpz_srcptr>(sum)) != 0) return false;
  }
  return true;
}

ExactVector taken(const std::vector<Big>& numerators, const Big& denominator) {
  Big common = denominator;
  for (const Big& numerator : numerators) mpz_gcd(common, common, numerator);
  ExactVector x;
  Big quotient;
  for (const Big& numerator : numerators) {
    mpz_divexact(quotient, numerator, common);
    x.numerators.push_back(Integer::from_gmp(static_cast<mpz_srcptr>(quotient)));
  }
  mpz_divexact(quotient, denominator, common);
  x.denominator = Integer::from_gmp(static_cast<mpz_srcptr>(quotient));
  return x;
}

}  // namespace

ExactVector IntegerSystem::solve(const IntegerVector& b) const {
  std::vector<Big> right;
  for (const Integer& entry : b) right.emplace_back(entry);
  Lifting lifting(data_->rows, data_->inverse, data_->field, right);
  std::vector<Big> numerators;
  Big denominator;
  // Numerator and denominator of Cramer's rule, and what is to spare.
  const double enough = 2 * cramer_bits(data_->rows, right) + 2 * static_cast<double>(spare_bits);
  double next = 4 * static_cast<double>(spare_bits);
  while (true) {
    while (static_cast<double>(lifting.modulus().bits()) < next) lifting.lift();
    if (read_fractions(lifting.x(), lifting.modulus(), numerators, denominator) &&
        satisfies(data_->rows, numerators, denominator, right))
      return taken(numerators, denominator);
    invariant(next < 2 * enough, "fractions as long as Cramer's rule allows solve the system");
    next = next < enough ? std::min(next * growth, enough) : 2 * enough;
  }
}

}  // namespace convex::inline exact_arithmetic
