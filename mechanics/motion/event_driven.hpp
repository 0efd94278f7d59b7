#pragma once

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>
#include <string_view>

#include "mechanics/motion/accumulation.hpp"
#include "mechanics/motion/course.hpp"
#include "mechanics/motion/expansion.hpp"
#include "mechanics/motion/zero_search.hpp"

namespace mechanics::inline motions {

inline constexpr double epsilon = std::numeric_limits<double>::epsilon();

/// f of a closed contact is 0 up to so many roundings of what it is the sum of.
inline constexpr double roundings_of_closed = 16;

/// What to do where gradients of contacts held vanish, or depend on each other, at one position alone.
inline constexpr std::string_view advice_on_singular_states =
    ", a singular position, as of a linkage stretched out; write the loop otherwise (by an angle for both "
    "sides, or by constraints that are independent there), start beyond the position, or follow the motion "
    "with --method time-stepping";

/// A motion followed from event to event. A step ends at the first event of its arc; the event changes the
/// velocity, and the right limit of the motion chooses the contacts of the next arc.
class Motion::EventDriven final : public Motion::Course {
 public:
  EventDriven(const LagrangianSystem& system, const State& state, MotionOptions options);
  bool advance(double until) override;

 private:
  void begin(const State& at);
  void take_step(double until);
  void look_for_progress();
  void look_for_stiffness();
  double rounding_of_time(double ahead) const;
  std::vector<Zero> closing_at_once();
  std::vector<Zero> closing_at_the_end();
  void watch();
  double polished(const Zero& zero, double tau);
  void land_softly(Zero& zero, double end) const;
  bool fits(double tau, int halvings);
  bool is_met(double at, double tau, bool may_leave_zero);
  bool is_met_on_branches(double at, double tau, bool may_leave_zero);
  double pull_of_weak(const Vector& lambda);
  bool is_passed(double at);
  void move_time(double by);
  /// What the rounding of a time is of: motions without t in them are the same whenever they start.
  double clock() const {
    return expansion_.uses_time() ? std::max(std::abs(state.t), since_start_) : since_start_;
  }
  bool is_at_once(const Zero& zero, const Zero& first) const;
  void handle(const std::vector<Zero>& zeros);
  double rounding_of_f(Index a);
  /// Whether f, as the arc behind has it, comes to its least value so near that it is 0 there but for
  /// rounding: a touch, and no impact, whatever the speed that rounding leaves.
  bool turns_within_rounding(Index a);
  void stop_at_vanishing_gradient(Index a);
  void stop_at_dependent_rows();
  void project_after_step();
  /// Gradients of these contacts that are 0 but for rounding count as 0 from here on.
  void take_rounding_of_gradients_for_zero(const std::vector<Index>& contacts);
  void tell_blur(const std::vector<Zero>& zeros);
  void tell_order(const std::vector<Zero>& zeros, const std::vector<Index>& closing);
  void collide(const std::vector<Index>& closing, const std::vector<Index>& touching,
               const std::vector<Index>& switches);
  double bounce_over_rounding(Index a, double speed, const ImpactHistory& history) const;
  /// The contacts whose impacts come to an end so soon that they are at rest from now on.
  std::vector<Index> accumulating(const std::vector<Index>& closing) const;
  std::vector<Index> brought_to_rest(std::vector<Index> contacts);
  bool may_stop_in_time(const std::vector<Index>& contacts, const std::vector<double>& weights);
  /// Impacts follow each other within the rounding of t.
  bool time_stands_still() const { return events_at_once_ > many_at_once; }
  static constexpr long many_at_once = 10;
  void release_event(const std::vector<Index>& held_before, const Vector& velocity_before);
  bool is_defined_here();
  std::vector<Index> find_branches();
  /// Of the switches, before a jump of the velocity.
  struct Switches {
    std::vector<double> arguments, branches;
    std::vector<Index> at_zero;
  };
  Switches switches_before_jump(const std::vector<Index>& at_zero) const;
  std::vector<Index> branches_after_jump(const Switches& before);
  /// A new arc from here. In question: contacts that may persist, and switches at 0. Of contacts whose
  /// gradient vanishes, which are in question too, none can push: where one would have to, the motion stops.
  void begin_arc(const std::vector<Index>& contacts, std::vector<Index> switches,
                 const std::vector<Index>& without_gradient = {});
  /// Appends to `at_zero` what is at 0 with the branches of the others.
  std::optional<ContactAnswer> answer_on_branches(const std::vector<Index>& contacts,
                                                  std::vector<Index>& at_zero);
  std::optional<double> sign_ahead(std::size_t k, std::vector<double> by_rounding);
  double length_ahead() const;
  bool is_denied_beside(const std::vector<Index>& at_zero, const std::vector<double>& signs);
  void take_signs_beside(const std::vector<Index>& switches, std::vector<double>& signs);
  bool has_left_its_branch(std::size_t k, double tau);
  void note_across(double tau);
  double distance_of_zero(const Zero& zero, double tau);
  bool is_jump(double tau, std::vector<Zero>& zeros);
  bool leads_from_pole();
  double terms_of_argument(std::size_t k, double tau) const;
  double rate_of_argument(std::size_t k, double tau) const;
  bool is_at_zero_of_arc(std::size_t k) const;
  double left_of_argument(std::size_t k, double tau);
  bool has_left_zero(std::size_t k, double tau, double times);
  std::vector<Zero> left_behind();
  void come_to_rest(std::vector<Zero>& zeros);
  void keep_unseen(ContactAnswer& answer);
  std::optional<HeldRows::Answer> acceleration_off_zero(double tau);
  std::optional<HeldRows::Answer> acceleration_off_zero(const State& there,
                                                        const std::vector<std::size_t>& left, double tau = 0);
  void follow_jumps(std::vector<Index>& at_zero, const std::vector<double>& before);
  bool take_sides_of_start(std::vector<Index>& switches);
  void take_sides_ahead(Contacts& found, const std::vector<Index>& switches);
  /// Where expressions have changed their branch, f and df/dt of contacts may have jumped: then what follows
  /// is an impact, a separation, or the end, and nothing is left to do.
  bool meet_kinks(const std::vector<Index>& contacts, const std::vector<Index>& switches);
  void note_behind();
  double difference_at_zero(std::size_t k, const std::vector<Index>& switches);
  std::string jump_of_energy(const std::vector<Index>& contacts, const std::vector<Index>& switches);
  void note_unloading(const std::vector<Zero>& zeros);
  ContactQuestion question_of(const std::vector<Index>& contacts) const;
  std::string advice_on_kinks() const;
  std::vector<Index> with_kinks(const std::vector<Index>& contacts, const std::vector<Index>& switches);
  /// Why nothing is found that goes on.
  std::string obstacle_ahead(const std::vector<Index>& contacts, const std::vector<Index>& switches);
  void continue_arc();
  /// Of a contact held: it is one-sided and has no multiplier.
  bool may_be_implied(Index a) const { return !is_two_sided(a) && is_weak_[static_cast<std::size_t>(a)]; }
  void take_counted(const std::vector<Index>& independent);
  bool let_go_of_moving();
  void project();
  void fill_next();
  bool may_leave_rest();
  void close_together(std::vector<Zero>& zeros) const;
  void look_for_penetration();
  /// Where no arc follows there is neither q'' nor a multiplier.
  void forget_right_limits() {
    acceleration.resize(0);
    multipliers.resize(0);
  }
  /// Sums such as T - V and p, and the values that a series tells, lose digits; as long as half of them are
  /// left, a difference of more is a jump.
  static constexpr double half_the_digits = 0x1p-26;
  /// Of what stays 0 the rounding of so many orders counts, the value and two derivatives.
  static constexpr int orders_at_zero = 3;
  /// A contact without a multiplier pulls beyond so many times what rounding made of that as the arc began.
  static constexpr double room_of_weak = 10;
  static constexpr double not_begun = std::numeric_limits<double>::quiet_NaN();
  Arc next;  ///< the one ahead of `state`; its t is not a number until it is begun
  Expansion expansion_;
  std::string obstacle_;          // why a step could not be taken, if an expression said so
  std::vector<Index> across_;     // the switches whose arguments were on their other side, unforeseen
  std::string undefined_beyond_;  // of branches tried at an event, what one of them said
  double start_ = 0;              // the time at the start
  double since_start_ = 0;        // the time is start_ + since_start_ + low_
  double low_ = 0;
  std::vector<Index> persist_;                     // held on the next arc
  std::vector<Index> counted_;                     // of them, those whose gradients count as it begins
  std::vector<int> zeros_of_f_, zeros_of_lambda_;  // leading ones on the next arc
  /// The argument of a branch.
  struct Argument {
    double branch_behind = 0;                   ///< before the event
    bool crosses = true;                        ///< it comes to 0 in the event, and does not go back
    bool jumps = false;                         ///< past 0, in the event
    double terms_behind = 0;                    ///< what it was the sum of as the arc behind ended
    double rate_behind = 0;                     ///< and its rate
    double width_of_zero = 0;                   ///< on the branches tried last: so far it counts as 0
    double left_of_zero = 0;                    ///< what rounding may have made of one that stays 0, so far
    std::vector<double> rounding_of_zero = {};  ///< and makes of it on the next arc, by order
    int zeros = 0;                              ///< leading ones on the next arc
  };
  std::vector<Argument> arguments_;         // by switch
  bool by_single_terms_ = false;            // the sign ahead of an argument
  std::vector<std::size_t> without_value_;  // switches whose argument is not finite as the next arc begins
  std::vector<ContactQuestion::Unloaded> unloaded_;  // in the event at hand
  std::vector<bool> is_weak_;                        // held without a multiplier
  std::vector<double> least_multiplier_;  // of a weak one: what is less, rounding made at the arc's beginning
  std::vector<bool> is_blurred_;          // of an impact it was told that its time is uncertain
  std::vector<double> elapsed_;           // since the last impact, by constraint
  std::vector<ImpactContact> striking_;   // in the impact at hand
  std::vector<ImpactHistory> history_;
  std::vector<Watched> watched_;  // on the next arc
  std::vector<double> sizes_;     // ||q_k||_A on the next arc, by order
  /// Steps without an event, one after the other, and the forces as they began.
  struct Stretch {
    long steps = 0, events = 0;
    int in_vain = 0;           ///< so many ones before it led nowhere
    bool is_of_series = true;  ///< no step is as short as the argument of a function asks for
    double begin = 0, took_before = 0;
    Vector force, largest, change, velocity;  ///< at the beginning; the largest ones since
  };
  Stretch stretch_;
  std::vector<bool> is_held_;     // on the next arc
  std::vector<bool> is_counted_;  // of them
  State there_;                   // the end of the step
  Vector q2_, expected_q2_;       // there, by the equations and by the series
  double reach_;                  // of arguments in a step
  bool is_blind_ = false;         // the step ahead is not the one that its series tell
  bool is_cut_ = false;           // on the next arc: a derivative has no bound as it begins
  bool ends_early_ = false;       // and its series end before that
  long cut_in_a_row_ = 0;         // arcs of that kind, one after the other
  double step_ahead_ = 0;
  long events_at_once_ = 0, kinks_at_once_ = 0;
  long mark_ = -1, impacts_at_mark_ = 0;  // steps, impacts and time where progress was looked at last
  double time_of_mark_ = 0;
  double time_of_crowd_ = 0;  // when as many steps had been taken as are looked at for a crowd
  double last_crowd_ = 0;     // the time that the crowd before took
  long events_at_crowd_ = 0;
  double until_ = std::numeric_limits<double>::infinity();  // not asked for yet
  /// At an event, on the branches before it, with the velocity after it.
  struct Behind {
    double lagrangian;
    Vector momentum, f, rate;
    Expansion::Roundings roundings;  ///< of these, on the branches before
  };
  std::optional<Behind> behind_;
  Vector left_of_f_;          // by constraint, at a kink: up to here f counts as 0
  double time_of_kinks_ = 0;  // the last one
  double since_event_ = 0;    // the time from the last event to here
  double last_length_ = 0;    // of the last arc that has one
  std::string ends_here_;     // at its last instant: why it does not go on from there
};

}  // namespace mechanics::inline motions
