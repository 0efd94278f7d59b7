#pragma once

/// A strictly convex quadratic program as other packages take it: minimise ½ q·Aq - z·q over Uq >= s, with
/// equality where `two_sided` is not 0. A: n×n; z, q: n; U: m×n by rows; s, two_sided: m.
struct PeerProgram {
  int n, m;
  const double *A, *z, *U, *s;
  const unsigned char* two_sided;
  double tolerance;      ///< asked for; 0: the package's own settings
  double* q;             ///< the answer
  double own_tolerance;  ///< that of the package's own settings, told by it
};

/// How it says that it ended.
enum PeerOutcome { peer_solved = 0, peer_infeasible = 1, peer_failed = 2 };

/// What each module has: its name is moreau_peer.
using SolvePeer = int (*)(PeerProgram*);
