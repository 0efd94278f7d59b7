#pragma once

namespace convex::inline composite {

/// How a saddle problem is gone about while this stands. No one choice is right for all: the scales of D that
/// suit one set of curvatures are slow for another, and an x taken from a steep term may leave a set by
/// rounding, as one taken from the set may leave the steep term's domain. The plain look is tried first, and
/// what it does not settle is looked at again; each answer is held against the values of the functions, so
/// that a look can fail and not mislead.
class Look {
 public:
  enum class Kind { plain, at_other_scales, by_steep_terms };
  explicit Look(Kind kind) : outer_(current()) { current() = kind; }
  ~Look() { current() = outer_; }
  Look(const Look&) = delete;
  Look& operator=(const Look&) = delete;

  /// Are other scales of D tried where the steps do not come to rounding?
  static bool at_other_scales() { return current() != Kind::plain; }
  /// Is x taken from the terms that are steep at an end of their domain, and are the multipliers of epigraphs
  /// and perspectives made of the slopes of their functions?
  static bool by_steep_terms() { return current() == Kind::by_steep_terms; }

 private:
  static Kind& current() {
    thread_local Kind kind = Kind::plain;
    return kind;
  }
  Kind outer_;
};

}  // namespace convex::inline composite
