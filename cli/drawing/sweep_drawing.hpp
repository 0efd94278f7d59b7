#pragma once

#include "cli/drawing/gnuplot.hpp"
#include "cli/sweep/sweep_point.hpp"

namespace cli::inline drawings {

/// The points of a sweep for a picture; of very many every second one is dropped, again and again.
class SweepRecord {
 public:
  void add(const SweepPoint&);
  const std::vector<SweepPoint>& points() const { return points_; }

 private:
  std::vector<SweepPoint> points_;
  std::size_t stride_ = 1, seen_ = 0;
};

/// Over one range: what is watched as curves, the sets of contacts that persist as bands behind them. Over
/// two: a map of these sets, or of one number that was chosen, with lines between the sets.
Drawing sweep_drawing(const SweepRecord&, const std::vector<SweepRange>&, const std::vector<Watched>&,
                      const std::vector<std::string>& constraints, const std::string& title, bool is_chosen);

}  // namespace cli::inline drawings
