// replay_log: what a DelayedFusion decides on recorded inputs, with every bit of its estimates, to
// compare processors.
//
//     replay_log record SEED    prints the inputs of a random run (its libm may differ elsewhere)
//     replay_log replay         reads inputs and prints verdicts and estimates

#include <cstdio>
#include <cstdlib>
#include <cstring>

#include "fusion/delayed_fusion.h"
#include "tests/fusion/fusion_feed.h"

namespace {

using namespace nadir::fusion;

test::FeedOptions options_of(std::uint64_t seed) {
  test::FeedOptions options;
  options.seed = seed;
  options.duration_s = 20.0;
  options.odometry_period_s = seed % 2 == 0 ? 0.02 : 0.005;
  options.cameras = 2;
  options.lost = 0.1;
  options.outliers = 0.1;
  options.most_delay_s = 0.2;
  options.is_slipping = true;
  return options;
}

void record(std::uint64_t seed) {
  const test::Feed feed = test::make_feed(options_of(seed));
  const std::vector<test::Frame> frames = test::by_arrival(feed);
  std::size_t next = 0;
  for (const test::OdometrySample& sample : feed.odometry) {
    std::printf("o %lld %lld %a %a %a %a\n", static_cast<long long>(sample.from.count()),
                static_cast<long long>(sample.to.count()), sample.rates.u_mps, sample.rates.v_mps,
                sample.rates.r_radps, sample.nominal.heading_rad);
    for (; next < frames.size() && frames[next].arrival <= sample.to; ++next) {
      const VisionPose& v = frames[next].vision;
      std::printf("v %u %llu %lld %a %a %a", v.camera, static_cast<unsigned long long>(v.frame),
                  static_cast<long long>(v.capture.count()), v.pose.x_m, v.pose.y_m,
                  v.pose.heading_rad);
      for (int i = 0; i < 9; ++i) std::printf(" %a", v.covariance(i));
      std::printf("\n");
    }
  }
}

template <class Fusion>
void print(const Fusion& fusion) {
  const auto estimate = fusion.estimate();
  if (!estimate) return;
  std::printf("%a %a %a", estimate->pose.x_m, estimate->pose.y_m, estimate->pose.heading_rad);
  for (int i = 0; i < 9; ++i) std::printf(" %a", estimate->covariance(i));
  std::printf("\n");
}

template <class Fusion>
void print_all_verdicts(const Fusion& fusion) {
  for (const FrameRecord& frame : fusion.frames()) {
    std::printf("%s ", description(frame.verdict));
  }
  std::printf("\nrevised %llu\n", static_cast<unsigned long long>(fusion.health().revised));
}

int replay() {
  DelayedFusion<AboutEstimate> about_estimate;
  DelayedFusion<AlongNominal> along_nominal;
  char line[1024];
  while (std::fgets(line, sizeof line, stdin) != nullptr) {
    long long a = 0;
    long long b = 0;
    long long c = 0;
    test::OdometrySample sample;
    VisionPose v;
    if (std::sscanf(line, "o %lld %lld %la %la %la %la", &a, &b, &sample.rates.u_mps,
                    &sample.rates.v_mps, &sample.rates.r_radps, &sample.nominal.heading_rad) == 6) {
      sample.from = Timestamp(a);
      sample.to = Timestamp(b);
      sample.nominal.rates = sample.rates;
      about_estimate.add_odometry(test::odometry_for<DelayedFusion<AboutEstimate>>(sample));
      along_nominal.add_odometry(test::odometry_for<DelayedFusion<AlongNominal>>(sample));
    } else if (double p[12]; std::sscanf(line,
                                         "v %lld %lld %lld %la %la %la %la %la %la %la %la %la "
                                         "%la %la %la",
                                         &a, &b, &c, p, p + 1, p + 2, p + 3, p + 4, p + 5, p + 6,
                                         p + 7, p + 8, p + 9, p + 10, p + 11) == 15) {
      v.camera = static_cast<std::uint32_t>(a);
      v.frame = static_cast<std::uint64_t>(b);
      v.capture = Timestamp(c);
      v.pose = {p[0], p[1], p[2]};
      for (int i = 0; i < 9; ++i) v.covariance(i) = p[3 + i];
      std::printf("%s, %s\n", description(about_estimate.add_pose(v).verdict),
                  description(along_nominal.add_pose(v).verdict));
    } else {
      std::fprintf(stderr, "replay_log: cannot read: %s", line);
      return 1;
    }
    print(about_estimate);
    print(along_nominal);
  }
  print_all_verdicts(about_estimate);
  print_all_verdicts(along_nominal);
  return 0;
}

}  // namespace

int main(int argc, char** argv) {
  if (argc == 3 && std::strcmp(argv[1], "record") == 0) {
    record(std::strtoull(argv[2], nullptr, 10));
    return 0;
  }
  if (argc == 2 && std::strcmp(argv[1], "replay") == 0) return replay();
  std::fprintf(stderr, "usage: replay_log record SEED | replay_log replay\n");
  return 2;
}
