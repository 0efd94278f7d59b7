// Time of each kernel beside a plain copy of the same vector.
//   prox_speed [--smoke] [NAME]...    names as they are printed; all when none is given
// Prints ns per entry (the fastest of many runs taken in turn with the copy) and, in parentheses, how many
// times the copy's time that is. Every run allocates its result, as the copy does.
#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <cstring>
#include <functional>
#include <random>
#include <string>
#include <vector>

#include "convex/functions/function.hpp"
#include "convex/functions/norms.hpp"
#include "convex/prox_formulas/capped_simplex.hpp"
#include "convex/prox_formulas/exponential_cone.hpp"
#include "convex/prox_formulas/isotonic.hpp"
#include "convex/prox_formulas/log_barrier.hpp"
#include "convex/prox_formulas/logistic.hpp"
#include "convex/prox_formulas/norm2.hpp"
#include "convex/prox_formulas/nuclear_norm.hpp"
#include "convex/prox_formulas/power.hpp"
#include "convex/prox_formulas/power_cone.hpp"
#include "convex/prox_formulas/relative_entropy.hpp"
#include "convex/prox_formulas/second_order_cone.hpp"
#include "convex/prox_formulas/separable.hpp"
#include "convex/prox_formulas/simplex.hpp"
#include "convex/prox_formulas/spectral.hpp"
#include "convex/prox_formulas/total_variation.hpp"

namespace {

using convex::Index;
using convex::Matrix;
using convex::Vector;
namespace k = convex::prox_formulas;

struct Kernel {
  std::string name;
  std::function<Vector(const Vector&)> run;
  Index largest = 10'000'000;  ///< the largest n that is timed
};

template <class Prox>
Kernel each_entry(const std::string& name, Prox prox) {
  return {name, [prox](const Vector& z) {
            Vector x(z.size());
            for (Index i = 0; i < z.size(); ++i) x[i] = prox(z[i]).x;
            return x;
          }};
}

template <class Projection>
Kernel each_triple(const std::string& name, Projection proj) {
  return {name, [proj](const Vector& z) {
            Vector x = z;
            for (Index i = 0; i + 3 <= z.size(); i += 3) x.segment<3>(i) = proj(z.segment<3>(i));
            return x;
          }};
}

/// Of the matrix of the first m² entries, stacked; O(m³), so that n stops at 1e5.
template <class Prox>
Kernel square(const std::string& name, Prox prox) {
  return {name + " (m x m)",
          [prox](const Vector& z) {
            const Index m = static_cast<Index>(std::sqrt(double(z.size())));
            const auto M = z.head(m * m).reshaped(m, m);
            const Matrix symmetric = 0.5 * (M + M.transpose());
            return Vector(prox(Vector(symmetric.reshaped())));
          },
          100'000};
}

std::vector<Kernel> kernels() {
  return {
      {"norm1", [](const Vector& z) { return k::prox_norm1(z, 0.7); }},
      {"box", [](const Vector& z) { return k::proj_box(z, -0.5, 1); }},
      {"huber", [](const Vector& z) { return k::prox_huber(z, 0.5, 0.7); }},
      {"hinge", [](const Vector& z) { return k::prox_hinge(z, 0.7); }},
      {"squared_hinge", [](const Vector& z) { return k::prox_squared_hinge(z, 0.7); }},
      {"elastic_net", [](const Vector& z) { return k::prox_elastic_net(z, 0.3, 0.7); }},
      {"norm2", [](const Vector& z) { return k::prox_norm2(z, 1); }},
      {"ball2", [](const Vector& z) { return k::proj_ball2(z, 1); }},
      {"group_norm, groups of 10",
       [f = convex::group_norm(1, 10)](const Vector& z) {
         return f.prox(z.head(z.size() / 10 * 10), convex::Metric::identity(z.size() / 10 * 10)).x;
       }},
      {"second_order_cone", k::proj_second_order_cone},
      {"rotated_cone", k::proj_rotated_cone},
      {"simplex", [](const Vector& z) { return k::proj_simplex(z, 1); }},
      {"simplex, total n/2", [](const Vector& z) { return k::proj_simplex(z, 0.5 * double(z.size())); }},
      {"simplex, total 100n", [](const Vector& z) { return k::proj_simplex(z, 100 * double(z.size())); }},
      {"ball1", [](const Vector& z) { return k::proj_ball1(z, 1); }},
      {"ball1, radius n/2", [](const Vector& z) { return k::proj_ball1(z, 0.5 * double(z.size())); }},
      {"norm_inf", [](const Vector& z) { return k::prox_norm_inf(z, 1); }},
      {"max", [](const Vector& z) { return k::prox_max(z, 1); }},
      {"simplex in a metric",
       [](const Vector& z) { return k::proj_simplex(z, 1, z.array().square() + 0.1); }},
      {"sum_largest, k = n/10",
       [](const Vector& z) { return k::prox_sum_largest(z, std::floor(0.1 * double(z.size()))); }},
      {"capped_simplex, total n/10",
       [](const Vector& z) { return k::proj_capped_simplex(z, 1, 0.1 * double(z.size())); }},
      {"sorted_norm1",
       [](const Vector& z) { return k::prox_sorted_norm1(z, Vector::LinSpaced(z.size(), 2, 0)); }},
      {"isotonic", [](const Vector& z) { return k::proj_monotone(z).x; }},
      {"total_variation", [](const Vector& z) { return k::prox_total_variation(z, 2).x; }},
      each_entry("entropy", [](double z) { return k::prox_entropy(z, 1); }),
      each_entry("exponential", [](double z) { return k::prox_exponential(z, 1); }),
      each_entry("kullback_leibler", [](double z) { return k::prox_kullback_leibler(z, 1, 0.5); }),
      each_entry("binary_entropy", [](double z) { return k::prox_binary_entropy(z, 1); }),
      each_entry("logistic", [](double z) { return k::prox_logistic(z, 1); }),
      each_entry("log_barrier", [](double z) { return k::prox_log_barrier(z, 1); }),
      each_entry("power 1.5", [](double z) { return k::prox_power(z, 1, 1.5); }),
      each_entry("power 3", [](double z) { return k::prox_power(z, 1, 3); }),
      each_entry("inverse_power 1", [](double z) { return k::prox_inverse_power(z, 1, 1); }),
      each_triple("exponential_cone", [](const Eigen::Vector3d& z) { return k::proj_exponential_cone(z); }),
      each_triple("power_cone 0.3", [](const Eigen::Vector3d& z) { return k::proj_power_cone(z, 0.3); }),
      square("psd_cone", [](const Vector& z) { return k::proj_psd_cone(z); }),
      square("neg_log_det", [](const Vector& z) { return k::prox_log_det(z); }),
      square("nuclear_norm",
             [](const Vector& z) {
               return k::prox_nuclear_norm(z, 1, static_cast<Index>(std::sqrt(double(z.size()))));
             }),
  };
}

double sink = 0;  // keeps results alive

template <class Work>
double seconds(Work work, int calls) {
  const auto start = std::chrono::steady_clock::now();
  for (int i = 0; i < calls; ++i) {
    const Vector x = work();
    sink += x[x.size() / 2];
  }
  return std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count() / calls;
}

}  // namespace

int main(int argc, char** argv) {
  const bool smoke = argc > 1 && std::strcmp(argv[1], "--smoke") == 0;
  const std::vector<std::string> names(argv + (smoke ? 2 : 1), argv + argc);
  const std::vector<Index> sizes =
      smoke ? std::vector<Index>{10, 100} : std::vector<Index>{1000, 10000, 100000, 1000000, 10000000};
  std::printf("%-24s", "ns per entry (x copy)");
  for (Index n : sizes) std::printf(" %16.0e", static_cast<double>(n));
  std::printf("\n");
  for (const Kernel& kernel : kernels()) {
    if (!names.empty() && std::find(names.begin(), names.end(), kernel.name) == names.end()) continue;
    std::printf("%-24s", kernel.name.c_str());
    for (Index n : sizes) {
      if (n > kernel.largest) break;
      std::mt19937_64 generator(1);
      std::normal_distribution<double> normal;
      Vector z(n);
      for (double& v : z) v = normal(generator);
      const auto copy = [&] { return Vector(z); };
      const auto run = [&] { return kernel.run(z); };
      const double once = seconds(run, 1);
      const int calls = smoke ? 1 : std::max(1, static_cast<int>(1e-3 / once));
      double best = once, best_copy = seconds(copy, 1);
      for (int batch = 0; batch < (smoke ? 1 : once > 0.5 ? 3 : 15); ++batch) {
        best = std::min(best, seconds(run, calls));
        best_copy = std::min(best_copy, seconds(copy, std::min(calls * 4, 4000)));
      }
      std::printf(" %8.2f (%5.1f)", best / static_cast<double>(n) * 1e9, best / best_copy);
      std::fflush(stdout);
    }
    std::printf("\n");
  }
  return std::isnan(sink) ? 1 : 0;
}
