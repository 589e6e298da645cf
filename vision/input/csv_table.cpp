#include "vision/input/csv_table.h"

#include <algorithm>
#include <optional>
#include <sstream>
#include <string_view>

#include "vision/input/number_text.h"
#include "vision/input/text_file.h"

namespace nadir::vision {
namespace {

/// One cell and the column of the file, from 1, where it begins.
struct Cell {
  std::string text;
  int column = 1;
};

bool is_space(char letter) { return letter == ' ' || letter == '\t' || letter == '\r'; }

std::vector<Cell> split(const std::string& line) {
  std::vector<Cell> cells;
  std::size_t start = 0;
  while (true) {
    const std::size_t comma = std::min(line.find(',', start), line.size());
    std::size_t first = start;
    std::size_t last = comma;
    while (first < last && is_space(line[first])) ++first;
    while (last > first && is_space(line[last - 1])) --last;
    cells.push_back({line.substr(first, last - first), static_cast<int>(first) + 1});
    if (comma == line.size()) return cells;
    start = comma + 1;
  }
}

bool counts(const std::string& line) {
  const auto first = std::find_if_not(line.begin(), line.end(), is_space);
  return first != line.end() && *first != '#';
}

/// Where each wanted column stands in the header.
std::vector<std::size_t> find_columns(const std::vector<Cell>& header,
                                      const std::vector<std::string>& columns,
                                      const std::string& file, int line) {
  std::vector<std::size_t> places;
  for (const std::string& name : columns) {
    std::optional<std::size_t> found;
    for (std::size_t i = 0; i < header.size(); ++i) {
      if (header[i].text != name) continue;
      if (found) {
        throw InputError({file, line, header[i].column}, "column '" + name + "' stands twice",
                         "remove one of the two");
      }
      found = i;
    }
    if (!found) {
      std::string wanted;
      for (const std::string& column : columns) wanted += (wanted.empty() ? "" : ",") + column;
      throw InputError({file, line, 1}, "the header lacks the column '" + name + "'",
                       "the first line must hold " + wanted);
    }
    places.push_back(*found);
  }
  return places;
}

}  // namespace

CsvTable CsvTable::load(const std::filesystem::path& file,
                        const std::vector<std::string>& columns) {
  CsvTable table;
  table.file_ = file.string();
  table.columns_ = columns;
  std::istringstream stream(read_text_file(file));
  std::vector<std::size_t> places;
  std::size_t width = 0;
  int line_number = 0;
  for (std::string line; std::getline(stream, line);) {
    ++line_number;
    if (!counts(line)) continue;
    const std::vector<Cell> cells = split(line);
    if (width == 0) {
      places = find_columns(cells, columns, table.file_, line_number);
      width = cells.size();
      continue;
    }
    if (cells.size() != width) {
      throw InputError({table.file_, line_number, cells.back().column},
                       "the row has " + std::to_string(cells.size()) + " cells",
                       "the header has " + std::to_string(width));
    }
    table.lines_.push_back(line_number);
    std::vector<std::string>& texts = table.cells_.emplace_back();
    std::vector<int>& starts = table.cell_columns_.emplace_back();
    for (const std::size_t place : places) {
      texts.push_back(cells[place].text);
      starts.push_back(cells[place].column);
    }
  }
  if (width == 0) throw InputError({table.file_}, "is empty", "write a header line and rows");
  return table;
}

const std::string& CsvTable::text(std::size_t row, std::size_t column) const {
  return cells_.at(row).at(column);
}

double CsvTable::number(std::size_t row, std::size_t column) const {
  const std::optional<double> number = number_from_text(text(row, column));
  if (!number) {
    throw error(row, column, columns_[column] + " is '" + text(row, column) + "'",
                "write a finite number");
  }
  return *number;
}

long long CsvTable::integer(std::size_t row, std::size_t column) const {
  const std::optional<long long> number = integer_from_text(text(row, column));
  if (!number) {
    throw error(row, column, columns_[column] + " is '" + text(row, column) + "'",
                "write a whole number");
  }
  return *number;
}

InputError CsvTable::error(std::size_t row, std::size_t column, const std::string& cause,
                           const std::string& remedy) const {
  return {{file_, lines_.at(row), cell_columns_.at(row).at(column)}, cause, remedy};
}

}  // namespace nadir::vision
