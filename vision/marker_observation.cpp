#include "vision/marker_observation.h"

namespace nadir::vision {

const char* reject_reason_text(RejectReason reason) {
  switch (reason) {
    case RejectReason::kWrongSize:
      return "disc has the wrong size";
    case RejectReason::kNotRound:
      return "not round";
    case RejectReason::kWeakContrast:
      return "too little contrast";
    case RejectReason::kNoHeadingMarker:
      return "no heading marker";
    case RejectReason::kUnknownIdentity:
      return "colours of no known robot";
    case RejectReason::kPatternDoesNotFit:
      return "discs do not fit the layout";
    case RejectReason::kSharedDisc:
      return "disc belongs to another robot";
    case RejectReason::kOutsideImage:
      return "reaches over the image border";
    case RejectReason::kDuplicateIdentity:
      return "same robot seen better elsewhere";
    case RejectReason::kTooManyCandidates:
      return "too many candidates";
    case RejectReason::kUnknownTag:
      return "tag of no known robot";
    case RejectReason::kWrongTagSize:
      return "tag has the wrong size";
  }
  return "";
}

}  // namespace nadir::vision
