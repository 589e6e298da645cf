#include "tests/support/loopback_dds.h"

#include <unistd.h>

#include <cmath>
#include <cstdlib>
#include <random>

namespace nadir::test {
namespace {

/// Process ids come back; the random part keeps a lingering peer of an earlier test out.
std::string unique_tag() {
  static int count = 0;
  return "nadir-" + std::to_string(getpid()) + "-" + std::to_string(++count) + "-" +
         std::to_string(std::random_device()());
}

std::string lossy(double loss) {
  if (loss <= 0.0) return "";
  return "<Internal><Test><XmitLossiness>" + std::to_string(std::lround(1000.0 * loss)) +
         "</XmitLossiness></Test></Internal>";
}

}  // namespace

LoopbackDds::LoopbackDds(double loss)
    // Spreads the ports: each domain has its own. 101 is the last one below the ephemeral ports.
    : domain_(static_cast<std::uint32_t>(getpid()) % 102),
      // No multicast: the tag and the one peer are the whole network. The default of 9 participants
      // is too few, because those of killed processes linger. Each says every second that it is
      // there: where packets are lost, eight seconds (the default) may be all of a test.
      uri_(
          "<CycloneDDS><Domain id=\"any\"><General><Interfaces><NetworkInterface "
          "address=\"127.0.0.1\"/>"
          "</Interfaces><AllowMulticast>false</AllowMulticast></General><Discovery><Tag>" +
          unique_tag() +
          "</Tag><SPDPInterval>1s</SPDPInterval><ParticipantIndex>auto</ParticipantIndex>"
          "<MaxAutoParticipantIndex>99</MaxAutoParticipantIndex>"
          "<Peers><Peer address=\"127.0.0.1\"/></Peers></Discovery>" +
          lossy(loss) + "</Domain></CycloneDDS>") {
  setenv("CYCLONEDDS_URI", uri_.c_str(), 1);
}

LoopbackDds::~LoopbackDds() { unsetenv("CYCLONEDDS_URI"); }

}  // namespace nadir::test
