#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numeric>
#include <random>

#include "calibration/noise_file.h"
#include "tests/vision/input_error_line.h"
#include "tests/vision/scratch_folder.h"

namespace nadir::calibration {
namespace {

using testing::HasSubstr;
using vision::DiscObservation;
using vision::input_error_line;

DiscObservation seen(double pixels, double expected_pixels = 50.0) {
  DiscObservation disc;
  disc.pixels = pixels;
  disc.expected_pixels = expected_pixels;
  return disc;
}

PixelCountVariance published_table() {
  return load_pixel_count_variance(NADIR_DATA_DIR "/noise/goncalves2008.yaml");
}

const Eigen::Matrix2d kUnit = Eigen::Matrix2d::Identity();

TEST(TableVariance, HasHalfOpenClasses) {
  const PixelCountVariance table = published_table();
  EXPECT_FALSE(table.covariance_m2(seen(4.99), kUnit).has_value());
  EXPECT_DOUBLE_EQ((*table.covariance_m2(seen(5.0), kUnit))(0, 0), 1.5e-5);
  EXPECT_DOUBLE_EQ((*table.covariance_m2(seen(9.99), kUnit))(1, 1), 1.9e-5);
  EXPECT_DOUBLE_EQ((*table.covariance_m2(seen(10.0), kUnit))(0, 0), 9.25e-6);
  EXPECT_DOUBLE_EQ((*table.covariance_m2(seen(25.0), kUnit))(1, 1), 4.86e-6);
  EXPECT_DOUBLE_EQ((*table.covariance_m2(seen(40.0), kUnit))(0, 0), 1.96e-6);
  EXPECT_DOUBLE_EQ((*table.covariance_m2(seen(4000.0), kUnit))(1, 1), 2.21e-6);
  EXPECT_EQ((*table.covariance_m2(seen(25.0), kUnit))(0, 1), 0.0);
}

TEST(TableVariance, StatesTheHeading) {
  const PixelCountVariance table = published_table();
  EXPECT_DOUBLE_EQ(*table.heading_variance_rad2(7.0, 7.0), 0.14);
  EXPECT_DOUBLE_EQ(*table.heading_variance_rad2(7.0, 15.0), 8e-2);
  EXPECT_DOUBLE_EQ(*table.heading_variance_rad2(15.0, 7.0), 1.6e-2);
  EXPECT_DOUBLE_EQ(*table.heading_variance_rad2(45.0, 25.0), 5.77e-3);
  EXPECT_DOUBLE_EQ(*table.heading_variance_rad2(45.0, 45.0), 3e-3);
  EXPECT_FALSE(table.heading_variance_rad2(4.0, 45.0).has_value());
  EXPECT_FALSE(PixelCountVariance().heading_variance_rad2(45.0, 45.0).has_value());
}

TEST(LawVariance, AgreesWithThePublishedTableInItsClasses) {
  const PixelCountVariance law(LawVariance{});
  const PixelCountVariance table = published_table();
  for (const double middle : {7.5, 15.0, 25.0, 35.0}) {
    const double published = table.covariance_m2(seen(middle), kUnit)->trace() / 2.0;
    EXPECT_NEAR((*law.covariance_m2(seen(middle), kUnit))(0, 0) / published, 1.0, 0.15) << middle;
  }
  // The last class has no upper end; 1/N meets its value inside it.
  const double last = table.covariance_m2(seen(50.0), kUnit)->trace() / 2.0;
  EXPECT_GT((*law.covariance_m2(seen(40.0), kUnit))(0, 0), last);
  EXPECT_LT((*law.covariance_m2(seen(80.0), kUnit))(0, 0), last);
}

TEST(LawVariance, IsItsFormula) {
  const PixelCountVariance law(LawVariance{2e-4, 3e-6, 8.0});
  EXPECT_DOUBLE_EQ((*law.covariance_m2(seen(20.0), kUnit))(1, 1), 1e-5 + 3e-6);
  EXPECT_FALSE(law.covariance_m2(seen(7.9), kUnit).has_value());
  EXPECT_FALSE(law.covariance_m2(seen(std::nan("")), kUnit).has_value());
}

/// Centroid of a random share of a disc's pixels about the centroid of all of them.
TEST(DropOutVariance, AgreesWithMonteCarlo) {
  std::mt19937_64 random(51);
  for (const double radius_px : {3.0, 5.0, 8.0}) {
    std::vector<Eigen::Vector2d> disc;
    for (int u = -9; u <= 9; ++u) {
      for (int v = -9; v <= 9; ++v) {
        if (std::hypot(u, v) <= radius_px) disc.emplace_back(u, v);
      }
    }
    const auto all = static_cast<double>(disc.size());
    for (const double share : {0.3, 0.6, 0.9}) {
      const auto found = static_cast<std::size_t>(std::lround(share * all));
      double scatter_px2 = 0.0;
      constexpr int kRuns = 20000;
      for (int run = 0; run < kRuns; ++run) {
        std::shuffle(disc.begin(), disc.end(), random);
        const Eigen::Vector2d sum =
            std::accumulate(disc.begin(), disc.begin() + static_cast<std::ptrdiff_t>(found),
                            Eigen::Vector2d(0.0, 0.0));
        scatter_px2 += (sum / static_cast<double>(found)).squaredNorm() / (2.0 * kRuns);
      }
      const PixelCountVariance law(DropOutVariance{0.0, 1.0, 1.0});
      const double predicted_px2 =
          (*law.covariance_m2(seen(static_cast<double>(found), all), kUnit))(0, 0);
      EXPECT_NEAR(predicted_px2 / scatter_px2, 1.0, 0.06) << radius_px << " px, share " << share;
    }
  }
}

TEST(DropOutVariance, AddsTheDetectorsVarianceAndTheFloorThroughTheJacobian) {
  DiscObservation disc = seen(46.0, 50.0);  // more than the complete 45: nothing dropped out
  disc.variance_px2 = 0.0016;
  Eigen::Matrix2d jacobian;
  jacobian << 2e-3, 1e-3, 0.0, -3e-3;
  const PixelCountVariance law(DropOutVariance{0.03, 5.0, 0.9});
  const Eigen::Matrix2d expected = 0.0025 * jacobian * jacobian.transpose();
  EXPECT_TRUE(law.covariance_m2(disc, jacobian)->isApprox(expected, 1e-12));
  // 36 of 45 are left: (45/36 - 1) / (4 pi) px^2 more.
  disc.pixels = 36.0;
  const double with_drop_out_px2 = 0.0025 + 0.25 / (4.0 * M_PI);
  EXPECT_TRUE(law.covariance_m2(disc, jacobian)
                  ->isApprox(with_drop_out_px2 * jacobian * jacobian.transpose(), 1e-12));
  EXPECT_FALSE(law.covariance_m2(seen(4.9), jacobian).has_value());
}

TEST(DropOutVariance, IsTheDefault) {
  EXPECT_TRUE(std::holds_alternative<DropOutVariance>(PixelCountVariance().law()));
}

class NoiseFile : public testing::Test {
 protected:
  PixelCountVariance read(const std::string& text) const {
    return load_pixel_count_variance(folder_.write("noise.yaml", text));
  }
  std::string refusal(const std::string& text) const {
    return input_error_line([&] { read(text); });
  }

  vision::ScratchFolder folder_;
};

TEST_F(NoiseFile, ReadsTheLaws) {
  const auto law = std::get<LawVariance>(
      read("nadir_noise: 1\nkind: law\npixel_variance_m2: 2e-4\nfloor_m2: 0\n").law());
  EXPECT_DOUBLE_EQ(law.pixel_variance_m2, 2e-4);
  EXPECT_DOUBLE_EQ(law.floor_m2, 0.0);
  EXPECT_DOUBLE_EQ(law.minimum_pixels, LawVariance{}.minimum_pixels);
  const auto drop_out = std::get<DropOutVariance>(
      read("nadir_noise: 1\nkind: pixels\nfloor_px: 0.02\ncomplete_share: 0.8\nminimum_pixels: 9\n")
          .law());
  EXPECT_DOUBLE_EQ(drop_out.floor_px, 0.02);
  EXPECT_DOUBLE_EQ(drop_out.minimum_pixels, 9.0);
  EXPECT_DOUBLE_EQ(drop_out.complete_share, 0.8);
}

TEST_F(NoiseFile, RefusesWhatItDoesNotKnow) {
  EXPECT_THAT(refusal("nadir_noise: 2\nkind: law\n"), HasSubstr(":1:1: noise file of version 2"));
  EXPECT_THAT(refusal("nadir_noise: 1\nkind: tabel\n"), HasSubstr("did you mean 'table'?"));
  EXPECT_THAT(refusal("nadir_noise: 1\nkind: law\nfloor_px: 1\n"), HasSubstr("floor_px"));
  EXPECT_THAT(refusal("nadir_noise: 1\nkind: pixels\nfloor_px: -1\n"), HasSubstr(":3:11"));
  EXPECT_THAT(refusal("nadir_noise: 1\nkind: table\nclasses: []\n"), HasSubstr("is empty"));
}

TEST_F(NoiseFile, RefusesClassesOutOfOrder) {
  const std::string one =
      "  - {from_pixels: 5, variance_x_m2: 1e-5, variance_y_m2: 1e-5, "
      "variance_heading_rad2: [1e-2, 1e-2]}\n";
  EXPECT_THAT(refusal("nadir_noise: 1\nkind: table\nclasses:\n" + one + one),
              HasSubstr(":5:6: 'from_pixels' does not rise"));
  EXPECT_THAT(refusal("nadir_noise: 1\nkind: table\nclasses:\n" + one),
              HasSubstr("variance_heading_rad2"));
}

}  // namespace
}  // namespace nadir::calibration
