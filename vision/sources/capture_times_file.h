#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "vision/frame.h"

namespace nadir::vision {

/// Reads a times file, header `file,capture_ns`: when each picture of a recording was taken,
/// nanoseconds since the Unix epoch. Folders in the column `file` do not count, the name does.
/// @param names  the recording's pictures, in order, without folders
/// @return one time a picture, in the order of `names`
/// Throws InputError where a picture has no row or two, where a row's picture is absent and where
/// the times do not increase.
std::vector<CaptureTime> load_capture_times(const std::filesystem::path& file,
                                            const std::vector<std::string>& names);

}  // namespace nadir::vision
