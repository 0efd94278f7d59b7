// Exact integers beside those of FLINT, where it is found: sums of products, combinations of rows as
// elimination makes them, and dense systems solved over the rationals.
//   exact_speed [--smoke]
// Prints nanoseconds an entry, or milliseconds a system, and FLINT's over ours.
#include <algorithm>
#include <chrono>
#include <cstdio>
#include <cstring>
#include <random>
#include <string>
#ifdef MOREAU_HAS_FLINT
#include <flint/fmpq_mat.h>
#include <flint/fmpz.h>
#include <flint/fmpz_mat.h>
#include <flint/fmpz_vec.h>
#endif

#include "convex/exact/elimination.hpp"
#include "convex/exact/integer_system.hpp"

namespace {

using convex::Integer;
using convex::IntegerRows;
using convex::IntegerVector;

template <class Work>
double least_seconds(int rounds, int batch, Work work) {
  double least = 1e300;
  for (int round = 0; round < rounds; ++round) {
    const auto start = std::chrono::steady_clock::now();
    for (int k = 0; k < batch; ++k) work();
    const std::chrono::duration<double> passed = std::chrono::steady_clock::now() - start;
    least = std::min(least, passed.count() / batch);
  }
  return least;
}

/// About so many bits, of either sign.
std::string digits(int bits, std::mt19937_64& random) {
  std::string text = random() % 2 == 0 ? "-" : "";
  text += static_cast<char>('1' + random() % 9);
  for (int d = 1; d < bits * 3 / 10; ++d) text += static_cast<char>('0' + random() % 10);
  return text;
}

#ifdef MOREAU_HAS_FLINT
void set(fmpz_t into, const Integer& a) { fmpz_set_str(into, a.text().c_str(), 10); }
#endif

void products(int bits, int rounds, std::mt19937_64& random) {
  constexpr int n = 64, batch = 100;
  IntegerVector a, b, c(n);
  for (int i = 0; i < n; ++i) {
    a.push_back(Integer::from_digits(digits(bits, random)));
    b.push_back(Integer::from_digits(digits(bits, random)));
  }
  Integer sum;
  const double dot = least_seconds(rounds, batch, [&] { sum = convex::dot(a, b); });
  const double combine = least_seconds(rounds, batch, [&] {
    for (std::size_t i = 0; i < n; ++i) c[i] = a[0] * b[i] - b[0] * a[i];
  });
  std::printf("%4d bits  sum of products %7.1f ns", bits, 1e9 * dot / n);
  double other_dot = 0, other_combine = 0;
#ifdef MOREAU_HAS_FLINT
  fmpz *x = _fmpz_vec_init(n), *y = _fmpz_vec_init(n), *z = _fmpz_vec_init(n);
  for (int i = 0; i < n; ++i) {
    set(x + i, a[static_cast<std::size_t>(i)]);
    set(y + i, b[static_cast<std::size_t>(i)]);
  }
  fmpz_t total;
  fmpz_init(total);
  other_dot = least_seconds(rounds, batch, [&] { _fmpz_vec_dot(total, x, y, n); });
  other_combine = least_seconds(rounds, batch, [&] {
    for (int i = 0; i < n; ++i) {
      fmpz_mul(z + i, x, y + i);
      fmpz_submul(z + i, y, x + i);
    }
  });
  fmpz_clear(total);
  for (fmpz* each : {x, y, z}) _fmpz_vec_clear(each, n);
  std::printf(" (FLINT %5.2f)", other_dot / dot);
#endif
  std::printf("  combination %7.1f ns", 1e9 * combine / n);
  if (other_combine > 0) std::printf(" (FLINT %5.2f)", other_combine / combine);
  std::printf("\n");
}

void systems(int n, int bits, int rounds, std::mt19937_64& random) {
  IntegerRows M(static_cast<std::size_t>(n));
  IntegerVector b;
  for (IntegerVector& row : M) {
    for (int j = 0; j < n; ++j) row.push_back(Integer::from_digits(digits(bits, random)));
    b.push_back(Integer::from_digits(digits(bits, random)));
  }
  convex::ExactVector x;
  const double ours =
      least_seconds(rounds, 1, [&] { x = convex::IntegerSystem::prepared(M).value().solve(b); });
  std::printf("%4d bits  system of %3d %9.3f ms", bits, n, 1e3 * ours);
#ifdef MOREAU_HAS_FLINT
  fmpz_mat_t A, B;
  fmpz_mat_init(A, n, n);
  fmpz_mat_init(B, n, 1);
  for (int i = 0; i < n; ++i) {
    const auto at = static_cast<std::size_t>(i);
    for (int j = 0; j < n; ++j) set(fmpz_mat_entry(A, i, j), M[at][static_cast<std::size_t>(j)]);
    set(fmpz_mat_entry(B, i, 0), b[at]);
  }
  const double theirs = least_seconds(rounds, 1, [&] {
    fmpq_mat_t X;
    fmpq_mat_init(X, n, 1);
    fmpq_mat_solve_fmpz_mat_dixon(X, A, B);
    fmpq_mat_clear(X);
  });
  fmpz_mat_clear(A);
  fmpz_mat_clear(B);
  std::printf(" (FLINT %5.2f)", theirs / ours);
#endif
  std::printf("\n");
}

}  // namespace

int main(int count, char** arguments) {
  const bool smoke = count > 1 && std::strcmp(arguments[1], "--smoke") == 0;
#ifndef MOREAU_HAS_FLINT
  std::printf("FLINT: not found\n");
#endif
  std::mt19937_64 random(1966);
  for (const int bits : {8, 24, 53, 120, 400}) products(bits, smoke ? 2 : 200, random);
  for (const int n : {8, 20, 40, 80})
    if (n == 8 || !smoke)
      for (const int bits : {10, 53}) systems(n, bits, smoke ? 1 : 7, random);
}
