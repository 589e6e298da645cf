#pragma once

#include "vision/input/strict_yaml.h"
#include "vision/synthetic/scene.h"

namespace nadir::vision {

/// Reads a scene's `delivery` mapping: how frames of a real-time scene reach their reader.
///
///     delivery:
///       delay_ms: [60, 100]      # from mid-exposure to delivery: one number, or lowest and
///       highest loss: 0.1                # share of frames that never arrive blackouts: # when
///       none arrives, seconds after the scene's start
///         - {start_s: 20, length_s: 1}
SceneDelivery read_delivery(const YamlMap& map);

}  // namespace nadir::vision
