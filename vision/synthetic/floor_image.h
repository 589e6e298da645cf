#pragma once

#include <cstdint>
#include <opencv2/core.hpp>

#include "vision/synthetic/camera_model.h"
#include "vision/synthetic/scene.h"

namespace nadir::vision {

/// The empty field as the optics shows it in even white light: reflectance of carpet texture and
/// painted lines, blurred and integrated over the pixels. CV_32FC3 of the camera's size, blue green
/// red.
cv::Mat floor_image(const Scene& scene, const CameraModel& camera, std::uint64_t seed);

}  // namespace nadir::vision
