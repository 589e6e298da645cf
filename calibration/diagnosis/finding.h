#pragma once

#include <algorithm>
#include <string>
#include <vector>

namespace nadir::calibration {

/// How much a calibration is to be trusted. kFail: the points are wrong, the map would mislead.
enum class Grade { kPass, kWarn, kFail };

/// "PASS", "WARN", "FAIL".
inline const char* grade_name(Grade grade) {
  return grade == Grade::kPass ? "PASS" : grade == Grade::kWarn ? "WARN" : "FAIL";
}

/// One thing that a person should know of a calibration. A finding of grade kPass is a remark.
struct Finding {
  Grade grade = Grade::kPass;
  std::string kind;        ///< "typing error", "swapped points", "mirrored", ...: for programs
  std::vector<int> lines;  ///< of the points file; empty where it concerns all points
  std::string text;        ///< one sentence or two, for people
};

/// The gravest.
inline Grade grade_of(const std::vector<Finding>& findings) {
  Grade grade = Grade::kPass;
  for (const Finding& finding : findings) grade = std::max(grade, finding.grade);
  return grade;
}

}  // namespace nadir::calibration
