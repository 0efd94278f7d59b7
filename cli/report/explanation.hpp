#pragma once

#include "cli/problem_file/problem.hpp"
#include "cli/report/document.hpp"
#include "cli/report/solve_report.hpp"
#include "mechanics/motion/motion.hpp"

namespace cli::inline reports {

/// The reasoning of Moreau 1966 on one scene, in words, numbers and formulas: the letters of its text, T and
/// the momenta, what z gathers, what each contact asks of q'', the classical hypothesis and Delassus' rule,
/// Gauss' and Appell's functions with their minimum, the reactions, and which contact changes next. `text` is
/// what a [system] was read from, null for a [projection]; `next` what follows, found by moving on.
Document explanation(const SolvedScene&, const SystemProblem* text, const Line& next);

// Its sections, in order.
/// Parameters with their values, and definitions.
void explain_letters(Document&, const SystemProblem& text);
void explain_mechanism(Document&, const SolvedScene&, const SystemProblem& text);
void explain_contacts(Document&, const SolvedScene&, const SystemProblem* text);
void explain_hypothesis(Document&, const SolvedScene&);
void explain_answer(Document&, const SolvedScene&);

/// An expression of a family, `key` "left[i in 2..N]", as that of its member "left[2]": the letters of its
/// indices are numbers. The expression as it stands where a sum binds a letter anew.
std::string of_member(const std::string& key, const std::string& expression, const std::string& name);

/// What happens next in the motion from the state of the scene, found by following it.
Line next_event(const Scene&, const mechanics::MotionOptions&);

/// The name of a constraint, or of a row of the problem, with (=) behind it when it is two-sided.
Name constraint_name(const Scene&, std::size_t constraint);
Name row_name(const Scene&, convex::Index row);

/// "lambda_floor" and so on: a letter with a name below it.
Math indexed(const std::string& plain, const std::string& latex, const std::string& name);
/// "(0.5, -1)": the numbers of a vector; a long one is cut and counted.
Math vector_math(const convex::Vector&);

}  // namespace cli::inline reports
