#include "tracker/pose_log.h"

#include <cerrno>
#include <cmath>
#include <cstring>
#include <iterator>

#include "vision/input/input_error.h"

namespace nadir::tracker {
namespace {

using Out = std::back_insert_iterator<fmt::memory_buffer>;

template <typename... Values>
void put(fmt::memory_buffer& line, fmt::format_string<Values...> text, Values&&... values) {
  fmt::format_to(Out(line), text, std::forward<Values>(values)...);
}

void put_text(fmt::memory_buffer& line, std::string_view text) {
  line.push_back('"');
  for (const char c : text) {
    if (c == '"' || c == '\\') {
      put(line, "\\{}", c);
    } else if (static_cast<unsigned char>(c) < 0x20) {
      put(line, "\\u{:04x}", static_cast<unsigned>(c));
    } else {
      line.push_back(c);
    }
  }
  line.push_back('"');
}

void put_fixed(fmt::memory_buffer& line, const char* key, double value, int decimals) {
  if (std::isfinite(value)) {
    put(line, "\"{}\": {:.{}f}", key, value, decimals);
  } else {
    put(line, "\"{}\": null", key);
  }
}

void put_stages(fmt::memory_buffer& line, const StageTimes& stages) {
  put(line, "\"stages_us\": {{");
  put_fixed(line, "read", stages.read_us, 1);
  put(line, ", ");
  put_fixed(line, "detect", stages.detect_us, 1);
  put(line, ", ");
  put_fixed(line, "map", stages.map_us, 1);
  put(line, ", ");
  put_fixed(line, "total", stages.total_us, 1);
  put(line, "}}");
}

void put_covariance(fmt::memory_buffer& line, const fusion::PoseCovariance& covariance) {
  put(line, "\"covariance\": [");
  for (int row = 0; row < 3; ++row) {
    for (int column = 0; column < 3; ++column) {
      if (row + column > 0) put(line, ", ");
      const double value = covariance(row, column);
      if (std::isfinite(value)) {
        put(line, "{:.10g}", value);
      } else {
        put(line, "null");
      }
    }
  }
  put(line, "]");
}

void put_robot(fmt::memory_buffer& line, const RobotReport& robot) {
  put(line, "{{\"id\": {}, \"team\": ", robot.id);
  put_text(line, robot.team);
  put(line, ", ");
  put_fixed(line, "x_m", robot.pose_world_robot.x_m, 9);
  put(line, ", ");
  put_fixed(line, "y_m", robot.pose_world_robot.y_m, 9);
  put(line, ", ");
  put_fixed(line, "heading_rad", robot.pose_world_robot.heading_rad, 9);
  put(line, ", ");
  put_covariance(line, robot.covariance);
  put(line, ", ");
  put_fixed(line, "u_px", robot.centre_px.x(), 4);
  put(line, ", ");
  put_fixed(line, "v_px", robot.centre_px.y(), 4);
  put(line, ", \"pixels\": [");
  for (int i = 0; i < robot.marker_count; ++i) {
    if (i > 0) put(line, ", ");
    put(line, "{}", robot.pixels[static_cast<std::size_t>(i)]);
  }
  put(line, "], ");
  put_fixed(line, "confidence", robot.confidence, 4);
  put(line, ", \"aligned\": {}}}", robot.aligned);
}

void put_rejection(fmt::memory_buffer& line, const RejectionReport& rejection) {
  put(line, "{{");
  put_fixed(line, "u_px", rejection.centre_px.x(), 1);
  put(line, ", ");
  put_fixed(line, "v_px", rejection.centre_px.y(), 1);
  put(line, ", \"reason\": ");
  put_text(line, rejection.reason);
  put(line, "}}");
}

}  // namespace

void append_json(const FrameReport& report, fmt::memory_buffer& line) {
  put(line, "{{\"frame\": {}, \"camera\": ", report.frame);
  put_text(line, report.camera);
  put(line, ", \"capture_ns\": {}, ", report.capture_ns);
  put_stages(line, report.stages);
  put(line, ", \"robots\": [");
  for (std::size_t i = 0; i < report.robots.size(); ++i) {
    if (i > 0) put(line, ", ");
    put_robot(line, report.robots[i]);
  }
  put(line, "], \"rejected\": [");
  for (std::size_t i = 0; i < report.rejected.size(); ++i) {
    if (i > 0) put(line, ", ");
    put_rejection(line, report.rejected[i]);
  }
  put(line, "]");
  if (report.rejected_not_listed > 0)
    put(line, ", \"rejected_not_listed\": {}", report.rejected_not_listed);
  put(line, "}}");
}

PoseLog::PoseLog(const std::filesystem::path& file) {
  if (file == "-") {
    file_ = stdout;
    return;
  }
  file_ = std::fopen(file.c_str(), "w");
  owns_file_ = true;
  if (file_ == nullptr) {
    throw vision::InputError({file.string(), 0, 0},
                             std::string("cannot be written: ") + std::strerror(errno),
                             "name a file in a folder that exists and is writable");
  }
}

PoseLog::~PoseLog() {
  if (owns_file_) {
    std::fclose(file_);
  } else {
    std::fflush(file_);
  }
}

bool PoseLog::write(const FrameReport& report) {
  const std::lock_guard lock(mutex_);
  line_.clear();
  append_json(report, line_);
  line_.push_back('\n');
  return std::fwrite(line_.data(), 1, line_.size(), file_) == line_.size();
}

bool PoseLog::flush() {
  const std::lock_guard lock(mutex_);
  return std::fflush(file_) == 0;
}

}  // namespace nadir::tracker
