#include "cli/report/explanation.hpp"

#include <algorithm>

#include "cli/report/readable_numbers.hpp"
#include "cli/report/text_table.hpp"

namespace cli::inline reports {

Name constraint_name(const Scene& scene, std::size_t constraint) {
  return {scene.constraints[constraint] + (scene.two_sided[constraint] ? " (=)" : "")};
}

Name row_name(const Scene& scene, convex::Index row) {
  const auto k = static_cast<std::size_t>(row);
  return k < scene.contacts.size() ? constraint_name(scene, static_cast<std::size_t>(scene.contacts[k]))
                                   : Name{scene.contact_name(row)};
}

Math indexed(const std::string& plain, const std::string& latex, const std::string& name) {
  std::string safe;
  for (const char c : name) safe += c == '_' ? std::string("\\_") : std::string(1, c);
  return {plain + "_" + name, latex + "_{\\text{" + safe + "}}"};
}

Math vector_math(const convex::Vector& v) {
  constexpr convex::Index most = 8;
  Math made{"(", "("};
  const convex::Index shown = v.size() <= most + 1 ? v.size() : most;  // "1 more" is as long as the number
  for (convex::Index i = 0; i < shown; ++i) {
    const Math number = number_math(without_rounding(v[i], v.cwiseAbs().maxCoeff()));
    made.plain += (i == 0 ? "" : ", ") + number.plain;
    made.latex += (i == 0 ? "" : ",\\allowbreak\\ ") + number.latex;
  }
  if (shown < v.size()) {
    const std::string rest = std::to_string(v.size() - shown);
    made.plain += ", … " + rest + " more";
    made.latex += ",\\ \\dots\\ \\text{" + rest + " more}";
  }
  made.plain += ")";
  made.latex += ")";
  return made;
}

Document explanation(const SolvedScene& solved, const SystemProblem* text, const Line& next) {
  const Scene& scene = solved.scene;
  Document document{scene.title.empty() ? scene.file : scene.title, {}};
  if (text != nullptr) explain_letters(document, *text);
  if (text != nullptr) explain_mechanism(document, solved, *text);
  explain_contacts(document, solved, text);
  if (!solved.infeasible()) explain_hypothesis(document, solved);
  explain_answer(document, solved);
  if (!next.empty()) {
    document.blocks.emplace_back(Heading{"What comes next"});
    document.blocks.emplace_back(Paragraph{next});
  }
  return document;
}

}  // namespace cli::inline reports
