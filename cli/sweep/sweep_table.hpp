#pragma once

#include <functional>

#include "cli/json_writer.hpp"
#include "cli/sweep/sweep_point.hpp"

namespace cli::inline sweeps {

/// The table of a sweep: parameters, status, active, change (where changes are looked for), what is watched,
/// error_bound.
class SweepTable {
 public:
  SweepTable(std::vector<std::string> keys, const std::vector<Watched>& watched,
             std::vector<std::string> constraints, bool has_changes)
      : keys_(std::move(keys)),
        watched_(watched),
        constraints_(std::move(constraints)),
        has_changes_(has_changes) {}

  std::string header() const;
  std::string row(const SweepPoint&) const;
  /// The same as an object, `active` a list; null for what is missing.
  void write(JsonWriter&, const SweepPoint&) const;
  /// Which point it is, and why it has no answer.
  std::string without_answer(const SweepPoint&) const;
  /// The names of what persists, with spaces between.
  std::string active(const SweepPoint&) const;

  /// How much of a table is there: bytes up to the end of the last point but one, and how many points that
  /// is. Throws InvalidInput when it is the table of something else.
  std::pair<std::uintmax_t, std::size_t> resumed(
      const std::string& file, const std::function<std::vector<double>(std::size_t)>& point) const;

 private:
  std::vector<std::string> keys_;
  const std::vector<Watched>& watched_;
  std::vector<std::string> constraints_;
  bool has_changes_;
};

}  // namespace cli::inline sweeps
