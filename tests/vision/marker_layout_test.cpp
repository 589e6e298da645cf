#include "vision/marker_layout.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <stdexcept>

#include "tests/vision/input_error_line.h"
#include "tests/vision/scratch_folder.h"

namespace nadir::vision {
namespace {

const std::string kHead =
    "name: test\n"
    "kind: discs\n"
    "height_m: 0.1\n"
    "teams: {one: blue}\n"
    "centre_radius_m: 0.025\n";

class MarkerLayoutFile : public testing::Test {
 protected:
  MarkerLayout load(const std::string& text) const {
    return load_marker_layout(folder_.write("robot.yaml", text));
  }
  std::string load_error(const std::string& text) const {
    const std::string line = input_error_line([&] { load(text); });
    const std::string prefix = folder_.path().string() + "/";
    return line.starts_with(prefix) ? line.substr(prefix.size()) : line;
  }

  ScratchFolder folder_;
};

std::string data_layout(const std::string& name) {
  return std::string(NADIR_DATA_DIR) + "/layouts/" + name;
}

TEST(MarkerLayout, LoadsTheTwoMarkerRobot) {
  const MarkerLayout layout = load_marker_layout(data_layout("pair.yaml"));
  EXPECT_EQ(layout.name, "pair");
  EXPECT_DOUBLE_EQ(layout.height_m, 0.12);
  EXPECT_TRUE(layout.is_anonymous());
  ASSERT_EQ(layout.disc_count(), 2);
  EXPECT_EQ(layout.disc(0, 0, -1).colour, Colour::kBlue);
  EXPECT_DOUBLE_EQ(layout.disc(0, 0, -1).radius_m, 0.025);
  EXPECT_EQ(layout.disc(1, 0, -1).colour, Colour::kYellow);
  EXPECT_EQ(layout.disc(1, 0, -1).position_robot_m, Eigen::Vector2d(0.06, 0.0));
}

TEST(MarkerLayout, LoadsTheLeaguePattern) {
  const MarkerLayout layout = load_marker_layout(data_layout("league.yaml"));
  ASSERT_EQ(layout.identities.size(), 16U);
  ASSERT_EQ(layout.teams.size(), 2U);
  ASSERT_EQ(layout.disc_count(), 5);
  // The rules' drawing of robot 0: pink, green, pink, pink, counter-clockwise from the front left.
  EXPECT_EQ(layout.disc(1, 0, 0).colour, Colour::kPink);
  EXPECT_EQ(layout.disc(2, 0, 0).colour, Colour::kGreen);
  EXPECT_EQ(layout.disc(3, 0, 0).colour, Colour::kPink);
  EXPECT_EQ(layout.disc(4, 0, 0).colour, Colour::kPink);
  EXPECT_EQ(layout.disc(0, 1, 0).colour, Colour::kBlue);
  for (std::size_t i = 0; i < 16; ++i) EXPECT_EQ(layout.identities[i].id, static_cast<int>(i));
  // Every outer disc is 65 mm from the centre, and the first one is on the left in front.
  for (const Disc& disc : layout.outer) EXPECT_NEAR(disc.position_robot_m.norm(), 0.065, 1e-6);
  EXPECT_GT(layout.outer[0].position_robot_m.x(), 0.0);
  EXPECT_GT(layout.outer[0].position_robot_m.y(), 0.0);
}

TEST(MarkerLayout, LoadsAnyOtherArrangement) {
  const MarkerLayout layout = load_marker_layout(data_layout("triangle.yaml"));
  EXPECT_EQ(layout.disc_count(), 3);
  EXPECT_TRUE(layout.is_anonymous());
  EXPECT_EQ(layout.disc(2, 0, -1).colour, Colour::kGreen);
}

TEST(MarkerLayout, KnowsEveryColourByName) {
  for (int i = 0; i < kColourCount; ++i) {
    EXPECT_EQ(static_cast<int>(colour_from_name(kColourNames[i])), i);
  }
  EXPECT_THROW(colour_from_name("purple"), std::out_of_range);
}

TEST_F(MarkerLayoutFile, RefusesAnUnknownKey) {
  EXPECT_EQ(load_error("name: test\nkind: discs\nheigth_m: 0.1\nheight_m: 0.1\nteams: {one: blue}\n"
                       "centre_radius_m: 0.025\n"
                       "outer: [{x_m: 0.06, y_m: 0, radius_m: 0.02, colour: pink}]\n"),
            "robot.yaml:3:1: unknown key 'heigth_m'; did you mean 'height_m'?");
  EXPECT_EQ(load_error(kHead + "outer:\n  - {x_m: 0.06, y_m: 0, radius_m: 0.02, color: pink, "
                               "colour: pink}\n"),
            "robot.yaml:7:41: unknown key 'color'; did you mean 'colour'?");
}

TEST_F(MarkerLayoutFile, RefusesADuplicateKey) {
  EXPECT_EQ(load_error(kHead + "height_m: 0.2\n"),
            "robot.yaml:6:1: key 'height_m' again; it is already on line 3; remove one of the two");
}

TEST_F(MarkerLayoutFile, RefusesValuesOutOfRange) {
  EXPECT_EQ(load_error("name: test\nkind: discs\nheight_m: 2.5\n"),
            "robot.yaml:3:11: 'height_m' is 2.5, out of range; valid is from 0 to 2");
  EXPECT_THAT(load_error(kHead + "outer: [{x_m: 0.06, y_m: 0, radius_m: 0.001, colour: pink}]\n"),
              testing::EndsWith("valid is from 0.002 to 0.5"));
  EXPECT_EQ(load_error(kHead + "outer: []\n"),
            "robot.yaml:6:1: 'outer' has 0 discs; valid is from 1 to 7");
}

TEST_F(MarkerLayoutFile, RefusesDiscsThatOverlap) {
  EXPECT_EQ(load_error(kHead + "outer:\n  - {x_m: 0.04, y_m: 0, radius_m: 0.025, colour: pink}\n"),
            "robot.yaml:7:6: outer disc 1 overlaps the centre disc by 10.0 mm; move them apart or "
            "make them smaller");
}

TEST_F(MarkerLayoutFile, RefusesTwoTeamsOfOneColour) {
  EXPECT_EQ(
      load_error("name: test\nkind: discs\nheight_m: 0.1\nteams:\n  us: blue\n  them: blue\n"),
      "robot.yaml:6:3: teams 'us' and 'them' have the same colour blue; give each team a "
      "colour of its own");
}

TEST_F(MarkerLayoutFile, AsksForColoursEitherOfDiscsOrOfIdentities) {
  EXPECT_THAT(load_error(kHead + "outer: [{x_m: 0.06, y_m: 0, radius_m: 0.02}]\n"),
              testing::HasSubstr("'outer[0]' lacks the key 'colour'"));
  EXPECT_THAT(load_error(kHead + "outer: [{x_m: 0.06, y_m: 0, radius_m: 0.02, colour: pink}]\n"
                                 "identities: {1: [pink]}\n"),
              testing::HasSubstr("an outer disc has a colour although 'identities'"));
}

const std::string kTwoDiscs =
    "outer:\n"
    "  - {x_m: 0.06, y_m: 0.00, radius_m: 0.02}\n"
    "  - {x_m: 0.00, y_m: 0.06, radius_m: 0.02}\n";

TEST_F(MarkerLayoutFile, RefusesEqualIdentities) {
  EXPECT_EQ(load_error(kHead + kTwoDiscs +
                       "identities:\n  3: [pink, green]\n  4: [green, pink]\n  7: [pink, green]\n"),
            "robot.yaml:12:3: identities 3 and 7 have equal colours; give each identity colours of "
            "its own");
  EXPECT_THAT(
      load_error(kHead + kTwoDiscs + "identities:\n  3: [pink, green]\n  03: [green, pink]\n"),
      testing::HasSubstr("identity 3 stands twice"));
}

TEST_F(MarkerLayoutFile, RefusesIdentitiesThatDoNotFitTheDiscs) {
  EXPECT_EQ(load_error(kHead + kTwoDiscs + "identities:\n  3: [pink]\n"),
            "robot.yaml:10:3: identity 3 has 1 colours; write 2, one for each outer disc");
  EXPECT_THAT(load_error(kHead + kTwoDiscs + "identities:\n  3: [pink, gren]\n"),
              testing::HasSubstr("unknown colour 'gren'"));
  EXPECT_THAT(load_error(kHead + kTwoDiscs + "identities:\n  -1: [pink, green]\n"),
              testing::HasSubstr("out of range"));
  EXPECT_THAT(load_error(kHead + kTwoDiscs + "identities: {}\n"),
              testing::HasSubstr("'identities' is empty"));
}

std::string anonymous_square(const std::string& last_colour) {
  return kHead +
         "outer:\n"
         "  - {x_m: 0.06, y_m: 0.0, radius_m: 0.02, colour: pink}\n"
         "  - {x_m: 0.0, y_m: 0.06, radius_m: 0.02, colour: pink}\n"
         "  - {x_m: -0.06, y_m: 0.0, radius_m: 0.02, colour: pink}\n"
         "  - {x_m: 0.0, y_m: -0.06, radius_m: 0.02, colour: " +
         last_colour + "}\n";
}

TEST_F(MarkerLayoutFile, RefusesAPatternWithoutHeading) {
  EXPECT_THAT(load_error(anonymous_square("pink")),
              testing::HasSubstr("degrees looks like itself; move a disc or change a colour"));
  EXPECT_NO_THROW(load(anonymous_square("green")));
}

TEST_F(MarkerLayoutFile, RefusesIdentitiesThatAreRotationsOfEachOther) {
  const std::string line =
      "outer:\n"
      "  - {x_m: 0.06, y_m: 0.0, radius_m: 0.02}\n"
      "  - {x_m: -0.06, y_m: 0.0, radius_m: 0.02}\n";
  const std::string error =
      load_error(kHead + line + "identities: {1: [pink, green], 2: [green, pink]}\n");
  EXPECT_EQ(error,
            "robot.yaml:6:1: robot 'one 1' turned by 180 degrees looks like robot 'one 2'; move a "
            "disc or change a colour");
  EXPECT_NO_THROW(load(kHead + line + "identities: {1: [pink, green]}\n"));
}

TEST_F(MarkerLayoutFile, RefusesAPairThatIsItsOwnMirror) {
  // Centre and heading marker of one colour and size: either end could be the front.
  EXPECT_THAT(load_error(kHead + "outer: [{x_m: 0.06, y_m: 0, radius_m: 0.025, colour: blue}]\n"),
              testing::HasSubstr("robot 'one' turned by 180 degrees looks like itself"));
  EXPECT_NO_THROW(load(kHead + "outer: [{x_m: 0.06, y_m: 0, radius_m: 0.012, colour: blue}]\n"));
}

TEST_F(MarkerLayoutFile, HasAKnownKind) {
  EXPECT_THAT(load_error("name: tag\nkind: disc\n"), testing::HasSubstr("did you mean 'discs'?"));
}

}  // namespace
}  // namespace nadir::vision
