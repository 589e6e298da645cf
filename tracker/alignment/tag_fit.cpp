#include "tracker/alignment/tag_fit.h"

#include <algorithm>

#include "tracker/alignment/lanes.h"
#include "vision/vector_clones.h"

namespace nadir::tracker {
namespace {

using lanes::Floats;
using lanes::Ints;
using lanes::kLanes;

// The pixels to look at after those at `i`: of blocks of eight every `stride`-th, however many
// pixels are looked at at once. Segments begin with a block.
NADIR_INLINE std::size_t after(std::size_t i, int stride) {
  constexpr std::size_t kBlock = 8;
  const std::size_t next = i + kLanes;
  return next % kBlock == 0 ? next + kBlock * static_cast<std::size_t>(stride - 1) : next;
}

// Where pixels lie on the print, in cells from its upper left corner, and if they count.
struct Cells {
  Floats a, b, count;
};

NADIR_INLINE void locate(const TagPatch& patch, std::size_t i, const TagTemplate& print,
                         const TagPlace& place, float margin, Cells& cells) {
  Floats x, y;
  lanes::load(&patch.x_m[i], x);
  lanes::load(&patch.y_m[i], y);
  x -= place.x_m;
  y -= place.y_m;
  const float c = place.cosine / place.cell_m;
  const float s = place.sine / place.cell_m;
  const float size = static_cast<float>(print.cells);
  cells.a = c * x + s * y + 0.5F * size;
  cells.b = place.left * (s * x - c * y) + 0.5F * size;
  const Floats zero = x * 0.0F;
  const Ints inside = (cells.a > margin) & (cells.a < size - margin) & (cells.b > margin) &
                      (cells.b < size - margin);
  cells.count = inside ? zero + 1.0F : zero;
  cells.a = cells.a > 0.0F ? (cells.a < size ? cells.a : zero + size) : zero;
  cells.b = cells.b > 0.0F ? (cells.b < size ? cells.b : zero + size) : zero;
}

// Shares of a blurred place in four cells along one axis, their derivatives by the place and, times
// the blur, by the blur. `first` is the index of the first of the four cells.
struct Shares {
  Floats share[4], slope[4], spread[4];
  Ints first;
};

// With kNear only the nearest edge is blurred: right where cells are wide.
template <bool kNear>
NADIR_INLINE void share_out(const Floats& place, float blur, Shares& shares) {
  const Ints edge = __builtin_convertvector(place + 0.5F, Ints);
  shares.first = edge - 2;
  const Floats offset = place - __builtin_convertvector(edge, Floats);
  const float inverse = 1.0F / blur;
  const Floats zero = place * 0.0F;
  Floats density[3], below[3];
  if constexpr (kNear) {
    lanes::normal(offset * inverse, density[1], below[1]);
    density[0] = density[2] = zero;
    below[0] = zero + 1.0F;
    below[2] = zero;
  } else {
    lanes::normal((offset + 1.0F) * inverse, density[0], below[0]);
    lanes::normal(offset * inverse, density[1], below[1]);
    lanes::normal((offset - 1.0F) * inverse, density[2], below[2]);
  }
  shares.share[0] = 1.0F - below[0];
  shares.share[1] = below[0] - below[1];
  shares.share[2] = below[1] - below[2];
  shares.share[3] = below[2];
  const Floats spread[3] = {-(offset + 1.0F) * inverse * density[0], -offset * inverse * density[1],
                            -(offset - 1.0F) * inverse * density[2]};
  shares.slope[0] = -inverse * density[0];
  shares.slope[1] = inverse * (density[0] - density[1]);
  shares.slope[2] = inverse * (density[1] - density[2]);
  shares.slope[3] = inverse * density[2];
  shares.spread[0] = -inverse * spread[0];
  shares.spread[1] = inverse * (spread[0] - spread[1]);
  shares.spread[2] = inverse * (spread[1] - spread[2]);
  shares.spread[3] = inverse * spread[2];
}

struct Template {
  Floats value{}, by_a{}, by_b{}, by_blur{};
};

// Sums of those shares whose cell is white, over the four cells of a row.
NADIR_INLINE void pick(const Ints& bits, const Floats (&shares)[4], Floats& sum) {
  const Floats zero = shares[1] * 0.0F;
  sum = (bits & 1) != 0 ? shares[0] : zero;
  for (int k = 1; k < 4; ++k) sum += (bits & (1 << k)) != 0 ? shares[k] : zero;
}

template <bool kNear, bool kBlur>
NADIR_INLINE void blur_cells(const TagTemplate& print, const Cells& cells, float blur,
                             Template& result) {
  Shares columns, rows;
  share_out<kNear>(cells.a, blur, columns);
  share_out<kNear>(cells.b, blur, rows);
  constexpr int kFirst = kNear ? 1 : 0;
  constexpr int kLast = kNear ? 2 : 3;
  for (int row = kFirst; row <= kLast; ++row) {
    Ints bits;
    for (int lane = 0; lane < kLanes; ++lane) {
      const int index = rows.first[lane] + row + TagTemplate::kBeyond;
      bits[lane] = print.rows[static_cast<std::size_t>(index)];
    }
    bits >>= columns.first + TagTemplate::kBeyond;
    Floats along, slope;
    pick(bits, columns.share, along);
    pick(bits, columns.slope, slope);
    const Floats value = rows.share[row] * along;
    const Floats by_a = rows.share[row] * slope;
    const Floats by_b = rows.slope[row] * along;
    result.value = row == kFirst ? value : result.value + value;
    result.by_a = row == kFirst ? by_a : result.by_a + by_a;
    result.by_b = row == kFirst ? by_b : result.by_b + by_b;
    if constexpr (kBlur) {
      Floats spread;
      pick(bits, columns.spread, spread);
      const Floats by_blur = rows.share[row] * spread + rows.spread[row] * along;
      result.by_blur = row == kFirst ? by_blur : result.by_blur + by_blur;
    }
  }
}

// Weight of a residual: one over the noise's variance, less beyond Huber's limit.
NADIR_INLINE void weigh(const Floats& expected, const Floats& residual, const TagWeights& weights,
                        const Floats& count, Floats& weight) {
  const auto read = static_cast<float>(weights.noise.read);
  const auto shot = static_cast<float>(weights.noise.shot);
  const Floats zero = expected * 0.0F;
  const Floats variance = read + shot * (expected > 0.0F ? expected : zero);
  Floats inverse_deviation;
  lanes::inverse_root(variance, inverse_deviation);
  const Floats sigmas = residual * inverse_deviation;
  const Floats away = sigmas < 0.0F ? -sigmas : sigmas;
  weight = inverse_deviation * inverse_deviation * count;
  weight = away > weights.huber_sigmas ? weight * (weights.huber_sigmas / (away + 1e-6F)) : weight;
}

// What a pixel should show: value, and the light there on a print that is white or grey.
NADIR_INLINE void expect(const Template& t, const TagLevels& levels, const Floats& along,
                         const Floats& down, Floats& even, Floats& light, Floats& expected) {
  even = levels.black + levels.contrast * t.value;
  light = 1.0F + levels.rise_a * along + levels.rise_b * down;
  expected = even * light;
}

template <bool kNear>
NADIR_INLINE void sum_cells(const TagPatch& patch, int segment, const TagTemplate& print,
                            const TagPlace& place, const TagLevels& levels,
                            const TagWeights& weights, TagSums& result) {
  constexpr int kPairs = kTagSteps * (kTagSteps + 1) / 2;
  Floats plain[11], with_t[kTagSteps], with_r[kTagSteps], with_1[kTagSteps], pairs[kPairs];
  for (Floats& sum : plain) sum = Floats{};
  for (int k = 0; k < kTagSteps; ++k) with_t[k] = with_r[k] = with_1[k] = Floats{};
  for (Floats& sum : pairs) sum = Floats{};
  const float middle = 0.5F * static_cast<float>(print.cells);
  const auto begin = static_cast<std::size_t>(patch.begin[static_cast<std::size_t>(segment)]);
  const auto end = static_cast<std::size_t>(patch.end[static_cast<std::size_t>(segment)]);
  for (std::size_t i = begin; i < end; i = after(i, weights.stride)) {
    Cells cells;
    locate(patch, i, print, place, weights.margin_cells, cells);
    Template t;
    blur_cells<kNear, false>(print, cells, weights.blur_cells, t);
    const Floats along = (cells.a - middle) * (1.0F / middle);
    const Floats down = (cells.b - middle) * (1.0F / middle);
    Floats value, even, light, expected, w;
    lanes::load(&patch.value[i], value);
    expect(t, levels, along, down, even, light, expected);
    const Floats r = value - expected;
    weigh(expected, r, weights, cells.count, w);
    // The tag moves, not the pixel; turning it moves the print under the pixel the other way.
    const Floats scale = levels.contrast * light;
    const Floats turn = (place.left * middle) * (t.by_b * along - t.by_a * down);
    const Floats d[kTagSteps] = {-scale * t.by_a, -scale * t.by_b, scale * turn, even * along,
                                 even * down};
    const Floats share = light * t.value;
    const Floats wr = w * r;
    const Floats wt = w * share;
    plain[0] += w * light * light;
    plain[1] += wt * light;
    plain[2] += wr * light;
    plain[3] += wt * share;
    plain[4] += wt * r;
    plain[5] += wr * r;
    plain[6] += cells.count;
    plain[7] += wr * wr * (d[0] * d[0] + d[1] * d[1]);
    plain[8] += cells.count * value;
    plain[9] += cells.count * value * value;
    plain[10] += cells.count * r * r;
    int pair = 0;
    for (int k = 0; k < kTagSteps; ++k) {
      const Floats wd = w * d[k];
      with_1[k] += wd * light;
      with_t[k] += wd * share;
      with_r[k] += wd * r;
      for (int m = k; m < kTagSteps; ++m) pairs[pair++] += wd * d[m];
    }
  }
  float* const out[11] = {&result.n,
                          &result.t,
                          &result.r,
                          &result.tt,
                          &result.tr,
                          &result.rr,
                          &result.pixels,
                          &result.pull,
                          &result.value_sum,
                          &result.value_squares,
                          &result.residual_squares};
  for (int k = 0; k < 11; ++k) *out[k] = lanes::sum_of(plain[k]);
  for (std::size_t k = 0; k < kTagSteps; ++k) {
    result.d[k] = lanes::sum_of(with_1[k]);
    result.td[k] = lanes::sum_of(with_t[k]);
    result.rd[k] = lanes::sum_of(with_r[k]);
  }
  for (std::size_t k = 0; k < kPairs; ++k) result.dd[k] = lanes::sum_of(pairs[k]);
}

// Cells so wide that the edges next to the nearest one are 3 sigmas away.
bool is_near(const TagWeights& weights) { return weights.blur_cells < 0.5F / 3.0F; }

}  // namespace

TagTemplate::TagTemplate(const vision::TagPattern& pattern) : cells(pattern.cells) {
  for (int j = -kBeyond; j < cells + kBeyond; ++j) {
    std::int32_t bits = 0;
    for (int i = -kBeyond; i < cells + kBeyond; ++i) {
      const int column = std::clamp(i, 0, cells - 1);
      const int row = std::clamp(j, 0, cells - 1);
      if (pattern.is_white(column, row)) bits |= 1 << (i + kBeyond);
    }
    const int index = j + kBeyond;
    rows[static_cast<std::size_t>(index)] = bits;
  }
}

NADIR_VECTOR_CLONES
TagSums sum_tag(const TagPatch& patch, int segment, const TagTemplate& print, const TagPlace& place,
                const TagLevels& levels, const TagWeights& weights) {
  TagSums sums;
  if (is_near(weights)) {
    sum_cells<true>(patch, segment, print, place, levels, weights, sums);
  } else {
    sum_cells<false>(patch, segment, print, place, levels, weights, sums);
  }
  return sums;
}

NADIR_VECTOR_CLONES
TagLevels fit_tag_levels(const TagPatch& patch, int segment, const TagTemplate& print,
                         const TagPlace& place, const TagWeights& weights) {
  Floats n{}, t{}, tt{}, v{}, vt{};
  const auto begin = static_cast<std::size_t>(patch.begin[static_cast<std::size_t>(segment)]);
  const auto end = static_cast<std::size_t>(patch.end[static_cast<std::size_t>(segment)]);
  for (std::size_t i = begin; i < end; i = after(i, weights.stride)) {
    Cells cells;
    locate(patch, i, print, place, weights.margin_cells, cells);
    Template now;
    blur_cells<true, false>(print, cells, weights.blur_cells, now);
    Floats value;
    lanes::load(&patch.value[i], value);
    const Floats share = cells.count * now.value;
    n += cells.count;
    t += share;
    tt += share * now.value;
    v += cells.count * value;
    vt += share * value;
  }
  const float count = lanes::sum_of(n);
  const float ones = lanes::sum_of(t);
  const float squares = lanes::sum_of(tt);
  const float determinant = count * squares - ones * ones;
  if (!(determinant > 1e-6F * count * count)) return {};
  const float values = lanes::sum_of(v);
  const float products = lanes::sum_of(vt);
  return {(squares * values - ones * products) / determinant,
          (count * products - ones * values) / determinant};
}

NADIR_VECTOR_CLONES
TagScatter scatter_tag(const TagPatch& patch, int segment, const TagTemplate& print,
                       const TagPlace& place, const TagLevels& levels, const TagWeights& weights) {
  Floats sums[11];
  for (Floats& sum : sums) sum = Floats{};
  const float middle = 0.5F * static_cast<float>(print.cells);
  const auto begin = static_cast<std::size_t>(patch.begin[static_cast<std::size_t>(segment)]);
  const auto end = static_cast<std::size_t>(patch.end[static_cast<std::size_t>(segment)]);
  for (std::size_t i = begin; i < end; i += kLanes) {
    Cells cells;
    locate(patch, i, print, place, weights.margin_cells, cells);
    Template t;
    blur_cells<false, true>(print, cells, weights.blur_cells, t);
    Floats value, even, light, expected, w;
    lanes::load(&patch.value[i], value);
    expect(t, levels, (cells.a - middle) * (1.0F / middle), (cells.b - middle) * (1.0F / middle),
           even, light, expected);
    const Floats r = value - expected;
    weigh(expected, r, weights, cells.count, w);
    const Floats zero = r * 0.0F;
    const Floats black = t.value < 0.005F ? cells.count : zero;
    const Floats white = t.value > 0.995F ? cells.count : zero;
    const Floats terms[11] = {black,
                              black * r * r,
                              white,
                              white * r * r,
                              w,
                              w * t.value,
                              w * t.value * t.value,
                              w * t.by_blur,
                              w * t.by_blur * t.value,
                              w * t.by_blur * t.by_blur,
                              w * t.by_blur * r};
    for (int k = 0; k < 11; ++k) sums[k] += terms[k];
  }
  TagScatter result;
  float* const out[11] = {&result.black_count, &result.black_squares,
                          &result.white_count, &result.white_squares,
                          &result.n,           &result.t,
                          &result.tt,          &result.s,
                          &result.st,          &result.ss,
                          &result.sr};
  for (int k = 0; k < 11; ++k) *out[k] = lanes::sum_of(sums[k]);
  return result;
}

}  // namespace nadir::tracker
