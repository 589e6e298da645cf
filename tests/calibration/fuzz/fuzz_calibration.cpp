// libFuzzer's entry: calibration files. See tests/calibration/fuzz/CMakeLists.txt.

#include <cstddef>
#include <cstdint>

#include "tests/calibration/fuzz/fuzzed_input.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  nadir::calibration::reads_calibration(std::string(reinterpret_cast<const char*>(data), size));
  return 0;
}
