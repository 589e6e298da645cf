#include "calibration/program/picture_checkerboard.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <deque>
#include <map>
#include <numbers>
#include <opencv2/imgproc.hpp>

namespace nadir::calibration {
namespace {

using vision::PixelPoint;
using Cell = std::pair<int, int>;  // of the grid: column, row, from the seed

constexpr double kBlur_px = 1.5;
constexpr double kLeastResponse = 0.10;  // of the strongest corner's
constexpr int kSuppress_px = 4;          // radius in which the strongest candidate stands alone
constexpr int kRing = 24;                // samples
constexpr double kRing_px = 4.0;
constexpr std::size_t kMostCandidates = 20000;
/// Distance of a corner from where its neighbours promise it, in steps of the grid.
constexpr double kTolerance = 0.25;

cv::Mat grey_of(const cv::Mat& picture) {
  cv::Mat grey;
  if (picture.channels() == 3) {
    cv::cvtColor(picture, grey, cv::COLOR_BGR2GRAY);
  } else {
    grey = picture.clone();
  }
  return grey;
}

/// I_uv^2 - I_uu I_vv: positive where the brightness is a saddle.
cv::Mat saddle_response(const cv::Mat& grey) {
  cv::Mat smooth;
  cv::GaussianBlur(grey, smooth, {0, 0}, kBlur_px);
  smooth.convertTo(smooth, CV_32F);
  cv::Mat uu;
  cv::Mat vv;
  cv::Mat uv;
  cv::Sobel(smooth, uu, CV_32F, 2, 0, 3);
  cv::Sobel(smooth, vv, CV_32F, 0, 2, 3);
  cv::Sobel(smooth, uv, CV_32F, 1, 1, 3);
  return uv.mul(uv) - uu.mul(vv);
}

float bilinear(const cv::Mat& grey, double u, double v) {
  const int left = std::clamp(static_cast<int>(std::floor(u)), 0, grey.cols - 2);
  const int top = std::clamp(static_cast<int>(std::floor(v)), 0, grey.rows - 2);
  const auto du = static_cast<float>(u - left);
  const auto dv = static_cast<float>(v - top);
  const auto at = [&](int row, int column) {
    return static_cast<float>(grey.at<std::uint8_t>(top + row, left + column));
  };
  return (1 - dv) * ((1 - du) * at(0, 0) + du * at(0, 1)) +
         dv * ((1 - du) * at(1, 0) + du * at(1, 1));
}

/// Two dark and two bright sectors around the place, opposite ones alike.
bool has_four_sectors(const cv::Mat& grey, const cv::Point& place) {
  const double reach = kRing_px + 1.0;
  if (place.x < reach || place.y < reach || place.x >= grey.cols - 1 - reach ||
      place.y >= grey.rows - 1 - reach) {
    return false;
  }
  std::array<float, kRing> ring{};
  float low = 255.0F;
  float high = 0.0F;
  for (int i = 0; i < kRing; ++i) {
    const double angle = 2.0 * std::numbers::pi * i / kRing;
    ring[static_cast<std::size_t>(i)] =
        bilinear(grey, place.x + kRing_px * std::cos(angle), place.y + kRing_px * std::sin(angle));
    low = std::min(low, ring[static_cast<std::size_t>(i)]);
    high = std::max(high, ring[static_cast<std::size_t>(i)]);
  }
  if (high - low < 12.0F) return false;
  const float middle = 0.5F * (low + high);
  int changes = 0;
  for (std::size_t i = 0; i < kRing; ++i) {
    const bool bright = ring[i] > middle;
    if (bright != (ring[(i + 1) % kRing] > middle)) ++changes;
  }
  return changes == 4;
}

std::vector<cv::Point2f> candidates(const cv::Mat& grey) {
  const cv::Mat response = saddle_response(grey);
  double strongest = 0.0;
  cv::minMaxLoc(response, nullptr, &strongest);
  cv::Mat largest;
  const int size = 2 * kSuppress_px + 1;
  cv::dilate(response, largest, cv::getStructuringElement(cv::MORPH_RECT, {size, size}));
  const auto least = static_cast<float>(std::max(kLeastResponse * strongest, 1.0));
  std::vector<cv::Point2f> found;
  for (int v = 0; v < response.rows; ++v) {
    for (int u = 0; u < response.cols; ++u) {
      const float value = response.at<float>(v, u);
      if (value < least || value < largest.at<float>(v, u)) continue;
      if (!has_four_sectors(grey, {u, v})) continue;
      found.emplace_back(static_cast<float>(u), static_cast<float>(v));
      if (found.size() == kMostCandidates) return found;
    }
  }
  return found;
}

PixelPoint pixel(const cv::Point2f& point) {
  return {static_cast<double>(point.x), static_cast<double>(point.y)};
}

/// Index of the nearest place within a distance, or -1.
int nearest(const std::vector<PixelPoint>& places, const PixelPoint& wanted, double within) {
  int best = -1;
  for (std::size_t i = 0; i < places.size(); ++i) {
    const double distance = (places[i] - wanted).norm();
    if (distance >= within) continue;
    within = distance;
    best = static_cast<int>(i);
  }
  return best;
}

/// Labels of corners that hang together in one grid.
class Grid {
 public:
  explicit Grid(const std::vector<PixelPoint>& places) : places_(places) {}

  /// Starts from `seed` with a step to each side; false where it has no two neighbours.
  bool grow_from(std::size_t seed) {
    cells_.clear();
    if (!start(seed)) return false;
    while (!open_.empty()) {
      const Cell cell = open_.front();
      open_.pop_front();
      for (const Cell& side : {Cell{1, 0}, Cell{-1, 0}, Cell{0, 1}, Cell{0, -1}})
        extend(cell, side);
    }
    return true;
  }

  /// The cells as a board of this size, turned where need be; nothing if any corner is missing.
  std::optional<BoardCorners> board(const BoardSize& size) const {
    Cell low = cells_.begin()->first;
    Cell high = low;
    for (const auto& [cell, index] : cells_) {
      low = {std::min(low.first, cell.first), std::min(low.second, cell.second)};
      high = {std::max(high.first, cell.first), std::max(high.second, cell.second)};
    }
    const int columns = high.first - low.first + 1;
    const int rows = high.second - low.second + 1;
    const bool straight = columns == size.columns && rows == size.rows;
    const bool turned = columns == size.rows && rows == size.columns;
    if (!straight && !turned) return std::nullopt;
    BoardCorners board{size, {}};
    for (int row = 0; row < size.rows; ++row) {
      for (int column = 0; column < size.columns; ++column) {
        const Cell cell = straight ? Cell{low.first + column, low.second + row}
                                   : Cell{low.first + row, low.second + column};
        const auto found = cells_.find(cell);
        if (found == cells_.end()) return std::nullopt;
        board.corners.push_back(places_[static_cast<std::size_t>(found->second)]);
      }
    }
    return board;
  }

  std::size_t size() const { return cells_.size(); }

 private:
  bool start(std::size_t seed) {
    // The nearest other corner is a neighbour along one axis; a quarter turn from it is the other.
    double nearest_distance = 1e9;
    std::size_t other = seed;
    for (std::size_t i = 0; i < places_.size(); ++i) {
      const double distance = (places_[i] - places_[seed]).norm();
      if (i == seed || distance >= nearest_distance) continue;
      nearest_distance = distance;
      other = i;
    }
    if (other == seed) return false;
    const Eigen::Vector2d step = places_[other] - places_[seed];
    const Eigen::Vector2d across(-step.y(), step.x());
    int second = -1;
    for (const double side : {1.0, -1.0}) {
      second = nearest(places_, places_[seed] + side * across, 0.45 * step.norm());
      if (second >= 0) {
        put({0, static_cast<int>(side)}, second);
        break;
      }
    }
    if (second < 0) return false;
    put({0, 0}, static_cast<int>(seed));
    put({1, 0}, static_cast<int>(other));
    return true;
  }

  void put(const Cell& cell, int index) {
    cells_[cell] = index;
    open_.push_back(cell);
  }

  const PixelPoint* at(int column, int row) const {
    const auto found = cells_.find({column, row});
    return found == cells_.end() ? nullptr : &places_[static_cast<std::size_t>(found->second)];
  }

  /// The step to one side of a cell as its neighbours have it.
  std::optional<Eigen::Vector2d> step(const Cell& cell, const Cell& side) const {
    const auto [c, r] = cell;
    const auto [dc, dr] = side;
    const PixelPoint* here = at(c, r);
    if (const PixelPoint* behind = at(c - dc, r - dr)) return *here - *behind;
    // Parallel to it, one row beside.
    for (const int beside : {1, -1}) {
      const PixelPoint* a = at(c + beside * dr, r + beside * dc);
      const PixelPoint* b = at(c + beside * dr + dc, r + beside * dc + dr);
      if (a != nullptr && b != nullptr) return *b - *a;
    }
    return std::nullopt;
  }

  void extend(const Cell& cell, const Cell& side) {
    const Cell next{cell.first + side.first, cell.second + side.second};
    if (cells_.contains(next)) return;
    const auto way = step(cell, side);
    if (!way) return;
    const int found =
        nearest(places_, *at(cell.first, cell.second) + *way, kTolerance * way->norm());
    if (found < 0) return;
    for (const auto& [other, index] : cells_) {
      if (index == found) return;  // a corner stands in one cell
    }
    put(next, found);
  }

  const std::vector<PixelPoint>& places_;
  std::map<Cell, int> cells_;
  std::deque<Cell> open_;
};

double median_spacing(const std::vector<cv::Point2f>& points) {
  std::vector<double> spacing;
  const std::size_t step = std::max<std::size_t>(1, points.size() / 200);
  for (std::size_t i = 0; i < points.size(); i += step) {
    double best = 1e9;
    for (std::size_t j = 0; j < points.size(); ++j) {
      if (i != j) best = std::min(best, cv::norm(points[i] - points[j]));
    }
    spacing.push_back(best);
  }
  const auto middle = spacing.begin() + static_cast<std::ptrdiff_t>(spacing.size() / 2);
  std::nth_element(spacing.begin(), middle, spacing.end());
  return *middle;
}

}  // namespace

std::optional<BoardCorners> find_checkerboard(const cv::Mat& picture, const BoardSize& size) {
  const auto wanted = static_cast<std::size_t>(size.columns) * static_cast<std::size_t>(size.rows);
  const cv::Mat grey = grey_of(picture);
  std::vector<cv::Point2f> found = candidates(grey);
  if (found.size() < wanted) return std::nullopt;
  const int half = std::clamp(static_cast<int>(0.3 * median_spacing(found)), 2, 9);
  cv::cornerSubPix(grey, found, {half, half}, {-1, -1},
                   {cv::TermCriteria::COUNT + cv::TermCriteria::EPS, 40, 1e-3});
  std::vector<PixelPoint> places;
  places.reserve(found.size());
  for (const cv::Point2f& point : found) places.push_back(pixel(point));
  Grid grid(places);
  // A seed on clutter leads to a small grid; a few dozen of them meet the board, if there is one.
  constexpr std::size_t kSeeds = 60;
  const std::size_t step = std::max<std::size_t>(1, places.size() / kSeeds);
  for (std::size_t seed = step / 2; seed < places.size(); seed += step) {
    if (!grid.grow_from(seed) || grid.size() < wanted) continue;
    if (auto board = grid.board(size)) return board;
  }
  return std::nullopt;
}

}  // namespace nadir::calibration
