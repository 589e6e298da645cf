#include "tracker/alignment/disc_patch.h"

#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <cstdint>
#include <cstring>

#include "tracker/alignment/bgr_run.h"
#include "vision/vector_clones.h"

namespace nadir::tracker {
namespace {

using bgr_run::kRun;
using bgr_run::Values;

constexpr int kLeastHole_px = 5;  // a shorter one in a row costs more to leave out than to look at

// Pixels of a row, the last not included.
struct Chord {
  int begin = 0;
  int end = 0;
};

// The window as a ring between two ellipses about `centre` in the image: offsets d with
// inner2 < d^T metric d <= outer2.
class Ring {
 public:
  Ring(const Eigen::Matrix2d& slope, const PatchWindow& window)
      : centre_(window.centre_px), metric_(slope.transpose() * slope) {
    determinant_ = metric_.determinant();
    m_per_px_ = std::sqrt(std::sqrt(determinant_));
    per_uu_ = 1.0 / metric_(0, 0);
    lean_ = metric_(0, 1) * per_uu_;
    across2_per_px2_ = determinant_ * per_uu_;
    const double margin_m = window.margin_px * m_per_px_;
    const double outer_m = window.radius_m + margin_m;
    const double inner_m = window.whole ? 0.0 : std::max(0.0, window.radius_m - margin_m);
    outer2_m2_ = outer_m * outer_m;
    inner2_m2_ = inner_m * inner_m;
  }

  double half_height_px() const { return std::sqrt(outer2_m2_ * metric_(0, 0) / determinant_); }
  double area_px() const { return M_PI * (outer2_m2_ - inner2_m2_) / (m_per_px_ * m_per_px_); }

  // One or two chords of a row; two with a hole between them.
  int chords(int v, int columns, std::array<Chord, 2>& result) const {
    const double dv = v - centre_.y();
    const double middle = centre_.x() - lean_ * dv;
    const double across2 = across2_per_px2_ * dv * dv;
    const double outer = std::sqrt(std::max(0.0, (outer2_m2_ - across2) * per_uu_));
    const Chord all = {std::max(0, static_cast<int>(std::ceil(middle - outer))),
                       std::min(columns, static_cast<int>(std::floor(middle + outer)) + 1)};
    if (across2 < inner2_m2_) {
      const double inner = std::sqrt((inner2_m2_ - across2) * per_uu_);
      const Chord hole = {static_cast<int>(std::floor(middle - inner)) + 1,
                          static_cast<int>(std::ceil(middle + inner))};
      if (hole.end - hole.begin >= kLeastHole_px && hole.begin > all.begin && hole.end < all.end) {
        result = {Chord{all.begin, hole.begin}, Chord{hole.end, all.end}};
        return 2;
      }
    }
    result[0] = all;
    return all.end > all.begin ? 1 : 0;
  }

 private:
  vision::PixelPoint centre_;
  Eigen::Matrix2d metric_;  // m^2 per px^2
  double determinant_;
  double m_per_px_;
  double per_uu_;           // of the metric: its first element's inverse
  double lean_;             // of the middle of the rows, px per row
  double across2_per_px2_;  // squared distance of the nearest point of a row, m^2 per px^2
  double outer2_m2_;
  double inner2_m2_;
};

// What all rows have in common.
struct Rows {
  int begin, end, step;
  int u0, v0;               // from where pixels count
  float level, by_u, by_v;  // light there over that of the disc's middle, and its change
  vision::PixelFetch* meanwhile;
};

Rows rows_of(const Ring& ring, const PatchWindow& window, const cv::Mat& image, bool mosaic) {
  Rows rows;
  const double half_height = ring.half_height_px();
  rows.begin = std::max(0, static_cast<int>(std::ceil(window.centre_px.y() - half_height)));
  rows.end =
      std::min(image.rows, static_cast<int>(std::floor(window.centre_px.y() + half_height)) + 1);
  // Of large discs; with a mosaic by threes or more odd ones, so that both kinds of rows stay.
  rows.step = 1;
  while (ring.area_px() / rows.step > 0.85 * kPatchCapacity) rows.step += mosaic ? 2 : 1;
  rows.u0 = static_cast<int>(std::lround(window.centre_px.x()));
  rows.v0 = static_cast<int>(std::lround(window.centre_px.y()));
  const Eigen::Vector2d& slope = window.light_slope_per_px;
  const vision::PixelPoint from(rows.u0, rows.v0);
  rows.level = static_cast<float>(1.0 - slope.dot(window.centre_px - from));
  rows.by_u = static_cast<float>(slope.x());
  rows.by_v = static_cast<float>(slope.y());
  rows.meanwhile = window.meanwhile;
  return rows;
}

void pad(DiscPatch& patch) {
  while (patch.count % kRun != 0) {
    const auto i = static_cast<std::size_t>(patch.count++);
    patch.du[i] = 0.0F;
    patch.dv[i] = 0.0F;
    patch.use[i] = 0.0F;
    for (auto& channel : patch.value) channel[i] = 0.0F;
  }
}

// Writes eight pixels from `i` on, whether or not so many are wanted.
NADIR_INLINE void take_run(const bgr_run::Words& words, const Rows& rows, float du, float dv,
                           std::size_t i, DiscPatch& patch) {
  const Values from_first = {0, 1, 2, 3, 4, 5, 6, 7};
  const Values across = from_first + du;
  const Values down = from_first * 0.0F + dv;
  const Values per_light = 1.0F / (rows.level + rows.by_u * across + rows.by_v * down);
  std::memcpy(&patch.du[i], &across, sizeof(Values));
  std::memcpy(&patch.dv[i], &down, sizeof(Values));
  for (int c = 0; c < 3; ++c) {
    Values value;
    bgr_run::channel(words, c, value);
    value *= per_light;
    std::memcpy(&patch.value[static_cast<std::size_t>(c)][i], &value, sizeof(Values));
  }
}

NADIR_INLINE void take_chord(const std::uint8_t* row, int row_bytes, const Chord& chord, int v,
                             const Rows& rows, DiscPatch& patch) {
  const int count = chord.end - chord.begin;
  const auto dv = static_cast<float>(v - rows.v0);
  for (int first = 0; first < count; first += kRun) {
    const int u = chord.begin + first;
    bgr_run::Words words;
    bgr_run::load(row, row_bytes, u, words);
    const int i = patch.count + first;
    take_run(words, rows, static_cast<float>(u - rows.u0), dv, static_cast<std::size_t>(i), patch);
  }
  patch.count += count;
}

NADIR_VECTOR_CLONES
void gather_all(const cv::Mat& image, const Ring& ring, const Rows& rows, DiscPatch& patch) {
  std::array<Chord, 2> chords;
  for (int v = rows.begin; v < rows.end; v += rows.step) {
    if (rows.meanwhile != nullptr) rows.meanwhile->next_row();
    const int chord_count = ring.chords(v, image.cols, chords);
    for (int k = 0; k < chord_count; ++k) {
      if (patch.count + chords[k].end - chords[k].begin > kPatchCapacity - 2 * kRun) break;
      take_chord(image.ptr<std::uint8_t>(v), 3 * image.cols, chords[k], v, rows, patch);
    }
    if (chord_count == 2) patch.skipped += chords[1].begin - chords[0].end;
  }
  std::fill_n(patch.use.begin(), patch.count, 1.0F);
  pad(patch);
  patch.begin = {0, 0, 0};
  patch.end = {patch.count, patch.count, patch.count};
}

void gather_native(const cv::Mat& image, Mosaic mosaic, const Ring& ring, const Rows& rows,
                   DiscPatch& patch) {
  const std::array<int, 4> native = native_channels(mosaic);
  const std::ptrdiff_t channels = image.channels();
  std::array<Chord, 2> chords;
  for (int c = 0; c < 3; ++c) {
    const auto channel = static_cast<std::size_t>(c);
    patch.begin[channel] = patch.count;
    for (int v = rows.begin; v < rows.end; v += rows.step) {
      if (rows.meanwhile != nullptr) rows.meanwhile->next_row();
      const int chord_count = ring.chords(v, image.cols, chords);
      const std::uint8_t* row = image.ptr<std::uint8_t>(v) + (channels == 3 ? c : 0);
      const std::size_t first = (v & 1) != 0 ? 2 : 0;
      const std::array<int, 2> of_row = {native[first], native[first + 1]};
      if (of_row[0] != c && of_row[1] != c) continue;
      const int parity = of_row[0] == c ? 0 : 1;
      const auto dv = static_cast<float>(v - rows.v0);
      auto i = static_cast<std::size_t>(patch.count);
      for (int k = 0; k < chord_count; ++k) {
        const Chord& chord = chords[static_cast<std::size_t>(k)];
        if (i + static_cast<std::size_t>(chord.end - chord.begin) > kPatchCapacity - kRun) break;
        for (int u = chord.begin + ((chord.begin & 1) != parity ? 1 : 0); u < chord.end; u += 2) {
          const auto du = static_cast<float>(u - rows.u0);
          patch.du[i] = du;
          patch.dv[i] = dv;
          patch.use[i] = 1.0F;
          patch.value[channel][i] = static_cast<float>(row[channels * u]) /
                                    (rows.level + rows.by_u * du + rows.by_v * dv);
          ++i;
        }
      }
      patch.count = static_cast<int>(i);
      if (chord_count == 2) patch.skipped += (chords[1].begin - chords[0].end) / 2;
    }
    pad(patch);
    patch.end[channel] = patch.count;
  }
}

}  // namespace

bool gather(const cv::Mat& image, Mosaic mosaic, const PlaneGrid& grid, const PatchWindow& window,
            DiscPatch& patch) {
  patch.count = 0;
  patch.skipped = 0;
  const int u0 = static_cast<int>(std::lround(window.centre_px.x()));
  const int v0 = static_cast<int>(std::lround(window.centre_px.y()));
  patch.plane = grid.about(u0, v0);
  patch.origin_px = {u0, v0};
  const Ring ring(patch.plane.slope, window);
  const Rows rows = rows_of(ring, window, image, mosaic != Mosaic::kNone);
  if (mosaic == Mosaic::kNone) {
    gather_all(image, ring, rows, patch);
  } else {
    gather_native(image, mosaic, ring, rows, patch);
  }
  return patch.count > 0;
}

}  // namespace nadir::tracker
