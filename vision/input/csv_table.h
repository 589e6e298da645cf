#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "vision/input/input_error.h"

namespace nadir::vision {

/// A comma separated file with one header line. Lines that are empty or start with '#' do not
/// count.
class CsvTable {
 public:
  /// Reads the file; the header must hold every name of `columns` (in any order; further columns
  /// are allowed and left out). Throws InputError with file:line:column on a missing file, an
  /// absent column or a short row.
  static CsvTable load(const std::filesystem::path& file, const std::vector<std::string>& columns);

  std::size_t rows() const { return lines_.size(); }
  /// Line of the file, from 1, on which a row stands.
  int line(std::size_t row) const { return lines_[row]; }
  /// `column` is an index into the `columns` that load was given.
  const std::string& text(std::size_t row, std::size_t column) const;
  /// A finite number, else InputError.
  double number(std::size_t row, std::size_t column) const;
  /// A whole number that fits 64 bits, else InputError.
  long long integer(std::size_t row, std::size_t column) const;

  InputError error(std::size_t row, std::size_t column, const std::string& cause,
                   const std::string& remedy) const;

 private:
  std::string file_;
  std::vector<std::string> columns_;
  std::vector<int> lines_;
  std::vector<std::vector<std::string>> cells_;
  std::vector<std::vector<int>> cell_columns_;
};

}  // namespace nadir::vision
