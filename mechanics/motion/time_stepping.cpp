#include "mechanics/motion/time_stepping.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "mechanics/contacts.hpp"
#include "mechanics/data_radii.hpp"
#include "mechanics/expression/lagrangian_model.hpp"
#include "mechanics/gauss_problem.hpp"
#include "mechanics/number_text.hpp"

namespace mechanics::inline motions {
namespace {

/// The velocity of a step is found by iteration until it would change by less than this part: far below the
/// error of the scheme.
constexpr double settled_part = 1e-10;
/// The same where very many rows change and each is found to about this part.
constexpr double settled_part_of_crowd = 1e-7;
constexpr int most_iterations = 100;

/// A step whose iteration comes to no end but for changes below this part is taken, and it is told.
constexpr double bearable_part = 1e-3;

/// Velocities of a step that are uncertain by more than this part are told of.
constexpr double unsaid_part = 1e-6;

/// Contacts touch at the start where their f is 0 but for so many roundings of its terms.
constexpr double roundings_of_touch = 16;
constexpr double double_epsilon = std::numeric_limits<double>::epsilon();

/// A contact whose rate after a step is below this part of its terms stays.
constexpr double resting_part = 1e-9;

bool same(const convex::SparseMatrix& a, const convex::SparseMatrix& b) {
  return a.rows() == b.rows() && a.nonZeros() == b.nonZeros() &&
         std::equal(a.outerIndexPtr(), a.outerIndexPtr() + a.outerSize() + 1, b.outerIndexPtr()) &&
         std::equal(a.innerIndexPtr(), a.innerIndexPtr() + a.nonZeros(), b.innerIndexPtr()) &&
         std::equal(a.valuePtr(), a.valuePtr() + a.nonZeros(), b.valuePtr());
}

bool has_very_many(const LagrangianSystem& system, Index fewest_for_sparse_method) {
  const std::vector<Constraint>& all = system.constraints();
  return static_cast<Index>(system.coordinates().size()) >= fewest_for_sparse_method &&
         static_cast<Index>(all.size()) >= fewest_for_sparse_method &&
         std::none_of(all.begin(), all.end(), [](const Constraint& one) { return one.two_sided; });
}

}  // namespace

Motion::TimeStepping::TimeStepping(const LagrangianSystem& of, const State& at, MotionOptions chosen)
    : Course(of, std::move(chosen)),
      origin_(at.t),
      rests_(of.constraints().size()),
      is_crowded_(has_very_many(of, fewest_for_sparse_method)) {
  if (!(options.theta >= 0.5 && options.theta <= 1))
    throw convex::InvalidInput("theta: " + number_text(options.theta) + " is not from 1/2 to 1");
  if (options.impact_law != ImpactLaw::moreau)
    throw convex::InvalidInput(std::string("impact_law: time-stepping has Moreau's law alone, not ") +
                               name(options.impact_law) + "; take method = \"event-driven\" for it");
  state = at;
  const mechanics::Contacts found =
      mechanics::contacts(system, state, options.contact_tolerance, Impending::allowed);
  for (const Index a : found.present) rests_[static_cast<std::size_t>(a)] = true;
  for (Index a = 0; a < found.rates.f.size(); ++a)
    if (!is_two_sided(a) &&
        std::abs(found.rates.f[a]) <= roundings_of_touch * double_epsilon * found.rates.f_scale[a])
      touch_at_start_.push_back(a);
  for (const expression::NodeId f : system.model().f)
    moves_.push_back((system.model().tape.depends(f) & expression::on_time) != 0);
  done.t = state.t;
  done.q = state.q;
  multipliers = Vector::Zero(static_cast<Index>(system.constraints().size()));
}

bool Motion::TimeStepping::advance(double until) {
  if (!may_advance(until)) return false;
  const double before = state.t;
  // The same length for all steps, to the last digit: what is at rest is then the same problem again.
  double h = options.step, end = origin_ + static_cast<double>(count_ + 1) * options.step;
  // What is left of the last step may be a rounding of it.
  constexpr double least_part = 1e-6;
  if (end > until - least_part * options.step) {
    end = until;
    h = end - before;
    origin_ = until;
    count_ = -1;
  }
  try {
    take_step(h, end);
  } catch (const convex::InvalidInput& error) {
    stop("at t = " + number_text(state.t) + ": " + error.what());
  }
  ++count_;
  return status == MotionStatus::done || state.t > before;
}

/// What f is the sum of by its gradient: it changes by so much when q does by a part of itself, or of 1.
double Motion::TimeStepping::size_along(const State& at, const convex::SparseRows& U, Index k) {
  double size = 0;
  for (convex::SparseRows::InnerIterator u(U, k); u; ++u)
    size += std::abs(u.value()) * (1 + std::abs(at.q[u.col()]));
  return size;
}

/// Those that stay, and those whose f comes to 0, within the contact tolerance of f and of q: where the
/// gradient is nearly 0, f is far below its tolerance while q is far from where it is 0.
std::vector<Index> Motion::TimeStepping::closed(const State& ahead) const {
  const ConstraintRates rates = system.constraint_rates(ahead);
  std::vector<Index> found, near;
  for (Index a = 0; a < rates.f.size(); ++a)
    if (is_two_sided(a) || rests_[static_cast<std::size_t>(a)] || rates.f[a] <= 0)
      found.push_back(a);
    else if (rates.f[a] <= options.contact_tolerance[a] * rates.f_scale[a])
      near.push_back(a);
  if (near.empty()) return found;
  const convex::SparseRows U = system.contact_rows(ahead, near).U;
  for (std::size_t k = 0; k < near.size(); ++k)
    if (rates.f[near[k]] <= options.contact_tolerance[near[k]] * size_along(ahead, U, static_cast<Index>(k)))
      found.push_back(near[k]);
  std::sort(found.begin(), found.end());
  return found;
}

void Motion::TimeStepping::find_inertia(const State& at) {
  Inertia inertia = system.inertia(at);
  inertia.A.makeCompressed();
  z_ = std::move(inertia.z);
  if (A_ && same(gram_, inertia.A)) return;
  velocities_.problem.reset();
  positions_.problem.reset();
  tangents_.problem.reset();
  A_ = kinetic_metric(inertia.A, system.coordinates());
  gram_ = std::move(inertia.A);
}

/// Gradients of contacts that are 0 but for rounding become 0.
void Motion::TimeStepping::take_rounding_for_zero(const State& middle, const std::vector<Index>& constraints,
                                                  const ConstraintRates& rates, convex::SparseRows& U) const {
  std::vector<Index> rows, small;
  for (Index k = 0; k < U.rows(); ++k) {
    const Index a = constraints[static_cast<std::size_t>(k)];
    const double size = size_along(middle, U, k);
    if (is_two_sided(a) || size == 0 || size > suspicious_gradient * rates.f_scale[a]) continue;
    rows.push_back(k);
    small.push_back(a);
  }
  const convex::SparseRows beyond = gradients_beyond_rounding(system, middle, small);
  for (std::size_t j = 0; j < rows.size(); ++j)
    if (beyond.row(static_cast<Index>(j)).nonZeros() == 0)
      for (convex::SparseRows::InnerIterator u(U, rows[j]); u; ++u) u.valueRef() = 0;
}

Motion::TimeStepping::Contacts Motion::TimeStepping::contacts_at(const State& middle,
                                                                 const std::vector<Index>& constraints,
                                                                 double h) const {
  Contacts found;
  found.constraints = constraints;
  ContactRows rows = system.contact_rows(middle, constraints);
  const ConstraintRates rates = system.constraint_rates(middle);
  take_rounding_for_zero(middle, constraints, rates, rows.U);
  const Vector free = A_->solve(z_), pull = rows.U * free - rows.s, along = rows.U * middle.v,
               before = rows.U * state.v;
  const auto m = static_cast<Index>(constraints.size());
  found.drift.resize(m);
  found.restitution = Vector::Zero(m);
  found.closes_fast.resize(constraints.size());
  for (Index k = 0; k < m; ++k) {
    const Index a = constraints[static_cast<std::size_t>(k)];
    // What does not know the time does not drift, not by the rounding of a difference either.
    found.drift[k] = moves_[static_cast<std::size_t>(a)] ? rates.df[a] - along[k] : 0;
    if (is_two_sided(a)) found.two_sided.push_back(k);
    if (is_two_sided(a) || rests_[static_cast<std::size_t>(a)]) {
      found.restitution[k] = (1 - options.theta) / options.theta;
      continue;
    }
    // What the forces of one step alone bring together is rest, not a row of impacts.
    const double closing = -(before[k] + found.drift[k]);
    if (!(closing > h * std::max(0.0, -pull[k]))) continue;
    found.closes_fast[static_cast<std::size_t>(k)] = true;
    found.restitution[k] = options.restitution[a];
  }
  found.before = before + found.drift;
  found.U = rows_to_solve(std::move(rows.U));
  return found;
}

bool Motion::TimeStepping::find_velocity(double h, double end) {
  const double theta = options.theta, t = (1 - theta) * state.t + theta * end;
  std::vector<Index> constraints = closed({t, state.q + theta * h * state.v, state.v});
  if (is_first_) {  // those that open have a part in an impact at the start
    constraints.insert(constraints.end(), touch_at_start_.begin(), touch_at_start_.end());
    std::sort(constraints.begin(), constraints.end());
    constraints.erase(std::unique(constraints.begin(), constraints.end()), constraints.end());
  }
  velocity_ = state.v;
  if (acceleration.size() == state.v.size() && !is_first_)
    velocity_ += h * acceleration;  // as in the last step
  double last = std::numeric_limits<double>::infinity(), error = 0;
  for (int i = 0; i < most_iterations; ++i) {
    const Vector along = (1 - theta) * state.v + theta * velocity_;
    middle_ = {t, state.q + theta * h * along, along};
    find_inertia(middle_);
    now_ = contacts_at(middle_, constraints, h);
    const Vector z = A_->multiply(state.v) + h * z_;
    const Vector s = -(now_.drift + now_.restitution.cwiseProduct(now_.before));
    const convex::Solution& solution = solve(velocities_, now_.constraints, now_.two_sided, now_.U, z, s,
                                             i > 0 ? Effort::warm : Effort::first);
    if (solution.status == convex::Status::infeasible) {
      if (is_first_ && !touch_at_start_.empty()) {  // beside what the step comes to later, they have none
        touch_at_start_.clear();
        return find_velocity(h, end);
      }
      status = MotionStatus::infeasible;
      for (std::size_t k = 0; k < constraints.size(); ++k)
        if (solution.farkas[static_cast<Index>(k)] != 0) excluding.push_back(constraints[k]);
      why = "after t = " + number_text(state.t) + ": no velocity satisfies all contacts";
      return false;
    }
    if (solution.q.size() != velocity_.size()) {
      stop("after t = " + number_text(state.t) + ": no velocity is found that satisfies the contacts");
      return false;
    }
    const double change = A_->norm(solution.q - velocity_);
    const double size = A_->norm(state.v) + A_->norm(solution.q) + solution.force_norm;
    velocity_ = solution.q;
    impulse_ = solution.lambda;
    // The next change would be smaller by the same factor again.
    const double next = i > 0 && change < last ? change * (change / last) : change;
    // No change below what is known of them tells more; the first may be found for its rows alone.
    const double settled = (is_crowded_ ? settled_part_of_crowd : settled_part) * size;
    const double known = solution.error_bound + (i > 1 ? error : 0);
    error = solution.error_bound;
    const bool is_first_rough = is_crowded_ && i == 0 && error > settled;
    if (!is_first_rough && (std::min(change, next) <= settled || change <= known)) {
      tell_error(error, size);
      return true;
    }
    constexpr int soonest = 8;  // it should have become smaller by then
    if (i > soonest && change >= last) {
      // Contacts that nearly depend on each other push one way or another as their rows turn ever so little:
      // each is a step of the scheme with rows taken a little earlier.
      if (std::max(change, last) > bearable_part * size) break;
      tell_error(change, size);
      return true;
    }
    last = change;
  }
  stop(
      "at t = " + number_text(state.t) + ": forces change too much in a step of " + number_text(h) +
      "; take a shorter one, [simulate] step" +
      (system.model().tape.has_branches()
           ? "; none is short enough where the motion slides along the place at which |x| or sign(x) changes "
             "its branch, as with dry friction"
           : ""));
  return false;
}

/// What velocities are known to, where this is more than the scheme leaves unsaid.
void Motion::TimeStepping::tell_error(double error, double size) {
  if (error <= unsaid_part * size) return;
  remark(RemarkKind::step,
         "contacts that depend on each other leave the velocity of a step uncertain by " +
             number_text(error) + " beside " + number_text(size) + ", in the kinetic metric",
         size > 0 ? error / size : 0);
}

void Motion::TimeStepping::take_step(double h, double end) {
  if (!find_velocity(h, end)) return;
  const State before = state;
  state.t = end;
  state.v = velocity_;
  state.q = before.q + h * ((1 - options.theta) * before.v + options.theta * velocity_);
  ++record.steps;
  tell_endings();  // of the motion before steps
  tell_events(h, before.v);
  note_pushing();
  correct_position();
  for (MotionEvent& event : events) event.velocity_after = state.v;
  acceleration = (state.v - before.v) / h;
  const auto m = static_cast<Index>(system.constraints().size());
  multipliers = Vector::Zero(m);
  for (std::size_t k = 0; k < now_.constraints.size(); ++k)
    multipliers[now_.constraints[k]] = impulse_[static_cast<Index>(k)] / h;
  // A parabola with the velocities of both ends; a correction of the position moves no velocity.
  done.t = before.t;
  done.length = h;
  done.q.resize(before.q.size(), 3);
  done.q.col(0) = before.q;
  done.q.col(1) = before.v;
  done.q.col(2) = 0.5 * acceleration;
  done.lambda = multipliers;
  done.persist = now_.constraints;
}

/// b·v of the kinetic energy v'Av/2 + b·v + c where the step has its forces; 0 where rounding may have made
/// it.
double Motion::TimeStepping::linear_part_of_energy(const Vector& v) const {
  const double all = system.kinetic_energy({middle_.t, middle_.q, v}),
               of_time = system.kinetic_energy({middle_.t, middle_.q, Vector::Zero(v.size())}),
               quadratic = 0.5 * v.dot(A_->multiply(v)), linear = all - of_time - quadratic;
  constexpr double roundings = 64 * std::numeric_limits<double>::epsilon();
  return std::abs(linear) <= roundings * (std::abs(all) + std::abs(of_time) + quadratic) ? 0 : linear;
}

void Motion::TimeStepping::tell_events(double h, const Vector& velocity_before) {
  const Vector after = now_.U.times(velocity_) + now_.drift;
  const Vector length = now_.U.lengths(A_->diagonal().cwiseInverse());
  const double speed = A_->norm(velocity_before) + A_->norm(velocity_);
  const Vector mean = 0.5 * (now_.before + after);
  std::vector<Index> hit, met, left;
  std::vector<bool> rests(rests_.size());
  double work = 0;
  for (std::size_t k = 0; k < now_.constraints.size(); ++k) {
    const Index a = now_.constraints[k], at = static_cast<Index>(k);
    work += impulse_[at] * (mean[at] - now_.drift[at]);
    if (is_two_sided(a)) continue;
    const auto i = static_cast<std::size_t>(a);
    const double slack = after[at] + now_.restitution[at] * now_.before[at];
    // Where it pushes, its slack is 0 as far as the velocity is known.
    rests[i] = (rests_[i] || now_.restitution[at] == 0) &&
               (impulse_[at] > 0 || slack <= resting_part * (length[at] * speed + std::abs(now_.drift[at])));
    const bool is_hit = !rests_[i] && impulse_[at] > 0 && now_.closes_fast[k];
    if (is_hit)
      hit.push_back(a);
    else if (rests[i] && !rests_[i])
      met.push_back(a);
  }
  for (std::size_t i = 0; i < rests.size(); ++i)
    if (rests_[i] && !rests[i] && !is_two_sided(static_cast<Index>(i))) left.push_back(static_cast<Index>(i));
  rests_ = std::move(rests);
  if (!hit.empty()) {
    event(EventKind::impact, hit, velocity_before);
    // T+ - T- = b·(v+ - v-) + (v+'A v+ - v-'A v-)/2 where the step has its forces, less what these do.
    const Vector change = velocity_ - velocity_before, middle = 0.5 * (velocity_ + velocity_before);
    const double linear = linear_part_of_energy(change);
    record.impact_energy += middle.dot(A_->multiply(change) - h * z_) + linear;
    record.ledger_energy += work + linear;
  }
  if (!met.empty()) event(EventKind::contact, met, velocity_before);
  if (!left.empty() && !is_first_) event(EventKind::release, left, velocity_before);
  is_first_ = false;
}

}  // namespace mechanics::inline motions
