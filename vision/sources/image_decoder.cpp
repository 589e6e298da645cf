#include "vision/sources/image_decoder.h"

#include <algorithm>
#include <array>
#include <exception>

#include "vision/pictures/codecs.h"

namespace nadir::vision {
namespace {

using Bytes = std::span<const std::uint8_t>;

bool starts_with(Bytes bytes, Bytes beginning) {
  return bytes.size() >= beginning.size() &&
         std::equal(beginning.begin(), beginning.end(), bytes.begin());
}

bool contains(Bytes bytes, Bytes part) {
  // Both marks stand at the end, so the search begins there.
  return std::search(bytes.rbegin(), bytes.rend(), part.rbegin(), part.rend()) != bytes.rend();
}

/// False for a PNG or JPEG whose closing mark is absent; other kinds have none.
bool is_complete(Bytes bytes) {
  constexpr std::array<std::uint8_t, 3> kJpegBegin{0xFF, 0xD8, 0xFF};
  constexpr std::array<std::uint8_t, 2> kJpegEnd{0xFF, 0xD9};
  constexpr std::array<std::uint8_t, 4> kPngBegin{0x89, 'P', 'N', 'G'};
  constexpr std::array<std::uint8_t, 4> kPngEnd{'I', 'E', 'N', 'D'};
  if (starts_with(bytes, kJpegBegin)) return contains(bytes, kJpegEnd);
  if (starts_with(bytes, kPngBegin)) return contains(bytes, kPngEnd);
  return !bytes.empty();
}

}  // namespace

const char* decode_status_text(DecodeStatus status) {
  switch (status) {
    case DecodeStatus::kDecoded:
      return "is decoded";
    case DecodeStatus::kIncomplete:
      return "is incomplete";
    case DecodeStatus::kNotAnImage:
      return "is damaged or not an image";
  }
  return "";
}

DecodeStatus decode_image(std::span<const std::uint8_t> bytes, cv::Mat& image) {
  if (!is_complete(bytes)) return DecodeStatus::kIncomplete;
  const Codecs& opencv = codecs();
  try {
    // Only a view: OpenCV asks for a matrix, which knows no constness.
    const cv::Mat view(1, static_cast<int>(bytes.size()), CV_8UC1,
                       const_cast<std::uint8_t*>(bytes.data()));
    // Decoding straight into `image` would save an allocation that costs less than a hundredth of
    // the decoding, but OpenCV 4.6 then hides failures: the picture of before stands there as if it
    // were this one.
    image = opencv.decode(view);
    return image.empty() ? DecodeStatus::kNotAnImage : DecodeStatus::kDecoded;
  } catch (const std::exception&) {
    return DecodeStatus::kNotAnImage;
  }
}

}  // namespace nadir::vision
