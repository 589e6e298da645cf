#include "calibration/program/calibrate_commands.h"

#include <sstream>

namespace nadir::calibration {

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
