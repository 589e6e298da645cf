#include "vision/contrast_map.h"

#include <algorithm>
#include <array>

namespace nadir::vision {
namespace {

constexpr int kSamples = 4;         // on a tile's side
constexpr int kBrightestTiles = 6;  // of which the darkest counts: fewer are a lamp or its mirror

}  // namespace

ContrastMap::ContrastMap(int width_px, int height_px, int spacing_px)
    : spacing_px_(spacing_px),
      columns_(std::max(1, width_px / (kSamples * spacing_px))),
      rows_(std::max(1, height_px / (kSamples * spacing_px))) {
  contrast_.resize(static_cast<std::size_t>(columns_) * rows_);
  open_.reserve(contrast_.size());
}

void ContrastMap::look(const cv::Mat& image, int first, int last) {
  first_ = std::clamp(first, 0, rows_);
  last_ = std::clamp(last, first_, rows_);
  const int channels = image.channels();
  const int step = spacing_px_ * channels;
  const int green = channels == 3 ? 1 : 0;
  for (int row = first_; row < last_; ++row) {
    std::array<const std::uint8_t*, kSamples> line{};
    for (int i = 0; i < kSamples; ++i) {
      const int v = std::min(image.rows - 1, (row * kSamples + i) * spacing_px_ + spacing_px_ / 2);
      line[static_cast<std::size_t>(i)] = image.ptr(v) + green + channels * (spacing_px_ / 2);
    }
    std::uint8_t* out = &contrast_[static_cast<std::size_t>(row) * columns_];
    for (int column = 0; column < columns_; ++column) {
      std::uint8_t low = 255;
      std::uint8_t high = 0;
      for (const std::uint8_t* samples : line) {
        const std::uint8_t* at = samples + static_cast<std::ptrdiff_t>(column) * kSamples * step;
        for (int i = 0; i < kSamples; ++i, at += step) {
          low = std::min(low, *at);
          high = std::max(high, *at);
        }
      }
      out[column] = static_cast<std::uint8_t>(high - low);
    }
  }
}

int ContrastMap::strongest() const {
  std::array<int, 256> tiles{};
  for (std::size_t i = static_cast<std::size_t>(first_) * columns_;
       i < static_cast<std::size_t>(last_) * columns_; ++i) {
    ++tiles[contrast_[i]];
  }
  int count = 0;
  for (int contrast = 255; contrast > 0; --contrast) {
    count += tiles[static_cast<std::size_t>(contrast)];
    if (count >= kBrightestTiles) return contrast;
  }
  return 0;
}

void ContrastMap::blank(const cv::Rect& part) {
  const int tile = tile_px();
  const int left = std::max(0, part.x / tile);
  const int top = std::max(first_, part.y / tile);
  const int right = std::min(columns_, (part.br().x + tile - 1) / tile);
  const int bottom = std::min(last_, (part.br().y + tile - 1) / tile);
  for (int row = top; row < bottom; ++row) {
    for (int column = left; column < right; ++column) {
      contrast_[static_cast<std::size_t>(row) * columns_ + column] = 0;
    }
  }
}

const std::vector<cv::Rect>& ContrastMap::patches(int least) {
  patches_.clear();
  const int tile = tile_px();
  for (int row = first_; row < last_; ++row) {
    for (int column = 0; column < columns_; ++column) {
      if (contrast_[static_cast<std::size_t>(row) * columns_ + column] < least) continue;
      cv::Rect box;
      flood(row, column, least, box);
      patches_.emplace_back(box.x * tile, box.y * tile, box.width * tile, box.height * tile);
    }
  }
  return patches_;
}

/// Takes the tile and all that hang together with it out of the map.
void ContrastMap::flood(int row, int column, int least, cv::Rect& box) {
  const auto take = [&](int r, int c) {
    if (r < first_ || r >= last_ || c < 0 || c >= columns_) return;
    std::uint8_t& contrast = contrast_[static_cast<std::size_t>(r) * columns_ + c];
    if (contrast < least) return;
    contrast = 0;
    open_.push_back(r * columns_ + c);
  };
  box = {column, row, 1, 1};
  open_.clear();
  take(row, column);
  while (!open_.empty()) {
    const int r = open_.back() / columns_;
    const int c = open_.back() % columns_;
    open_.pop_back();
    box |= cv::Rect(c, r, 1, 1);
    for (int i = 0; i < 9; ++i) take(r + i / 3 - 1, c + i % 3 - 1);
  }
}

}  // namespace nadir::vision
