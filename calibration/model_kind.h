#pragma once

#include <array>
#include <optional>
#include <string_view>

namespace nadir::calibration {

/// The plane maps that can be fitted, the simplest first. Polynomials are of the given order in
/// both pixel coordinates. A homography is a pinhole camera without distortion; `radial` has k1
/// about a known lens centre in addition, `radial2` also k2 and the lens centre.
///
/// polynomial2 stands first although it has more parameters than a homography: it is what the
/// field's papers use, so it wins where nothing speaks against it.
enum class ModelKind {
  kPolynomial2,
  kHomography,
  kRadial,
  kRadial2,
  kPolynomial3,
  kPolynomial4,
  kPolynomial5
};

inline constexpr std::array<ModelKind, 7> kAllModels = {
    ModelKind::kPolynomial2, ModelKind::kHomography,  ModelKind::kRadial,     ModelKind::kRadial2,
    ModelKind::kPolynomial3, ModelKind::kPolynomial4, ModelKind::kPolynomial5};

/// As on the command line and in files: "polynomial2", "radial", ...
const char* model_name(ModelKind model);
/// Nothing for a name that is none of them.
std::optional<ModelKind> model_from_name(std::string_view name);
/// Numbers that are fitted, of x and y together: 12 for polynomial2.
int parameter_count(ModelKind model);
/// Of a polynomial; 0 for other models.
int polynomial_order(ModelKind model);
/// Points that give as many numbers as there are parameters, rounded up: 6 for polynomial2.
int least_points(ModelKind model);

}  // namespace nadir::calibration
