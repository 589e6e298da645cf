#pragma once

#include <array>
#include <cstdint>

#include "tracker/alignment/pixel_noise.h"
#include "tracker/alignment/tag_patch.h"
#include "vision/tag_pattern.h"

namespace nadir::tracker {

/// Cells of a print as bits, ready to be blurred. Beyond the print its outermost cells go on.
struct TagTemplate {
  static constexpr int kBeyond = 4;

  explicit TagTemplate(const vision::TagPattern& pattern);

  int cells = 0;
  /// Row j of the print is rows[j + kBeyond]; in it, column i is bit i + kBeyond.
  std::array<std::int32_t, vision::kMaxTagCells + 2 * kBeyond> rows{};
};

/// Where the tag lies, in the patch's metres.
struct TagPlace {
  float x_m = 0.0F;
  float y_m = 0.0F;
  float cosine = 1.0F;  ///< of the heading
  float sine = 0.0F;
  float cell_m = 0.0F;
  /// 1 where rows of the print run against the plane's left, as everywhere with axes x, y that turn
  /// left seen from above; -1 where the plane is mirrored.
  float left = 1.0F;
};

/// A channel's black, and white minus black.
struct TagLevels {
  float black = 0.0F;
  float contrast = 0.0F;
  /// Light's rise over the tag, shares from its middle to its rim along rows and columns.
  float rise_a = 0.0F;
  float rise_b = 0.0F;
};

/// How a channel's pixels are weighted.
struct TagWeights {
  float blur_cells = 0.15F;    ///< RMS of the blur, cells
  float margin_cells = 0.35F;  ///< pixels nearer to the print's rim do not count
  PixelNoise noise;
  float huber_sigmas = 2.5F;
  int stride = 1;  ///< of eight pixels after eight pixels only each stride-th counts
};

inline constexpr int kTagSteps = 5;

/// Weighted sums over one segment of products of 1, the template T, the residual r = value - black
/// - contrast T, and the derivatives d of the expected value by
///  - moving the tag one cell along its rows, one cell down its columns, turning it (rad);
///  - light that rises towards the end of the rows, of the columns (share, from middle to rim).
struct TagSums {
  float n = 0, t = 0, r = 0, tt = 0, tr = 0, rr = 0;
  std::array<float, kTagSteps> d{};
  std::array<float, kTagSteps> td{};
  std::array<float, kTagSteps> rd{};
  std::array<float, kTagSteps*(kTagSteps + 1) / 2> dd{};  ///< the upper half, row by row
  float pixels = 0;                                       ///< that count, without weight
  float pull = 0;                                         ///< sum of (weight r)^2 (d0^2 + d1^2)
  float value_sum = 0, value_squares = 0;                 ///< of those pixels, unweighted
  float residual_squares = 0;                             ///< unweighted
};

TagSums sum_tag(const TagPatch& patch, int segment, const TagTemplate& print, const TagPlace& place,
                const TagLevels& levels, const TagWeights& weights);

/// Unweighted least squares of black and contrast.
TagLevels fit_tag_levels(const TagPatch& patch, int segment, const TagTemplate& print,
                         const TagPlace& place, const TagWeights& weights);

/// What residuals say of noise and blur.
struct TagScatter {
  float black_count = 0, black_squares = 0;  ///< of pixels that show nothing but black
  float white_count = 0, white_squares = 0;
  /// Weighted sums with T's derivative by the blur (per cell), s.
  float n = 0, t = 0, tt = 0, s = 0, st = 0, ss = 0, sr = 0;
};

TagScatter scatter_tag(const TagPatch& patch, int segment, const TagTemplate& print,
                       const TagPlace& place, const TagLevels& levels, const TagWeights& weights);

}  // namespace nadir::tracker
