#pragma once

#include <cstdlib>
#include <memory>
#include <new>

#include "convex/dense/dense_kernels.hpp"

namespace convex::inline dense {

/// Memory in one piece for the arrays of a solve, handed out by cache lines and taken back all at once.
class Arena {
 public:
  /// Forgets all arrays; there is room for `lines` cache lines then.
  void start(Index lines) {
    if (lines > lines_) {
      room_.reset(static_cast<double*>(std::aligned_alloc(64, static_cast<std::size_t>(lines) * 64)));
      lines_ = room_ ? lines : 0;
      if (!room_) throw std::bad_alloc();
    }
    next_ = room_.get();
  }
  /// `count` numbers or indices, at a cache line, not set to anything.
  template <class T>
  T* take(Index count) {
    static_assert(sizeof(T) == sizeof(double));
    T* const at = new (next_) T[static_cast<std::size_t>(padded(count))];
    next_ += padded(count);
    return at;
  }
  template <class T>
  T* take_filled(Index count, T value) {
    T* const at = take<T>(count);
    for (Index i = 0; i < padded(count); i += 8)
      for (Index k = 0; k < 8; ++k) at[i + k] = value;
    return at;
  }
  Index lines() const { return lines_; }
  void give_back() {
    room_.reset();
    lines_ = 0;
  }

 private:
  struct Free {
    void operator()(double* room) const { std::free(room); }
  };
  std::unique_ptr<double, Free> room_;
  double* next_ = nullptr;
  Index lines_ = 0;
};

}  // namespace convex::inline dense
