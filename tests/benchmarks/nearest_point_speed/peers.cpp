#include "peers.hpp"

namespace speed {

const std::vector<PeerKind>& peer_kinds() {
  static const std::vector<PeerKind> kinds{{"DAQP", make_daqp},
                                           {"eiquadprog", make_eiquadprog},
                                           {"qpmad", make_qpmad},
                                           {"quadprog", make_quadprog}};
  return kinds;
}

}  // namespace speed
