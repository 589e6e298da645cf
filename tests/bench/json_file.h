#pragma once

#include <nlohmann/json_fwd.hpp>
#include <string>

namespace nadir::bench {

/// Writes a benchmark's figures; nothing if `file` is empty. Throws std::runtime_error if it cannot
/// be written.
void write_json_file(const nlohmann::json& figures, const std::string& file);

}  // namespace nadir::bench
