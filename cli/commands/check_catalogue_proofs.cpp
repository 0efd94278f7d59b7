#include <fmt/format.h>

#include <algorithm>
#include <atomic>
#include <chrono>
#include <cmath>
#include <thread>

#include "cli/commands/command_line.hpp"
#include "cli/function_language/number_of_entries.hpp"
#include "cli/function_language/parse_call.hpp"
#include "cli/json_writer.hpp"
#include "cli/report/answer.hpp"
#include "cli/report/text_table.hpp"
#include "convex/catalogue/catalogue.hpp"
#include "convex/proved_prox/proved_split.hpp"

namespace cli::inline commands {
namespace {

using convex::Index;
using convex::Metric;
using convex::ProofLevel;
using convex::Vector;

/// An example of the catalogue with what is proved of its prox at every point, in every metric: the largest
/// bound relative to max(1, ||z||_W), the lowest level; or why not.
struct ProvedExample {
  std::string text;
  Index n = 0;
  ProofLevel level = ProofLevel::exact;
  double error_bound = 0;
  std::size_t questions = 0, proved = 0;
  std::string why_none = {};

  bool is_proved() const { return proved == questions; }
  /// Of which all are proved.
  int digits() const {
    constexpr int most_digits = 17;
    if (error_bound <= 0) return most_digits;
    return std::clamp(static_cast<int>(std::floor(-std::log10(error_bound))), 0, most_digits);
  }
};

/// Identity, a diagonal and a full metric.
std::vector<Metric> proof_metrics(Index n) {
  Vector d(n);
  convex::Matrix W = convex::Matrix::Identity(n, n);
  for (Index i = 0; i < n; ++i) {
    d[i] = 1 + 0.5 * static_cast<double>(i % 3);
    W(i, i) = 2;
    if (i > 0) W(i, i - 1) = W(i - 1, i) = 0.5;
  }
  return {Metric::identity(n), Metric::diagonal(d), Metric::dense(W)};
}

/// Points on both sides of domains and corners, in quarters.
std::vector<Vector> proof_points(Index n) {
  Vector a(n), b(n);
  for (Index i = 0; i < n; ++i) {
    a[i] = 0.25 * static_cast<double>((7 * i + 5) % 13 - 4);
    b[i] = 1.5 - 0.75 * static_cast<double>((5 * i + 2) % 7);
  }
  return {a, b, 0.125 * a};
}

void prove_one(ProvedExample& example) {
  const convex::Call call = parse_call(example.text, "f");
  example.n = number_of_entries(call);
  for (const Metric& W : proof_metrics(example.n)) {
    try {
      const convex::Function f = convex::make_function(call, {W});
      for (const Vector& z : proof_points(example.n)) {
        ++example.questions;
        const convex::ProvedSplit proof =
            prove({call, convex::fractions(z), convex::exact_gram(W)}, convex::decompose(f, z, W));
        if (proof.level == ProofLevel::none) {
          if (example.why_none.empty()) example.why_none = proof.why_none;
          continue;
        }
        ++example.proved;
        example.level = std::min(example.level, proof.level);
        example.error_bound = std::max(example.error_bound, proof.error_bound() / std::max(1.0, W.norm(z)));
      }
    } catch (const convex::InvalidInput&) {  // a metric that couples blocks which depend on it
    }
  }
}

void prove_all(std::vector<ProvedExample>& all) {
  std::atomic<std::size_t> next{0};
  const auto work = [&] {
    for (std::size_t k = next++; k < all.size(); k = next++) prove_one(all[k]);
  };
  std::vector<std::jthread> threads;
  for (unsigned k = 1; k < std::max(1U, std::thread::hardware_concurrency()); ++k) threads.emplace_back(work);
  work();
}

std::string proofs_text(const std::vector<ProvedExample>& all, std::size_t proved, double seconds) {
  TextTable table({"", "proved", "level", "digits"});
  std::string others;
  int least = 17;
  for (const ProvedExample& one : all) {
    table.add({one.text, fmt::format("{}/{}", one.proved, one.questions),
               one.proved > 0 ? name(one.level) : "none",
               one.proved > 0 ? std::to_string(one.digits()) : ""});
    if (one.is_proved())
      least = std::min(least, one.digits());
    else
      others += fmt::format("not proved  {}: {}\n", one.text, one.why_none);
  }
  return table.text() + (others.empty() ? "" : "\n" + others) +
         fmt::format(
             "\n{} of {} examples are proved at three points in three metrics, to {} digits at least "
             "({:.1f} s).\n",
             proved, all.size(), least, seconds);
}

std::string proofs_json(const std::vector<ProvedExample>& all, std::size_t proved, double seconds) {
  JsonWriter json;
  json.begin_object().key("kind").value("catalogue").key("status");
  json.value(proved == all.size() ? "passed" : "unproved");
  json.key("proved").value(static_cast<Index>(proved)).key("examples").value(static_cast<Index>(all.size()));
  json.key("functions").begin_array();
  for (const ProvedExample& one : all) {
    json.begin_object().key("call").value(one.text).key("dimension").value(one.n);
    json.key("proved").value(static_cast<Index>(one.proved));
    json.key("questions").value(static_cast<Index>(one.questions));
    json.key("level").value(name(one.proved > 0 ? one.level : ProofLevel::none));
    if (one.proved > 0) json.key("error_bound").value(one.error_bound);
    if (!one.is_proved()) json.key("why").value(one.why_none);
    json.end_object();
  }
  return json.end_array().key("seconds").value(seconds).end_object().text() + "\n";
}

}  // namespace

Exit prove_catalogue(const Printing& options) {
  const auto start = std::chrono::steady_clock::now();
  std::vector<ProvedExample> all;
  for (const convex::CatalogueEntry& entry : convex::catalogue())
    for (const std::string_view example : entry.examples)
      all.push_back(ProvedExample{.text = std::string(example)});
  prove_all(all);
  const double seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  const auto proved = static_cast<std::size_t>(
      std::count_if(all.begin(), all.end(), [](const ProvedExample& one) { return one.is_proved(); }));
  if (options.json)
    fmt::print("{}", proofs_json(all, proved, seconds));
  else if (!options.quiet)
    fmt::print("{}", proofs_text(all, proved, seconds));
  return proved == all.size() ? Exit::solved : Exit::inaccurate;
}

}  // namespace cli::inline commands
