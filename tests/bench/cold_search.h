#pragma once

#include <string>
#include <vector>

#include "tracker/camera_pipeline.h"
#include "vision/synthetic/scene.h"

namespace nadir::bench {

// What a full-frame search costs that knows nothing of earlier frames, poses included, beside
// merely reading every byte of the frame and beside a pipeline of OpenCV functions. One thread. All
// variants work on frames that none of them has touched for longer than the last-level cache
// remembers: a camera's next frame is in memory, never in the cache. nadir and reading take turns;
// OpenCV comes after them, since its pictures come and go, and with them the page tables of all.

struct SearchCase {
  std::string name;
  vision::Scene scene;  ///< robots at new places in every frame; or standing, to be followed
  tracker::PoseSource source = tracker::PoseSource::kDetector;
  bool beside_opencv = true;  ///< or `opencv` stays empty
};

/// CPU time of one variant, microseconds.
struct Cost {
  double median_us = 0.0;
  double quarter_us = 0.0;         ///< a quarter of the frames took less
  double three_quarters_us = 0.0;  ///< and a quarter more
};

struct SearchCosts {
  std::string name;
  int width_px = 0;
  int height_px = 0;
  int robots = 0;               ///< in each frame
  int buffers = 0;              ///< distinct frames in turn
  int measurements = 0;         ///< of each variant
  Cost read_in_order;           ///< sum of all bytes, first to last
  Cost read_two_streams;        ///< the same in two halves side by side
  Cost nadir;                   ///< tracker::CameraPipeline, frame to poses
  Cost opencv;                  ///< BlobPipeline
  double nadir_robots = 0.0;    ///< reported in a frame, mean
  double nadir_rejected = 0.0;  ///< candidates looked at and turned down in a frame, mean
  double opencv_robots = 0.0;   ///< grouped in a frame, mean

  /// The faster of the two ways to read.
  double reading_us() const;
  double nadir_per_reading() const { return nadir.median_us / reading_us(); }
  double opencv_per_reading() const { return opencv.median_us / reading_us(); }
};

/// Renders the frames, then measures. `measurements`: of each variant. Throws std::runtime_error if
/// a sum of bytes is wrong.
SearchCosts measure_cold_search(const SearchCase& search_case, int measurements);

/// The same picture with `factor` times as many pixels in each direction.
vision::Scene enlarged(vision::Scene scene, int factor);

}  // namespace nadir::bench
