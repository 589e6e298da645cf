#pragma once

#include <optional>

#include "tracker/alignment/robot_fit.h"
#include "tracker/alignment/sensor_model.h"

namespace nadir::tracker {

/// The number of the lesson that a robot gives in a frame; nothing where it is not its turn. Of
/// `robots_per_lesson` robots that follow each other in `ordinal`, their place among all that are
/// aligned in the frame, one teaches in each frame. A robot that keeps its ordinal counts its
/// lessons one by one, however many robots there are.
inline std::optional<unsigned> lesson_due(unsigned frame, unsigned ordinal,
                                          unsigned robots_per_lesson) {
  const unsigned turn = frame + ordinal;
  if (turn % robots_per_lesson != 0) return std::nullopt;
  return turn / robots_per_lesson;
}

/// Tells the camera's model what one disc of a robot that was just aligned says of noise, blur and
/// light: all of its pixels, also those that say nothing of its place.
void teach(const cv::Mat& image, Mosaic mosaic, std::size_t disc, RobotFit& fit,
           SensorModel& sensor, const OutlierLimits& limits);

}  // namespace nadir::tracker
