#pragma once

#include <opencv2/core.hpp>
#include <vector>

#include "vision/marker_layout.h"

namespace nadir::bench {

/// Colour blob detection of the usual kind, built from OpenCV's own functions: the whole frame to
/// HSV, a threshold for each colour, connected components, blobs of about the right area, and
/// robots as a centre blob with enough outer blobs near it. Poses and identities are left out: it
/// is a lower bound of what such a pipeline costs. It runs in one thread if OpenCV is told so.
class BlobPipeline {
 public:
  /// `pixels_per_metre` at the markers' height; it is taken to be the same everywhere.
  BlobPipeline(const vision::MarkerLayout& layout, double pixels_per_metre);

  /// Number of robots in a CV_8UC3 frame.
  int count_robots(const cv::Mat& bgr);

 private:
  struct ColourClass {
    vision::Colour colour;
    cv::Scalar lowest_hsv;
    cv::Scalar highest_hsv;
    double least_area_px;
    double most_area_px;
    bool is_centre;
  };
  struct Blob {
    cv::Point2d centre_px;
    bool is_centre;
  };

  void add_class(vision::Colour colour, double radius_px, bool is_centre);
  void find_blobs(const ColourClass& colour_class);
  int group() const;

  std::vector<ColourClass> classes_;
  std::size_t outer_count_;
  double reach_px_;
  cv::Mat hsv_, mask_, labels_, statistics_, centroids_;
  std::vector<Blob> blobs_;
};

}  // namespace nadir::bench
