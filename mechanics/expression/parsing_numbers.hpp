#pragma once

#include "mechanics/expression/parsing.hpp"

namespace mechanics::expression {

/// While it lives, what is read are numbers: arguments of functions, indices, entries of lists.
class Parsing::Numbers {
 public:
  explicit Numbers(Parsing& parsing) : parsing_(parsing), component_(parsing.component_) {
    parsing_.component_ = 0;
  }
  ~Numbers() {
    parsing_.component_ = component_;
    parsing_.is_vector_ = false;
  }
  Numbers(const Numbers&) = delete;
  Numbers& operator=(const Numbers&) = delete;

 private:
  Parsing& parsing_;
  int component_;
};

/// One level of nesting, for as long as it lives.
class Parsing::Nested {
 public:
  explicit Nested(Parsing& parsing) : depth_(parsing.depth_) {
    if (++depth_ > deepest_nesting)
      parsing.source_->fail(parsing.token_.offset,
                            "nested more than 256 deep; name a part of it under [system.definitions]");
  }
  ~Nested() { --depth_; }
  Nested(const Nested&) = delete;
  Nested& operator=(const Nested&) = delete;

 private:
  int& depth_;
};

}  // namespace mechanics::expression
