#include "vision/sources/open_source.h"

#include <cctype>
#include <cmath>
#include <filesystem>
#include <utility>

#include "vision/input/input_error.h"
#include "vision/sources/image_folder.h"
#include "vision/sources/v4l2_camera.h"
#include "vision/sources/video_file.h"
#include "vision/synthetic/synthetic_source.h"

namespace nadir::vision {
namespace {

constexpr const char* kPossibleSources =
    "possible are a folder of images, a video file, v4l2:/dev/video0 and synthetic:SCENE.yaml";

struct SchemeAndRest {
  std::string scheme;  ///< empty for a plain path
  std::string rest;
};

/// Splits at the first colon if what stands before it looks like a scheme: letters, digits, plus,
/// minus, dot.
SchemeAndRest split_scheme(const std::string& source) {
  const std::size_t colon = source.find(':');
  if (colon == std::string::npos || colon == 0) return {"", source};
  for (const char letter : source.substr(0, colon)) {
    const bool fits = std::isalnum(static_cast<unsigned char>(letter)) != 0 || letter == '+' ||
                      letter == '-' || letter == '.';
    if (!fits) return {"", source};
  }
  return {source.substr(0, colon), source.substr(colon + 1)};
}

std::unique_ptr<FrameSource> open_recording(const std::string& path, const SourceOptions& options) {
  std::error_code code;
  if (!std::filesystem::exists(path, code)) {
    throw InputError({path}, "no such file or folder", kPossibleSources);
  }
  if (std::filesystem::is_directory(path, code)) {
    return std::make_unique<ImageFolder>(path, options.rate_hz, options.start_time);
  }
  return std::make_unique<VideoFile>(path, options.rate_hz, options.start_time);
}

}  // namespace

std::unique_ptr<FrameSource> open_source(const std::string& source, const SourceOptions& options) {
  if (!std::isfinite(options.rate_hz) || options.rate_hz <= 0.0) {
    throw InputError({}, "the rate is not above 0 Hz", "give frames a second, such as 30");
  }
  if (source.empty()) throw InputError({}, "the source is empty", kPossibleSources);
  std::error_code code;
  const SchemeAndRest parts = split_scheme(source);
  if (parts.scheme.empty() || std::filesystem::exists(source, code)) {
    return open_recording(source, options);
  }
  if (parts.rest.empty()) {
    throw InputError({source}, "nothing stands behind the colon", kPossibleSources);
  }
  if (parts.scheme == "v4l2") {
    return std::make_unique<V4l2Camera>(
        parts.rest, V4l2Request{options.width_px, options.height_px, options.rate_hz});
  }
  if (parts.scheme == "synthetic") {
    const SyntheticPace pace =
        options.synthetic_in_real_time ? SyntheticPace::kRealTime : SyntheticPace::kFastest;
    Scene scene = load_scene(parts.rest);
    if (scene.live_robots && options.live_robots) {
      auto robots = options.live_robots(scene.live_robots->hold_s);
      return std::make_unique<SyntheticSource>(std::move(scene), options.seed, std::move(robots));
    }
    return std::make_unique<SyntheticSource>(std::move(scene), options.seed, pace);
  }
  throw InputError({source}, "unknown source scheme '" + parts.scheme + "'", kPossibleSources);
}

}  // namespace nadir::vision
