#include "cli/measurement/trial_files.hpp"

#include <fmt/format.h>

#include <cmath>
#include <fstream>
#include <iterator>

#include "cli/json_writer.hpp"
#include "cli/measurement/machine.hpp"
#include "convex/invalid_input.hpp"

namespace cli::inline measurement {
namespace {

/// Four digits are more than any of these numbers has; empty where there is nothing to tell.
std::string field(double x) { return std::isfinite(x) ? fmt::format("{:.4g}", x) : ""; }

std::string field(const std::string& text) {
  if (text.find_first_of(",\"\n") == std::string::npos) return text;
  std::string result = "\"";
  for (const char c : text) result += c == '"' ? std::string("\"\"") : std::string(1, c);
  return result + "\"";
}

}  // namespace

std::string chart_csv(const std::vector<Trial>& trials) {
  std::string text = "problem,n,m,method,setting,seconds,error,status\n";
  for (const Trial& t : trials)
    text += fmt::format("{},{},{},{},{},{},{},{}\n", field(t.problem), t.n, t.m, t.method, field(t.setting),
                        field(t.seconds), field(t.judgement.error), verdict_text(t.verdict()));
  return text;
}

std::string stress_csv(const std::vector<StressTrial>& trials) {
  std::string text = "family,difficulty,n,m,method,seconds,error,status\n";
  for (const auto& [family, knob, difficulty, t] : trials)
    text += fmt::format("{},{},{},{},{},{},{},{}\n", family, field(difficulty), t.n, t.m, t.method,
                        field(t.seconds), field(t.judgement.error), verdict_text(t.verdict()));
  return text;
}

std::string measurement_json(const std::vector<Trial>& trials, const TrialLimits& limits) {
  JsonWriter json;
  json.begin_object().key("machine").value(machine_text());
  json.key("time").value(
      "processor seconds from raw numbers to the answer, factorisations included: the median of batches of "
      "at "
      "least 20 us after a warm-up, one process pinned to one processor");
  json.key("budget_seconds").value(limits.budget).key("limit_seconds").value(limits.limit);
  json.key("rows").begin_array();
  const auto number = [&](const char* key, double value) {
    json.key(key);
    if (std::isfinite(value))
      json.value(value);
    else
      json.null();
  };
  for (const Trial& t : trials) {
    json.begin_object().key("polished").value(t.judgement.polished);
    number("lower_quartile", t.lower);
    number("upper_quartile", t.upper);
    json.key("repetitions").value(t.repetitions);
    number("multiplier_error", t.judgement.multiplier_error);
    number("reported_bound", t.judgement.bound);
    json.end_object();
  }
  json.end_array().end_object();
  return json.text() + "\n";
}

std::string about_file(const std::string& data_file) {
  const std::size_t dot = data_file.rfind('.');
  const std::size_t slash = data_file.rfind('/');
  const bool has_ending = dot != std::string::npos && (slash == std::string::npos || dot > slash);
  return (has_ending ? data_file.substr(0, dot) : data_file) + ".about.json";
}

}  // namespace cli::inline measurement
