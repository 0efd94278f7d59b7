#include <fmt/format.h>

#include "cli/report/catalogue_report.hpp"
#include "convex/catalogue/references.hpp"

namespace cli::inline reports {
namespace {

using convex::CatalogueEntry;
using convex::EntryKind;

constexpr const char* introduction = R"(# Functions

<!-- Made by `moreau functions --markdown`; a test compares. Change the catalogue, not this page. -->

What may stand in `f` of a `[decomposition]` ([problem-files.md](problem-files.md)) and in `moreau prox` and `moreau conjugate`
([commands.md](commands.md)): calls `name(arguments)`, one in another up to 256 deep.

- An argument is given by position or as `key=value`. It is a number (`2`, `1e-3`, `1/3`, `inf`, `-inf`), a vector `[1, 2]`, a
  matrix `[[1, 2], [3, 4]]` by rows, a set or a function. Where a vector is wanted a number stands for equal entries; where a function
  is wanted a set stands for its indicator. `a=1` below is a default.
- A function that is not convex, closed and proper is refused, and so is an empty set.
- `2*norm1() + norm2()` is `sum(scale(norm1(), 2), norm2())`, also as an argument. A difference, which need not be convex, is refused.
- Numbers in a call are plain coordinates, whatever the metric, and so are the norms in names. The metric's product (x|y) = x·Wy enters
  in `conjugate`, `envelope`, `support` and `proximal_average` alone. Inside `separable` these take the diagonal block of the metric,
  inside `precompose`, `perspective` and `epigraph` the identity.
- A matrix as an argument of a set of matrices or a spectral function is stacked by columns.
- A value is +inf outside the domain; a point within 1e-9 of the scale of itself and of the data belongs to it. Of one that
  is more than 1e-12 of that outside, farther than any prox leaves its point, the value is told with an error that may be infinite.

Facts are those that hold whatever the arguments are; a call with particular ones can have more. `moreau functions NAME` tells
more of one entry, with examples.

How a prox is found, in the identity metric, a diagonal one, and any other:

| words | meaning |
| --- | --- |
| closed form | a formula or a finite algorithm for this function, right to rounding |
| exact by active set | a nearest-point problem, solved exactly but for rounding ([methods.md](methods.md)) |
| iterative to 1e-12 | Newton's method with a returned bound on the error, which says when 1e-12 of the scale was not reached; what it leaves open of a split is looked at by cutting planes |
| as its parts, as its set, … | the best of what the arguments have |
)";

std::string escaped(std::string_view text) {
  std::string made;
  for (const char c : text) {
    if (c == '|') made += '\\';
    made += c;
  }
  return made;
}

std::string code(std::string_view text) { return "`" + escaped(text) + "`"; }

std::string prox_cell(const CatalogueEntry& entry) {
  if (entry.in_identity == entry.in_diagonal && entry.in_diagonal == entry.in_general)
    return escaped(entry.in_identity);
  if (entry.in_identity == entry.in_diagonal)
    return escaped(fmt::format("{}; general: {}", entry.in_identity, entry.in_general));
  if (entry.in_diagonal == entry.in_general)
    return escaped(fmt::format("identity: {}; else {}", entry.in_identity, entry.in_general));
  return escaped(fmt::format("identity: {}; diagonal: {}; general: {}", entry.in_identity, entry.in_diagonal,
                             entry.in_general));
}

std::string facts_cell(const CatalogueLine& line) {
  std::string text;
  for (const std::string& word : fact_words(line.facts)) text += (text.empty() ? "" : ", ") + word;
  if (!line.entry->domain.empty())
    text += fmt::format("{}finite on {}", text.empty() ? "" : ", ", escaped(line.entry->domain));
  return text;
}

std::string section(const std::vector<CatalogueLine>& lines, EntryKind kind, const char* title) {
  const bool operation = kind == EntryKind::operation;
  std::string text =
      fmt::format("\n## {}\n\n| call | meaning | {}prox | source |\n| --- | --- | {}--- | --- |\n", title,
                  operation ? "" : "facts | ", operation ? "" : "--- | ");
  for (const CatalogueLine& line : lines) {
    const CatalogueEntry& entry = *line.entry;
    if (entry.kind != kind) continue;
    text +=
        fmt::format("| {} | {} | {}{} | {} |\n",
                    code(std::string(entry.name) + "(" + arguments_text(entry) + ")"), escaped(entry.formula),
                    operation ? "" : facts_cell(line) + " | ", prox_cell(entry), escaped(entry.source));
  }
  return text;
}

std::string reference_list() {
  std::string text = "\n## References\n\n";
  for (const convex::Reference& work : convex::references())
    text += fmt::format("- {}: {}.\n", work.name, escaped(work.text));
  return text;
}

}  // namespace

std::string catalogue_markdown(const std::vector<CatalogueLine>& lines) {
  return introduction + section(lines, EntryKind::set, "Sets") +
         section(lines, EntryKind::function, "Functions") +
         section(lines, EntryKind::operation, "Operations") + reference_list();
}

}  // namespace cli::inline reports
