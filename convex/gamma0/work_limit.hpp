#pragma once

namespace convex::inline gamma0 {

/// A bound on the work of one question, a decomposition, a prox or a value, counted and not timed, so that
/// the same question has the same answer everywhere: evaluations of the functions of one variable whose roots
/// give the proxes of epigraphs and perspectives, and the steps of saddle problems, each as so many of them.
/// An epigraph in a perspective in an epigraph needs a root for each step to a root; where a saddle problem
/// on top of that converges slowly it would take minutes. Once the limit is passed its steps end, and the
/// answer says how far they got.
///
/// Those that stand inside another are parts of its question: each may take its own part of the whole, and no
/// more than is left.
class WorkLimit {
 public:
  explicit WorkLimit(double part = 1);
  /// For one of several ways, whose others are to have some: a half of what is left.
  static WorkLimit half_of_the_rest() { return WorkLimit(rest() / 2); }
  ~WorkLimit();
  WorkLimit(const WorkLimit&) = delete;
  WorkLimit& operator=(const WorkLimit&) = delete;
  /// What an evaluation of a function of so many entries counts as: few cost hardly more than one.
  static constexpr long of_entries(long n) { return 1 + n / 16; }
  /// What one evaluation of a saddle problem counts as.
  static constexpr long of_a_saddle_point = 4;
  /// And a search for the nearest point of a domain, whose program is made and solved, often by others
  /// within.
  static constexpr long of_a_nearest_point = 1000;
  /// A prox by linear and quadratic programs, however it comes out.
  static constexpr long of_a_program = 100;
  /// A value by a program of a few variables.
  static constexpr long of_a_program_value = 16;
  static void count(long evaluations = 1);
  static bool passed();
  /// Is so much left? For what is counted as a whole, beforehand.
  static bool has(long evaluations);

 private:
  /// What is left, as a part of the whole.
  static double rest();
  const WorkLimit* outer_;
  long end_;
};

}  // namespace convex::inline gamma0
