#include "tracker/wire/clock_exchange.h"

#include <atomic>
#include <stop_token>
#include <thread>
#include <utility>

#include "tracker/wire/bounded_queue.h"
#include "tracker/wire/clock_codec.h"
#include "tracker/wire/dds_entities.h"
#include "tracker/wire/participant_state.h"
#include "tracker/wire/stream_reader.h"
#include "tracker/wire/topics.h"
#include "tracker/wire/wire_qos.h"

namespace nadir::tracker {
namespace {

constexpr std::size_t kAnswersKept = 16;
constexpr std::size_t kQuestionsKept = 64;
constexpr std::chrono::milliseconds kLookForStop{100};

StreamPlace request_place(const Participant& participant) {
  return {nadir_wire_ClockRequest_desc, kClockRequestTopic, clock_qos(participant.options())};
}
StreamPlace reply_place(const Participant& participant) {
  return {nadir_wire_ClockReply_desc, kClockReplyTopic, clock_qos(participant.options())};
}

/// A topic and its writer.
struct TopicWriter {
  TopicWriter(const Participant& participant, const StreamPlace& place)
      : topic(make_topic(participant.state().entity, place.type, place.topic)),
        writer(make_writer(participant.state().entity, topic, place.qos, place.topic)) {}

  DdsEntity topic;
  DdsEntity writer;
};

}  // namespace

std::int64_t system_clock_ns() {
  return std::chrono::duration_cast<std::chrono::nanoseconds>(
             std::chrono::system_clock::now().time_since_epoch())
      .count();
}

struct ClockAsker::State {
  State(const Participant& place, std::uint64_t client_run, WallClock wall_clock)
      : participant(place),
        client(client_run),
        clock(std::move(wall_clock)),
        answers(kAnswersKept),
        questions(place, request_place(place)),
        replies(
            place, 1, reply_place(place),
            [client_run](const nadir_wire_ClockReply& sample) {
              return sample.client == client_run;
            },
            [this](const ClockExchange& reply) { take(reply); }) {}

  void take(ClockExchange exchange) {
    exchange.t4_ns = clock();
    answers.push(&exchange);
  }

  Participant participant;
  std::uint64_t client;
  WallClock clock;
  std::uint64_t asked = 0;
  BoundedQueue<ClockExchange> answers;
  TopicWriter questions;
  StreamReader<nadir_wire_ClockReply, ClockExchange> replies;  // last: it uses the others
};

ClockAsker::ClockAsker(const Participant& participant, std::uint64_t client, WallClock clock)
    : state_(std::make_unique<State>(participant, client, std::move(clock))) {}
ClockAsker::ClockAsker(ClockAsker&&) noexcept = default;
ClockAsker& ClockAsker::operator=(ClockAsker&&) noexcept = default;
ClockAsker::~ClockAsker() = default;

void ClockAsker::ask() {
  nadir_wire_ClockRequest sample{};
  sample.client = state_->client;
  sample.number = ++state_->asked;
  sample.t1_ns = state_->clock();
  // What is lost is asked again.
  dds_write(state_->questions.writer.handle(), &sample);
}

bool ClockAsker::poll(ClockExchange* exchange, std::chrono::nanoseconds timeout) {
  return state_->answers.pop(exchange, timeout);
}

ReaderStatus ClockAsker::status() const { return state_->replies.status(); }

struct ClockAnswerer::State {
  State(const Participant& place, std::uint64_t tracker_epoch, WallClock wall_clock)
      : participant(place),
        epoch(tracker_epoch),
        clock(std::move(wall_clock)),
        waiting(kQuestionsKept),
        answers(place, reply_place(place)),
        questions(
            place, 1, request_place(place), [](const nadir_wire_ClockRequest&) { return true; },
            [this](const ClockQuestion& question) { take(question); }),
        thread([this](const std::stop_token& stop) { answer_all(stop); }) {}

  void take(ClockQuestion question) {
    question.t2_ns = clock();
    waiting.push(&question);
  }

  void answer_all(const std::stop_token& stop) {
    ClockQuestion question;
    while (!stop.stop_requested()) {
      if (waiting.pop(&question, kLookForStop)) answer(question);
    }
  }

  void answer(const ClockQuestion& question) {
    nadir_wire_ClockReply sample{};
    sample.client = question.client;
    sample.number = question.sequence;
    sample.epoch = epoch;
    sample.t1_ns = question.t1_ns;
    sample.t2_ns = question.t2_ns;
    sample.t3_ns = clock();
    ++(dds_write(answers.writer.handle(), &sample) == DDS_RETCODE_OK ? answered : failed);
  }

  Participant participant;
  std::uint64_t epoch;
  WallClock clock;
  std::atomic<std::uint64_t> answered{0};
  std::atomic<std::uint64_t> failed{0};
  BoundedQueue<ClockQuestion> waiting;
  TopicWriter answers;
  StreamReader<nadir_wire_ClockRequest, ClockQuestion> questions;
  std::jthread thread;  // last: it uses the others
};

ClockAnswerer::ClockAnswerer(const Participant& participant, std::uint64_t epoch, WallClock clock)
    : state_(std::make_unique<State>(participant, epoch, std::move(clock))) {}
ClockAnswerer::ClockAnswerer(ClockAnswerer&&) noexcept = default;
ClockAnswerer& ClockAnswerer::operator=(ClockAnswerer&&) noexcept = default;
ClockAnswerer::~ClockAnswerer() = default;

ClockAnswerer::Status ClockAnswerer::status() const {
  return {.answered = state_->answered,
          .dropped = state_->waiting.dropped(),
          .malformed = state_->questions.status().malformed,
          .failed = state_->failed};
}

}  // namespace nadir::tracker
