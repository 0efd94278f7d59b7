#include <CLI/CLI.hpp>

#include <fmt/format.h>

#include <atomic>
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <thread>

#include "cli/commands/command_line.hpp"
#include "cli/drawing/sweep_drawing.hpp"
#include "cli/each_file.hpp"
#include "cli/json_writer.hpp"
#include "cli/measurement/progress.hpp"
#include "cli/problem_file/documents.hpp"
#include "cli/problem_file/settings.hpp"
#include "cli/report/answer.hpp"
#include "cli/sweep/change_search.hpp"
#include "cli/sweep/sweep_table.hpp"
#include "convex/counted.hpp"

namespace cli::inline commands {
namespace {

using convex::InvalidInput;

/// What `moreau sweep` is told.
struct SweepOptions : Printing, Overrides, SceneOptions {
  std::string file;
  std::vector<std::string> over, watch;
  std::optional<std::string> output, plot;
  bool resume = false;
  unsigned threads = 0;
};

/// So many points are in memory at once.
constexpr std::size_t points_at_once = 8192;

/// The points of all ranges, the last one running fastest.
class SweepGrid {
 public:
  explicit SweepGrid(const std::vector<SweepRange>& ranges) : ranges_(ranges) {
    for (const SweepRange& range : ranges) size_ *= range.values.size();
  }
  std::size_t size() const { return size_; }
  std::vector<double> operator[](std::size_t k) const {
    std::vector<double> at(ranges_.size());
    for (std::size_t r = ranges_.size(); r-- > 0;) {
      at[r] = ranges_[r].values[k % ranges_[r].values.size()];
      k /= ranges_[r].values.size();
    }
    return at;
  }

 private:
  const std::vector<SweepRange>& ranges_;
  std::size_t size_ = 1;
};

/// Runs `work(worker, k)` for k < count on all workers.
void share_out(std::vector<SweepScene>& workers, std::size_t count,
               const std::function<void(SweepScene&, std::size_t)>& work) {
  constexpr std::size_t share = 16;
  std::atomic<std::size_t> next{0};
  const auto run = [&](SweepScene& scene) {
    for (std::size_t first = next.fetch_add(share); first < count; first = next.fetch_add(share))
      for (std::size_t k = first; k < std::min(first + share, count); ++k) work(scene, k);
  };
  std::vector<std::thread> threads;
  for (std::size_t w = 1; w < workers.size() && w * share < count; ++w)
    threads.emplace_back([&run, &workers, w] { run(workers[w]); });
  run(workers.front());
  for (std::thread& thread : threads) thread.join();
}

/// What a sweep came to.
struct SweepSummary {
  std::size_t points = 0, without_answer = 0;
  Exit exit = Exit::solved;
  std::vector<std::pair<double, std::string>> changes;  ///< and what persists there
  std::string first_without;                            ///< which point it is, and why it has no answer
  std::vector<SweepPoint> rows;                         ///< where no table is written
};

class Sweep {
 public:
  Sweep(const SweepOptions& options, TomlValue document) : options_(options) {
    ranges_ = parse_sweep_ranges(options.over);
    std::vector<std::string> keys;
    for (const SweepRange& range : ranges_) keys.push_back(range.key);
    locates_ = ranges_.size() == 1 && ranges_.front().is_range;
    unsigned threads = options.threads > 0 ? options.threads : std::thread::hardware_concurrency();
    threads = std::max(1U, threads);
    for (unsigned k = 0; k < threads; ++k) workers_.emplace_back(document, options.file, keys, options);
    watched_ = workers_.front().watched(options.watch, SweepGrid(ranges_)[0]);
    table_ = std::make_unique<SweepTable>(keys, watched_, workers_.front().constraints(), locates_);
  }

  SweepSummary run() {
    const SweepGrid grid(ranges_);
    std::size_t begin = open_output(grid);
    if (begin > 0 && locates_) {
      pending_ = workers_.front().solve(grid[begin - 1], watched_);
      is_written_ = true;
    }
    const std::size_t blocks = (grid.size() - begin + points_at_once - 1) / points_at_once;
    Progress progress(static_cast<int>(blocks));
    for (; begin < grid.size() && !Progress::interrupted(); begin += points_at_once) {
      const std::size_t count = std::min(points_at_once, grid.size() - begin);
      std::vector<SweepPoint> points(count);
      share_out(workers_, count, [&](SweepScene& scene, std::size_t k) {
        points[k] = scene.solve(grid[begin + k], watched_);
      });
      if (locates_) locate(points);
      for (const SweepPoint& point : points) write(point);
      progress.step();
    }
    if (pending_) write(*pending_);
    if (file_.is_open()) {
      file_.close();
      if (!file_)
        throw InvalidInput("cannot write " + *options_.output + "; check its folder and permissions");
    }
    return std::move(summary_);
  }

  const SweepRecord& record() const { return record_; }
  std::vector<std::string> angles_in_degrees() {
    const SweepGrid grid(ranges_);
    return workers_.front().angles_in_degrees({grid[0], grid[grid.size() - 1]});
  }
  const std::vector<SweepRange>& ranges() const { return ranges_; }
  const std::vector<Watched>& watched() const { return watched_; }
  const SweepTable& table() const { return *table_; }
  const std::vector<std::string>& constraints() { return workers_.front().constraints(); }

 private:
  /// The first point that is still to be done.
  std::size_t open_output(const SweepGrid& grid) {
    if (!options_.output) {
      if (prints_table()) fmt::print("{}", table_->header());
      return 0;
    }
    std::size_t done = 0;
    if (options_.resume) {
      const auto [kept, points] = table_->resumed(*options_.output, [&](std::size_t k) { return grid[k]; });
      done = points;
      if (points > 0) {
        std::error_code error;
        std::filesystem::resize_file(*options_.output, kept, error);
        if (error) throw InvalidInput("cannot write " + *options_.output + "; check its permissions");
        // The last point is done again: changes may follow it.
        file_.open(*options_.output, std::ios::binary | std::ios::app);
        return done;
      }
    }
    file_.open(*options_.output, std::ios::binary | std::ios::trunc);
    if (!file_) throw InvalidInput("cannot write " + *options_.output + "; check its folder and permissions");
    file_ << table_->header();
    return done;
  }

  bool prints_table() const { return !options_.output && !options_.quiet && !options_.json; }

  /// Adds the points where contacts change, each behind the point before it.
  void locate(std::vector<SweepPoint>& points) {
    std::vector<SweepPoint> all;
    if (pending_) all.push_back(std::move(*pending_));
    pending_.reset();
    for (SweepPoint& point : points) all.push_back(std::move(point));
    std::vector<std::size_t> pairs;
    for (std::size_t k = 0; k + 1 < all.size(); ++k)
      if (all[k].has_answer() != all[k + 1].has_answer() || all[k].active != all[k + 1].active)
        pairs.push_back(k);
    std::vector<std::vector<SweepPoint>> found(all.size());
    const std::vector<double>& values = ranges_.front().values;
    const double range = std::abs(values.back() - values.front());
    share_out_singly(pairs.size(), [&](SweepScene& scene, std::size_t p) {
      const std::size_t k = pairs[p];
      ChangeSearch search(scene, watched_, values.front(), values.back());
      for (const double value : search.between(all[k], all[k + 1])) {
        SweepPoint point = scene.solve({value}, watched_);
        point.is_change = true;
        found[k].push_back(std::move(point));
      }
    });
    points.clear();
    const std::size_t written = is_written_ ? 1 : 0;
    is_written_ = false;
    for (std::size_t k = 0; k < all.size(); ++k) {
      const auto is_at = [&](const SweepPoint& change, const SweepPoint& point) {
        return std::abs(change.at[0] - point.at[0]) <= ChangeSearch::change_part * range;
      };
      // A change at a point of the grid is marked there.
      for (SweepPoint& change : found[k]) {
        if (is_at(change, all[k])) all[k].is_change = true;
        if (k + 1 < all.size() && is_at(change, all[k + 1])) all[k + 1].is_change = true;
      }
      if (k < written) continue;
      points.push_back(all[k]);
      for (SweepPoint& change : found[k]) {
        const bool on_grid = is_at(change, all[k]) || (k + 1 < all.size() && is_at(change, all[k + 1]));
        if (!on_grid && !is_at(change, points.back())) points.push_back(std::move(change));
      }
    }
    pending_ = std::move(points.back());
    points.pop_back();
  }

  void share_out_singly(std::size_t count, const std::function<void(SweepScene&, std::size_t)>& work) {
    std::atomic<std::size_t> next{0};
    const auto run = [&](SweepScene& scene) {
      for (std::size_t k = next++; k < count; k = next++) work(scene, k);
    };
    std::vector<std::thread> threads;
    for (std::size_t w = 1; w < workers_.size() && w < count; ++w)
      threads.emplace_back([&run, this, w] { run(workers_[w]); });
    run(workers_.front());
    for (std::thread& thread : threads) thread.join();
  }

  void write(const SweepPoint& point) {
    ++summary_.points;
    summary_.exit = std::max(summary_.exit, point.exit);
    if (!point.has_answer()) {
      ++summary_.without_answer;
      if (summary_.without_answer == 1) summary_.first_without = table_->without_answer(point);
    }
    if (point.is_change) summary_.changes.emplace_back(point.at[0], table_->active(point));
    if (options_.plot) record_.add(point);
    if (options_.json && !options_.output) summary_.rows.push_back(point);
    const std::string row = table_->row(point);
    if (file_.is_open())
      file_ << row;
    else if (prints_table())
      std::fwrite(row.data(), 1, row.size(), stdout);
  }

  const SweepOptions& options_;
  std::vector<SweepRange> ranges_;
  bool locates_ = false;
  std::vector<SweepScene> workers_;
  std::vector<Watched> watched_;
  std::unique_ptr<SweepTable> table_;
  std::ofstream file_;
  std::optional<SweepPoint> pending_;  ///< the last point, which may still turn out to be a change
  bool is_written_ = false;            ///< of a sweep that goes on: it stands in the table
  SweepSummary summary_;
  SweepRecord record_;
};

std::string summary_json(const SweepSummary& summary, const SweepTable& table, const SweepOptions& options) {
  JsonWriter json;
  json.begin_object().key("file").value(options.file).key("status");
  json.value(summary.without_answer > 0         ? "incomplete"
             : summary.exit == Exit::inaccurate ? "inaccurate"
                                                : "solved");
  json.key("rows").value(static_cast<convex::Index>(summary.points));
  json.key("without_answer").value(static_cast<convex::Index>(summary.without_answer));
  json.key("changes").begin_array();
  for (const auto& [value, active] : summary.changes)
    json.begin_object().key("value").value(value).key("active").value(active).end_object();
  json.end_array();
  if (!options.output) {
    json.key("table").begin_array();
    for (const SweepPoint& point : summary.rows) table.write(json, point);
    json.end_array();
  }
  return json.end_object().text() + "\n";
}

std::string summary_text(const SweepSummary& summary) {
  std::string text = convex::counted(summary.points, "row", "rows");
  if (summary.without_answer > 0) text += fmt::format(", {} without an answer", summary.without_answer);
  text += summary.changes.empty() ? "\n" : "; the contacts that persist change at\n";
  constexpr std::size_t most_told = 20;
  for (std::size_t k = 0; k < std::min(summary.changes.size(), most_told); ++k)
    text += fmt::format("  {}\n", summary.changes[k].first);
  if (summary.changes.size() > most_told)
    text += fmt::format("  and {} more\n", summary.changes.size() - most_told);
  return text;
}

Exit sweep(const SweepOptions& options) {
  if (options.plot) require_drawable(*options.plot);
  if (options.resume && !options.output)
    throw InvalidInput("--resume goes with --output F.csv; add the file to go on with");
  TomlValue document = read_document(options.file);
  apply_settings(document, parsed_settings(options.settings));
  const TomlValue* told = document.find("title");
  const std::string title = told != nullptr ? told->text : options.file;
  Sweep sweep(options, std::move(document));
  if (options.plot && sweep.ranges().size() > 2)
    throw InvalidInput("--plot takes one or two --over; a table holds any number");
  const SweepSummary summary = sweep.run();
  if (options.plot)
    draw(*options.plot, sweep_drawing(sweep.record(), sweep.ranges(), sweep.watched(), sweep.constraints(),
                                      title, !options.watch.empty()));
  if (options.json)
    fmt::print("{}", summary_json(summary, sweep.table(), options));
  else if (options.output && !options.quiet)
    fmt::print("{}", summary_text(summary));
  std::fflush(stdout);
  for (const std::string& angle : sweep.angles_in_degrees())
    fmt::print(stderr, "moreau: warning: {}: {}\n", options.file, angle);
  if (summary.without_answer > 0)
    fmt::print(stderr, "moreau: {}: {}{}\n", options.file,
               summary.without_answer == 1
                   ? std::string("1 point has no answer, ")
                   : fmt::format("{} points have no answer, the first ", summary.without_answer),
               summary.first_without);
  return summary.exit;
}

}  // namespace

void add_sweep(CLI::App& program, Work& chosen) {
  const auto options = std::make_shared<SweepOptions>();
  CLI::App& command =
      add_command(program, "sweep", "one answer for each value of a parameter, and where the contacts change",
                  chosen, [options] {
                    return answered(*options, {options->file, ""}, [&] { return sweep(*options); });
                  });
  command.add_option("FILE", options->file, "a problem file")->required();
  command
      .add_option(
          "--over", options->over,
          "what varies: a=0:0.1:1 (first:step:last) or m=1,2,4; keys as for --set; several make a grid")
      ->type_name("KEY=VALUES")
      ->required()
      ->allow_extra_args(false);
  command
      .add_option("--watch", options->watch,
                  "a column: x'', lambda[floor], reaction[x], gauss, x, x', f[floor], df[floor], ddf[floor]; "
                  "default all "
                  "accelerations and multipliers")
      ->type_name("NAME")
      ->allow_extra_args(false);
  add_table(command, "--output", options->output, "the table; default standard output");
  command.add_option("--plot", options->plot, "a picture: F.svg, F.png or F.pdf (by gnuplot)")
      ->type_name("FILE");
  command.add_flag("--resume", options->resume, "go on behind the last row of --output");
  command.add_option("--threads", options->threads, "how many at once; default all cores")->type_name("N");
  add_accuracy(command, *options);
  add_overrides(command, *options);
  add_printing(command, *options);
}

}  // namespace cli::inline commands
