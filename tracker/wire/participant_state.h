#pragma once

#include "tracker/wire/dds_entities.h"
#include "tracker/wire/participant.h"

namespace nadir::tracker {

/// What is behind a Participant: for the writers and readers of this room.
struct Participant::State {
  WireOptions options;
  DdsEntity entity;
};

}  // namespace nadir::tracker
