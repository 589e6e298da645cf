#include "tests/calibration/fuzz/fuzzed_input.h"

#include <unistd.h>

#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <fstream>

#include "calibration/calibration_height.h"
#include "calibration/field_calibration.h"
#include "calibration/survey_file.h"
#include "vision/input/input_error.h"

namespace nadir::calibration {
namespace {

/// More rows only make a run slow.
constexpr std::size_t kMostRows = 60;

std::filesystem::path written(const std::string& text, const char* ending) {
  static const std::string kName =
      (std::filesystem::temp_directory_path() / ("nadir_fuzz_" + std::to_string(getpid())))
          .string();
  std::filesystem::path file = kName + ending;
  std::ofstream(file, std::ios::binary) << text;
  return file;
}

void require(bool holds, const char* what) {
  if (holds) return;
  std::fprintf(stderr, "a promise is broken: %s\n", what);
  std::abort();
}

/// What a map of accepted points promises.
void check_result(const FieldPoints& points, const FieldResult& result) {
  require(result.fit.point_residuals.size() == points.points.size(), "a residual for each point");
  require(std::isfinite(result.fit.residuals.rms_m), "a finite residual");
  for (const FieldPoint& point : points.points) {
    const PlanePoint mapped = result.calibration.map.map(point.pixel, Eigen::Matrix2d::Identity());
    require(mapped.position_m.allFinite(), "a finite place");
    require(mapped.covariance_m2.allFinite(), "a finite covariance");
  }
}

}  // namespace

bool fits_points(const std::string& text) {
  try {
    Survey survey = load_survey(written(text, ".csv"), 0.0);
    if (survey.plane.points.size() > kMostRows) return false;
    FieldSettings settings;
    settings.model = std::nullopt;
    settings.camera.other_heights = std::move(survey.others);
    check_result(survey.plane, calibrate_field(survey.plane, settings));
    return true;
  } catch (const vision::InputError&) {
    return false;
  } catch (const CalibrationRefused&) {
    return false;
  }
}

bool reads_calibration(const std::string& text) {
  try {
    const Calibration calibration = load_calibration(written(text, ".yaml"));
    const PlaneMap map = map_at_height(calibration, calibration.height_m + 0.1);
    const vision::PixelPoint middle =
        0.5 * (calibration.points_box.low_px + calibration.points_box.high_px);
    for (const vision::PixelPoint& pixel : {middle, calibration.points_box.high_px}) {
      const PlanePoint point = map.map(pixel, Eigen::Matrix2d::Identity());
      if (point.position_m.allFinite()) map.pixel_from_plane(point.position_m);
    }
    const std::string again = calibration_yaml(calibration);
    require(calibration_yaml(load_calibration(written(again, ".yaml"))) == again,
            "a file that is read can be written and read again");
    return true;
  } catch (const vision::InputError&) {
    return false;
  }
}

}  // namespace nadir::calibration
