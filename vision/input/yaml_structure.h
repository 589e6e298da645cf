#pragma once

#include <string>

namespace nadir::vision {

/// Refuses what a YAML parser lets pass but a configuration must not contain: a key twice in one
/// mapping (at any depth), keys that are not plain texts, anchors and aliases, more than one
/// document, no document at all. Throws InputError, also for syntax errors.
void check_yaml_structure(const std::string& text, const std::string& file_name);

}  // namespace nadir::vision
