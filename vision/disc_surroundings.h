#pragma once

#include "vision/colour_classes.h"
#include "vision/disc_ring.h"

namespace nadir::vision {

/// The colour of what is around a disc: the median of each channel of the ring. Where several
/// things share the ring (floor, plate, another disc) that is a mixture, and `plate` is taken
/// instead, as it is seen in the ring: the colour under the robot's other discs (null if it is not
/// known).
Bgr surroundings_of(const Ring& ring, const Bgr& disc_colour, const Bgr* plate);

/// The linear function that tells a pixel's share in a disc from its difference from the
/// surroundings: 1 for `difference`, the disc's own. It follows `difference`, unless the ring shows
/// a second colour that would pass for a share in the disc (the floor beyond the rim of a robot's
/// plate): then it is turned until that colour counts nothing, as far as enough contrast is left.
Bgr share_function(const Ring& ring, const Bgr& surroundings, const Bgr& difference);

}  // namespace nadir::vision
