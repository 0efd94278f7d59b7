#include "cli/commands/liquid_frames.hpp"

#include "cli/drawing/liquid_animation.hpp"
#include "cli/measurement/progress.hpp"
#include "cli/problem_file/documents.hpp"

namespace cli::inline commands {
namespace {

using convex::InvalidInput;
using mechanics::liquid::LiquidScene;
using mechanics::liquid::LiquidText;

/// A page holds no more frames.
constexpr std::size_t most_frames = 500;
/// Cells of a frame along the longest side, by dimension, where the file does not say.
constexpr std::array<long, 3> cells_of_frame{256, 128, 32};

}  // namespace

LiquidFrames::LiquidFrames(const LiquidText& text, const std::optional<std::string>& file,
                           const std::optional<std::string>& over)
    : text_(text) {
  if (!file)
    throw InvalidInput(
        "--over goes with --animate here; give a page to write, or run `moreau sweep` on a mechanism");
  if (!over) throw InvalidInput("--animate of a liquid needs --over; write --over NAME=0:0.05:3");
  if (!file->ends_with(".html"))
    throw InvalidInput("--animate " + *file + ": a page is written; give a name that ends with .html");
  file_ = *file;
  range_ = parse_sweep_range(*over);
  mechanics::liquid::parameter_value(text, range_.key);
  if (range_.values.size() > most_frames)
    throw InvalidInput("--over " + *over + ": a page holds at most " + std::to_string(most_frames) +
                       " values; choose a larger step");
}

void LiquidFrames::write(const std::string& title) const {
  LiquidAnimation animation(range_.key);
  Progress progress(static_cast<int>(range_.values.size()));
  for (const double value : range_.values) {
    if (Progress::interrupted())
      throw InvalidInput("--animate " + file_ + ": interrupted; nothing is written");
    try {
      LiquidScene scene = mechanics::liquid::read_scene(with_parameter(text_, range_.key, value));
      if (!scene.cells) scene.cells = cells_of_frame[scene.dimension() - 1];
      animation.add(value, scene, mechanics::liquid::solve_liquid(scene));
    } catch (const InvalidInput& error) {
      animation.add_failure(value, error.what());
    }
    progress.step();
  }
  if (const auto onset = mechanics::liquid::find_onset(text_, range_.key, {}).onset)
    animation.mark_onset(*onset);
  write_file(file_, animation.page(title));
}

}  // namespace cli::inline commands
