#include "tests/tracker/kernel_poses.h"

#include <limits>

#include "tracker/alignment/pose_aligner.h"
#include "tracker/alignment/tag_aligner.h"

#ifdef NADIR_PLAIN
#define NADIR_POSES plain_poses
#else
#define NADIR_POSES usual_poses
#endif

namespace nadir::kernels {
namespace {

constexpr double kNone = std::numeric_limits<double>::quiet_NaN();

std::array<double, 3> numbers(bool found, const fusion::PlanarPose& pose) {
  if (!found) return {kNone, kNone, kNone};
  return {pose.x_m, pose.y_m, pose.heading_rad};
}

fusion::PlanarPose start(const Guess& guess) {
  return {guess.pose[0], guess.pose[1], guess.pose[2]};
}

}  // namespace

Poses NADIR_POSES(const vision::MarkerLayout& layout, const calibration::PlaneMap& map, bool mosaic,
                  const std::vector<Picture>& pictures) {
  const int width_px = pictures.front().image.cols;
  const int height_px = pictures.front().image.rows;
  const tracker::Mosaic kind = mosaic ? tracker::Mosaic::kRggb : tracker::Mosaic::kNone;
  const tracker::PlaneGrid grid(map, width_px, height_px);
  tracker::SensorModel sensor(width_px, height_px);
  Poses poses;
  if (layout.tags) {
    tracker::TagAligner aligner(*layout.tags, grid);
    tracker::AlignedTag aligned;
    for (const Picture& picture : pictures) {
      for (const Guess& guess : picture.guesses) {
        const bool found = aligner.align(picture.image, kind, sensor, guess.id, start(guess),
                                         guess.centre_px, aligned);
        if (found) aligner.teach(sensor);
        poses.push_back(numbers(found, aligned.pose_world_tag));
      }
    }
    return poses;
  }
  tracker::PoseAligner aligner(layout, grid);
  tracker::AlignedPose aligned;
  unsigned lesson = 0;
  for (const Picture& picture : pictures) {
    for (const Guess& guess : picture.guesses) {
      const bool found = aligner.align(picture.image, kind, sensor, {start(guess), guess.centre_px},
                                       nullptr, {}, aligned);
      if (found) aligner.teach(picture.image, kind, lesson++, sensor);
      poses.push_back(numbers(found, aligned.pose_world_robot));
    }
  }
  return poses;
}

}  // namespace nadir::kernels
