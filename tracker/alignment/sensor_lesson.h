#pragma once

#include "tracker/alignment/robot_fit.h"
#include "tracker/alignment/sensor_model.h"

namespace nadir::tracker {

/// Tells the camera's model what one disc of a robot that was just aligned says of noise, blur and
/// light: all of its pixels, also those that say nothing of its place.
void teach(const cv::Mat& image, Mosaic mosaic, std::size_t disc, RobotFit& fit,
           SensorModel& sensor, const OutlierLimits& limits);

}  // namespace nadir::tracker
