#include "cli/drawing/method_style.hpp"

#include <algorithm>
#include <array>

namespace cli {
namespace {

constexpr std::array colours{"#0072b2", "#009e73", "#cc79a7", "#e69f00", "#56b4e9", "#882255", "#999933"};
constexpr std::array markers{5, 9, 11, 13, 7};

}  // namespace

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
      styles_.push_back({others % 2 == 0 ? "#222222" : "#6b6b6b", markers[others % markers.size()],
                         1 + static_cast<int>(others % 4), 0.75});
      ++others;
    }
  }
}

const MethodStyle& MethodStyles::style(const std::string& method) const {
  const auto place = std::find(methods_.begin(), methods_.end(), method) - methods_.begin();
  return styles_[static_cast<std::size_t>(place)];
}

}  // namespace cli
