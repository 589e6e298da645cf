#include "vision/colour_file.h"

#include <gtest/gtest.h>

#include "tests/vision/scratch_folder.h"
#include "vision/input/input_error.h"

namespace nadir::vision {
namespace {

TEST(ColourFile, ReplacesTheNamedColoursAndKeepsTheOthers) {
  const ScratchFolder folder;
  const ColourClasses classes =
      load_colour_classes(folder.write("c.yaml", "colours:\n  pink: [150, 70.5, 230]\n"));
  EXPECT_EQ(classes.of(Colour::kPink), Bgr(150.0F, 70.5F, 230.0F));
  EXPECT_EQ(classes.of(Colour::kBlue), default_colour_classes().of(Colour::kBlue));
}

TEST(ColourFile, RefusesWhatItDoesNotKnow) {
  const ScratchFolder folder;
  const auto refuses = [&folder](const char* text) {
    EXPECT_THROW(load_colour_classes(folder.write("c.yaml", text)), InputError) << text;
  };
  refuses("colours:\n  pnik: [150, 70, 230]\n");
  refuses("colours:\n  pink: [150, 70]\n");
  refuses("colours:\n  pink: [150, 70, 256]\n");
  refuses("colours:\n  pink: [1, 2, 3]\n  pink: [1, 2, 3]\n");
  refuses("colors:\n  pink: [1, 2, 3]\n");
  EXPECT_THROW(load_colour_classes(folder.path() / "absent.yaml"), InputError);
}

}  // namespace
}  // namespace nadir::vision
