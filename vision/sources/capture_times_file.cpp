#include "vision/sources/capture_times_file.h"

#include <fmt/format.h>

#include <optional>
#include <unordered_map>

#include "vision/input/csv_table.h"

namespace nadir::vision {
namespace {

constexpr std::size_t kFileColumn = 0;
constexpr std::size_t kTimeColumn = 1;

}  // namespace

std::vector<CaptureTime> load_capture_times(const std::filesystem::path& file,
                                            const std::vector<std::string>& names) {
  const CsvTable table = CsvTable::load(file, {"file", "capture_ns"});
  std::unordered_map<std::string, std::optional<std::size_t>> row_of;
  for (const std::string& name : names) row_of[name] = std::nullopt;
  for (std::size_t row = 0; row < table.rows(); ++row) {
    const std::string name = std::filesystem::path(table.text(row, kFileColumn)).filename();
    const auto entry = row_of.find(name);
    if (entry == row_of.end()) {
      throw table.error(row, kFileColumn, fmt::format("there is no image '{}'", name),
                        "restore the image or remove the row");
    }
    if (entry->second) {
      throw table.error(
          row, kFileColumn,
          fmt::format("'{}' again; it is already on line {}", name, table.line(*entry->second)),
          "remove one of the two");
    }
    entry->second = row;
  }
  std::vector<CaptureTime> times;
  times.reserve(names.size());
  for (const std::string& name : names) {
    const std::optional<std::size_t> row = row_of[name];
    if (!row) {
      throw InputError({file.string()}, fmt::format("has no row for the image '{}'", name),
                       "add the row or remove the image");
    }
    const CaptureTime time{std::chrono::nanoseconds(table.integer(*row, kTimeColumn))};
    if (!times.empty() && time <= times.back()) {
      throw table.error(*row, kTimeColumn,
                        fmt::format("'{}' was not taken after the image before it", name),
                        "name the images in the order of their capture times");
    }
    times.push_back(time);
  }
  return times;
}

}  // namespace nadir::vision
