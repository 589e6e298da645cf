#include "vision/input/input_error.h"

#include <utility>

namespace nadir::vision {
namespace {

std::string one_line(const InputPlace& place, const std::string& cause, const std::string& remedy) {
  std::string text = place.file;
  if (place.line > 0) text += ":" + std::to_string(place.line);
  if (place.line > 0 && place.column > 0) text += ":" + std::to_string(place.column);
  if (!text.empty()) text += ": ";
  text += cause;
  if (!remedy.empty()) text += "; " + remedy;
  return text;
}

}  // namespace

InputError::InputError(InputPlace place, const std::string& cause, const std::string& remedy)
    : std::runtime_error(one_line(place, cause, remedy)), place_(std::move(place)) {}

}  // namespace nadir::vision
