#pragma once

namespace convex {

/// A bound on the work of one question, a decomposition, a prox or a value, counted and not timed, so that
/// the same question has the same answer everywhere: evaluations of the functions of one variable whose roots
/// give the proxes of epigraphs and perspectives. An epigraph in a perspective in an epigraph needs a root
/// for each step to a root; where a saddle problem on top of that converges slowly it would take minutes.
/// Once the limit is passed its steps end, and the answer says how far they got.
///
/// The outermost one that stands counts; those inside are parts of its question.
class WorkLimit {
 public:
  WorkLimit();
  ~WorkLimit();
  WorkLimit(const WorkLimit&) = delete;
  WorkLimit& operator=(const WorkLimit&) = delete;
  static void count();
  static bool passed();
};

}  // namespace convex
