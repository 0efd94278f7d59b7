#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "cli/report/appell_function.hpp"
#include "cli/report/explanation.hpp"
#include "cli/report/readable_numbers.hpp"
#include "cli/report/text_table.hpp"
#include "cli/report/verdict_text.hpp"
#include "convex/nearest_point/multipliers/sensitivity.hpp"

namespace cli::inline reports {
namespace {

using convex::Index;
using convex::Vector;

double gauss(const Scene& scene, const Vector& q) {
  return q.dot(scene.problem.A.multiply(q)) / 2 - scene.problem.z.dot(q);
}

/// The lines of a text as paragraphs.
void add_lines(Document& document, const std::string& text) {
  std::string paragraph;
  for (std::size_t at = 0; at < text.size();) {
    const std::size_t end = std::min(text.find('\n', at), text.size());
    const std::string line = text.substr(at, end - at);
    if (!line.empty()) paragraph += (paragraph.empty() ? "" : " ") + line;
    at = end + 1;
  }
  if (!paragraph.empty()) document.blocks.emplace_back(Paragraph{{paragraph}});
}

/// Above this many coordinates a polynomial is too long to read.
constexpr Index longest_polynomial = 8;

std::string latex_number(double x) { return number_math(x).latex; }

void explain_gauss(Document& document, const SolvedScene& solved) {
  const Scene& scene = solved.scene;
  auto& blocks = document.blocks;
  const Vector free = without_rounding(solved, scene.problem.A.solve(scene.problem.z));
  Vector acceleration = solved.solution.primal.q;
  const Vector readable = readable_numbers(solved, most_rows).acceleration;
  acceleration.head(readable.size()) = readable;
  blocks.emplace_back(Heading{"Gauss' function and its minimum"});
  blocks.emplace_back(Formula{{"G(q'') = 1/2 q''·A q'' - z·q''",
                               "G(\\ddot q) = \\tfrac12\\,\\ddot q\\cdot A\\ddot q - z\\cdot\\ddot q"}});
  blocks.emplace_back(Paragraph{
      {"Without contacts the acceleration would be ", Math{"A⁻¹z", "A^{-1}z"}, " = ", vector_math(free),
       ", where G = ", number_math(gauss(scene, free)),
       " is least of all. Of the accelerations that the contacts allow the true one makes G least: ",
       Math{"q''", "\\ddot q"}, " = ", vector_math(acceleration),
       ", where G = ", number_math(solved.solution.gauss), "."}});
  const mechanics::TwoSided& classical = solved.solution.hypothesis.two_sided;
  if (!solved.solution.hypothesis.accepted && classical.consistent && classical.acceleration.size() > 0)
    blocks.emplace_back(
        Paragraph{{"With every contact held G would be ", number_math(gauss(scene, classical.acceleration)),
                   ", which is more: letting go is nearer to the free motion."}});
  // ||y||_(A⁻¹), y = -R: not the root of a difference of G's, which keeps half their digits.
  const convex::Solution& primal = solved.solution.primal;
  const double distance = without_rounding(scene.problem.A.dual_norm(solved.solution.reaction),
                                           std::max(primal.acceleration_norm, primal.force_norm));
  blocks.emplace_back(
      Paragraph{{"In the kinetic metric this says that ", Math{"x = A q''", "x = A\\ddot q"},
                 " is the point of ", Math{"C = {x : (u_a|x) >= s_a}", "C = \\{x : (u_a|x) \\ge s_a\\}"},
                 " nearest to z, at the distance ", number_math(distance), "; the rest, ",
                 Math{"y = z - x = -R", "y = z - x = -R"}, ", is what the system exerts on its contacts: ",
                 Math{"z = x + y = prox_f z + prox_g z",
                      "z = x + y = \\operatorname{prox}_f z + \\operatorname{prox}_g z"},
                 ", f the indicator of C and g its support function."}});
  blocks.emplace_back(Heading{"Appell's function"});
  if (scene.problem.dimension() <= longest_polynomial)
    blocks.emplace_back(Formula{
        {appell_function(scene, number_text), expression_latex(appell_function(scene, number_text))}});
  blocks.emplace_back(Paragraph{
      {"This is G written out. Where the masses are particles it is Appell's function, half the sum of the "
       "masses times their "
       "squared accelerations less the power of the forces, up to a number without accelerations: both "
       "have the same minimum."}});
}

void explain_contact(Document& document, const SolvedScene& solved, const ReadableNumbers& read,
                     std::size_t a) {
  const Scene& scene = solved.scene;
  const Index i = static_cast<Index>(a);
  const std::string& name = scene.constraints[a];
  Line line{constraint_name(scene, a)};
  const auto say = [&](auto piece) { line.emplace_back(std::move(piece)); };
  const Math lambda = indexed("lambda", "\\lambda", name);
  const Math value = number_math(read.lambda[i]), rate = number_math(read.second_rates[i]);
  if (solved.is_weighed(a)) {
    say(std::string(" persists; its multiplier grows without bound near this singular state."));
  } else if (solved.states[a] == ConstraintState::persists) {
    say(std::string(" persists with "));
    say(Math{lambda.plain + " = " + value.plain, lambda.latex + " = " + value.latex});
    if (const auto force = read.forces[a]) {
      say(std::string(", a force "));
      say(Math{"|lambda grad f| = " + number_text(*force),
               "\\lvert\\lambda\\nabla f\\rvert = " + latex_number(*force)});
    }
    const auto row = std::find(scene.contacts.begin(), scene.contacts.end(), i);
    if (row != scene.contacts.end()) {
      say(std::string("; on the coordinates it exerts "));
      const Vector u = scene.problem.U.row(static_cast<Index>(row - scene.contacts.begin()));
      say(vector_math(read.lambda[i] * u));
    }
    say(std::string("."));
  } else if (solved.states[a] == ConstraintState::touches) {
    say(std::string(
        " only touches: it neither presses nor opens to second order, and higher derivatives decide (f = "));
    say(number_math(scene.rates ? read.f[i] : 0));
    say(std::string(")."));
  } else {
    say(std::string(" opens: it exerts nothing, and "));
    say(Math{"d²f/dt² = " + rate.plain, "\\ddot f = " + rate.latex});
    say(std::string(" > 0 leads away from it."));
  }
  document.blocks.emplace_back(Paragraph{std::move(line)});
}

void explain_margins(Document& document, const SolvedScene& solved) {
  if (solved.scene.problem.rows() == 0) return;
  const auto margins = convex::margins(solved.scene.problem, solved.solution.primal,
                                       solved.solution.multipliers, solved.solution.touching);
  if (!margins) return;
  Index nearest = -1;
  for (Index a = 0; a < margins->size(); ++a)
    if (std::isfinite((*margins)[a]) && (nearest < 0 || (*margins)[a] < (*margins)[nearest])) nearest = a;
  if (nearest < 0) return;
  const bool opens = solved.state_of_row(nearest) == ConstraintState::opens;
  document.blocks.emplace_back(Paragraph{
      {"Nearest to changing, if forces changed now, is ", row_name(solved.scene, nearest), ": it would ",
       opens ? "close" : "open", " when they change by ", number_math((*margins)[nearest]),
       " in the norm of ", Math{"A⁻¹", "A^{-1}"}, ", with the multiplier ",
       number_math(solved.solution.multipliers.least_norm[nearest]), " and ",
       Math{"u·q'' - s", "u\\cdot\\ddot q - s"}, " = ", number_math(solved.solution.primal.slack[nearest]),
       ", u = ", vector_math(solved.scene.problem.U.row(nearest)), "."}});
}

}  // namespace

void explain_hypothesis(Document& document, const SolvedScene& solved) {
  if (solved.scene.problem.rows() == 0) return;
  const mechanics::Hypothesis& hypothesis = solved.solution.hypothesis;
  document.blocks.emplace_back(Heading{"The classical hypothesis, and Delassus' rule"});
  if (hypothesis.accepted && hypothesis.two_sided.multipliers.size() > 0) {
    Line line{"If every contact persists, the conditions are equations, and lambda is "};
    const Index shown = std::min<Index>(hypothesis.two_sided.multipliers.size(), most_rows);
    for (Index row = 0; row < shown; ++row) {
      line.emplace_back(std::string(row == 0 ? "" : ", "));
      line.emplace_back(row_name(solved.scene, row));
      line.emplace_back(std::string(" "));
      const double scale = hypothesis.two_sided.multipliers.cwiseAbs().maxCoeff();
      line.emplace_back(number_math(without_rounding(hypothesis.two_sided.multipliers[row], scale)));
    }
    line.emplace_back(
        std::string(hypothesis.negative.empty()
                        ? ": no one-sided contact has to pull, so that the hypothesis is true, and there is "
                          "nothing to drop."
                        : ". Others with the same reaction are all >= 0, so that the hypothesis is true."));
    document.blocks.emplace_back(Paragraph{std::move(line)});
    return;
  }
  add_lines(document, hypothesis_text(solved));
}

void explain_answer(Document& document, const SolvedScene& solved) {
  const Scene& scene = solved.scene;
  auto& blocks = document.blocks;
  if (solved.infeasible()) {
    blocks.emplace_back(Heading{"No acceleration is allowed"});
    Line line{"The contacts contradict each other: in the sum of "};
    const Vector& w = solved.solution.primal.farkas;
    bool first = true;
    for (Index row = 0; row < w.size(); ++row) {
      if (w[row] == 0) continue;
      line.emplace_back(std::string(first ? "" : ", "));
      line.emplace_back(number_math(w[row]));
      line.emplace_back(std::string(" times "));
      line.emplace_back(row_name(scene, row));
      first = false;
    }
    line.emplace_back(std::string(" the accelerations cancel, and what is left reads 0 >= "));
    line.emplace_back(number_math(left_of_contradiction(solved)));
    line.emplace_back(std::string(" (Farkas)."));
    blocks.emplace_back(Paragraph{std::move(line)});
    return;
  }
  if (!solved.has_answer()) {
    blocks.emplace_back(Paragraph{{"No answer was found, and no proof that there is none."}});
    return;
  }
  explain_gauss(document, solved);
  blocks.emplace_back(Heading{"Reactions"});
  const ReadableNumbers read = readable_numbers(solved, most_rows);
  for (std::size_t a = 0; a < static_cast<std::size_t>(read.lambda.size()); ++a)
    if (solved.states[a] != ConstraintState::inactive) explain_contact(document, solved, read, a);
  if (!solved.multipliers_are_unique())
    blocks.emplace_back(
        Paragraph{{std::string("The multipliers are not unique; shown are ") +
                   (solved.solution.multipliers.is_least_norm ? "those of least norm" : "some") +
                   ". The acceleration and the reaction are unique."}});
  Table table{{{"coordinate"}, {Math{"q''", "\\ddot q"}}, {Math{"R", "R"}}}, {}};
  for (Index i = 0; i < read.acceleration.size(); ++i)
    table.rows.push_back({{Name{scene.coordinates[static_cast<std::size_t>(i)]}},
                          {number_math(read.acceleration[i])},
                          {number_math(read.reaction[i])}});
  blocks.emplace_back(std::move(table));
  explain_margins(document, solved);
  std::string accuracy = accuracy_text(solved);
  accuracy.pop_back();  // its end of the line
  blocks.emplace_back(Paragraph{{std::move(accuracy)}});
}

}  // namespace cli::inline reports
