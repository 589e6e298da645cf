#include "vision/disc_window.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <cstring>

#include "vision/vector_clones.h"

namespace nadir::vision {
namespace {

constexpr float kWindowMargin_px = 1.1F;  // the window's taper ends here, outside the edge
constexpr float kTaper_px = 0.8F;
constexpr float kDeep_px = 2.2F;  // well inside: this far from the edge
// Pixels further from the line between disc and surroundings than this share of the contrast lose
// their weight, ...
constexpr float kForeignShare = 0.35F;
constexpr float kForeignLimit = 2.0F;  // ... all of it at sqrt(2) times that
constexpr float kDarkest = 0.3F;       // limits of the light relative to the disc's middle
constexpr float kBrightest = 1.7F;
constexpr float kFarAway_px = 1e4F;
constexpr float kFitted = 3.0F;  // of the inside's shares: mean and two slopes

// Eight pixels at once, in the compiler's portable vectors.
constexpr int kLanes = 8;
// NOLINTBEGIN(modernize-use-using)
typedef float Floats __attribute__((vector_size(4 * kLanes)));
typedef std::int32_t Ints __attribute__((vector_size(4 * kLanes)));
typedef std::uint8_t Bytes __attribute__((vector_size(4 * kLanes)));
typedef std::uint8_t HalfBytes __attribute__((vector_size(2 * kLanes)));
// NOLINTEND(modernize-use-using)
constexpr std::size_t kHalfStep = 3 * kLanes / 2;  // bytes from the first pixel to the fifth
constexpr int kPixelsRead = 10;  // the bytes that are fetched for eight, rounded up

struct PixelRange {
  int u_begin;
  int u_end;  // last column, included
  int v_begin;
  int v_end;
};

// Pixels within `reach_px` of the window's centre, in the image.
PixelRange range_of(const cv::Mat& bgr, const DiscWindow& w, float reach_px) {
  // Rows of the inverse, whose determinant is 1 or -1: the ellipse's half width and half height.
  const float half_u = reach_px * w.to_round.col(1).norm();
  const float half_v = reach_px * w.to_round.col(0).norm();
  const auto u = static_cast<float>(w.centre.x());
  const auto v = static_cast<float>(w.centre.y());
  return {std::max(0, static_cast<int>(std::ceil(u - half_u))),
          std::min(bgr.cols - 1, static_cast<int>(std::floor(u + half_u))),
          std::max(0, static_cast<int>(std::ceil(v - half_v))),
          std::min(bgr.rows - 1, static_cast<int>(std::floor(v + half_v)))};
}

// Eight pixels from column `u` on as one word each, whose highest byte means nothing. Never reads
// past the row's end: what would lie there is arbitrary. Vectors never cross a function but by
// reference, and only where it is inlined: it has another form in each clone.
inline __attribute__((always_inline)) void load_pixels(const std::uint8_t* row, int u, int columns,
                                                       Ints& words) {
  std::uint8_t tail[3 * kPixelsRead] = {};
  const std::uint8_t* pixel = row + 3 * static_cast<std::size_t>(u);
  if (u + kPixelsRead > columns) {
    std::memcpy(tail, pixel, 3 * static_cast<std::size_t>(columns - u));
    pixel = tail;
  }
  HalfBytes first;
  HalfBytes second;
  std::memcpy(&first, pixel, sizeof(first));
  std::memcpy(&second, pixel + kHalfStep, sizeof(second));
  const Bytes both = __builtin_shufflevector(                               //
      first, second, 0, 1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11, 12, 13, 14, 15,  //
      16, 17, 18, 19, 20, 21, 22, 23, 24, 25, 26, 27, 28, 29, 30, 31);
  const Bytes spread = __builtin_shufflevector(                       //
      both, both, 0, 1, 2, 3, 3, 4, 5, 6, 6, 7, 8, 9, 9, 10, 11, 12,  //
      16, 17, 18, 19, 19, 20, 21, 22, 22, 23, 24, 25, 25, 26, 27, 28);
  words = reinterpret_cast<Ints>(spread);
}

inline __attribute__((always_inline)) float sum_of(const Floats& lanes) {
  float sum = 0.0F;
  for (int i = 0; i < kLanes; ++i) sum += lanes[i];
  return sum;
}

}  // namespace

NADIR_VECTOR_CLONES
WeightSums sum_weights(const cv::Mat& bgr, const DiscWindow& w) {
  const float outer = w.radius_px + kWindowMargin_px;
  const float inner = outer - kTaper_px;
  const float outer2 = outer * outer;
  const float taper_gain = 1.0F / (outer2 - inner * inner);
  const float share_gain = 1.0F / (w.limits.high - w.limits.low);
  const float per_contrast2 = 1.0F / w.difference.squaredNorm();
  const float per_foreign2 = per_contrast2 / (kForeignShare * kForeignShare);
  const bool shaded = w.slope_u != 0.0F || w.slope_v != 0.0F;
  const PixelRange range = range_of(bgr, w, outer);
  const Eigen::Matrix2f metric = w.to_round.transpose() * w.to_round;  // of distances squared
  const auto centre_u = static_cast<float>(w.centre.x());
  const auto centre_v = static_cast<float>(w.centre.y());
  const Floats zero = {};
  const Floats one = zero + 1.0F;
  const Floats lane_offset = {0, 1, 2, 3, 4, 5, 6, 7};
  Floats weight_sum = zero;
  Floats weight_u_sum = zero;
  Floats weight_v_sum = zero;
  Floats edge_sum = zero;
  for (int v = range.v_begin; v <= range.v_end; v += w.row_step) {
    const std::uint8_t* row = bgr.ptr<std::uint8_t>(v);
    const float dv = static_cast<float>(v) - centre_v;
    const float metric_uv_dv = 2.0F * metric(0, 1) * dv;
    const float metric_vv_dv2 = metric(1, 1) * dv * dv;
    for (int u = range.u_begin; u <= range.u_end; u += kLanes) {
      Floats du = lane_offset + (static_cast<float>(u) - centre_u);
      if (u + kLanes > bgr.cols) {  // what is beyond the row's end is too far away to count
        du = lane_offset < static_cast<float>(bgr.cols - u) ? du : zero + kFarAway_px;
      }
      Ints word;
      load_pixels(row, u, bgr.cols, word);
      const Floats blue = __builtin_convertvector(word & 255, Floats) - w.surroundings[0];
      const Floats green = __builtin_convertvector((word >> 8) & 255, Floats) - w.surroundings[1];
      const Floats red = __builtin_convertvector((word >> 16) & 255, Floats) - w.surroundings[2];

      const Floats distance2 = du * (metric(0, 0) * du + metric_uv_dv) + metric_vv_dv2;
      Floats taper = (outer2 - distance2) * taper_gain;
      taper = taper < one ? taper : one;
      taper = taper > zero ? taper : zero;

      const Floats along = w.difference[0] * blue + w.difference[1] * green + w.difference[2] * red;
      const Floats share = w.share_of[0] * blue + w.share_of[1] * green + w.share_of[2] * red;
      // What is neither disc nor surroundings nor a mixture of both lies off the line between them.
      const Floats off_line2 =
          blue * blue + green * green + red * red - along * along * per_contrast2;
      Floats own = kForeignLimit - off_line2 * per_foreign2;
      own = own < one ? own : one;
      own = own > zero ? own : zero;

      Floats even_share = share;  // as it would be in even light
      if (shaded) {
        Floats lit = one + w.slope_u * du + w.slope_v * dv;
        lit = lit < kBrightest ? lit : zero + kBrightest;
        lit = lit > kDarkest ? lit : zero + kDarkest;
        even_share = share / lit;
      }
      const Floats limited = (even_share - w.limits.low) * share_gain;
      Floats held = limited < one ? limited : one;
      held = held > zero ? held : zero;

      const Floats weight = taper * own * held;
      weight_sum += weight;
      weight_u_sum += weight * du;
      weight_v_sum += weight * dv;
      const Floats edge = taper * taper * distance2;
      edge_sum += held == limited ? edge : zero;
    }
  }
  return {sum_of(weight_sum), sum_of(weight_u_sum), sum_of(weight_v_sum), sum_of(edge_sum)};
}

NADIR_VECTOR_CLONES
InsideShares inside_shares(const cv::Mat& bgr, const DiscWindow& w) {
  const float deep = std::max(0.0F, w.radius_px - kDeep_px);
  const float surroundings_share = w.share_of.dot(w.surroundings);
  const PixelRange range = range_of(bgr, w, deep);
  const Eigen::Matrix2f metric = w.to_round.transpose() * w.to_round;  // of distances squared
  const auto centre_u = static_cast<float>(w.centre.x());
  const auto centre_v = static_cast<float>(w.centre.y());
  const Floats zero = {};
  const Floats one = zero + 1.0F;
  const Floats lane_offset = {0, 1, 2, 3, 4, 5, 6, 7};
  Floats count_sum = zero;
  Floats share_lanes = zero;
  Floats share2_lanes = zero;
  Floats u_lanes = zero;
  Floats v_lanes = zero;
  Floats u2_lanes = zero;
  Floats v2_lanes = zero;
  Floats share_u_lanes = zero;
  Floats share_v_lanes = zero;
  for (int v = range.v_begin; v <= range.v_end; ++v) {
    const std::uint8_t* row = bgr.ptr<std::uint8_t>(v);
    const float dv = static_cast<float>(v) - centre_v;
    const float metric_uv_dv = 2.0F * metric(0, 1) * dv;
    const float metric_vv_dv2 = metric(1, 1) * dv * dv;
    for (int u = range.u_begin; u <= range.u_end; u += kLanes) {
      const Floats du = lane_offset + (static_cast<float>(u) - centre_u);
      Ints word;
      load_pixels(row, u, bgr.cols, word);
      const Floats distance2 = du * (metric(0, 0) * du + metric_uv_dv) + metric_vv_dv2;
      const Floats counts = distance2 < deep * deep ? one : zero;
      const Floats blue = __builtin_convertvector(word & 255, Floats);
      const Floats green = __builtin_convertvector((word >> 8) & 255, Floats);
      const Floats red = __builtin_convertvector((word >> 16) & 255, Floats);
      const Floats share = counts * (w.share_of[0] * blue + w.share_of[1] * green +
                                     w.share_of[2] * red - surroundings_share);
      const Floats counted_u = counts * du;
      const Floats counted_v = counts * dv;
      count_sum += counts;
      share_lanes += share;
      share2_lanes += share * share;
      u_lanes += counted_u;
      v_lanes += counted_v;
      u2_lanes += counted_u * du;
      v2_lanes += counted_v * dv;
      share_u_lanes += share * du;
      share_v_lanes += share * dv;
    }
  }
  InsideShares inside;
  inside.count = static_cast<int>(sum_of(count_sum));
  const float share_sum = sum_of(share_lanes);
  const float share2_sum = sum_of(share2_lanes);
  const Eigen::Vector2f offset_sum(sum_of(u_lanes), sum_of(v_lanes));
  const Eigen::Vector2f offset2_sum(sum_of(u2_lanes), sum_of(v2_lanes));
  const Eigen::Vector2f share_offset_sum(sum_of(share_u_lanes), sum_of(share_v_lanes));
  if (inside.count == 0 || !(offset2_sum.minCoeff() > 0.0F)) return inside;
  const auto count = static_cast<float>(inside.count);
  inside.mean = share_sum / count;
  const Eigen::Vector2f moment = share_offset_sum - inside.mean * offset_sum;
  inside.slope_u = moment.x() / offset2_sum.x();
  inside.slope_v = moment.y() / offset2_sum.y();
  inside.explained = moment.cwiseAbs2().cwiseQuotient(offset2_sum).sum();
  const float left = share2_sum - share_sum * inside.mean - inside.explained;
  inside.scatter = std::max(0.0F, left) / std::max(1.0F, count - kFitted);
  return inside;
}

}  // namespace nadir::vision
