#pragma once

#include <string>

#include "tracker/wire/pose_reader.h"

namespace nadir::tracker {

/// The network interfaces that are up, with their IPv4 addresses: "lo 127.0.0.1, eth0 192.168.1.4
/// (multicast)".
std::string network_interfaces();

/// Whom nadir-listen wants to hear.
enum class Speaker { kTracker, kClient };

/// Why nadir-listen has nothing to print, and what to try: several lines, from what the reader
/// knows. interfaces: from network_interfaces(); uri: CYCLONEDDS_URI, or null.
std::string explain_silence(const ReaderOptions& options, Speaker speaker,
                            const ReaderStatus& status, double silent_s,
                            const std::string& interfaces, const char* uri);

}  // namespace nadir::tracker
