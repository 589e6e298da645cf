#include "tests/bench/json_file.h"

#include <fstream>
#include <nlohmann/json.hpp>
#include <stdexcept>

namespace nadir::bench {

void write_json_file(const nlohmann::json& figures, const std::string& file) {
  if (file.empty()) return;
  std::ofstream out(file);
  out << figures.dump(1) << '\n';
  if (!out.flush()) throw std::runtime_error("cannot write " + file);
}

}  // namespace nadir::bench
