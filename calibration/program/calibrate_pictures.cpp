// Pictures in and out of nadir-calibrate.

#include "calibration/program/calibrate_pictures.h"

#include <cstdint>
#include <span>

#include "vision/input/input_error.h"
#include "vision/input/text_file.h"
#include "vision/pictures/codecs.h"
#include "vision/sources/image_decoder.h"

namespace nadir::calibration {

using vision::InputError;

cv::Mat load_picture(const std::string& file) {
  const std::string bytes = vision::read_text_file(file);
  cv::Mat picture;
  const auto status = vision::decode_image(
      std::span(reinterpret_cast<const std::uint8_t*>(bytes.data()), bytes.size()), picture);
  if (status != vision::DecodeStatus::kDecoded) {
    throw InputError({file}, vision::decode_status_text(status),
                     "give a PNG, JPEG, BMP, PPM or TIFF");
  }
  return picture;
}

void write_picture(const std::string& file, const cv::Mat& picture) {
  bool written = false;
  try {
    written = vision::codecs().write(file, picture);
  } catch (const cv::Exception&) {  // an ending that is not known
    throw InputError({file}, "has no ending of a picture", "call it .png or .jpg");
  }
  if (!written) throw InputError({file}, "cannot be written", "check the folder and its rights");
}

}  // namespace nadir::calibration
