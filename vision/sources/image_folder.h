#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include "vision/frame_source.h"

namespace nadir::vision {

/// A recording as a folder of pictures (png, jpg, jpeg, bmp, ppm, tif, tiff), one a frame, in the
/// order of their names.
///
/// Capture times come from times.csv in the folder, or beside it if the folder is called `frames`
/// (as nadir-render writes); without such a file frame i was taken at start_time + i / rate_hz. A
/// picture that cannot be read is skipped and reported; its frame number stays free.
class ImageFolder final : public FrameSource {
 public:
  /// @param rate_hz  frames a second, above 0
  /// Throws InputError if the folder is absent or holds no picture, or if times.csv is wrong.
  ImageFolder(const std::filesystem::path& folder, double rate_hz, CaptureTime start_time);

  ReadResult read(Frame& frame) override;

  std::size_t frame_count() const { return files_.size(); }

 private:
  bool load_bytes(const std::filesystem::path& file);

  std::vector<std::filesystem::path> files_;
  std::vector<CaptureTime> times_;
  std::vector<std::uint8_t> bytes_;  ///< of the picture being read; keeps its memory
  std::size_t next_ = 0;
};

}  // namespace nadir::vision
