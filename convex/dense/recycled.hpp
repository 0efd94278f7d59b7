#pragma once

#include <memory>
#include <utility>

namespace convex::inline dense {

/// A T in the state, and with the room, of the last one that the thread gave up and `is_worth_keeping` says
/// yes of; a new one where there is none. One solve after the other then takes no room from the system, which
/// merges and splits what it gets back.
template <class T, bool (*is_worth_keeping)(const T&)>
class Recycled {
 public:
  static std::shared_ptr<T> one() { return {spare_ ? std::exchange(spare_, nullptr) : new T, GiveBack()}; }

 private:
  struct Keeper {
    ~Keeper() {
      delete std::exchange(spare_, nullptr);
      is_over_ = true;
    }
  };
  struct GiveBack {
    void operator()(T* given) const {
      if (!is_over_ && is_worth_keeping(*given)) {
        [[maybe_unused]] thread_local const Keeper keeper;
        std::swap(spare_, given);
      }
      delete given;
    }
  };
  // Without destructors, so that they last as long as the thread: what is shared may outlive the keeper.
  static inline thread_local T* spare_ = nullptr;
  static inline thread_local bool is_over_ = false;
};

}  // namespace convex::inline dense
