#include "vision/input/csv_table.h"

#include <gtest/gtest.h>

#include "tests/vision/input_error_line.h"
#include "tests/vision/scratch_folder.h"

namespace nadir::vision {
namespace {

class CsvTableFile : public testing::Test {
 protected:
  CsvTable load(const std::string& text) const {
    return CsvTable::load(folder_.write("points.csv", text), {"u_px", "x_m"});
  }
  /// The error of `action` without the folder's name.
  template <typename Action>
  std::string error(const Action& action) const {
    const std::string line = input_error_line(action);
    const std::string prefix = folder_.path().string() + "/";
    return line.starts_with(prefix) ? line.substr(prefix.size()) : line;
  }
  std::string load_error(const std::string& text) const {
    return error([&] { load(text); });
  }

  ScratchFolder folder_;
};

TEST_F(CsvTableFile, FindsColumnsInAnyOrderAndLeavesOutOthers) {
  const CsvTable table = load("x_m,note,u_px\n# comment\n\n1.5, hello ,-2\r\n+3e-1,,7\n");
  ASSERT_EQ(table.rows(), 2U);
  EXPECT_DOUBLE_EQ(table.number(0, 0), -2.0);
  EXPECT_DOUBLE_EQ(table.number(0, 1), 1.5);
  EXPECT_DOUBLE_EQ(table.number(1, 1), 0.3);
  EXPECT_EQ(table.integer(1, 0), 7);
  EXPECT_EQ(table.line(0), 4);
  EXPECT_EQ(table.line(1), 5);
}

TEST_F(CsvTableFile, KeepsSixtyFourBitIntegersExactly) {
  const CsvTable table = load("u_px,x_m\n1700000000000000001,0\n");
  EXPECT_EQ(table.integer(0, 0), 1700000000000000001LL);
}

TEST_F(CsvTableFile, RefusesAHeaderThatLacksAColumn) {
  EXPECT_EQ(load_error("u_px,y_m\n1,2\n"),
            "points.csv:1:1: the header lacks the column 'x_m'; the first line must hold u_px,x_m");
  EXPECT_EQ(load_error("u_px,x_m,u_px\n1,2,3\n"),
            "points.csv:1:10: column 'u_px' stands twice; remove one of the two");
}

TEST_F(CsvTableFile, RefusesRowsOfTheWrongLength) {
  EXPECT_EQ(load_error("u_px,x_m\n1,2\n3\n"),
            "points.csv:3:1: the row has 1 cells; the header has 2");
  EXPECT_EQ(load_error("u_px,x_m\n1,2,3\n"),
            "points.csv:2:5: the row has 3 cells; the header has 2");
}

TEST_F(CsvTableFile, NamesTheCellThatIsNoNumber) {
  const CsvTable table = load("u_px,x_m\n1,2\n3, west\n1.5,nan\n");
  EXPECT_EQ(error([&] { table.number(1, 1); }),
            "points.csv:3:4: x_m is 'west'; write a finite number");
  EXPECT_EQ(error([&] { table.number(2, 1); }),
            "points.csv:4:5: x_m is 'nan'; write a finite number");
  EXPECT_EQ(error([&] { table.integer(2, 0); }),
            "points.csv:4:1: u_px is '1.5'; write a whole number");
}

TEST_F(CsvTableFile, RefusesFilesWithoutContent) {
  EXPECT_EQ(load_error(""), "points.csv: is empty; write a header line and rows");
  EXPECT_EQ(error([&] { CsvTable::load(folder_.path() / "none.csv", {"a"}); }),
            "none.csv: cannot be opened: No such file or directory; check the path and the "
            "permissions");
  EXPECT_EQ(load("u_px,x_m\n").rows(), 0U);
}

}  // namespace
}  // namespace nadir::vision
