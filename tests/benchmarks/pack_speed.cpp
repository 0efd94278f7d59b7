// The library's packs of eight doubles beside Google Highway's vectors (libhwy-dev), kernel by kernel, for
// the processor at hand: do both give the same bytes, and how long does each take?
//   pack_speed [--smoke]
// Prints for each kernel the nanoseconds of ours, the fastest of many runs taken in turn, and Highway's time
// over ours.
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "tests/benchmarks/pack_speed.cpp"
#include <hwy/foreach_target.h>
#include <hwy/highway.h>

#include "convex/vector.hpp"

HWY_BEFORE_NAMESPACE();
namespace beside::HWY_NAMESPACE {

namespace hn = hwy::HWY_NAMESPACE;
using convex::Index;

using D = hn::CappedTag<double, 8>;
using V = hn::Vec<D>;
constexpr Index width = hn::MaxLanes(D());
constexpr int parts = 8 / width;

void gram(Index n, const double* X, const double* Y, double* into, Index stride) {
  const D d;
  constexpr Index together = width == 8 ? 8 : 4;
  for (Index first = 0; first < 8; first += together) {
    V sum[together][parts];
    for (auto& row : sum)
      for (V& part : row) part = hn::Zero(d);
    for (Index i = 0; i < n; ++i)
      for (int k = 0; k < parts; ++k) {
        const V x = hn::LoadU(d, X + 8 * i + k * width);
        for (Index l = 0; l < together; ++l)
          sum[l][k] = hn::Add(sum[l][k], hn::Mul(x, hn::Set(d, Y[8 * i + first + l])));
      }
    for (Index l = 0; l < together; ++l)
      for (int k = 0; k < parts; ++k) hn::StoreU(sum[l][k], d, into + (first + l) * stride + k * width);
  }
}

void dots(Index n, const double* X, const double* y, double* into) {
  const D d;
  V even[parts], odd[parts];
  for (int k = 0; k < parts; ++k) even[k] = odd[k] = hn::Zero(d);
  Index i = 0;
  for (; i + 2 <= n; i += 2)
    for (int k = 0; k < parts; ++k) {
      even[k] = hn::Add(even[k], hn::Mul(hn::LoadU(d, X + 8 * i + k * width), hn::Set(d, y[i])));
      odd[k] = hn::Add(odd[k], hn::Mul(hn::LoadU(d, X + 8 * i + 8 + k * width), hn::Set(d, y[i + 1])));
    }
  for (int k = 0; k < parts; ++k) {
    if (i < n) even[k] = hn::Add(even[k], hn::Mul(hn::LoadU(d, X + 8 * i + k * width), hn::Set(d, y[i])));
    hn::StoreU(hn::Add(even[k], odd[k]), d, into + k * width);
  }
}

/// hi + lo += x c in twice the working precision.
HWY_INLINE void add_precisely(V& hi, V& lo, V x, V c) {
  const V product = hn::Mul(x, c);
#if HWY_NATIVE_FMA
  const V error = hn::MulSub(x, c, product);
#else
  const V splitter = hn::Set(D(), 0x1p27 + 1), cx = hn::Mul(splitter, x), cc = hn::Mul(splitter, c);
  const V x_high = hn::Sub(cx, hn::Sub(cx, x)), x_low = hn::Sub(x, x_high);
  const V c_high = hn::Sub(cc, hn::Sub(cc, c)), c_low = hn::Sub(c, c_high);
  const V error = hn::Sub(hn::Mul(x_low, c_low),
                          hn::Sub(hn::Sub(hn::Sub(product, hn::Mul(x_high, c_high)), hn::Mul(x_low, c_high)),
                                  hn::Mul(x_high, c_low)));
#endif
  const V sum = hn::Add(hi, product), grown = hn::Sub(sum, hi);
  lo = hn::Add(lo, hn::Add(hn::Add(hn::Sub(hi, hn::Sub(sum, grown)), hn::Sub(product, grown)), error));
  hi = sum;
}

void precise_slacks(Index n, const double* X, const double* q, const double* s, double* into) {
  const D d;
  V hi[parts], lo[parts];
  for (int k = 0; k < parts; ++k) {
    hi[k] = hn::Mul(hn::LoadU(d, s + k * width), hn::Set(d, -1));
    lo[k] = hn::Zero(d);
  }
  for (Index i = 0; i < n; ++i)
    for (int k = 0; k < parts; ++k)
      add_precisely(hi[k], lo[k], hn::LoadU(d, X + 8 * i + k * width), hn::Set(d, q[i]));
  for (int k = 0; k < parts; ++k) hn::StoreU(hn::Add(hi[k], lo[k]), d, into + k * width);
}

void add_multiple(Index n, double c, const double* x, double* y) {
  const D d;
  const V factor = hn::Set(d, c);
  for (Index i = 0; i < n; i += width)
    hn::StoreU(hn::Add(hn::LoadU(d, y + i), hn::Mul(hn::LoadU(d, x + i), factor)), d, y + i);
}

double dot(Index n, const double* x, const double* y) {
  const D d;
  V sum[parts];
  for (V& part : sum) part = hn::Zero(d);
  for (Index i = 0; i < n; i += 8)
    for (int k = 0; k < parts; ++k)
      sum[k] = hn::Add(sum[k], hn::Mul(hn::LoadU(d, x + i + k * width), hn::LoadU(d, y + i + k * width)));
  double t[8];
  for (int k = 0; k < parts; ++k) hn::StoreU(sum[k], d, t + k * width);
  return ((t[0] + t[4]) + (t[2] + t[6])) + ((t[1] + t[5]) + (t[3] + t[7]));
}

}  // namespace beside::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE

#include <algorithm>
#include <chrono>
#include <cstdint>
#include <cstdio>
#include <cstring>
#include <functional>
#include <random>
#include <string>
#include <vector>

#include "convex/dense/dense_kernels.hpp"

namespace beside {

HWY_EXPORT(gram);
HWY_EXPORT(dots);
HWY_EXPORT(precise_slacks);
HWY_EXPORT(add_multiple);
HWY_EXPORT(dot);

namespace {

using Kernel = std::function<void(double* into)>;

double seconds_of(const Kernel& kernel, double* into, int runs) {
  const auto start = std::chrono::steady_clock::now();
  for (int run = 0; run < runs; ++run) kernel(into);
  return std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count() / runs;
}

bool compare(const std::string& name, const Kernel& ours, const Kernel& theirs, std::size_t numbers,
             int turns) {
  std::vector<double> a(numbers, 1), b(numbers, 1);
  ours(a.data());
  theirs(b.data());
  const bool same = std::memcmp(a.data(), b.data(), numbers * sizeof(double)) == 0;
  double best_ours = 1, best_theirs = 1;
  for (int turn = 0; turn < turns; ++turn) {
    constexpr int runs = 200;
    best_ours = std::min(best_ours, seconds_of(ours, a.data(), runs));
    best_theirs = std::min(best_theirs, seconds_of(theirs, b.data(), runs));
  }
  std::printf("%-20s %9.1f ns %6.2f  %s\n", name.c_str(), 1e9 * best_ours, best_theirs / best_ours,
              same ? "same bytes" : "OTHER BYTES");
  return same;
}

}  // namespace

/// What Highway has for one of our families of processors.
struct Family {
  const char* name;
  std::int64_t targets;
};
constexpr Family families[] = {{"any", HWY_SSSE3}, {"avx2, fma", HWY_AVX2}, {"avx512f", HWY_AVX3}};

bool run(const convex::DenseKernels& ours, int turns) {
  // Chosen once, as ours are.
  const auto their_gram = HWY_DYNAMIC_DISPATCH(gram);
  const auto their_dots = HWY_DYNAMIC_DISPATCH(dots);
  const auto their_slacks = HWY_DYNAMIC_DISPATCH(precise_slacks);
  const auto their_multiple = HWY_DYNAMIC_DISPATCH(add_multiple);
  const auto their_dot = HWY_DYNAMIC_DISPATCH(dot);
  std::mt19937_64 random(1966);
  std::normal_distribution<double> normal;
  bool same = true;
  for (const convex::Index n : {8, 32, 120}) {
    std::vector<double> X(static_cast<std::size_t>(8 * n)), Y = X, q(static_cast<std::size_t>(n)), s(8);
    for (auto* numbers : {&X, &Y, &q, &s})
      for (double& x : *numbers) x = normal(random);
    std::string size = "(";
    size += std::to_string(n);
    size += ")";
    const double *x = X.data(), *y = Y.data(), *v = q.data(), *rest = s.data();
    const auto both = [&](std::string name, const auto& kernel_ours, const auto& kernel_theirs,
                          std::size_t numbers) {
      name += size;
      same = compare(name, kernel_ours, kernel_theirs, numbers, turns) && same;
    };
    both(
        "gram", [&](double* G) { ours.gram(n, x, y, G, 8); }, [&](double* G) { their_gram(n, x, y, G, 8); },
        64);
    both(
        "dots", [&](double* d) { ours.dots(n, x, v, d); }, [&](double* d) { their_dots(n, x, v, d); }, 8);
    both(
        "precise_slacks", [&](double* d) { ours.precise_slacks(n, x, v, rest, d); },
        [&](double* d) { their_slacks(n, x, v, rest, d); }, 8);
    both(
        "add_multiple", [&](double* d) { ours.add_multiple(n, 0x1p-40, x, d); },
        [&](double* d) { their_multiple(n, 0x1p-40, x, d); }, static_cast<std::size_t>(n));
    both(
        "dot", [&](double* d) { *d = ours.dot(n, x, y); }, [&](double* d) { *d = their_dot(n, x, y); }, 1);
  }
  return same;
}

bool run(bool smoke) {
  bool same = true;
  std::size_t k = 0;
  const std::int64_t supported = hwy::SupportedTargets();
  for (const convex::DenseKernels* ours : convex::all_dense_kernels()) {
    const Family& family = families[k++];
    const std::int64_t theirs = supported & family.targets;
    if (theirs == 0) {
      std::printf("%s: Highway has nothing for it here\n", family.name);
      continue;
    }
    hwy::SetSupportedTargetsForTest(theirs);
    hwy::GetChosenTarget().Update(hwy::SupportedTargets());
    std::printf("%s: %s\n", family.name, hwy::TargetName(theirs & -theirs));
    same = run(*ours, smoke ? 2 : 1000) && same;
  }
  return same;
}

}  // namespace beside

int main(int count, char** arguments) {
  const bool smoke = count > 1 && std::string(arguments[1]) == "--smoke";
  std::printf("%-20s %12s %6s\n", "kernel (n)", "ours", "Highway over ours");
  return beside::run(smoke) ? 0 : 1;
}

#endif
