#pragma once

#include <cstdint>

namespace nadir::tracker {

struct ReaderStatus {
  int matched_writers = 0;             ///< discovered and compatible
  int alive_writers = 0;               ///< of these, heard of within the stream's lease
  int peers = 0;                       ///< other DDS participants in the domain, of whatever kind
  std::uint64_t received = 0;          ///< passed the filter
  std::uint64_t dropped = 0;           ///< of these, pushed out of a full queue
  std::uint64_t malformed = 0;         ///< refused by the codec
  std::uint64_t writers_lost = 0;      ///< times a writer fell silent without a good-bye
  std::uint64_t deadlines_missed = 0;  ///< times a robot was not heard of for the stream's deadline
};

struct WriterStatus {
  int matched_readers = 0;
  std::uint64_t published = 0;
  std::uint64_t refused = 0;  ///< values that do not belong on the wire
  std::uint64_t failed = 0;   ///< DDS took them not
};

}  // namespace nadir::tracker
