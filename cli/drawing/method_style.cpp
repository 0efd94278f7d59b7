#include "cli/drawing/method_style.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cstdlib>

namespace cli::inline drawings {
namespace {

constexpr std::array colours{"#0072b2", "#009e73", "#cc79a7", "#e69f00", "#56b4e9", "#882255", "#999933"};
constexpr std::array dark_colours{"#222222", "#8c510a", "#542788", "#01665e",
                                  "#a31621", "#1f4e79", "#6b6b6b"};
constexpr std::array markers{5, 9, 11, 13, 7};

}  // namespace

std::string MethodStyle::text_colour() const {
  constexpr double lightest = 0.3;  // of white: readable on white at 9 points
  constexpr int base = 16;
  const long value = std::strtol(colour.c_str() + 1, nullptr, base);
  const double red = static_cast<double>(value >> 16 & 255), green = static_cast<double>(value >> 8 & 255),
               blue = static_cast<double>(value & 255);
  const double light = (0.3 * red + 0.59 * green + 0.11 * blue) / 255;
  const double part = std::min(1.0, lightest / std::max(light, lightest / 2));
  return fmt::format("#{:02x}{:02x}{:02x}", static_cast<int>(part * red), static_cast<int>(part * green),
                     static_cast<int>(part * blue));
}

MethodStyles::MethodStyles(const std::vector<Trial>& trials) {
  std::size_t iterations = 0, others = 0;
  for (const Trial& trial : trials) {
    if (trial.verdict() == Verdict::refused) continue;
    if (std::find(methods_.begin(), methods_.end(), trial.method) != methods_.end()) continue;
    methods_.push_back(trial.method);
    if (trial.method == "auto") {
      styles_.push_back({"#d55e00", 7, 1, 1.1});
    } else if (trial.kind == convex::MethodKind::iterative) {
      styles_.push_back({colours[iterations % colours.size()], markers[iterations % markers.size()],
                         1 + static_cast<int>(iterations / 2 % 4), 0.55});
      ++iterations;
    } else {
      styles_.push_back({dark_colours[others % dark_colours.size()], markers[others % markers.size()],
                         1 + static_cast<int>(others % 4), 0.75});
      ++others;
    }
  }
}

const MethodStyle& MethodStyles::style(const std::string& method) const {
  const auto place = std::find(methods_.begin(), methods_.end(), method) - methods_.begin();
  return styles_[static_cast<std::size_t>(place)];
}

}  // namespace cli::inline drawings
