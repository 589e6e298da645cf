#include "control_client/drive/frame_gaps.h"

#include <algorithm>

namespace nadir::control_client {

void FrameGaps::add(std::uint32_t camera, std::uint64_t epoch, std::uint64_t frame) {
  ++frames_;
  auto stream = std::ranges::find_if(streams_, [&](const Stream& each) {
    return each.heard > 0 && each.camera == camera && each.epoch == epoch;
  });
  if (stream == streams_.end()) {
    stream = std::ranges::min_element(streams_, {}, &Stream::heard);
    if (stream->heard > 0) lost_of_forgotten_ += stream->lost();
    *stream = {camera, epoch, frames_, frame, frame, 1};
    return;
  }
  stream->heard = frames_;
  stream->first = std::min(stream->first, frame);
  stream->newest = std::max(stream->newest, frame);
  ++stream->received;
}

std::uint64_t FrameGaps::lost() const {
  std::uint64_t lost = lost_of_forgotten_;
  for (const Stream& stream : streams_) {
    if (stream.heard > 0) lost += stream.lost();
  }
  return lost;
}

}  // namespace nadir::control_client
