// Layout files of kind apriltag.

#include "vision/tag_layout.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <numbers>

#include "tests/vision/input_error_line.h"
#include "tests/vision/scratch_folder.h"
#include "vision/marker_layout.h"

namespace nadir::vision {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;

const std::string kHead =
    "name: test\n"
    "kind: apriltag\n"
    "family: tag36h11\n"
    "height_m: 0.1\n"
    "tag_size_m: 0.08\n";

class TagLayoutFile : public testing::Test {
 protected:
  MarkerLayout load(const std::string& text) const {
    return load_marker_layout(folder_.write("robot.yaml", text));
  }
  std::string load_error(const std::string& text) const {
    return input_error_line([&] { load(text); });
  }

  ScratchFolder folder_;
};

TEST_F(TagLayoutFile, WithoutRobotsEveryTagIsTheRobotOfItsNumber) {
  const MarkerLayout layout = load(kHead + "offset: {x_m: 0.01, heading_rad: 1.5}\n");
  ASSERT_TRUE(layout.tags);
  EXPECT_FALSE(layout.is_anonymous());
  EXPECT_EQ(layout.disc_count(), 0);
  EXPECT_EQ(layout.teams.at(0).name, "test");
  EXPECT_DOUBLE_EQ(layout.tags->size_m, 0.08);
  EXPECT_DOUBLE_EQ(layout.tags->printed_size_m(), 0.1);
  const auto tag = layout.tags->find(586);
  ASSERT_TRUE(tag);
  EXPECT_EQ(tag->robot_id, 586);
  EXPECT_EQ(tag->mount.position_robot_m, Eigen::Vector2d(0.01, 0.0));
  EXPECT_DOUBLE_EQ(tag->mount.heading_robot_rad, 1.5);
  EXPECT_FALSE(layout.tags->find(587));
  EXPECT_FALSE(layout.has_robot(587));
  EXPECT_EQ(layout.robot_ids().size(), 587U);
}

TEST_F(TagLayoutFile, RobotsMayHaveSeveralTags) {
  const MarkerLayout layout = load(kHead +
                                   "team: red\n"
                                   "robots: {9: 2, 7: 1, 8: 1}\n"
                                   "offset: {y_m: 0.05}\n"
                                   "offsets: {8: {x_m: -0.1, heading_rad: 3.0}}\n");
  EXPECT_EQ(layout.teams.at(0).name, "red");
  EXPECT_THAT(layout.robot_ids(), ElementsAre(1, 2));
  EXPECT_TRUE(layout.has_robot(2));
  EXPECT_FALSE(layout.has_robot(7));
  const auto own = layout.tags->tags_of(1);
  ASSERT_EQ(own.size(), 2U);
  EXPECT_EQ(own[0].tag_id, 7);
  EXPECT_EQ(own[0].mount.position_robot_m, Eigen::Vector2d(0.0, 0.05));
  EXPECT_EQ(own[1].mount.position_robot_m, Eigen::Vector2d(-0.1, 0.0));
  EXPECT_DOUBLE_EQ(own[1].mount.heading_robot_rad, 3.0);
  EXPECT_FALSE(layout.tags->find(10));
  EXPECT_NEAR(layout.extent_m(), 0.1 + 0.05 * std::numbers::sqrt2, 1e-12);
}

TEST_F(TagLayoutFile, FamiliesHaveLongAndShortNames) {
  for (const std::string& name : tag_families()) {
    const std::string head = "name: a\nkind: apriltag\nheight_m: 0.1\ntag_size_m: 0.1\nfamily: ";
    EXPECT_EQ(load(head + name).tags->facts().name, name);
    EXPECT_EQ(load(head + name.substr(3)).tags->facts().name, name);
  }
  EXPECT_THAT(load_error("name: a\nkind: apriltag\nheight_m: 0.1\ntag_size_m: 0.1\nfamily: 99\n"),
              HasSubstr("robot.yaml:5:1: '99' is no tag family; choose of tag36h11, tag25h9"));
}

TEST_F(TagLayoutFile, SaysInOneLineWhatIsWrong) {
  const auto expect = [this](const std::string& more, const std::string& part) {
    EXPECT_THAT(load_error(kHead + more), HasSubstr(part));
  };
  expect("tag_sise_m: 0.1\n", ":6:1:");
  expect("teams: {blue: blue}\n", "teams");
  expect("robots: {587: 1}\n", "tag36h11 has no tag 587; its tags are 0 to 586");
  expect("robots: {7: 1, 07: 2}\n", "tag 7 stands twice");
  expect("robots: {7: -1}\n", ":6:");
  expect("robots: {}\n", "'robots' is empty");
  expect("robots: {7: 1, 8: 1}\n", "tags 7 and 8 of robot 1 are 0 mm apart and 80 mm wide");
  expect("robots: {7: 1, 8: 1}\noffsets: {8: {x_m: 0.05}}\n", "50 mm apart");
  expect("robots: {7: 1}\noffsets: {8: {x_m: 0.05}}\n", "tag 8 is not in 'robots'");
  expect("offsets: {8: {x_m: 0.05}}\n", "there is no 'robots'");
  expect("robots: {7: 1}\noffsets: {7: {x: 0.05}}\n", "x_m");
  expect("offset: {x_m: 0.05, y_m: left}\n", ":6:");
  EXPECT_THAT(load_error("name: a\nkind: apriltag\nheight_m: 0.1\ntag_size_m: 0.1\n"),
              HasSubstr("family"));
}

TEST_F(TagLayoutFile, IsRefusedByThoseWhoNeedDiscs) {
  const auto file = folder_.write("robot.yaml", kHead);
  EXPECT_THAT(input_error_line([&] { load_disc_layout(file); }), HasSubstr(":2:"));
}

TEST(TagLayout, ExamplesAreGood) {
  const std::string folder = std::string(NADIR_DATA_DIR) + "/layouts/";
  EXPECT_EQ(load_marker_layout(folder + "apriltag.yaml").tags->find(7)->robot_id, 7);
  EXPECT_EQ(load_marker_layout(folder + "apriltag_pairs.yaml").tags->tags_of(2).size(), 2U);
}

}  // namespace
}  // namespace nadir::vision
