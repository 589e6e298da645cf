// Prints of tags beside libapriltag's own pictures of them, and painted ones.

#include "vision/tag_pattern.h"

#include <apriltag/apriltag.h>
#include <gtest/gtest.h>

#include <cstdlib>
#include <memory>
#include <numbers>
#include <stdexcept>

#include "vision/libapriltag_family.h"
#include "vision/synthetic/tag_paint.h"

namespace nadir::vision {
namespace {

TEST(TagPattern, IsThatOfTheLibrary) {
  for (std::size_t family = 0; family < kTagFamilies.size(); ++family) {
    const int index = static_cast<int>(family);
    const LibraryFamily library = library_family(index);
    EXPECT_EQ(static_cast<int>(library->ncodes), kTagFamilies[family].ids);
    EXPECT_EQ(library->total_width, kTagFamilies[family].cells);
    EXPECT_EQ(library->width_at_border, kTagFamilies[family].square_cells);
    for (const int id : {0, 1, 17, kTagFamilies[family].ids - 1}) {
      const TagPattern pattern = tag_pattern(index, id);
      // The library's picture is one block and its pixels another; no library exports what frees
      // both.
      image_u8_t* const picture = apriltag_to_image(library.get(), static_cast<std::uint32_t>(id));
      const std::unique_ptr<image_u8_t, decltype(&std::free)> owned(picture, &std::free);
      const std::unique_ptr<std::uint8_t, decltype(&std::free)> pixels(picture->buf, &std::free);
      ASSERT_EQ(pattern.cells, picture->width);
      for (int row = 0; row < pattern.cells; ++row) {
        for (int column = 0; column < pattern.cells; ++column) {
          EXPECT_EQ(pattern.is_white(column, row),
                    picture->buf[row * picture->stride + column] != 0)
              << kTagFamilies[family].name << " " << id << ": " << column << ", " << row;
        }
      }
    }
    EXPECT_THROW(tag_pattern(index, kTagFamilies[family].ids), std::out_of_range);
  }
}

// A fine row of samples through the middle of the print's upper row of cells.
TEST(TagPaint, SamplesShowTheCellsThatTheyTouch) {
  PaintedTag tag;
  tag.cell_m = 0.01;
  tag.pattern = tag_pattern(0, 3);
  tag.black = Eigen::Array4f(0.0F, 0.0F, 0.0F, 1.0F);
  // Turned by a quarter: the print's right hand is the sprite's left, its upper side the back.
  tag.mount.heading_robot_rad = std::numbers::pi / 2.0;
  tag.mount.position_robot_m = {0.2, 0.0};
  for (int row = 0; row < tag.pattern.cells; ++row) {
    const auto up_m = static_cast<float>((4.5 - row) * tag.cell_m);
    for (int column = 0; column < tag.pattern.cells; ++column) {
      const auto right_m = static_cast<float>((column - 4.5) * tag.cell_m);
      const float x_m = 0.2F - up_m;
      const float y_m = right_m;
      Eigen::Array4f sample = Eigen::Array4f::Constant(0.5F);
      paint_tag(tag, &x_m, &y_m, 0, 1, 0.002F, &sample);
      EXPECT_FLOAT_EQ(sample[0], tag.pattern.is_white(column, row) ? 1.0F : 0.0F);
      EXPECT_FLOAT_EQ(sample[3], 1.0F);
    }
  }
  // On the edge of the margin, a quarter of the sample beyond it: three quarters of white paper.
  const float x_m = 0.2F - 0.05F + 0.0005F;
  const float y_m = 0.0045F;
  Eigen::Array4f sample = Eigen::Array4f::Zero();
  paint_tag(tag, &x_m, &y_m, 0, 1, 0.002F, &sample);
  EXPECT_NEAR(sample[0], 0.75F, 1e-3F);
  EXPECT_NEAR(sample[3], 0.75F, 1e-3F);
}

}  // namespace
}  // namespace nadir::vision
