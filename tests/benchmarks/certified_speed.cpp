// What a proof adds to a decomposition z = x + y, both in one run and by processor time.
//   certified_speed [--smoke] [NAME]...    calls as they are printed; all when none is given
// Prints microseconds of the plain decomposition, of it with its proof, and their ratio; the proof's level
// and digits.
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstring>
#include <ctime>
#include <random>
#include <string>
#include <vector>

#include "convex/catalogue/catalogue.hpp"
#include "convex/proved_prox/proved_split.hpp"

namespace {

using convex::Call;
using convex::Index;
using convex::Metric;
using convex::NamedArgument;
using convex::Vector;

struct Subject {
  Call f;
  bool stacks_matrix = false;  ///< of 10 by 10 entries
};

Call call(std::string name, std::vector<NamedArgument> arguments = {}) {
  return {std::move(name), std::move(arguments)};
}
NamedArgument number(double value) { return {"", value, {}}; }
NamedArgument number(Vector value) { return {"", std::move(value), {}}; }

std::vector<Subject> subjects(Index n) {
  const auto set = [](Call c) { return convex::indicator_call(std::move(c)); };
  Vector weights = Vector::LinSpaced(n, 2, 0);
  std::vector<Subject> all = {{call("norm1", {number(0.7)})},
                              {call("huber", {number(0.5)})},
                              {call("hinge")},
                              {call("squared_norm2")},
                              {call("elastic_net", {number(0.3), number(0.7)})},
                              {set(call("box", {number(-0.5), number(1)}))},
                              {set(call("orthant"))},
                              {call("entropy")},
                              {call("logistic")},
                              {call("exponential")},
                              {call("log_barrier")},
                              {call("power", {number(1.5)})},
                              {call("inverse_power", {number(1)})},
                              {call("kullback_leibler", {number(2)})},
                              {call("norm2")},
                              {set(call("ball2"))},
                              {call("group_norm", {number(10)})},
                              {set(call("second_order_cone"))},
                              {set(call("rotated_second_order_cone"))},
                              {set(call("simplex", {number(1)}))},
                              {set(call("ball1"))},
                              {set(call("halfspace", {number(weights), number(-1)}))},
                              {call("norm_inf")},
                              {call("max")},
                              {call("sum_largest", {number(3)})},
                              {call("log_sum_exp")},
                              {call("total_variation", {number(0.3)})},
                              {set(call("psd_cone")), true},
                              {call("nuclear_norm", {number(1), number(10)}), true}};
  return all;
}

double seconds() { return static_cast<double>(std::clock()) / CLOCKS_PER_SEC; }

template <class Work>
double best_time(Work work, bool smoke) {
  double best = 1e300;
  for (int k = 0; k < (smoke ? 1 : 5); ++k) {
    const double start = seconds();
    int done = 0;
    do {
      work();
      ++done;
    } while (!smoke && seconds() - start < 2e-3);
    best = std::min(best, (seconds() - start) / done);
  }
  return best;
}

Metric full_metric(Index n) {
  convex::Matrix W = convex::Matrix::Identity(n, n) * 2;
  for (Index i = 1; i < n; ++i) W(i, i - 1) = W(i - 1, i) = 0.5;
  return Metric::dense(W);
}

}  // namespace

int main(int argc, char** argv) {
  const bool smoke = argc > 1 && std::strcmp(argv[1], "--smoke") == 0;
  const std::vector<std::string> names(argv + (smoke ? 2 : 1), argv + argc);
  const Index n = smoke ? 9 : 100;
  std::printf("n = %td\n%-34s %-9s %10s %12s %8s  %s\n", n, "", "metric", "plain us", "proved us", "ratio",
              "proof");
  const std::pair<const char*, Metric> metrics[] = {
      {"identity", Metric::identity(n)},
      {"diagonal", Metric::diagonal(Vector::LinSpaced(n, 1, 2))},
      {"full", full_metric(n)}};
  for (const Subject& one : subjects(n)) {
    const std::string text = convex::to_text(one.f);
    if (!names.empty() && std::find(names.begin(), names.end(), one.f.name) == names.end()) continue;
    for (const auto& [kind, W] : metrics) {
      if (smoke && one.stacks_matrix) continue;
      std::mt19937_64 generator(1);
      std::normal_distribution<double> normal;
      Vector z(n);
      for (double& entry : z) entry = normal(generator);
      const convex::Function f = convex::make_function(one.f, {W});
      const double plain = best_time([&, &W = W] { convex::decompose(f, z, W); }, smoke);
      const convex::Decomposition split = convex::decompose(f, z, W);
      convex::ProvedSplit proof;
      const double proving = best_time([&, &W = W] { proof = convex::prove(one.f, z, W, split); }, smoke);
      std::printf("%-34.34s %-9s %10.2f %12.2f %8.1f  %s, %.1f digits\n", text.c_str(), kind, plain * 1e6,
                  (plain + proving) * 1e6, (plain + proving) / plain,
                  proof.level == convex::ProofLevel::none    ? "none"
                  : proof.level == convex::ProofLevel::exact ? "exact"
                                                             : "enclosure",
                  -std::log10(proof.error_bound() / std::max(1.0, W.norm(z))));
      std::fflush(stdout);
    }
  }
  return 0;
}
