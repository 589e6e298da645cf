#include "tracker/wire/participant.h"

#include "tracker/wire/participant_state.h"

namespace nadir::tracker {

Participant::Participant(const WireOptions& options)
    : state_(std::make_shared<const State>(State{options, make_participant(options)})) {}

const WireOptions& Participant::options() const { return state_->options; }

int Participant::peers() const { return count_peers(state_->entity); }

}  // namespace nadir::tracker
