#include <algorithm>

#include "cli/report/explanation.hpp"
#include "cli/report/readable_numbers.hpp"
#include "cli/report/singular_report.hpp"
#include "cli/report/text_table.hpp"

namespace cli::inline reports {
namespace {

using convex::Index;

/// The constraint as it was written: that of its member, else that of its family; "" when it is given by
/// looseness under another name.
std::string written_constraint(const SystemProblem& text, const std::string& name) {
  const std::string family = name.substr(0, name.find('['));
  const mechanics::NamedText* found = nullptr;
  for (const mechanics::NamedText& constraint : text.system.constraints) {
    const std::string& key = constraint.name.text;
    if (key == name) return constraint.value.text;
    if (key.substr(0, key.find('[')) == family && found == nullptr) found = &constraint;
  }
  return found != nullptr ? of_member(found->name.text, found->value.text, name) : "";
}

Line row_of(const SolvedScene& solved, std::size_t k) {
  const Index row = static_cast<Index>(k);
  return {Math{"u", "u"}, " = ", vector_math(solved.scene.problem.U.row(row)),  " and ",
          Math{"s", "s"}, " = ", number_math(solved.scene.problem.s[row] + 0.0)};
}

void append(Line& line, Line more) {
  for (Piece& piece : more) line.push_back(std::move(piece));
}

Line begun(const SolvedScene& solved, const SystemProblem* text, std::size_t a) {
  const std::string& name = solved.scene.constraints[a];
  Line line{Name{name}};
  if (text == nullptr) return line;
  const std::string relation = written_constraint(*text, name);
  if (!relation.empty()) append(line, {", ", Math{relation, expression_latex(relation)}});
  return line;
}

}  // namespace

void explain_contacts(Document& document, const SolvedScene& solved, const SystemProblem* text) {
  const Scene& scene = solved.scene;
  auto& blocks = document.blocks;
  blocks.emplace_back(Heading{"What each contact asks"});
  blocks.emplace_back(Paragraph{
      {text == nullptr ? "Every row is a condition on q'', as those of contacts are at their instant: "
                       : "A constraint that holds with room, f > 0, or that is being left, df/dt > 0, asks "
                         "nothing of the accelerations. One "
                         "that is just met, f = 0 and df/dt = 0, is in K and asks that f does not fall below "
                         "0 next (the paper's (7)): ",
       Math{"d²f/dt² = u·q'' - s >= 0", "\\ddot f = u\\cdot\\ddot q - s \\ge 0"}, "."}});
  if (scene.constraints.empty())
    blocks.emplace_back(Paragraph{{"There is no constraint: the motion is free."}});
  const std::size_t shown = std::min(scene.constraints.size(), static_cast<std::size_t>(most_rows));
  for (std::size_t a = 0; a < shown; ++a) {
    const Index i = static_cast<Index>(a);
    Line line = begun(solved, text, a);
    const auto row = std::find(scene.contacts.begin(), scene.contacts.end(), i);
    if (scene.rates) {
      const double f = without_rounding(scene.rates->f[i], scene.rates->f_scale[i]),
                   df = without_rounding(scene.rates->df[i], scene.rates->df_scale[i]);
      append(line, {": ", Math{"f = " + number_text(f), "f = " + number_math(f).latex}, ", ",
                    Math{"df/dt = " + number_text(df), "\\dot f = " + number_math(df).latex}});
      if (row == scene.contacts.end())
        line.emplace_back(f != 0 ? std::string(". It is apart: not in K.")
                                 : std::string(". It is being left: not in K."));
    }
    if (row != scene.contacts.end()) {
      line.emplace_back(scene.rates
                            ? (scene.two_sided[a] ? ". It is two-sided, in K at all times, with equality: "
                                                  : ". It is in K: ")
                            : ": ");
      append(line, row_of(solved, static_cast<std::size_t>(row - scene.contacts.begin())));
      if (!scene.rates && scene.two_sided[a]) line.emplace_back(", with equality");
      line.emplace_back(".");
    }
    blocks.emplace_back(Paragraph{std::move(line)});
  }
  if (shown < scene.constraints.size())
    blocks.emplace_back(Paragraph{
        {std::to_string(scene.constraints.size() - shown) + " more constraints are left out here."}});
  for (std::size_t k = 0; k < scene.added.size(); ++k)
    blocks.emplace_back(Paragraph{{added_row_text(scene, k) +
                                   ". It is held with equality, like a two-sided contact, and its multiplier "
                                   "is that of the row, not of a contact."}});
}

}  // namespace cli::inline reports
