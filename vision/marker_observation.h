#pragma once

#include <Eigen/Core>
#include <array>
#include <cstdint>
#include <vector>

#include "vision/marker_layout.h"
#include "vision/pixel.h"

namespace nadir::vision {

/// One disc as the image shows it.
struct DiscObservation {
  PixelPoint centre_px = PixelPoint::Zero();
  double pixels = 0.0;           ///< soft pixel count: sum of the pixels' shares in the disc
  double expected_pixels = 0.0;  ///< area of the disc by the calibration
  double variance_px2 = 0.0;     ///< of the centre, per axis, from the scatter of the pixels seen
  double contrast = 0.0;         ///< disc against its surroundings, grey levels
  Colour colour = Colour::kBlack;
};

/// Discs in the image that together look like one robot of a layout.
struct RobotObservation {
  int team = 0;       ///< index into MarkerLayout::teams
  int identity = -1;  ///< index into MarkerLayout::identities, -1 for an anonymous robot
  int disc_count = 0;
  std::array<DiscObservation, kMaxDiscs>
      discs;                  ///< disc 0 is the centre disc, as in MarkerLayout::disc
  double fit_error_px = 0.0;  ///< RMS distance of the discs from the layout's best fit
  double confidence = 0.0;    ///< 0 to 1: agreement in colour, size and place
};

/// Why a candidate is not a robot.
enum class RejectReason {
  kWrongSize,
  kNotRound,
  kWeakContrast,
  kNoHeadingMarker,
  kUnknownIdentity,
  kPatternDoesNotFit,
  kSharedDisc,
  kOutsideImage,
  kDuplicateIdentity,
  kTooManyCandidates,
  kUnknownTag,
  kWrongTagSize,
};
const char* reject_reason_text(RejectReason reason);

struct RejectedCandidate {
  PixelPoint centre_px = PixelPoint::Zero();
  RejectReason reason = RejectReason::kWrongSize;
};

/// What a detector saw in one frame. Its vectors keep their memory from frame to frame.
struct DetectionResult {
  std::vector<RobotObservation> robots;
  std::vector<RejectedCandidate> rejected;
  std::int64_t rejected_not_listed = 0;  ///< candidates beyond the list's capacity

  void clear() {
    robots.clear();
    rejected.clear();
    rejected_not_listed = 0;
  }
};

}  // namespace nadir::vision
