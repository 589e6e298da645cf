#pragma once

#include <opencv2/core.hpp>

namespace nadir::vision {

/// True if the green channel of a CV_8UC3 frame was interpolated from a Bayer mosaic: then half of
/// its pixels, those of one colour of the chess board, are means of their neighbours and carry less
/// noise of their own than the others. Looks at some hundred pixels spread over the frame.
/// Recompression as JPEG wipes the trace out.
bool looks_demosaiced(const cv::Mat& bgr);

}  // namespace nadir::vision
