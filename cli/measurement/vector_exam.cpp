#include "cli/measurement/vector_exam.hpp"

#include <cmath>
#include <memory>

namespace cli::inline measurement {

std::vector<Contest> contests(VectorExam given, std::vector<Way> ways) {
  const auto exam = std::make_shared<const VectorExam>(std::move(given));
  std::vector<Contest> all;
  for (Way& way : ways) {
    const auto found = std::make_shared<FoundVector>();
    all.push_back({exam->name, exam->W.dimension(), 0, std::move(way.method), way.kind,
                   std::move(way.refused),
                   [found, find = std::move(way.find)](const convex::Accuracy& accuracy) {
                     *found = find(accuracy.tolerance);
                   },
                   [exam, found] {
                     Judgement result;
                     if (found->x.size() != exam->truth.size()) return Judgement{.verdict = Verdict::gave_up};
                     result.error = exam->W.norm((found->x - exam->truth.hi) - exam->truth.lo) / exam->scale;
                     result.bound = found->bound / exam->scale;
                     if (found->gave_up || !std::isfinite(result.bound))
                       result.verdict = Verdict::gave_up;
                     else if (exceeds(result.error, result.bound))
                       result.verdict = Verdict::wrong;
                     return result;
                   }});
  }
  return all;
}

}  // namespace cli::inline measurement
