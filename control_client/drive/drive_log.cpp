#include "control_client/drive/drive_log.h"

#include <fmt/format.h>

#include <cmath>
#include <iterator>
#include <stdexcept>

namespace nadir::control_client {
namespace {

const char* name_of(MotionPlan::Phase phase) {
  switch (phase) {
    case MotionPlan::Phase::kApproach:
      return "approach";
    case MotionPlan::Phase::kFollow:
      return "follow";
    case MotionPlan::Phase::kOver:
      return "over";
    case MotionPlan::Phase::kNone:
      break;
  }
  return "none";
}

void put_pose(std::string* row, const fusion::PlanarPose& pose) {
  fmt::format_to(std::back_inserter(*row), ",{:.6f},{:.6f},{:.6f}", pose.x_m, pose.y_m,
                 pose.heading_rad);
}

void put_pose(std::string* row, const Eigen::Vector3d& pose) {
  put_pose(row, fusion::PlanarPose{pose.x(), pose.y(), fusion::wrap_angle(pose.z())});
}

}  // namespace

DriveLog::DriveLog(const std::filesystem::path& file, bool has_truth)
    : file_(file), stream_(file, std::ios::binary), has_truth_(has_truth) {
  stream_ << "t_s,mode,reason,phase,pace,trajectory_s,command_x_m,command_y_m,command_heading_rad,"
             "nominal_x_m,nominal_y_m,nominal_heading_rad,x_m,y_m,heading_rad,sigma_x_m,sigma_y_m,"
             "sigma_heading_rad,encoder_x_m,encoder_y_m,encoder_heading_rad";
  if (has_truth) stream_ << ",true_x_m,true_y_m,true_heading_rad";
  stream_ << ",u_mps,v_mps,r_radps,saturated,pose_age_s,clock_offset_s,ticks_missed\n";
  if (!stream_) throw std::runtime_error("cannot write " + file.string());
}

void DriveLog::write(fusion::Timestamp now, const DriveCore& core,
                     const std::optional<fusion::PlanarPose>& truth) {
  if (!core.estimate() || !core.encoder_pose()) return;  // nothing to tell yet
  if (start_ns_ == 0) start_ns_ = now.count();
  const tracker::WireClientState state = core.state();
  const MotionPlan& plan = core.plan();
  const auto deviation = state.covariance.diagonal().cwiseSqrt();
  std::string row = fmt::format("{:.4f},{},{},{},{:.3f},{:.4f}",
                                1e-9 * static_cast<double>(now.count() - start_ns_),
                                tracker::name_of(state.mode), tracker::name_of(state.reason),
                                name_of(plan.phase()), plan.pace(), plan.trajectory_time_s());
  put_pose(&row, plan.command().pose);
  put_pose(&row, plan.motion().pose);
  put_pose(&row, core.estimate()->pose);
  fmt::format_to(std::back_inserter(row), ",{:.3e},{:.3e},{:.3e}", deviation(0), deviation(1),
                 deviation(2));
  put_pose(&row, *core.encoder_pose());
  if (has_truth_ && truth) put_pose(&row, *truth);
  const Eigen::Vector3d& rates = core.loop().command();
  fmt::format_to(std::back_inserter(row), ",{:.4f},{:.4f},{:.4f},{},{:.4f},{:.6f},{}\n", rates.x(),
                 rates.y(), rates.z(), core.loop().is_saturated() ? 1 : 0,
                 1e-9 * static_cast<double>(state.pose_age_ns),
                 1e-9 * static_cast<double>(state.clock_offset_ns), state.counts.ticks_missed);
  stream_ << row;
}

void DriveLog::finish() {
  stream_.flush();
  if (!stream_) throw std::runtime_error("cannot write " + file_.string());
}

}  // namespace nadir::control_client
