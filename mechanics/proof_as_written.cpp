#include "mechanics/proof_as_written.hpp"

#include <algorithm>

#include "convex/infinity.hpp"
#include "convex/invalid_input.hpp"
#include "convex/nearest_point/automatic.hpp"
#include "convex/nearest_point/proof/enclosure.hpp"
#include "convex/nearest_point/proof/exact_method.hpp"
#include "convex/nearest_point/proof/infeasibility_proof.hpp"
#include "mechanics/data_radii.hpp"
#include "mechanics/dependent_rows.hpp"
#include "mechanics/expression/lagrangian_model.hpp"
#include "mechanics/settled_middle.hpp"

namespace mechanics {
namespace {

using convex::infinity;

using convex::NearestPointProblem;
using convex::ProofLevel;
using convex::Status;

bool holds(const std::vector<Index>& sorted, Index a) {
  return std::binary_search(sorted.begin(), sorted.end(), a);
}

/// What is proved of one K: that there is no solution, or how far the answer is from it.
struct OneProof {
  ProofLevel level = ProofLevel::enclosure;
  bool feasible = true;
  double distance = 0;
};

class Proving {
 public:
  Proving(CertifiedSolution& found, const NearestPointProblem& problem, const WrittenMechanism& written,
          const std::vector<Index>& contacts, const GaussOptions& options)
      : found_(found), problem_(problem), written_(written), contacts_(contacts), options_(options) {}

  void prove() {
    TextProof& proof = found_.text.emplace();
    decide_contacts(proof);
    found_.certificate = {ProofLevel::none, found_.solution.primal.error_bound};
    proof.vanishing = vanishing_rows();
    if (proof.vanishing.empty()) prove_every_K(proof);
    if (found_.certificate.level == ProofLevel::none) proof.dependent = rows_within_radii();
  }

 private:
  void prove_every_K(TextProof& proof) {
    if (!proof.violated.empty() || proof.open.size() > most_open_contacts) return;
    const std::size_t sets = std::size_t{1} << proof.open.size();
    ProofLevel level = ProofLevel::exact;
    double worst = 0;
    std::size_t feasible = 0;
    for (std::size_t chosen = 0; chosen < sets; ++chosen) {
      const auto one = proved(proof, with_open(proof, chosen), sets == 1);
      if (!one) return;
      if (one->level != ProofLevel::exact) level = ProofLevel::enclosure;
      feasible += one->feasible ? 1 : 0;
      worst = std::max(worst, one->distance);
    }
    if (feasible != 0 && feasible != sets) return;
    proof.error_bound = worst;
    if (feasible == 0) {
      found_.certificate = {level, 0};
      return;
    }
    // Where several K, or another K than that of the tolerance, give this answer, it is theirs only if it is
    // close.
    const double most = options_.accuracy.tolerance * std::max(1.0, found_.solution.primal.acceleration_norm);
    if (!proof.contacts_hold && !(worst <= most)) return;
    found_.certificate = {level, worst};
    judge_by_certificate(found_, options_);
  }

  const std::vector<Constraint>& constraints() const { return written_.system->constraints(); }
  bool is_two_sided(Index a) const { return constraints()[static_cast<std::size_t>(a)].two_sided; }
  /// Does it hold by declaration?
  bool is_declared(Index a) const {
    return is_two_sided(a) || (holds(written_.in_contact, a) && holds(contacts_, a));
  }

  /// Constraints whose f is not near 0, for all that its rounding tells, need no closer look.
  std::vector<Index> near_contact() {
    const ConstraintRates rates = written_.system->constraint_rates(written_.state);
    const RateRadii radii = rate_radii(*written_.system, written_.state, written_.radii);
    std::vector<Index> near;
    for (Index a = 0; a < rates.f.size(); ++a)
      if (is_two_sided(a) || !(rates.f[a] > radii.f[a])) near.push_back(a);
    // What the tolerance took for a contact is apart only if the text says so.
    for (const Index a : contacts_)
      if (!holds(near, a)) near.insert(std::lower_bound(near.begin(), near.end(), a), a);
    return near;
  }

  void decide_contacts(TextProof& proof) {
    const std::vector<Index> near = near_contact();
    proof.contacts = contact_verdicts(*written_.system, written_.text, near);
    for (Index a = 0; a < static_cast<Index>(proof.contacts.size()); ++a) {
      ContactVerdict& verdict = proof.contacts[static_cast<std::size_t>(a)];
      if (!holds(near, a)) verdict = ContactVerdict::apart;
      const bool in_K = holds(contacts_, a);
      if (is_declared(a)) {
        declared_.push_back(a);
        moved_ = moved_ || verdict == ContactVerdict::violated || verdict == ContactVerdict::apart;
      } else if (verdict == ContactVerdict::violated) {
        proof.violated.push_back(a);
      } else if (verdict == ContactVerdict::undecided) {
        proof.open.push_back(a);
      } else {
        if (verdict == ContactVerdict::touches) declared_.push_back(a);
        if (in_K != (verdict == ContactVerdict::touches)) proof.refuted.push_back(a);
      }
    }
    proof.contacts_hold = proof.refuted.empty() && proof.violated.empty() && proof.open.empty();
  }

  std::vector<Index> with_open(const TextProof& proof, std::size_t chosen) const {
    std::vector<Index> K = declared_;
    for (std::size_t k = 0; k < proof.open.size(); ++k)
      if ((chosen >> k & 1U) != 0) K.push_back(proof.open[k]);
    std::sort(K.begin(), K.end());
    return K;
  }

  std::optional<OneProof> proved(TextProof& proof, const std::vector<Index>& K, bool only) {
    if (!moved_)
      if (const auto text = problem_from_text(*written_.system, written_.text, K))
        if (auto one = proved_from(*text, proof, K, only)) return one;
    return proved_in_doubles(K);
  }

  /// In fractions, or in balls.
  std::optional<OneProof> proved_from(const TextProblem& text, TextProof& proof, const std::vector<Index>& K,
                                      bool only) {
    const convex::ExactProblem& middle = text.problem.middle;
    const NearestPointProblem near = convex::rounded(middle);
    std::optional<ExactGaussSolution> exact;
    std::optional<convex::EnclosedSolution> enclosed;
    if (text.is_exact)
      exact = solve_exactly(middle, near, options_);
    else
      enclosed = convex::enclosed_solution(text.problem, likely_rows(near, K));
    if (!exact && !enclosed) return std::nullopt;
    OneProof one{exact ? ProofLevel::exact : ProofLevel::enclosure,
                 exact ? has_answer(exact->rounded) : enclosed->status != Status::infeasible, 0};
    const auto find_distance = [&] {
      if (!one.feasible || !has_answer(found_.solution)) return;
      const Vector& q = found_.solution.primal.q;
      one.distance = exact ? convex::distance_above(middle, q, exact->primal.q)
                           : convex::distance_above(text.problem, *enclosed, q);
    };
    find_distance();
    const bool wanted = exact && in_fractions() && !found_.exact;
    if (only && K == contacts_ && (wanted || one.feasible != has_answer(found_.solution) || is_off(one))) {
      found_.solution = exact ? exact->rounded : answer_in_balls(text, near, proof);
      found_.exact.reset();
      if (exact && in_fractions()) found_.exact = exact;
      find_distance();
    }
    if (one.feasible && !has_answer(found_.solution)) return std::nullopt;
    if (!only && K != contacts_) return one;
    if (enclosed && one.feasible) {
      constexpr int digits = 30;
      proof.acceleration = convex::decimals(text.problem, *enclosed, digits);
    }
    proof.K = K;
    if (exact && K == contacts_ && has_answer(found_.solution))
      found_.solution.touching = touching_in_fractions(found_.solution, *exact);
    proof.exact = std::move(exact);
    proof.enclosed = std::move(enclosed);
    return one;
  }

  /// With what the balls leave open of how rows depend on each other settled, or it would be told from their
  /// middles: which row opens, by the last digit, and which multipliers there are.
  GaussSolution answer_in_balls(const TextProblem& text, const NearestPointProblem& near,
                                TextProof& proof) const {
    const SettledMiddle settled = settled_middle(text.problem, likely_rows(near, contacts_));
    for (const Index row : settled.dependent)
      proof.dependent.push_back(contacts_[static_cast<std::size_t>(row)]);
    return solve_exactly(settled.problem, near, options_).rounded;
  }

  /// Whether fractions were asked for: those of the numbers as evaluated stay, where they are close enough.
  bool in_fractions() const { return options_.method->name == "exact"; }

  /// Whether the answer is to be that of the text: the method was left to the program, and doubles were off
  /// by more than fractions, rounded, would be, or than was asked for where there are balls only; or did not
  /// know, and then what they say beside it is no better.
  bool is_off(const OneProof& one) const {
    if (!one.feasible || !is_default(options_)) return false;
    if (found_.solution.primal.status != Status::solved) return true;
    const double norm = found_.solution.primal.acceleration_norm;
    return !(one.distance <= (one.level == ProofLevel::exact && !in_fractions()
                                  ? few_ulps * norm
                                  : options_.accuracy.tolerance * std::max(1.0, norm)));
  }

  std::vector<Index> likely_rows(const NearestPointProblem& near, const std::vector<Index>& K) const {
    return K == contacts_ && has_answer(found_.solution) && !found_.solution.primal.basis.empty()
               ? found_.solution.primal.basis
               : convex::likely_active_rows(near);
  }

  /// In doubles, for every A, z, U, s within the radii of their evaluation.
  std::optional<OneProof> proved_in_doubles(const std::vector<Index>& K) {
    const LagrangianSystem& system = *written_.system;
    const convex::EntryRadii radii =
        data_radii(system, written_.state, moved_ ? moved_radii() : written_.radii, K);
    // From the constraints themselves: rows of the problem may have been settled within their rounding.
    const ContactRows rows = system.contact_rows(written_.state, K);
    NearestPointProblem over{problem_.A, problem_.z, convex::ConstraintRows(rows.U), rows.s, {}};
    for (std::size_t k = 0; k < K.size(); ++k)
      if (is_two_sided(K[k])) over.two_sided.push_back(static_cast<Index>(k));
    if (!has_answer(found_.solution)) return contradiction_in_doubles(over, radii, K);
    if (K == contacts_) {
      const auto bound = convex::enclosed_error(over, radii, found_.solution.primal);
      return bound ? std::optional(OneProof{ProofLevel::enclosure, true, *bound}) : std::nullopt;
    }
    // The answer printed, then that of the other problem.
    const convex::Solution solution = options_.method->solve(over, options_.accuracy);
    if (solution.q.size() != problem_.dimension()) return std::nullopt;
    const auto bound = convex::enclosed_error(over, radii, solution);
    if (!bound) return std::nullopt;
    // In metrics within the radii of A, which are small beside A where the bound was proved.
    constexpr double other_metrics = 2;
    return OneProof{ProofLevel::enclosure, true,
                    *bound + other_metrics * problem_.A.norm(solution.q - found_.solution.primal.q)};
  }

  /// Rows that are the doubles exactly contradict each other as written when they do as evaluated.
  std::optional<OneProof> contradiction_in_doubles(const NearestPointProblem& over,
                                                   const convex::EntryRadii& radii,
                                                   const std::vector<Index>& K) {
    if (K != contacts_ || found_.solution.primal.status != Status::infeasible ||
        !radii.by_rows(over.A).is_zero())
      return std::nullopt;
    auto proof = convex::infeasibility_proof(over, found_.solution.primal.farkas);
    if (!proof) return std::nullopt;
    found_.solution.primal.farkas = std::move(proof->farkas);
    found_.farkas = std::move(proof->weights);
    return OneProof{proof->level, false, 0};
  }

  /// One-sided contacts whose row is 0 at this state, for all that rounding tells, and that second
  /// derivatives do not open: those without a row at any state ask nothing of q''.
  std::vector<Index> vanishing_rows() const {
    const expression::LagrangianModel& model = written_.system->model();
    const Vector unit = problem_.A.diagonal().cwiseSqrt().cwiseInverse();
    std::vector<Index> vanishing;
    for (std::size_t k = 0; k < contacts_.size(); ++k) {
      const Index a = contacts_[k];
      const bool moves =
          (model.tape.depends(model.f[static_cast<std::size_t>(a)]) & expression::on_coordinates) != 0;
      if (is_two_sided(a) || !moves) continue;
      const auto row = static_cast<Index>(k);
      const double radius = problem_.radii ? problem_.radii->row[row] : 0,
                   of_s = problem_.radii ? problem_.radii->s[row] : 0;
      if (problem_.U.row(row).cwiseProduct(unit).norm() <= radius && !(problem_.s[row] < -of_s))
        vanishing.push_back(a);
    }
    return vanishing;
  }

  std::vector<Index> rows_within_radii() const {
    std::vector<Index> found;
    for (const DependentRow& dependent : dependent_rows(problem_, RowsCompared::two_sided))
      if (static_cast<std::size_t>(dependent.row) < contacts_.size())
        found.push_back(contacts_[static_cast<std::size_t>(dependent.row)]);
    return found;
  }

  /// The radii of the state, and twice the way to the nearest state at which what is declared to hold does.
  StateRadii moved_radii() const {
    const LagrangianSystem& system = *written_.system;
    std::vector<Index> rows;
    for (const Index a : declared_)
      if (is_declared(a)) rows.push_back(a);
    State state = written_.state;
    const auto nearest = [&](bool of_velocity) {
      const ConstraintRates rates = system.constraint_rates(state);
      const ContactRows contact = system.contact_rows(state, rows);
      NearestPointProblem step{problem_.A,
                               Vector::Zero(problem_.dimension()),
                               convex::ConstraintRows(contact.U),
                               Vector(static_cast<Index>(rows.size())),
                               {}};
      for (std::size_t k = 0; k < rows.size(); ++k) {
        step.two_sided.push_back(static_cast<Index>(k));
        step.s[static_cast<Index>(k)] = of_velocity ? -rates.df[rows[k]] : -rates.f[rows[k]];
      }
      return convex::automatic(step).q;
    };
    StateRadii radii = written_.radii;
    radii.conditions.clear();  // the text tells of its own state alone
    constexpr double ways = 2;
    const auto widen = [&](Vector& numbers, Vector& about, const Vector& step) {
      if (step.size() != numbers.size()) {
        about.setConstant(numbers.size(), infinity);
        return;
      }
      numbers += step;
      const double way = ways * (step.size() > 0 ? step.cwiseAbs().maxCoeff() : 0);
      about = about.size() > 0 ? Vector(about.array() + way) : Vector(Vector::Constant(step.size(), way));
    };
    widen(state.q, radii.q, nearest(false));
    widen(state.v, radii.v, nearest(true));
    return radii;
  }

  CertifiedSolution& found_;
  const NearestPointProblem& problem_;
  const WrittenMechanism& written_;
  const std::vector<Index>& contacts_;
  const GaussOptions& options_;
  std::vector<Index> declared_;  // by the file, or proved to touch
  bool moved_ = false;           // what the file declares does not hold at the state as written
};

}  // namespace

void prove_as_written(CertifiedSolution& found, const NearestPointProblem& problem,
                      const WrittenMechanism& written, const std::vector<Index>& contacts,
                      const GaussOptions& options) {
  Proving(found, problem, written, contacts, options).prove();
}

}  // namespace mechanics
