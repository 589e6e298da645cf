#include "tracker/listen/listen_silence.h"

#include <arpa/inet.h>
#include <fmt/format.h>
#include <ifaddrs.h>
#include <net/if.h>
#include <netinet/in.h>

#include <array>
#include <memory>

namespace nadir::tracker {
namespace {

std::string describe(const PoseFilter& filter) {
  std::string text;
  if (filter.robot) text += fmt::format(" --robot {}", *filter.robot);
  if (!filter.team.empty()) text += " --team " + filter.team;
  if (!filter.camera.empty()) text += " --camera " + filter.camera;
  return text;
}

/// What there is to say of the one speaker and not of the other.
struct Words {
  std::string who;
  std::string program;
  std::string nothing_said;
};

Words words_of(Speaker speaker, const std::string& filter) {
  if (speaker == Speaker::kClient) {
    return {"client", "nadir-client drive",
            filter.empty()
                ? "a client is connected but has not said anything yet"
                : "a client is connected, but it is not that of" + filter + ": try without"};
  }
  return {"tracker", "nadir-tracker",
          filter.empty() ? "a tracker is connected but sees no robot: look at its overlay, or "
                           "here with --frames"
                         : "a tracker is connected but no pose passes" + filter + ": try without"};
}

std::string most_likely_reason(const ReaderOptions& options, Speaker speaker,
                               const ReaderStatus& status) {
  const Words words = words_of(speaker, describe(options.filter));
  if (status.malformed > 0) {
    return fmt::format(
        "samples arrive but hold impossible numbers: are {} and listener of the same version?",
        words.who);
  }
  if (status.alive_writers > 0) {
    return words.nothing_said;
  }
  if (status.matched_writers > 0) {
    return fmt::format("a {} was connected and fell silent: has it stopped, or is the network cut?",
                       words.who);
  }
  if (status.peers > 0) {
    const bool poses = speaker == Speaker::kTracker;
    return fmt::format(
        "others are in this domain, but none of them {}: is {} running, {}of the same version?",
        poses ? "publishes poses" : "is a client", words.program,
        poses ? "without --no-publish and " : "and ");
  }
  return fmt::format(
      "nobody else is in this domain: start {} with --domain {}; on another machine, "
      "let UDP "
      "multicast (239.255.0.1) and ports {} to {} pass, or name the machines as peers in "
      "CYCLONEDDS_URI",
      words.program, options.wire.domain, 7400 + 250 * options.wire.domain,
      7400 + 250 * options.wire.domain + 249);
}

}  // namespace

std::string network_interfaces() {
  ifaddrs* list = nullptr;
  if (getifaddrs(&list) != 0) return "unknown";
  const std::unique_ptr<ifaddrs, decltype(&freeifaddrs)> owner(list, &freeifaddrs);
  std::string text;
  for (const ifaddrs* entry = list; entry != nullptr; entry = entry->ifa_next) {
    if ((entry->ifa_flags & IFF_UP) == 0 || entry->ifa_addr == nullptr) continue;
    if (entry->ifa_addr->sa_family != AF_INET) continue;
    const auto* address = reinterpret_cast<const sockaddr_in*>(entry->ifa_addr);
    std::array<char, INET_ADDRSTRLEN> buffer{};
    inet_ntop(AF_INET, &address->sin_addr, buffer.data(), buffer.size());
    if (!text.empty()) text += ", ";
    text += fmt::format("{} {}", entry->ifa_name, buffer.data());
    if ((entry->ifa_flags & IFF_MULTICAST) != 0) text += " (multicast)";
  }
  return text.empty() ? "none" : text;
}

std::string explain_silence(const ReaderOptions& options, Speaker speaker,
                            const ReaderStatus& status, double silent_s,
                            const std::string& interfaces, const char* uri) {
  const bool configured = uri != nullptr && *uri != '\0';
  return fmt::format(
      "nothing to print for {:.0f} s on DDS domain {}\n"
      "  matched writers: {} (alive: {}), other DDS participants in the domain: {}\n"
      "  network interfaces up: {}\n"
      "  CYCLONEDDS_URI: {}\n"
      "  {}",
      silent_s, options.wire.domain, status.matched_writers, status.alive_writers, status.peers,
      interfaces, configured ? uri : "not set, Cyclone DDS takes the interface it finds best",
      most_likely_reason(options, speaker, status));
}

}  // namespace nadir::tracker
