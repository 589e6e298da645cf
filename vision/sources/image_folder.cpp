#include "vision/sources/image_folder.h"

#include <algorithm>
#include <array>
#include <cctype>
#include <fstream>
#include <optional>

#include "vision/input/input_error.h"
#include "vision/sources/capture_times_file.h"
#include "vision/sources/image_decoder.h"
#include "vision/sources/recording_clock.h"

namespace nadir::vision {
namespace {

namespace fs = std::filesystem;

bool is_picture(const fs::path& file) {
  constexpr std::array kExtensions{".png", ".jpg", ".jpeg", ".bmp", ".ppm", ".tif", ".tiff"};
  std::string extension = file.extension();
  std::transform(extension.begin(), extension.end(), extension.begin(),
                 [](unsigned char letter) { return static_cast<char>(std::tolower(letter)); });
  return std::find(kExtensions.begin(), kExtensions.end(), extension) != kExtensions.end();
}

/// The pictures in the folder, by name.
std::vector<fs::path> find_pictures(const fs::path& folder) {
  std::error_code code;
  std::vector<fs::path> files;
  fs::directory_iterator entry(folder, code);
  for (; !code && entry != fs::directory_iterator(); entry.increment(code)) {
    std::error_code of_entry;
    if (is_picture(entry->path()) && !entry->is_directory(of_entry)) files.push_back(*entry);
  }
  if (code) {
    throw InputError({folder.string()}, "cannot be read: " + code.message(),
                     "name a folder of images");
  }
  std::sort(files.begin(), files.end());
  return files;
}

std::string no_picture_remedy(const fs::path& folder) {
  std::error_code code;
  const fs::path frames = folder / "frames";
  if (fs::is_directory(frames, code)) return "did you mean '" + frames.string() + "'?";
  return "put png, jpg, jpeg, bmp, ppm or tif files into it";
}

std::optional<fs::path> find_times_file(const fs::path& folder) {
  std::error_code code;
  if (fs::exists(folder / "times.csv", code)) return folder / "times.csv";
  const fs::path absolute = fs::weakly_canonical(folder, code);
  if (absolute.filename() != "frames") return std::nullopt;
  const fs::path beside = absolute.parent_path() / "times.csv";
  if (fs::exists(beside, code)) return beside;
  return std::nullopt;
}

}  // namespace

ImageFolder::ImageFolder(const fs::path& folder, double rate_hz, CaptureTime start_time)
    : files_(find_pictures(folder)) {
  if (files_.empty()) {
    throw InputError({folder.string()}, "holds no image", no_picture_remedy(folder));
  }
  if (const auto times_file = find_times_file(folder)) {
    std::vector<std::string> names;
    for (const fs::path& file : files_) names.push_back(file.filename());
    times_ = load_capture_times(*times_file, names);
    return;
  }
  for (std::size_t i = 0; i < files_.size(); ++i) {
    times_.push_back(regular_capture_time(start_time, i, rate_hz));
  }
}

bool ImageFolder::load_bytes(const fs::path& file) {
  std::ifstream stream(file, std::ios::binary | std::ios::ate);
  if (!stream) return false;
  const std::streamoff size = stream.tellg();
  if (size < 0) return false;
  bytes_.resize(static_cast<std::size_t>(size));
  stream.seekg(0);
  stream.read(reinterpret_cast<char*>(bytes_.data()), size);
  return stream.gcount() == size;
}

ReadResult ImageFolder::read(Frame& frame) {
  if (next_ == files_.size()) return {ReadStatus::kEnd, {}};
  const std::size_t index = next_++;
  const fs::path& file = files_[index];
  if (!load_bytes(file)) {
    return {ReadStatus::kSkipped, file.string() + ": cannot be read; the frame is skipped"};
  }
  const DecodeStatus status = decode_image(bytes_, frame.image);
  if (status != DecodeStatus::kDecoded) {
    return {ReadStatus::kSkipped,
            file.string() + ": " + decode_status_text(status) + "; the frame is skipped"};
  }
  frame.number = index;
  frame.capture_time = times_[index];
  return {ReadStatus::kFrame, {}};
}

}  // namespace nadir::vision
