#pragma once

#include <cstdint>
#include <memory>
#include <optional>

#include "fusion/body_rates.h"
#include "fusion/fusion_health.h"
#include "fusion/gate.h"
#include "fusion/odometry_error_wheel_slip.h"
#include "fusion/timestamp.h"
#include "fusion/vision_pose.h"
#include "fusion/wheel_geometry.h"

namespace nadir::control_client {

/// Mean body rates over [from, to], on the robot's clock.
struct OdometryInterval {
  fusion::Timestamp from{0};
  fusion::Timestamp to{0};
  fusion::BodyRates mean_rates;
};

/// How the errors of odometry are modelled.
enum class OdometryModel : std::uint8_t {
  kWheelSlip,  ///< scale and slip of every wheel, learnt on the way
  kWhite,      ///< independent noise of every rim, the papers' model
};

struct OnboardFusionSettings {
  OdometryModel model = OdometryModel::kWheelSlip;
  fusion::WheelSlipParameters wheel_slip{.unlearnt_slip_sigma_s = 0.01};
  /// Of kWhite, over 0.02 s; twice the papers': frames are good.
  double white_rim_sigma_mps = 0.06;
  fusion::Gate gate = fusion::Gate::chi_square();
  fusion::LockOutRecovery recovery;
};

/// fusion::DelayedFusion with any model of odometry's errors.
class OnboardFusion {
 public:
  virtual ~OnboardFusion() = default;

  /// In the order of time.
  virtual fusion::OdometryVerdict add_odometry(const OdometryInterval& odometry) = 0;
  virtual fusion::PoseVerdict add_pose(const fusion::VisionPose& pose) = 0;
  /// A pose that was captured later is refused. One that is newer than the odometry, but not newer
  /// than this, waits for more of it.
  virtual fusion::Timestamp latest_capture() const = 0;
  /// Nothing before the first pose.
  virtual std::optional<fusion::Estimate> estimate_at(fusion::Timestamp time) const = 0;
  virtual fusion::FusionHealth health() const = 0;
  /// Capture of the newest pose that was used; nothing before the first.
  virtual std::optional<fusion::Timestamp> last_used_capture() const = 0;

 protected:
  OnboardFusion() = default;
  OnboardFusion(const OnboardFusion&) = default;
  OnboardFusion& operator=(const OnboardFusion&) = default;
};

/// The filter for a robot with these wheels (two to six), about its own estimate.
std::unique_ptr<OnboardFusion> make_onboard_fusion(const fusion::WheelGeometry& geometry,
                                                   const OnboardFusionSettings& settings);

}  // namespace nadir::control_client
