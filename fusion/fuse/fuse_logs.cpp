#include "fusion/fuse/fuse_logs.h"

#include <cmath>
#include <limits>
#include <string>

#include "vision/input/csv_table.h"

namespace nadir::fusion {
namespace {

using vision::CsvTable;
using vision::InputError;

/// Time stamps are kept in nanoseconds, 64 bits.
constexpr double kLatest_s = 9e9;

double time_s(const CsvTable& table, std::size_t row, std::size_t column) {
  const double t_s = table.number(row, column);
  if (std::abs(t_s) <= kLatest_s) return t_s;
  throw table.error(row, column, "the time is " + table.text(row, column) + " s",
                    "write seconds, not milliseconds or nanoseconds");
}

/// A number that somebody measured: it may be nan or inf.
double measured(const CsvTable& table, std::size_t row, std::size_t column) {
  std::string word = table.text(row, column);
  for (char& letter : word) {
    if (letter >= 'A' && letter <= 'Z') letter = static_cast<char>(letter - 'A' + 'a');
  }
  const bool is_negative = word.starts_with('-');
  if (is_negative || word.starts_with('+')) word.erase(0, 1);
  if (word == "nan") return std::numeric_limits<double>::quiet_NaN();
  if (word == "inf" || word == "infinity") {
    const double infinity = std::numeric_limits<double>::infinity();
    return is_negative ? -infinity : infinity;
  }
  return table.number(row, column);
}

BodyRates measured_rates(const CsvTable& table, std::size_t row, std::size_t first_column) {
  return {measured(table, row, first_column), measured(table, row, first_column + 1),
          measured(table, row, first_column + 2)};
}

void expect_rows(const CsvTable& table, const std::filesystem::path& file) {
  if (table.rows() == 0) {
    throw InputError({file.string()}, "holds no rows", "a row a sample below the header line");
  }
}

/// Column 0 of the row must not be before that of the row above.
void expect_order(const CsvTable& table, std::size_t row, double t_s, double above_s) {
  if (t_s >= above_s) return;
  throw table.error(row, 0, "t_s " + table.text(row, 0) + " is before that of the row above",
                    "sort the rows by time");
}

}  // namespace

std::vector<OdometryRow> load_odometry(const std::filesystem::path& file) {
  const CsvTable table = CsvTable::load(file, {"t_s", "u_mps", "v_mps", "r_radps"});
  expect_rows(table, file);
  std::vector<OdometryRow> rows;
  for (std::size_t i = 0; i < table.rows(); ++i) {
    rows.push_back({time_s(table, i, 0), measured_rates(table, i, 1), table.line(i)});
  }
  return rows;
}

std::vector<VisionRow> load_vision(const std::filesystem::path& file) {
  const CsvTable table =
      CsvTable::load(file, {"t_capture_s", "t_arrival_s", "x_m", "y_m", "heading_rad", "var_x_m2",
                            "var_y_m2", "var_heading_rad2"});
  std::vector<VisionRow> rows;
  for (std::size_t i = 0; i < table.rows(); ++i) {
    VisionRow row;
    row.t_capture_s = time_s(table, i, 0);
    row.t_arrival_s = time_s(table, i, 1);
    row.pose = {measured(table, i, 2), measured(table, i, 3), measured(table, i, 4)};
    row.var_x_m2 = measured(table, i, 5);
    row.var_y_m2 = measured(table, i, 6);
    row.var_heading_rad2 = measured(table, i, 7);
    row.line = table.line(i);
    if (!rows.empty() && row.t_arrival_s < rows.back().t_arrival_s) {
      throw table.error(i, 1,
                        "t_arrival_s " + table.text(i, 1) + " is before that of the row above",
                        "sort the rows by t_arrival_s");
    }
    rows.push_back(row);
  }
  return rows;
}

std::vector<TruthRow> load_truth(const std::filesystem::path& file) {
  const CsvTable table = CsvTable::load(file, {"t_s", "x_m", "y_m", "heading_rad"});
  expect_rows(table, file);
  std::vector<TruthRow> rows;
  for (std::size_t i = 0; i < table.rows(); ++i) {
    const double t_s = time_s(table, i, 0);
    if (!rows.empty()) expect_order(table, i, t_s, rows.back().t_s);
    rows.push_back({t_s, {table.number(i, 1), table.number(i, 2), table.number(i, 3)}});
  }
  return rows;
}

std::vector<NominalRow> load_nominal(const std::filesystem::path& file) {
  const CsvTable table = CsvTable::load(file, {"t_s", "heading_rad", "u_mps", "v_mps", "r_radps"});
  expect_rows(table, file);
  std::vector<NominalRow> rows;
  for (std::size_t i = 0; i < table.rows(); ++i) {
    const double t_s = time_s(table, i, 0);
    if (!rows.empty()) expect_order(table, i, t_s, rows.back().t_s);
    rows.push_back(
        {t_s, table.number(i, 1), {table.number(i, 2), table.number(i, 3), table.number(i, 4)}});
  }
  return rows;
}

}  // namespace nadir::fusion
