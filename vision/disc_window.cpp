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
typedef float Floats __attribute__((vector_size(4 * kLanes)));       // NOLINT(modernize-use-using)
typedef std::int32_t Ints __attribute__((vector_size(4 * kLanes)));  // NOLINT(modernize-use-using)

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

float sum_of(const float (&lanes)[kLanes]) {
  float sum = 0.0F;
  for (const float lane : lanes) sum += lane;
  return sum;
}

}  // namespace

// The compiler's vectors never cross a function here: all of it stands in one body for that reason.
NADIR_VECTOR_CLONES
WeightSums sum_weights(const cv::Mat& bgr, const DiscWindow& w) {
  const float outer = w.radius_px + kWindowMargin_px;
  const float inner = outer - kTaper_px;
  const float outer2 = outer * outer;
  const float taper_gain = 1.0F / (outer2 - inner * inner);
  const float share_gain = 1.0F / (w.limits.high - w.limits.low);
  const float per_contrast2 = 1.0F / w.difference.squaredNorm();
  const float per_foreign2 = per_contrast2 / (kForeignShare * kForeignShare);
  const PixelRange range = range_of(bgr, w, outer);
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
    for (int u = range.u_begin; u <= range.u_end; u += kLanes) {
      Floats du = lane_offset + (static_cast<float>(u) - centre_u);
      // A pixel is fetched as four bytes, of which the fourth is the next one's: not past the row's
      // end, beyond which everything is too far away to count.
      std::uint8_t tail[3 * kLanes + 1] = {};
      const std::uint8_t* pixel = row + 3 * u;
      if (u + kLanes >= bgr.cols) {
        std::memcpy(tail, pixel, 3 * static_cast<std::size_t>(bgr.cols - u));
        pixel = tail;
        du = lane_offset < static_cast<float>(bgr.cols - u) ? du : zero + kFarAway_px;
      }
      std::int32_t words[kLanes];
      for (int i = 0; i < kLanes; ++i) std::memcpy(&words[i], pixel + 3 * i, 4);
      Ints word;
      std::memcpy(&word, words, sizeof(word));
      const Floats blue = __builtin_convertvector(word & 255, Floats) - w.surroundings[0];
      const Floats green = __builtin_convertvector((word >> 8) & 255, Floats) - w.surroundings[1];
      const Floats red = __builtin_convertvector((word >> 16) & 255, Floats) - w.surroundings[2];

      const Floats x = w.to_round(0, 0) * du + w.to_round(0, 1) * dv;
      const Floats y = w.to_round(1, 0) * du + w.to_round(1, 1) * dv;
      const Floats distance2 = x * x + y * y;
      Floats taper = (outer2 - distance2) * taper_gain;
      taper = taper < one ? taper : one;
      taper = taper > zero ? taper : zero;

      const Floats along = w.difference[0] * blue + w.difference[1] * green + w.difference[2] * red;
      const Floats share = along * per_contrast2;
      // What is neither disc nor surroundings nor a mixture of both lies off the line between them.
      const Floats off_line2 = blue * blue + green * green + red * red - along * share;
      Floats own = kForeignLimit - off_line2 * per_foreign2;
      own = own < one ? own : one;
      own = own > zero ? own : zero;

      Floats lit = one + w.slope_u * du + w.slope_v * dv;
      lit = lit < kBrightest ? lit : zero + kBrightest;
      lit = lit > kDarkest ? lit : zero + kDarkest;
      const Floats limited = (share / lit - w.limits.low) * share_gain;
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
  float lanes[4][kLanes];
  std::memcpy(lanes[0], &weight_sum, sizeof(lanes[0]));
  std::memcpy(lanes[1], &weight_u_sum, sizeof(lanes[1]));
  std::memcpy(lanes[2], &weight_v_sum, sizeof(lanes[2]));
  std::memcpy(lanes[3], &edge_sum, sizeof(lanes[3]));
  return {sum_of(lanes[0]), sum_of(lanes[1]), sum_of(lanes[2]), sum_of(lanes[3])};
}

InsideShares inside_shares(const cv::Mat& bgr, const DiscWindow& w) {
  const float deep = std::max(0.0F, w.radius_px - kDeep_px);
  const Bgr direction = w.difference / w.difference.squaredNorm();
  const PixelRange range = range_of(bgr, w, deep);
  InsideShares inside;
  Eigen::Vector2f offset_sum = Eigen::Vector2f::Zero();
  Eigen::Vector2f offset2_sum = Eigen::Vector2f::Zero();
  Eigen::Vector2f share_offset_sum = Eigen::Vector2f::Zero();
  float share_sum = 0.0F;
  float share2_sum = 0.0F;
  for (int v = range.v_begin; v <= range.v_end; ++v) {
    const std::uint8_t* pixel = bgr.ptr<std::uint8_t>(v) + 3 * range.u_begin;
    for (int u = range.u_begin; u <= range.u_end; ++u, pixel += 3) {
      const Eigen::Vector2f offset(static_cast<float>(u - w.centre.x()),
                                   static_cast<float>(v - w.centre.y()));
      if ((w.to_round * offset).squaredNorm() >= deep * deep) continue;
      const float share = direction.dot(Bgr(pixel[0], pixel[1], pixel[2]) - w.surroundings);
      ++inside.count;
      share_sum += share;
      share2_sum += share * share;
      offset_sum += offset;
      offset2_sum += offset.cwiseAbs2();
      share_offset_sum += share * offset;
    }
  }
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
