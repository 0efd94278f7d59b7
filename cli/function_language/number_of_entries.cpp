#include "cli/function_language/number_of_entries.hpp"

#include <set>
#include <vector>

#include "convex/catalogue/catalogue.hpp"

namespace cli::inline function_language {
namespace {

using convex::Call;
using convex::Index;

/// Sizes larger than this are not tried: the data of a call that wants them have told.
constexpr Index largest_untold = 64, usual = 3;

/// The sizes of vectors and the widths of matrices, outer calls first.
void collect_sizes(const Call& call, std::vector<Index>& sizes) {
  for (const convex::NamedArgument& argument : call.arguments) {
    if (const auto* x = std::get_if<convex::Vector>(&argument.value)) sizes.push_back(x->size());
    if (const auto* A = std::get_if<convex::Matrix>(&argument.value)) sizes.push_back(A->cols());
  }
  for (const convex::NamedArgument& argument : call.arguments)
    if (const auto* nested = std::get_if<std::shared_ptr<const Call>>(&argument.value))
      collect_sizes(**nested, sizes);
}

bool accepts(const Call& call, Index n) {
  try {
    convex::make_function(call, {convex::Metric::identity(n)});
    return true;
  } catch (const convex::InvalidInput&) {
    return false;
  }
}

}  // namespace

Index number_of_entries(const Call& call) {
  std::vector<Index> candidates;
  collect_sizes(call, candidates);
  candidates.push_back(usual);
  for (Index n = 1; n <= largest_untold; ++n) candidates.push_back(n);
  std::set<Index> refused;
  for (const Index n : candidates)
    if (n > 0 && refused.insert(n).second && accepts(call, n)) return n;
  for (const Index n : candidates)
    if (n > 0) return n;  // the first suggestion, whose refusal says most
  return usual;
}

}  // namespace cli::inline function_language
