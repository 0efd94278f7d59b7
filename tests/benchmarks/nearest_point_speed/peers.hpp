#pragma once

#include <memory>
#include <string_view>
#include <vector>

#include "families.hpp"

namespace speed {

enum class Outcome { solved, infeasible, failed };

/// Another solver of the same problem. What it must convert is converted when it is made, outside every
/// clock; what a solve destroys is copied inside. Storage of an object meant to be used again is kept.
class Peer {
 public:
  virtual ~Peer() = default;
  /// From A, U, z and s, nothing known: q stands in `answer`.
  virtual Outcome cold() = 0;
  /// With other z and s after a cold solve, by whatever it keeps: a factor, the rows that were active.
  virtual Outcome again(const Vector& z, const Vector& s) = 0;

  Vector answer;
};

struct PeerKind {
  std::string_view name;
  /// Null: the program was built without it.
  std::unique_ptr<Peer> (*make)(const DenseProblem&);
};

/// DAQP, eiquadprog, qpmad, quadprog, in that order, with their default settings.
const std::vector<PeerKind>& peer_kinds();

std::unique_ptr<Peer> make_daqp(const DenseProblem&);
std::unique_ptr<Peer> make_eiquadprog(const DenseProblem&);
std::unique_ptr<Peer> make_qpmad(const DenseProblem&);
std::unique_ptr<Peer> make_quadprog(const DenseProblem&);

}  // namespace speed
