#pragma once

#include <string>

#include "vision/input/input_error.h"

namespace nadir::vision {

/// The line that a person reads when `action` refuses its input.
template <typename Action>
std::string input_error_line(const Action& action) {
  try {
    action();
  } catch (const InputError& error) {
    return error.what();
  }
  return "no InputError was thrown";
}

}  // namespace nadir::vision
