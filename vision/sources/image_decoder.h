#pragma once

#include <cstdint>
#include <opencv2/core.hpp>
#include <span>

namespace nadir::vision {

enum class DecodeStatus {
  kDecoded,
  kIncomplete,  ///< empty, or a PNG or JPEG without its end: cut off while it was written or sent
  kNotAnImage,  ///< damaged, or of a kind that is not known
};
/// For messages: "is incomplete".
const char* decode_status_text(DecodeStatus status);

/// Decodes a compressed picture (PNG, JPEG, BMP, PPM, TIFF) to CV_8UC3, blue green red, in a buffer
/// of its own. The image's content is undefined unless the status is kDecoded. Throws
/// only where the decoders are not installed (`codecs`).
///
/// Incomplete pictures are refused although decoders fill what is missing with grey: a robot must
/// not be measured in half a frame.
DecodeStatus decode_image(std::span<const std::uint8_t> bytes, cv::Mat& image);

}  // namespace nadir::vision
