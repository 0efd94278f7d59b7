#include "cli/report/sensitivity_text.hpp"

#include <fmt/format.h>

#include <cmath>

#include "cli/report/readable_numbers.hpp"
#include "cli/report/text_table.hpp"
#include "convex/nearest_point/multipliers/sensitivity.hpp"

namespace cli::inline reports {
namespace {

using convex::Index;
using convex::Vector;

/// Wider and longer tables are left to --json.
constexpr Index most_columns = 8, most_directions = 20;

std::optional<convex::Derivative> derivative(const SolvedScene& solved, const Vector& dz, const Vector& ds) {
  return convex::directional_derivative(solved.scene.problem, solved.solution.primal,
                                        solved.solution.multipliers, dz, ds, solved.solution.touching);
}

/// Whether one unit less does the opposite of one more.
bool is_linear(const convex::Derivative& more, const convex::Derivative& less) {
  constexpr double close = 1e-9;
  const auto opposite = [](const Vector& x, const Vector& y) {
    return (x + y).cwiseAbs().maxCoeff() <= close * x.cwiseAbs().maxCoeff();
  };
  return opposite(more.acceleration, less.acceleration) &&
         more.multipliers.has_value() == less.multipliers.has_value() &&
         (!more.multipliers || more.multipliers->size() == 0 ||
          opposite(*more.multipliers, *less.multipliers));
}

class DerivativeTable {
 public:
  explicit DerivativeTable(const SolvedScene& solved) : solved_(solved), table_(head(solved)) {}

  void add(const std::string& what, const Vector& dz, const Vector& ds) {
    const auto more = derivative(solved_, dz, ds), less = derivative(solved_, -dz, -ds);
    if (more && less && is_linear(*more, *less)) {
      add_row("a unit more of " + what, dz, more);
      return;
    }
    add_row("a unit more of " + what, dz, more);
    add_row("a unit less of " + what, -dz, less);
  }

  std::string text() const { return table_.text(); }

 private:
  static std::vector<std::string> head(const SolvedScene& solved) {
    std::vector<std::string> names{"changes"};
    for (const std::string& coordinate : solved.scene.coordinates) names.push_back(coordinate + "''");
    for (Index row = 0; row < solved.scene.problem.rows(); ++row)
      names.push_back("lambda " + solved.scene.contact_name(row));
    return names;
  }

  /// What cancels to rounding is 0: an acceleration of what the force and the contacts make of it or beside
  /// the others, a multiplier beside the force and the others, in the norm of A⁻¹.
  void add_row(const std::string& what, const Vector& dz, const std::optional<convex::Derivative>& by) {
    std::vector<std::string> row{what};
    const convex::NearestPointProblem& problem = solved_.scene.problem;
    const Index n = problem.dimension(), m = problem.rows();
    const bool has_multipliers = by && by->multipliers;
    Vector terms = problem.A.solve(dz).cwiseAbs();
    for (Index i = 0; by && i < n; ++i)
      terms[i] =
          std::max(terms[i], problem.A.norm(by->acceleration) * problem.A.dual_norm(Vector::Unit(n, i)));
    double largest = problem.A.dual_norm(dz);
    for (Index a = 0; has_multipliers && a < m; ++a) {
      const Vector u = problem.U.row(a);
      const double change = std::abs((*by->multipliers)[a]);
      terms += change * problem.A.solve(u).cwiseAbs();
      largest = std::max(largest, change * problem.A.dual_norm(u));
    }
    for (Index i = 0; i < n; ++i)
      row.push_back(by ? number_text(without_rounding(by->acceleration[i], terms[i])) : "-");
    for (Index a = 0; a < m; ++a) {
      const double length = problem.A.dual_norm(problem.U.row(a));
      row.push_back(has_multipliers ? number_text(without_rounding((*by->multipliers)[a],
                                                                   length > 0 ? largest / length : 0))
                                    : "-");
    }
    table_.add(std::move(row));
  }

  const SolvedScene& solved_;
  TextTable table_;
};

std::string derivatives_text(const SolvedScene& solved) {
  const Index n = solved.scene.problem.dimension(), m = solved.scene.problem.rows();
  if (n + m > most_columns || n + m > most_directions)
    return fmt::format("Derivatives by {} forces and bounds: --json gives them.\n", n + m);
  DerivativeTable table(solved);
  for (Index i = 0; i < n; ++i)
    table.add("the force on " + solved.scene.coordinates[static_cast<std::size_t>(i)], Vector::Unit(n, i),
              Vector::Zero(m));
  for (Index a = 0; a < m; ++a)
    table.add("the bound of " + solved.scene.contact_name(a), Vector::Zero(n), Vector::Unit(m, a));
  return "What changes, and by how much, until a contact opens or closes:\n" + table.text();
}

/// How much of each force alone, in its own unit, opens or closes the first contact.
std::string reaches_text(const SolvedScene& solved) {
  const Scene& scene = solved.scene;
  const Index n = scene.problem.dimension();
  if (!solved.solution.multipliers.unique || n > most_directions) return "";
  TextTable table({"force on", "more by", "then", "less by", "then"});
  bool is_any = false;
  for (Index i = 0; i < n; ++i) {
    std::vector<std::string> row{scene.coordinates[static_cast<std::size_t>(i)]};
    for (const double way : {1.0, -1.0}) {
      const Vector dz = way * Vector::Unit(n, i);
      const auto by = derivative(solved, dz, Vector::Zero(scene.problem.rows()));
      const auto first = by ? convex::first_change(scene.problem, solved.solution.primal,
                                                   solved.solution.multipliers, dz, *by)
                            : std::nullopt;
      is_any = is_any || first;
      row.push_back(first ? number_text(first->by) : by ? "never" : "-");
      row.push_back(first ? scene.contact_name(first->row) + (first->closes ? " closes" : " opens") : "");
    }
    table.add(std::move(row));
  }
  return is_any
             ? "How much one force alone may change until a contact opens or closes:\n" + table.text() + "\n"
             : "";
}

std::string margins_text(const SolvedScene& solved) {
  const auto margins = convex::margins(solved.scene.problem, solved.solution.primal,
                                       solved.solution.multipliers, solved.solution.touching);
  if (!margins && solved.solution.multipliers.unique)
    return "A is so nearly singular that doubles tell no derivatives and no margins.\n";
  if (!margins) return "The multipliers are not unique: no margins.\n";
  Index nearest = -1;
  for (Index a = 0; a < margins->size(); ++a)
    if (std::isfinite((*margins)[a]) && (nearest < 0 || (*margins)[a] < (*margins)[nearest])) nearest = a;
  if (nearest < 0) return "No change of forces opens or closes a contact.\n";
  TextTable table({"contact", "opens or closes when forces change by"});
  const Index shown = std::min(margins->size(), most_directions);
  for (Index a = 0; a < shown; ++a)
    table.add(
        {solved.scene.contact_name(a), std::isfinite((*margins)[a]) ? number_text((*margins)[a]) : "never"});
  const ConstraintState state = solved.state_of_row(nearest);
  return table.text() + fmt::format("in the norm of A⁻¹; the first to {} is {}.\n",
                                    state == ConstraintState::opens ? "close" : "open",
                                    solved.scene.contact_name(nearest));
}

}  // namespace

std::string sensitivity_text(const SolvedScene& solved) {
  if (!solved.sensitivity) return "";
  return "\n" + derivatives_text(solved) + "\n" + reaches_text(solved) + margins_text(solved);
}

}  // namespace cli::inline reports
