#pragma once

#include <array>
#include <opencv2/core.hpp>
#include <vector>

#include "vision/colour_classes.h"
#include "vision/disc_measurement.h"
#include "vision/hue_probe.h"
#include "vision/marker_layout.h"
#include "vision/marker_observation.h"

namespace nadir::vision {

/// Finds the outer discs that belong to a measured centre disc: tries every heading, measures the
/// discs of the best one, fits the layout to them and reads the identity from their colours.
class PatternMatch {
 public:
  PatternMatch(const MarkerLayout& layout, const ColourClasses& colours);

  /// `centre` is a measured disc in the colour of team `team`; `sampling_variance_px2` as in
  /// measure_disc. Fills `robot` and returns true, or says why not.
  bool match(const cv::Mat& bgr, const LocalScale& scale, const DiscMeasurement& centre, int team,
             double sampling_variance_px2, RobotObservation& robot, RejectReason& reason);

 private:
  struct OuterDisc {
    Eigen::Vector2f position_m;
    float radius_m;
    std::vector<Colour> colours;  ///< that this disc may have
    std::vector<ColourScore> scores;
  };
  /// What single pixels say of one heading.
  struct Evidence {
    float worst = 0.0F;  ///< score of its worst disc
    float sum = 0.0F;
  };
  struct Heading {
    Eigen::Vector2f direction = Eigen::Vector2f::Zero();  ///< (cos, sin)
    float score = 0.0F;        ///< of its worst disc; 0: no heading has all its discs
    bool any_outside = false;  ///< some heading has a disc out of the image
  };
  struct Reading {
    Colour colour = Colour::kBlack;
    float score = 0.0F;   ///< of the best colour
    float margin = 1.0F;  ///< 0 to 1: how far the second best is behind
  };

  Heading best_heading(const cv::Mat& bgr, const LocalScale& scale, const DiscMeasurement& centre);
  /// Those of disc 1 and up, around disc 0, from about this direction of the robot's front on.
  bool measure_outer_discs(const cv::Mat& bgr, const LocalScale& scale, Eigen::Vector2f direction,
                           double sampling_variance_px2,
                           std::array<DiscMeasurement, kMaxDiscs>& discs,
                           RejectReason& reason) const;
  Reading read_colour(const OuterDisc& outer, const Bgr& difference) const;
  int find_identity(const RobotObservation& robot) const;
  double fit_error_px(const LocalScale& scale, const RobotObservation& robot) const;

  MarkerLayout layout_;
  std::vector<OuterDisc> outer_;
  std::vector<Eigen::Vector2f> headings_;  ///< (cos, sin) of the headings that are tried
  std::vector<HueProbe> probes_;           ///< one for each outer disc, an offset for each heading
  std::vector<Evidence> evidence_;         ///< for each heading, about the present centre
  double tolerance_m_;                     ///< of the fit of the discs to the layout
};

}  // namespace nadir::vision
