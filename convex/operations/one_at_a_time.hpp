#pragma once

namespace convex::inline operations {

/// While one stands, questions of its kind asked inside it are answered without it. The conjugate of the
/// conjugate is the function itself, so a prox that asks its conjugate's, or a value that asks a supremum
/// over it, would come back to where it began and not end.
class OneAtATime {
 public:
  enum class Kind {
    conjugate_prox,
    supremum,
    lower_bound,
    maximum,
    maximum_in_maximum,
    maximum_conjugate,
    least_on_line
  };
  explicit OneAtATime(Kind kind) : standing_(of(kind)), first_(!standing_) { standing_ = true; }
  ~OneAtATime() {
    if (first_) standing_ = false;
  }
  OneAtATime(const OneAtATime&) = delete;
  OneAtATime& operator=(const OneAtATime&) = delete;
  /// Is there none around this one?
  bool first() const { return first_; }

 private:
  static bool& of(Kind kind) {
    thread_local bool standing[7] = {};
    return standing[static_cast<int>(kind)];
  }
  bool& standing_;
  bool first_;
};

}  // namespace convex::inline operations
