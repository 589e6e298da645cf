#pragma once

#include <filesystem>
#include <limits>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "vision/input/input_error.h"

namespace YAML {
class Node;
}

namespace nadir::vision {

/// Closed interval of valid values.
struct ValidRange {
  double low = -std::numeric_limits<double>::infinity();
  double high = std::numeric_limits<double>::infinity();
};

/// One mapping of a YAML file, read strictly: every key must be asked for once, every value must
/// have the right type and lie in its range. Anything else throws InputError with file:line:column
/// and the nearest known key.
///
///     YamlMap map = YamlMap::load("robot.yaml");
///     const double height_m = map.number("height_m", {0.0, 1.0});
///     map.finish();   // throws on a key that nobody asked for
class YamlMap {
 public:
  /// Reads a file. Throws InputError if it is missing, is not YAML, is not a mapping or has a key
  /// twice (at any depth).
  static YamlMap load(const std::filesystem::path& file);
  /// The same from memory; `file_name` is for messages.
  static YamlMap parse(const std::string& text, const std::string& file_name);

  bool has(const std::string& key) const;

  double number(const std::string& key, ValidRange range = {}) const;
  double number_or(const std::string& key, double fallback, ValidRange range = {}) const;
  int integer(const std::string& key, ValidRange range = {}) const;
  int integer_or(const std::string& key, int fallback, ValidRange range = {}) const;
  bool boolean_or(const std::string& key, bool fallback) const;
  std::string text(const std::string& key) const;
  std::string text_or(const std::string& key, const std::string& fallback) const;
  /// A text that must be one of `choices`.
  std::string choice(const std::string& key, const std::vector<std::string>& choices) const;
  std::string choice_or(const std::string& key, const std::string& fallback,
                        const std::vector<std::string>& choices) const;
  /// A list of numbers; `count` 0 allows any length.
  std::vector<double> numbers(const std::string& key, std::size_t count = 0,
                              ValidRange range = {}) const;
  std::vector<std::string> texts(const std::string& key) const;
  YamlMap map(const std::string& key) const;
  std::optional<YamlMap> map_if_present(const std::string& key) const;
  std::vector<YamlMap> maps(const std::string& key) const;
  /// The keys in the order of the file, for mappings whose keys are data (team names, ids).
  std::vector<std::string> keys() const;
  /// A data key that must be a whole number.
  int integer_key(const std::string& key, ValidRange range = {}) const;

  /// Throws on the first key that nobody asked for, and names the nearest one that exists.
  void finish() const;

  /// An error at this key (or at the mapping, if the key is absent), for rules of the caller.
  InputError error(const std::string& key, const std::string& cause,
                   const std::string& remedy) const;
  const std::string& file() const;

 private:
  struct Content;
  explicit YamlMap(std::shared_ptr<Content> content);
  YAML::Node value(const std::string& key) const;

  std::shared_ptr<Content> content_;
};

}  // namespace nadir::vision
