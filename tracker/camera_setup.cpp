#include "tracker/camera_setup.h"

#include <fmt/format.h>

#include "calibration/calibration_height.h"
#include "calibration/noise_file.h"
#include "tracker/wire/wire_types.h"
#include "vision/colour_file.h"
#include "vision/input/input_error.h"

namespace nadir::tracker {
namespace {

void take_noise(const CameraConfig& config, PipelineSetup& setup) {
  if (config.variance == VarianceModel::kLaw) {
    setup.variance = calibration::PixelCountVariance(calibration::LawVariance{});
  }
  if (config.noise.empty()) return;
  calibration::NoiseFile noise = calibration::load_noise_file(config.noise);
  setup.alignment_floor_px = noise.alignment_floor_px;
  if (config.variance == VarianceModel::kTable) setup.variance = std::move(noise.variance);
}

PoseSource source_of(VarianceModel variance) {
  switch (variance) {
    case VarianceModel::kFisher:
      return PoseSource::kAlignment;
    case VarianceModel::kPixels:
      return PoseSource::kDetector;
    case VarianceModel::kLaw:
    case VarianceModel::kTable:
      break;
  }
  return PoseSource::kAlignedAndCounts;
}

void check_teams(const vision::MarkerLayout& layout, const std::filesystem::path& file) {
  for (const vision::Team& team : layout.teams) {
    if (team.name.size() <= kMaxTeamLength) continue;
    throw vision::InputError(
        {file.string(), 0, 0},
        fmt::format("team name '{}' has {} letters", team.name, team.name.size()),
        fmt::format("use at most {}", kMaxTeamLength));
  }
}

void check_landmarks(const CameraConfig& config, const PipelineSetup& setup) {
  for (const Landmark& landmark : config.landmarks) {
    bool known = false;
    std::string names;
    for (const vision::MarkerLayout& layout : setup.layouts) {
      for (const vision::Team& team : layout.teams) {
        known = known || team.name == landmark.team;
        names += (names.empty() ? "" : ", ") + team.name;
      }
    }
    if (known) continue;
    throw vision::InputError({config.name, 0, 0},
                             fmt::format("a landmark is of team '{}', which no layout of the "
                                         "camera has",
                                         landmark.team),
                             "choose one of " + names);
  }
}

}  // namespace

PipelineSetup load_pipeline_setup(const CameraConfig& config, const TrackSettings& tracks) {
  PipelineSetup setup{.camera = config.name,
                      .calibration = calibration::load_calibration(config.calibration),
                      .calibration_file = config.calibration,
                      .layouts = {},
                      .colours = vision::default_colour_classes(),
                      .variance = {},
                      .tracks = tracks,
                      .source = source_of(config.variance),
                      .mosaic = config.mosaic};
  take_noise(config, setup);
  for (const std::filesystem::path& file : config.layouts) {
    setup.layouts.push_back(vision::load_marker_layout(file));
    check_teams(setup.layouts.back(), file);
  }
  check_landmarks(config, setup);
  if (!config.colours.empty()) setup.colours = vision::load_colour_classes(config.colours);
  return setup;
}

std::vector<std::string> setup_warnings(const PipelineSetup& setup) {
  std::vector<std::string> warnings;
  for (const vision::MarkerLayout& layout : setup.layouts) {
    if (calibration::is_corrected_at_height(setup.calibration, layout.height_m)) continue;
    warnings.push_back(fmt::format(
        "{}: warning: the markers of layout '{}' are {:g} m high, but {} was made for {:g} m and "
        "does not know where the camera is; positions are off towards the image border, and their "
        "covariance says so; calibrate at the markers' height, or with --camera-height and "
        "--nadir, --focal-px or points at a second height",
        setup.camera, layout.name, layout.height_m, setup.calibration_file.string(),
        setup.calibration.height_m));
  }
  return warnings;
}

std::string coverage_warning(const PipelineSetup& setup, int width_px, int height_px) {
  constexpr double kEnough = 0.6;  // of the image's width and height
  const calibration::Calibration& calibration = setup.calibration;
  const Eigen::Vector2d covered = calibration.points_box.high_px - calibration.points_box.low_px;
  const bool covers = covered.x() >= kEnough * width_px && covered.y() >= kEnough * height_px;
  if (calibration.image_width_px > 0 || covers) return "";
  return fmt::format(
      "{}: warning: the points of {} span {:.0f}x{:.0f} px, but frames have {}x{}: is it made for "
      "images of another size? State it with nadir-calibrate field --image-size",
      setup.camera, setup.calibration_file.string(), covered.x(), covered.y(), width_px, height_px);
}

}  // namespace nadir::tracker
