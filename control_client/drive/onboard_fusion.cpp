#include "control_client/drive/onboard_fusion.h"

#include <stdexcept>

#include "fusion/delayed_fusion.h"
#include "fusion/white_odometry_noise.h"

namespace nadir::control_client {
namespace {

template <class OdometryError>
class FusionWith : public OnboardFusion {
 public:
  FusionWith(const OnboardFusionSettings& settings, const OdometryError& odometry_error)
      : fusion_(settings_with(settings, odometry_error)) {}

  fusion::OdometryVerdict add_odometry(const OdometryInterval& odometry) override {
    return fusion_.add_odometry({odometry.from, odometry.to, odometry.mean_rates, {}});
  }
  fusion::PoseVerdict add_pose(const fusion::VisionPose& pose) override {
    return fusion_.add_pose(pose).verdict;
  }
  fusion::Timestamp latest_capture() const override {
    return fusion_.now() + fusion_.settings().future_tolerance;
  }
  std::optional<fusion::Estimate> estimate_at(fusion::Timestamp time) const override {
    return fusion_.estimate_at(time);
  }
  fusion::FusionHealth health() const override { return fusion_.health(); }
  std::optional<fusion::Timestamp> last_used_capture() const override {
    const fusion::FusionHealth health = fusion_.health();
    if (!health.age_of_last_used) return std::nullopt;
    return health.now - *health.age_of_last_used;
  }

 private:
  using Fusion = fusion::DelayedFusion<fusion::AboutEstimate, OdometryError>;

  static typename Fusion::Settings settings_with(const OnboardFusionSettings& settings,
                                                 const OdometryError& odometry_error) {
    return {.filter = {.gate = settings.gate,
                       .recovery = settings.recovery,
                       .gap = {},
                       .odometry_error = odometry_error},
            .history = {},
            .odometry = {}};
  }

  Fusion fusion_;
};

template <int kWheels>
std::unique_ptr<OnboardFusion> with_slip(const fusion::WheelGeometry& geometry,
                                         const OnboardFusionSettings& settings) {
  using Slip = fusion::WheelSlipError<kWheels>;
  return std::make_unique<FusionWith<Slip>>(settings, Slip(geometry, settings.wheel_slip));
}

}  // namespace

std::unique_ptr<OnboardFusion> make_onboard_fusion(const fusion::WheelGeometry& geometry,
                                                   const OnboardFusionSettings& settings) {
  if (settings.model == OdometryModel::kWhite) {
    constexpr double kInterval_s = 0.02;
    return std::make_unique<FusionWith<fusion::WhiteOdometryNoise>>(
        settings, fusion::WhiteOdometryNoise(geometry.rate_covariance(settings.white_rim_sigma_mps),
                                             kInterval_s));
  }
  switch (geometry.wheels()) {
    case 2:
      return with_slip<2>(geometry, settings);
    case 3:
      return with_slip<3>(geometry, settings);
    case 4:
      return with_slip<4>(geometry, settings);
    case 5:
      return with_slip<5>(geometry, settings);
    case 6:
      return with_slip<6>(geometry, settings);
    default:
      throw std::invalid_argument("a robot has two to six wheels");
  }
}

}  // namespace nadir::control_client
