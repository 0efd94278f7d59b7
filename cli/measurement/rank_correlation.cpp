#include "cli/measurement/rank_correlation.hpp"

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <map>

#include "cli/measurement/contest.hpp"
#include "convex/invalid_input.hpp"

namespace cli::inline measurement {
namespace {

constexpr double good_error = 1e-9;

using Times = std::map<std::string, double>;  // by method

/// The least time to a good error, by problem (with its size, which --quick changes) and method.
std::map<std::string, Times> best_times(const std::vector<Trial>& trials) {
  std::map<std::string, Times> best;
  for (const Trial& t : trials) {
    if (t.verdict() == Verdict::refused) continue;
    const std::string problem = t.problem + " (n " + std::to_string(t.n) + ", m " + std::to_string(t.m) + ")";
    double& time = best[problem].try_emplace(t.method, INFINITY).first->second;
    if (t.is_right() && t.judgement.error <= good_error) time = std::min(time, t.seconds);
  }
  return best;
}

std::vector<double> ranks(const std::vector<double>& times) {
  std::vector<double> result;
  for (const double time : times) {
    const auto less = std::count_if(times.begin(), times.end(), [&](double t) { return t < time; });
    const auto equal = std::count(times.begin(), times.end(), time);
    result.push_back(static_cast<double>(less) + 0.5 * static_cast<double>(equal + 1));
  }
  return result;
}

double correlation(const std::vector<double>& x, const std::vector<double>& y) {
  const auto n = static_cast<double>(x.size());
  double mean_x = 0, mean_y = 0, xy = 0, xx = 0, yy = 0;
  for (std::size_t i = 0; i < x.size(); ++i) {
    mean_x += x[i] / n;
    mean_y += y[i] / n;
  }
  for (std::size_t i = 0; i < x.size(); ++i) {
    xy += (x[i] - mean_x) * (y[i] - mean_y);
    xx += (x[i] - mean_x) * (x[i] - mean_x);
    yy += (y[i] - mean_y) * (y[i] - mean_y);
  }
  return xx > 0 && yy > 0 ? xy / std::sqrt(xx * yy) : 1;
}

/// The fields of a line; a quoted one may hold commas, "" in it is a quote.
std::vector<std::string> fields(const std::string& line) {
  std::vector<std::string> all(1);
  bool quoted = false;
  for (std::size_t i = 0; i < line.size(); ++i) {
    if (line[i] == '"' && quoted && i + 1 < line.size() && line[i + 1] == '"')
      all.back() += line[i++];
    else if (line[i] == '"')
      quoted = !quoted;
    else if (line[i] == ',' && !quoted)
      all.emplace_back();
    else
      all.back() += line[i];
  }
  return all;
}

double number(const std::string& text) { return text.empty() ? unknown : std::strtod(text.c_str(), nullptr); }

}  // namespace

std::vector<RankCorrelation> rank_correlations(const std::vector<Trial>& trials,
                                               const std::vector<Trial>& before) {
  const auto now = best_times(trials), then = best_times(before);
  std::vector<RankCorrelation> all;
  for (const auto& [problem, times] : now) {
    const auto known = then.find(problem);
    if (known == then.end()) continue;
    std::vector<double> x, y;
    for (const auto& [method, time] : times)
      if (const auto old = known->second.find(method); old != known->second.end()) {
        x.push_back(time);
        y.push_back(old->second);
      }
    if (x.size() > 1) all.push_back({problem, correlation(ranks(x), ranks(y))});
  }
  return all;
}

std::vector<Trial> read_chart_csv(const std::string& file) {
  std::ifstream lines(file);
  std::string line;
  if (!std::getline(lines, line) || line != "problem,n,m,method,setting,seconds,error,status")
    throw convex::InvalidInput(file + ": not a table of `moreau chart --data`; give one");
  std::vector<Trial> trials;
  while (std::getline(lines, line)) {
    const std::vector<std::string> row = fields(line);
    if (row.size() != 8) throw convex::InvalidInput(file + ": a row has not eight fields; write it again");
    Trial t;
    t.problem = row[0];
    t.n = std::strtol(row[1].c_str(), nullptr, 10);
    t.m = std::strtol(row[2].c_str(), nullptr, 10);
    t.method = row[3];
    t.setting = number(row[4]);
    t.seconds = number(row[5]);
    t.judgement.error = number(row[6]);
    t.judgement.verdict = Verdict::gave_up;
    for (const Verdict known :
         {Verdict::ok, Verdict::wrong, Verdict::too_slow, Verdict::refused, Verdict::crashed})
      if (row[7] == verdict_text(known)) t.judgement.verdict = known;
    // Of one method and setting the second row is that after refinement; an iteration has many settings.
    for (Trial& before : trials) {
      if (before.problem != t.problem || before.method != t.method) continue;
      if (before.setting == t.setting)
        t.judgement.polished = true;
      else
        t.kind = before.kind = convex::MethodKind::iterative;
    }
    trials.push_back(std::move(t));
  }
  return trials;
}

std::optional<std::string> committed_data() {
  namespace fs = std::filesystem;
  std::error_code ignored;
  const fs::path program = fs::read_symlink("/proc/self/exe", ignored);
  for (const fs::path& folder : {program.parent_path().parent_path(), fs::current_path(ignored)}) {
    const fs::path file = folder / "docs" / "charts" / "speed_accuracy.csv";
    if (fs::exists(file, ignored)) return file.string();
  }
  return std::nullopt;
}

}  // namespace cli::inline measurement
