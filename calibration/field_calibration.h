#pragma once

#include <optional>
#include <stdexcept>
#include <vector>

#include "calibration/calibration_file.h"
#include "calibration/camera_place.h"
#include "calibration/diagnosis/assessment.h"

namespace nadir::calibration {

struct FieldSettings {
  std::optional<ModelKind> model = ModelKind::kPolynomial2;  ///< nothing: auto, choose_model
  double height_m = 0.0;  ///< of the points' plane above the field
  StatedNoise noise{};
  int image_width_px = 0;  ///< 0 with image_height_px 0: unknown
  int image_height_px = 0;
  CameraClues camera{};
};

struct FieldResult {
  Calibration calibration;
  FieldFit fit;
  FieldAssessment assessment;
};

/// The points are so wrong that nothing can be fitted; the findings say why.
class CalibrationRefused : public std::runtime_error {
 public:
  explicit CalibrationRefused(std::vector<Finding> findings);

  const std::vector<Finding>& findings() const { return findings_; }

 private:
  std::vector<Finding> findings_;
};

/// Everything that `nadir-calibrate field` does with points, wherever they come from: diagnosis,
/// choice of the model, fit, assessment, place of the camera. A result of grade kFail is complete,
/// but should not be used.
///
/// Throws InputError as fit_map does, and for clues that do not tell the camera's place;
/// CalibrationRefused where the points cannot be fitted and the diagnosis says why.
FieldResult calibrate_field(const FieldPoints& points, const FieldSettings& settings);

/// The middle of the image, where lenses are taken to be centred; nothing for an unknown size.
FitOptions fit_options(int image_width_px, int image_height_px);

}  // namespace nadir::calibration
