#include "calibration/program/calibrate_commands.h"

#include <fstream>
#include <iostream>
#include <sstream>
#include <stdexcept>

#include "vision/input/input_error.h"

namespace nadir::calibration {

void write_text(const std::string& file, const std::string& text) {
  if (file == "-") {
    std::cout << text << std::flush;
    if (!std::cout) throw std::runtime_error("stdout cannot be written");
    return;
  }
  std::ofstream stream(file, std::ios::binary);
  stream << text << std::flush;
  if (!stream)
    throw vision::InputError({file}, "cannot be written", "check the folder and its rights");
}

CLI::Validator number_from_to(double low, double high) {
  return {[low, high](const std::string& text) -> std::string {
            double number = 0.0;
            const bool is_number = CLI::detail::lexical_cast(text, number);
            if (is_number && number >= low && number <= high) return "";
            std::ostringstream words;
            words << "'" << text << "' is not a number from " << low << " to " << high;
            return words.str();
          },
          ""};
}

}  // namespace nadir::calibration
