#pragma once

#include <array>
#include <opencv2/core.hpp>
#include <optional>
#include <string>
#include <vector>

namespace nadir::tracker {

/// Which of the three colours each pixel of the sensor has really measured: names the colours of
/// the top-left 2x2 pixels, row by row. kNone: all three.
enum class Mosaic { kNone, kRggb, kBggr, kGrbg, kGbrg };

/// Names of --mosaic: those of Mosaic in its order, then "auto".
extern const std::vector<std::string> kMosaicNames;

/// Mosaic of one of the names; nothing for "auto".
std::optional<Mosaic> mosaic_from_name(const std::string& name);

/// The other way round.
const std::string& mosaic_name(std::optional<Mosaic> mosaic);

/// Channel (0 blue, 1 green, 2 red) that a pixel has measured; at [2 (v & 1) + (u & 1)].
std::array<int, 4> native_channels(Mosaic mosaic);

/// The mosaic from which a CV_8UC3 frame was interpolated, by the noise: of each colour the
/// measured pixels carry more of it than those that are means of their neighbours. kNone if no
/// mosaic shows: a camera with three colours in each pixel, or a picture that was compressed as
/// JPEG. Looks at some thousand pixels spread over the frame.
Mosaic recognise_mosaic(const cv::Mat& bgr);

}  // namespace nadir::tracker
