#include "vision/disc_pattern_detector.h"

namespace nadir::vision {
struct DiscPatternDetector::State {};
DiscPatternDetector::DiscPatternDetector(const MarkerLayout&, const PixelScaleGrid&, const ColourClasses&) {}
DiscPatternDetector::~DiscPatternDetector() = default;
DiscPatternDetector::DiscPatternDetector(DiscPatternDetector&&) noexcept = default;
DiscPatternDetector& DiscPatternDetector::operator=(DiscPatternDetector&&) noexcept = default;
void DiscPatternDetector::detect(const cv::Mat&, DetectionResult& result) { result.clear(); }
}  // namespace nadir::vision
