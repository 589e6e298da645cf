#include "vision/input/strict_yaml.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/vision/input_error_line.h"
#include "tests/vision/scratch_folder.h"

namespace nadir::vision {
namespace {

YamlMap parse(const std::string& text) { return YamlMap::parse(text, "robot.yaml"); }

std::string parse_error(const std::string& text) {
  return input_error_line([&] { parse(text); });
}

TEST(StrictYaml, ReadsEveryKindOfValue) {
  const YamlMap map = parse(
      "height_m: 0.12\ncount: -3\nfast: true\nname: pair\nmode: slow\nsizes: [1, 2.5e-3]\n"
      "words: [a, 'b c']\ninner: {x_m: 1}\nlist:\n  - {x_m: 2}\n  - {x_m: 3}\n");
  EXPECT_DOUBLE_EQ(map.number("height_m", {0, 1}), 0.12);
  EXPECT_EQ(map.integer("count"), -3);
  EXPECT_TRUE(map.boolean_or("fast", false));
  EXPECT_EQ(map.text("name"), "pair");
  EXPECT_EQ(map.choice("mode", {"slow", "quick"}), "slow");
  EXPECT_EQ(map.numbers("sizes", 2), (std::vector<double>{1.0, 2.5e-3}));
  EXPECT_EQ(map.texts("words"), (std::vector<std::string>{"a", "b c"}));
  EXPECT_EQ(map.map("inner").integer("x_m"), 1);
  const std::vector<YamlMap> list = map.maps("list");
  ASSERT_EQ(list.size(), 2U);
  EXPECT_EQ(list[1].integer("x_m"), 3);
  EXPECT_NO_THROW(map.finish());
}

TEST(StrictYaml, FallsBackWhereAKeyIsAbsent) {
  const YamlMap map = parse("present: 1\n");
  EXPECT_DOUBLE_EQ(map.number_or("a", 2.5), 2.5);
  EXPECT_EQ(map.integer_or("b", 7), 7);
  EXPECT_TRUE(map.boolean_or("c", true));
  EXPECT_EQ(map.text_or("d", "x"), "x");
  EXPECT_EQ(map.choice_or("e", "one", {"one", "two"}), "one");
  EXPECT_FALSE(map.map_if_present("f").has_value());
  EXPECT_EQ(map.integer_or("present", 9), 1);
}

TEST(StrictYaml, NamesTheNearestKnownKey) {
  const YamlMap map = parse("name: pair\nkind: discs\nheigth_m: 0.12\n");
  map.text("name");
  map.text("kind");
  map.number_or("height_m", 0.0);
  EXPECT_EQ(input_error_line([&] { map.finish(); }),
            "robot.yaml:3:1: unknown key 'heigth_m'; did you mean 'height_m'?");
}

TEST(StrictYaml, ListsTheKnownKeysWhereNoneIsNear) {
  const YamlMap map = parse("name: pair\nbanana: 3\n");
  map.text("name");
  map.number_or("height_m", 0.0);
  EXPECT_EQ(input_error_line([&] { map.finish(); }),
            "robot.yaml:2:1: unknown key 'banana'; known keys are height_m, name");
}

TEST(StrictYaml, NamesTheMappingThatLacksAKey) {
  const YamlMap map = parse("outer:\n  - {x_m: 1}\n  - {y_m: 1}\n");
  EXPECT_EQ(input_error_line([&] { map.maps("outer")[1].number("x_m"); }),
            "robot.yaml:3:5: 'outer[1]' lacks the key 'x_m'; add it");
  EXPECT_EQ(input_error_line([&] { map.text("name"); }),
            "robot.yaml:1:1: lacks the key 'name'; add it");
}

TEST(StrictYaml, RefusesDuplicateKeysAtAnyDepth) {
  EXPECT_EQ(parse_error("a: 1\nb: 2\na: 3\n"),
            "robot.yaml:3:1: key 'a' again; it is already on line 1; remove one of the two");
  EXPECT_EQ(parse_error("list:\n  - inner:\n      x: 1\n      y: 2\n      x: 3\n"),
            "robot.yaml:5:7: key 'x' again; it is already on line 3; remove one of the two");
}

TEST(StrictYaml, AllowsTheSameKeyInSiblings) {
  EXPECT_NO_THROW(parse("a: {x: 1}\nb: {x: 1}\nlist:\n  - {x: 1}\n  - {x: 2}\n"));
}

TEST(StrictYaml, SaysTheValidRange) {
  const YamlMap map = parse("height_m: 5\ncount: 0\n");
  EXPECT_EQ(input_error_line([&] {
              map.number("height_m", {0, 2});
            }),
            "robot.yaml:1:11: 'height_m' is 5, out of range; valid is from 0 to 2");
  ValidRange positive;
  positive.low = 1;
  EXPECT_EQ(input_error_line([&] { map.integer("count", positive); }),
            "robot.yaml:2:8: 'count' is 0, out of range; valid is at least 1");
}

TEST(StrictYaml, RefusesWrongTypes) {
  const YamlMap map = parse("a: tall\nb: '0.1'\nc: 1.5\nd: [1]\ne:\nf: {x: 1}\ng: yes\n");
  EXPECT_EQ(input_error_line([&] { map.number("a"); }),
            "robot.yaml:1:4: 'a' is 'tall'; write a finite number");
  EXPECT_EQ(input_error_line([&] { map.number("b"); }),
            "robot.yaml:2:4: 'b' is '0.1'; write a finite number");
  EXPECT_EQ(input_error_line([&] { map.integer("c"); }),
            "robot.yaml:3:4: 'c' is '1.5'; write a whole number");
  EXPECT_EQ(input_error_line([&] { map.text("d"); }),
            "robot.yaml:4:4: 'd' is a list; write a text");
  EXPECT_THAT(input_error_line([&] { map.number("e"); }),
              testing::EndsWith("'e' has no value; write a finite number"));
  EXPECT_EQ(input_error_line([&] { map.numbers("f"); }),
            "robot.yaml:6:4: 'f' is a mapping; write a list of numbers");
  EXPECT_EQ(input_error_line([&] { map.boolean_or("g", false); }),
            "robot.yaml:7:4: 'g' is 'yes'; write true or false");
  EXPECT_EQ(input_error_line([&] { map.map("a"); }),
            "robot.yaml:1:4: 'a' is not a mapping; write 'key: value' lines");
}

TEST(StrictYaml, RefusesNumbersThatAreNotFinite) {
  for (const char* value : {".inf", "-.inf", ".nan", "inf", "nan", "1e999", "0x10", "1 000", ""}) {
    const YamlMap map = parse(std::string("a: ") + value + "\n");
    EXPECT_THROW(map.number("a"), InputError) << value;
  }
  EXPECT_THROW(parse("a: 3000000000\n").integer("a"), InputError);
}

TEST(StrictYaml, RefusesListsOfTheWrongLength) {
  const YamlMap map = parse("a: [1, 2]\nb: [1, x]\n");
  EXPECT_EQ(input_error_line([&] { map.numbers("a", 3); }),
            "robot.yaml:1:4: 'a' has 2 numbers; write 3");
  EXPECT_EQ(input_error_line([&] { map.numbers("b"); }),
            "robot.yaml:2:8: 'b[1]' is 'x'; write a finite number");
}

TEST(StrictYaml, SuggestsTheNearestChoice) {
  const YamlMap map = parse("colour: yelow\n");
  EXPECT_EQ(input_error_line([&] {
              map.choice("colour", {"blue", "yellow"});
            }),
            "robot.yaml:1:9: 'colour' is 'yelow'; did you mean 'yellow'?");
}

TEST(StrictYaml, ReportsSyntaxErrorsWithTheirPlace) {
  const std::string line = parse_error("a: 1\nb: [1, 2\nc: 3\n");
  EXPECT_TRUE(line.starts_with("robot.yaml:3:")) << line;
  EXPECT_NE(line.find("not valid YAML"), std::string::npos) << line;
}

TEST(StrictYaml, RefusesWhatAConfigurationNeedNotContain) {
  EXPECT_THAT(parse_error("a: &x 1\nb: *x\n"), testing::HasSubstr("anchors are not allowed"));
  EXPECT_THAT(parse_error("a: 1\n---\nb: 2\n"), testing::HasSubstr("second YAML document"));
  EXPECT_THAT(parse_error("? [1, 2]\n: 3\n"), testing::HasSubstr("a key is a list"));
  EXPECT_THAT(parse_error("- 1\n- 2\n"), testing::HasSubstr("the file is not a mapping"));
  EXPECT_THAT(parse_error("# nothing\n"), testing::HasSubstr("is empty"));
  EXPECT_THAT(parse_error(""), testing::HasSubstr("is empty"));
  EXPECT_THROW(parse(std::string(100000, '[')), InputError);
}

TEST(StrictYaml, ReadsKeysThatAreData) {
  const YamlMap map = parse("7: a\n-1: b\nx: c\n");
  EXPECT_EQ(map.keys(), (std::vector<std::string>{"7", "-1", "x"}));
  EXPECT_EQ(map.integer_key("7"), 7);
  EXPECT_THROW(map.integer_key("-1", {0, 10}), InputError);
  EXPECT_THROW(map.integer_key("x"), InputError);
}

TEST(StrictYaml, ReportsFilesThatCannotBeRead) {
  const ScratchFolder folder;
  const std::string missing = (folder.path() / "missing.yaml").string();
  EXPECT_EQ(input_error_line([&] { YamlMap::load(missing); }),
            missing +
                ": cannot be opened: No such file or directory; check the path and the "
                "permissions");
  EXPECT_EQ(input_error_line([&] { YamlMap::load(folder.path()); }),
            folder.path().string() + ": is a folder, not a file; name a file in it");
  const auto empty = folder.write("empty.yaml", "");
  EXPECT_EQ(input_error_line([&] { YamlMap::load(empty); }),
            empty.string() + ": is empty; write the keys into it");
}

TEST(StrictYaml, LoadsAFileWithByteOrderMarkAndWindowsLines) {
  const ScratchFolder folder;
  const auto file = folder.write("robot.yaml", "\xEF\xBB\xBFname: pair\r\ncount: 3\r\n");
  const YamlMap map = YamlMap::load(file);
  EXPECT_EQ(map.text("name"), "pair");
  EXPECT_EQ(map.integer("count"), 3);
}

TEST(StrictYaml, PlacesTheCallersErrorsAtTheKey) {
  const YamlMap map = parse("a: 1\n  \nbb: 2\n");
  EXPECT_EQ(map.error("bb", "is odd", "make it even").what(),
            std::string("robot.yaml:3:1: is odd; make it even"));
}

}  // namespace
}  // namespace nadir::vision
