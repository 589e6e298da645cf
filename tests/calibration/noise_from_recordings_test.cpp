// Noise files from pose logs whose noise is known.

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <fstream>
#include <random>

#include "calibration/noise/noise_from_law.h"
#include "calibration/noise/noise_from_log.h"
#include "calibration/noise/noise_from_standing.h"
#include "calibration/noise/noise_from_text.h"
#include "calibration/noise_file.h"
#include "tests/vision/input_error_line.h"
#include "tests/vision/scratch_folder.h"
#include "vision/disc_measurement.h"

namespace nadir::calibration {
namespace {

using testing::HasSubstr;
using vision::input_error_line;

constexpr double kDistance_m = 0.06;  // between the two marks of the robot
constexpr double kScale_m = 0.004;    // per pixel

/// Variance of one mark per axis, m^2, by its pixel count.
using Law = std::function<double(double)>;

/// A robot with two marks, seen with independent errors of both; theory 4.5 for equal marks.
class StandingRobot {
 public:
  StandingRobot(double heading_rad, double pixels, const Law& law, std::uint64_t seed)
      : heading_rad_(heading_rad), pixels_(pixels), variance_m2_(law(pixels)), random_(seed) {}

  LoggedPose pose(double time_s, const Eigen::Vector3d& moved = Eigen::Vector3d::Zero()) {
    const double sigma = std::sqrt(variance_m2_);
    const double along = 0.5 * sigma * (normal_(random_) + normal_(random_));
    const double first_across = sigma * normal_(random_);
    const double second_across = sigma * normal_(random_);
    const Eigen::Vector2d ahead(std::cos(heading_rad_), std::sin(heading_rad_));
    const Eigen::Vector2d left(-ahead.y(), ahead.x());
    LoggedPose pose;
    pose.time_s = time_s;
    pose.pose << along * ahead + first_across * left, (second_across - first_across) / kDistance_m;
    pose.pose += moved + Eigen::Vector3d(0.5, -0.3, heading_rad_);
    pose.centre_px = {pose.pose.x() / kScale_m, -pose.pose.y() / kScale_m};
    pose.pixels = {pixels_, pixels_};
    const double heading_variance = 2.0 * variance_m2_ / (kDistance_m * kDistance_m);
    pose.covariance.block<2, 1>(0, 2) = -variance_m2_ / kDistance_m * left;
    pose.covariance.block<1, 2>(2, 0) = pose.covariance.block<2, 1>(0, 2).transpose();
    pose.covariance(2, 2) = heading_variance;
    pose.covariance.topLeftCorner<2, 2>() =
        variance_m2_ * (0.5 * ahead * ahead.transpose() + left * left.transpose());
    return pose;
  }

 private:
  double heading_rad_;
  double pixels_;
  double variance_m2_;
  std::mt19937_64 random_;
  std::normal_distribution<double> normal_;
};

LoggedTrack standing_track(double pixels, const Law& law, std::uint64_t seed, int samples) {
  StandingRobot robot(0.1 * static_cast<double>(seed), pixels, law, seed);
  LoggedTrack track{"log", "blue " + std::to_string(seed), {}};
  for (int i = 0; i < samples; ++i) track.poses.push_back(robot.pose(i / 30.0));
  return track;
}

std::vector<LoggedTrack> tracks_at(const std::vector<double>& counts, const Law& law, int samples) {
  std::vector<LoggedTrack> tracks;
  for (std::size_t i = 0; i < counts.size(); ++i) {
    tracks.push_back(standing_track(counts[i], law, i + 1, samples));
  }
  return tracks;
}

TEST(NoiseFromRecordings, RecoversOneOverNWithItsFloor) {
  const Law law = [](double pixels) { return 1.23e-4 / pixels + 4e-7; };
  const auto data = find_standing(tracks_at({12, 25, 50, 100, 200, 400, 800}, law, 1000));
  const NoiseFit fit = fit_noise(data, {}, "log");
  ASSERT_TRUE(fit.has_floor);
  // 7000 poses with two axes know a variance to 1.2 %; here two constants share them.
  EXPECT_NEAR(fit.one_over_n.pixel_variance_m2 / 1.23e-4, 1.0, 0.07);
  EXPECT_NEAR(fit.one_over_n.floor_m2 / 4e-7, 1.0, 0.12);
  for (const PixelClass& each : fit.classes) EXPECT_NEAR(each.law_ratio, 1.0, 0.12) << each.pixels;
  EXPECT_TRUE(fit.remarks.empty()) << fit.remarks.front();
}

TEST(NoiseFromRecordings, VarianceErrsAsItSays) {
  // The fitted constant over the true one, in sigmas, over many recordings.
  const Law law = [](double pixels) { return 1e-4 / pixels; };
  double squares = 0.0;
  constexpr int kRuns = 120;
  for (int run = 0; run < kRuns; ++run) {
    const auto track = standing_track(60.0, law, static_cast<std::uint64_t>(1000 + run), 200);
    const NoiseFit fit = fit_noise(find_standing({track}), {}, "log");
    const double error = fit.one_over_n.pixel_variance_m2 / 1e-4 - 1.0;
    squares += error * error / (fit.relative_error * fit.relative_error) / kRuns;
  }
  EXPECT_NEAR(squares, 1.0, 0.45);  // chi-square of 120 runs: 0.77 to 1.28 in 95 %
}

TEST(NoiseFromRecordings, OneCountIsAGuessElsewhere) {
  const Law law = [](double) { return 1e-6; };
  const NoiseFit fit = fit_noise(find_standing(tracks_at({60, 62}, law, 400)), {}, "log");
  EXPECT_FALSE(fit.has_floor);
  EXPECT_EQ(fit.one_over_n.floor_m2, 0.0);
  EXPECT_NEAR(fit.one_over_n.pixel_variance_m2 / 61.0, 1e-6, 1e-7);
  ASSERT_EQ(fit.remarks.size(), 1U);
  EXPECT_THAT(fit.remarks.front(), HasSubstr("all marks have about 61 pixels"));
}

/// Aligned poses whose published covariance knows of `published` only.
std::vector<LoggedTrack> aligned_tracks(const Law& scatter, const Law& published) {
  std::vector<LoggedTrack> tracks = tracks_at({30, 60, 120, 240}, scatter, 1000);
  for (LoggedTrack& track : tracks) {
    const double pixels = track.poses.front().pixels.front();
    for (LoggedPose& pose : track.poses) {
      pose.aligned = true;
      pose.covariance *= published(pixels) / scatter(pixels);
    }
  }
  return tracks;
}

TEST(NoiseFromRecordings, AlignmentsFloorIsWhatItsCovarianceDoesNotExplain) {
  const Law published = [](double pixels) { return 4e-8 / pixels; };
  const double floor_m2 = std::pow(0.012 * kScale_m, 2);
  const Law shaken = [&](double pixels) { return published(pixels) + floor_m2; };
  const NoiseFit fit = fit_noise(find_standing(aligned_tracks(shaken, published)), {}, "log");
  ASSERT_TRUE(fit.alignment_floor_px);
  EXPECT_NEAR(*fit.alignment_floor_px, std::hypot(0.012, kAlignmentFloor_px), 0.0005);
  vision::ScratchFolder folder;
  const NoiseFile file = load_noise_file(folder.write("noise.yaml", noise_yaml(fit, "log")));
  ASSERT_TRUE(file.alignment_floor_px);
  EXPECT_NEAR(*file.alignment_floor_px, *fit.alignment_floor_px, 1e-5);

  const NoiseFit calm = fit_noise(find_standing(aligned_tracks(published, published)), {}, "log");
  EXPECT_NEAR(calm.alignment_floor_px.value(), kAlignmentFloor_px, 1e-3);
  const NoiseFit detected =
      fit_noise(find_standing(tracks_at({30, 60, 120, 240}, published, 100)), {}, "log");
  EXPECT_FALSE(detected.alignment_floor_px);
}

TEST(NoiseFromRecordings, AlignedMarksFeelLessOfThePixelGrid) {
  const Law law = [](double pixels) { return 4e-8 / pixels; };
  NoiseLawSettings settings;
  settings.grid_variance_px2 = vision::kSamplingVariance_px2;
  const NoiseFit detected =
      fit_noise(find_standing(tracks_at({30, 60, 120, 240}, law, 200)), settings, "log");
  const NoiseFit aligned = fit_noise(find_standing(aligned_tracks(law, law)), settings, "log");
  const double square_m2 = kScale_m * kScale_m;
  for (const PixelClass& each : detected.classes) {
    EXPECT_NEAR(each.grid_variance_m2 * std::sqrt(each.pixels) / square_m2,
                vision::kSamplingVariance_px2, 1e-4);
  }
  for (const PixelClass& each : aligned.classes) {
    EXPECT_NEAR(each.grid_variance_m2 / square_m2, std::pow(kAlignmentFloor_px, 2), 1e-7);
  }
}

TEST(NoiseFromRecordings, TableFollowsWhatNoOneOverNDoes) {
  const Law law = [](double pixels) { return 4e-2 * std::pow(pixels, -2.5); };
  NoiseLawSettings settings;
  const auto data = find_standing(tracks_at({20, 60, 200}, law, 600));
  const NoiseFit by_law = fit_noise(data, settings, "log");
  ASSERT_EQ(by_law.remarks.size(), 1U);
  EXPECT_THAT(by_law.remarks.front(), HasSubstr("--kind table follows it better"));
  EXPECT_NEAR(by_law.exponent, -2.5, 0.15);

  settings.table = true;
  const NoiseFit fit = fit_noise(data, settings, "log");
  vision::ScratchFolder folder;
  const auto variance =
      load_pixel_count_variance(folder.write("noise.yaml", noise_yaml(fit, "log")));
  for (const double pixels : {20.0, 60.0, 200.0}) {
    vision::DiscObservation disc;
    disc.pixels = pixels;
    const auto covariance = variance.covariance_m2(disc, Eigen::Matrix2d::Identity());
    ASSERT_TRUE(covariance);
    EXPECT_NEAR((*covariance)(0, 0) / law(pixels), 1.0, 0.25) << pixels;
    EXPECT_NEAR(*variance.heading_variance_rad2(pixels, pixels) /
                    (2.0 * law(pixels) / (kDistance_m * kDistance_m)),
                1.0, 0.25);
  }
}

TEST(NoiseFromRecordings, GridIsAddedThatStandingRobotsDoNotShow) {
  const Law law = [](double) { return 1e-6; };
  NoiseLawSettings settings;
  settings.grid_variance_px2 = 0.8;
  const auto data = find_standing(tracks_at({64.0}, law, 2000));
  const NoiseFit fit = fit_noise(data, settings, "log");
  // 0.8 / 8 px^2 of 4 mm pixels.
  const double expected_m2 = 1e-6 + 0.1 * kScale_m * kScale_m;
  EXPECT_NEAR(fit.one_over_n.pixel_variance_m2 / 64.0 / expected_m2, 1.0, 0.08);
  EXPECT_NEAR(fit.classes.front().grid_variance_m2, 0.1 * kScale_m * kScale_m, 1e-8);
}

TEST(StandingRobots, MovingOnesAreLeftOut) {
  const Law law = [](double) { return 1e-6; };
  StandingRobot drives(0.3, 60, law, 5);
  StandingRobot turns(0.3, 60, law, 6);
  StandingRobot creeps(0.3, 60, law, 7);
  std::vector<LoggedTrack> tracks(3);
  for (int i = 0; i < 400; ++i) {
    tracks[0].poses.push_back(drives.pose(i / 30.0, {0.002 * i, 0.0, 0.0}));
    tracks[1].poses.push_back(turns.pose(i / 30.0, {0.0, 0.0, 0.05 * i}));
    tracks[2].poses.push_back(creeps.pose(i / 30.0, {0.0, 0.0003 * i, 0.0}));
  }
  const StandingData data = find_standing(tracks);
  EXPECT_EQ(data.spans.size(), 0U);
  EXPECT_EQ(data.moving_samples, 1200);
  EXPECT_THAT(
      input_error_line([&] { fit_noise(data, {}, "drive.jsonl"); }),
      HasSubstr("drive.jsonl: 0 of 1200 poses are of robots that stand, 100 are needed: 100 "
                "are missing (3.3 s of one robot); record robots that nobody drives"));
}

TEST(StandingRobots, AreSeenBetweenDrives) {
  const Law law = [](double) { return 1e-6; };
  StandingRobot robot(0.3, 60, law, 8);
  LoggedTrack track;
  double x_m = 0.0;
  for (int i = 0; i < 600; ++i) {
    if (i >= 200 && i < 400) x_m += 0.003;
    track.poses.push_back(robot.pose(i / 30.0, {x_m, 0.0, 0.0}));
  }
  const StandingData data = find_standing({track});
  ASSERT_EQ(data.spans.size(), 2U);
  EXPECT_EQ(data.spans[0].samples, 200);
  EXPECT_EQ(data.spans[1].samples, 200);
  EXPECT_NEAR(data.spans[0].middle_variance_m2, 0.5e-6, 0.1e-6);
  EXPECT_NEAR(data.spans[0].jacobian_m_per_px(0, 0), kScale_m, 1e-9);
  EXPECT_NEAR(data.spans[0].jacobian_m_per_px(1, 1), -kScale_m, 1e-9);
  EXPECT_NEAR(data.rate_hz, 30.0, 1e-9);
}

TEST(StandingRobots, OfPureNoiseNearlyAllCount) {
  const Law law = [](double) { return 1e-6; };
  const StandingData data = find_standing(tracks_at({60, 60, 60, 60, 60}, law, 2000));
  EXPECT_LT(data.moving_samples, 200);  // 2 %
}

TEST(StandingRobots, AKnockIsNoNoise) {
  const Law law = [](double) { return 1e-6; };
  StandingRobot robot(0.3, 60, law, 9);
  LoggedTrack track;
  for (int i = 0; i < 200; ++i) {
    const bool knocked = i == 50 || i == 130;
    track.poses.push_back(robot.pose(i / 30.0, {knocked ? 0.05 : 0.0, 0.0, 0.0}));
  }
  for (const StandingSpan& span : find_standing({track}).spans) {
    EXPECT_LT(span.middle_variance_m2, 1e-6);
  }
}

TEST(PoseLog, IsReadStrictly) {
  vision::ScratchFolder folder;
  const auto line_of = [&](const std::string& text) {
    const std::string file = folder.write("poses.jsonl", text);
    return input_error_line([&] { load_pose_tracks(file); });
  };
  const std::string robot =
      R"({"id": 1, "team": "blue", "x_m": 0.1, "y_m": 0.2, "heading_rad": 3.1, )"
      R"("covariance": [1e-6,0,0,0,1e-6,0,0,0,1e-4], "u_px": 1.0, "v_px": 2.0, )"
      R"("pixels": [55, 48], "confidence": 0.98})";
  const std::string frame = R"({"frame": 0, "camera": "cam0", "capture_ns": 5, "robots": [)";
  EXPECT_THAT(line_of(frame + robot + "]}\n{"), HasSubstr("poses.jsonl:2: is not a JSON object"));
  EXPECT_THAT(line_of("{\"frame\": 0}\n"), HasSubstr("poses.jsonl:1: key 'capture_ns' not found"));
  EXPECT_THAT(line_of(R"({"capture_ns": 5, "camera": "c", "robots": [{"id": 1, "team": "t"}]})"),
              HasSubstr("poses.jsonl:1: key 'x_m' not found"));
  std::string blind = robot;
  blind.replace(blind.find("55, 48"), 6, "");
  EXPECT_THAT(line_of(frame + blind + "]}\n"), HasSubstr("has no sound pose or pixels"));
  EXPECT_THAT(input_error_line([] { load_pose_tracks("none.jsonl"); }),
              HasSubstr("none.jsonl: cannot be read"));

  // A heading that passes half a turn does not jump.
  std::string turned = robot;
  turned.replace(turned.find("3.1"), 3, "-3.1");
  const std::string good =
      folder.write("poses.jsonl", frame + robot + "]}\n" + frame + turned + "]}\n");
  const auto tracks = load_pose_tracks(good);
  ASSERT_EQ(tracks.size(), 1U);
  EXPECT_EQ(tracks[0].robot, "blue 1 of cam0");
  EXPECT_NEAR(tracks[0].poses[1].pose.z() - tracks[0].poses[0].pose.z(), 2 * M_PI - 6.2, 1e-9);
}

}  // namespace
}  // namespace nadir::calibration
