#include "vision/input/strict_yaml.h"

#include <yaml-cpp/yaml.h>

#include <algorithm>
#include <climits>
#include <cmath>
#include <numeric>
#include <set>

#include "vision/input/number_text.h"
#include "vision/input/text_file.h"
#include "vision/input/yaml_structure.h"

namespace nadir::vision {

struct YamlMap::Content {
  YAML::Node node;
  std::string file;
  std::string path;             ///< "outer[2]" or "" for the whole file
  std::set<std::string> asked;  ///< keys that the caller knows
};

namespace {

InputPlace place_of(const std::string& file, const YAML::Mark& mark) {
  return {file, mark.line + 1, mark.column + 1};
}

std::string joined(const std::vector<std::string>& words) {
  std::string text;
  for (const std::string& word : words) text += (text.empty() ? "" : ", ") + word;
  return text;
}

/// Levenshtein distance: insertions, deletions and exchanges of one letter.
std::size_t edit_distance(const std::string& a, const std::string& b) {
  std::vector<std::size_t> row(b.size() + 1);
  std::iota(row.begin(), row.end(), std::size_t{0});
  for (std::size_t i = 0; i < a.size(); ++i) {
    std::size_t diagonal = row[0];
    row[0] = i + 1;
    for (std::size_t j = 0; j < b.size(); ++j) {
      const std::size_t exchange = diagonal + (a[i] == b[j] ? 0 : 1);
      diagonal = row[j + 1];
      row[j + 1] = std::min({row[j + 1] + 1, row[j] + 1, exchange});
    }
  }
  return row.back();
}

/// "did you mean 'x'?" where one known word is near, else the list of all.
std::string suggestion(const std::string& word, const std::vector<std::string>& known,
                       const std::string& list_title) {
  if (known.empty()) return "remove it";
  const auto nearest =
      std::min_element(known.begin(), known.end(), [&](const auto& a, const auto& b) {
        return edit_distance(word, a) < edit_distance(word, b);
      });
  const std::size_t near_enough = std::max<std::size_t>(2, word.size() / 3);
  if (edit_distance(word, *nearest) <= near_enough) return "did you mean '" + *nearest + "'?";
  return list_title + joined(known);
}

std::string range_text(const ValidRange& range) {
  const bool has_low = std::isfinite(range.low);
  const bool has_high = std::isfinite(range.high);
  if (has_low && has_high) {
    return "from " + text_from_number(range.low) + " to " + text_from_number(range.high);
  }
  if (has_low) return "at least " + text_from_number(range.low);
  if (has_high) return "at most " + text_from_number(range.high);
  return "any finite number";
}

/// One value with what is needed to complain about it.
struct NamedValue {
  const YAML::Node& node;
  const std::string& file;
  std::string name;

  [[noreturn]] void fail(const std::string& cause, const std::string& remedy) const {
    throw InputError(place_of(file, node.Mark()), cause, remedy);
  }
  [[noreturn]] void fail_type(const std::string& wanted) const {
    if (node.IsNull()) fail("'" + name + "' has no value", "write " + wanted);
    if (!node.IsScalar()) {
      fail("'" + name + "' is a " + (node.IsMap() ? "mapping" : "list"), "write " + wanted);
    }
    fail("'" + name + "' is '" + node.Scalar() + "'", "write " + wanted);
  }
  /// Quoted texts are texts even if they look like numbers.
  bool is_plain() const { return node.IsScalar() && node.Tag() != "!"; }

  void check_range(double number, const ValidRange& range) const {
    if (number >= range.low && number <= range.high) return;
    fail("'" + name + "' is " + node.Scalar() + ", out of range", "valid is " + range_text(range));
  }
  double number(const ValidRange& range) const {
    const auto number = is_plain() ? number_from_text(node.Scalar()) : std::nullopt;
    if (!number) fail_type("a finite number");
    check_range(*number, range);
    return *number;
  }
  int integer(const ValidRange& range) const {
    const auto number = is_plain() ? integer_from_text(node.Scalar()) : std::nullopt;
    if (!number) fail_type("a whole number");
    check_range(static_cast<double>(*number), range);
    check_range(static_cast<double>(*number), {INT_MIN, INT_MAX});
    return static_cast<int>(*number);
  }
  std::string text() const {
    if (!node.IsScalar()) fail_type("a text");
    return node.Scalar();
  }
};

}  // namespace

YamlMap::YamlMap(std::shared_ptr<Content> content) : content_(std::move(content)) {
  const YAML::Node& node = content_->node;
  if (node.IsMap()) return;
  const std::string subject = content_->path.empty() ? "the file" : "'" + content_->path + "'";
  throw InputError(place_of(content_->file, node.Mark()), subject + " is not a mapping",
                   "write 'key: value' lines");
}

YamlMap YamlMap::load(const std::filesystem::path& file) {
  return parse(read_text_file(file), file.string());
}

YamlMap YamlMap::parse(const std::string& text, const std::string& file_name) {
  check_yaml_structure(text, file_name);
  return YamlMap(std::make_shared<Content>(Content{YAML::Load(text), file_name, "", {}}));
}

bool YamlMap::has(const std::string& key) const {
  content_->asked.insert(key);
  const YAML::Node& node = content_->node;
  return std::any_of(node.begin(), node.end(),
                     [&key](const auto& entry) { return entry.first.Scalar() == key; });
}

YAML::Node YamlMap::value(const std::string& key) const {
  content_->asked.insert(key);
  for (const auto& entry : content_->node) {
    if (entry.first.Scalar() == key) return entry.second;
  }
  const std::string subject = content_->path.empty() ? "" : "'" + content_->path + "' ";
  throw InputError(place_of(content_->file, content_->node.Mark()),
                   subject + "lacks the key '" + key + "'", "add it");
}

double YamlMap::number(const std::string& key, ValidRange range) const {
  return NamedValue{value(key), content_->file, key}.number(range);
}

double YamlMap::number_or(const std::string& key, double fallback, ValidRange range) const {
  return has(key) ? number(key, range) : fallback;
}

int YamlMap::integer(const std::string& key, ValidRange range) const {
  return NamedValue{value(key), content_->file, key}.integer(range);
}

int YamlMap::integer_or(const std::string& key, int fallback, ValidRange range) const {
  return has(key) ? integer(key, range) : fallback;
}

bool YamlMap::boolean_or(const std::string& key, bool fallback) const {
  if (!has(key)) return fallback;
  const YAML::Node node = value(key);
  const NamedValue named{node, content_->file, key};
  if (named.is_plain() && node.Scalar() == "true") return true;
  if (named.is_plain() && node.Scalar() == "false") return false;
  named.fail_type("true or false");
}

std::string YamlMap::text(const std::string& key) const {
  return NamedValue{value(key), content_->file, key}.text();
}

std::string YamlMap::text_or(const std::string& key, const std::string& fallback) const {
  return has(key) ? text(key) : fallback;
}

std::string YamlMap::choice(const std::string& key, const std::vector<std::string>& choices) const {
  const YAML::Node node = value(key);
  const NamedValue named{node, content_->file, key};
  std::string word = named.text();
  if (std::find(choices.begin(), choices.end(), word) == choices.end()) {
    named.fail("'" + key + "' is '" + word + "'", suggestion(word, choices, "choose one of "));
  }
  return word;
}

std::string YamlMap::choice_or(const std::string& key, const std::string& fallback,
                               const std::vector<std::string>& choices) const {
  return has(key) ? choice(key, choices) : fallback;
}

std::vector<double> YamlMap::numbers(const std::string& key, std::size_t count,
                                     ValidRange range) const {
  const YAML::Node node = value(key);
  const NamedValue list{node, content_->file, key};
  if (!node.IsSequence()) list.fail_type("a list of numbers");
  if (count != 0 && node.size() != count) {
    list.fail("'" + key + "' has " + std::to_string(node.size()) + " numbers",
              "write " + std::to_string(count));
  }
  std::vector<double> numbers;
  for (const auto& element : node) {
    const std::string name = key + "[" + std::to_string(numbers.size()) + "]";
    numbers.push_back(NamedValue{element, content_->file, name}.number(range));
  }
  return numbers;
}

std::vector<std::string> YamlMap::texts(const std::string& key) const {
  const YAML::Node node = value(key);
  if (!node.IsSequence()) NamedValue{node, content_->file, key}.fail_type("a list of texts");
  std::vector<std::string> texts;
  for (const auto& element : node) {
    const std::string name = key + "[" + std::to_string(texts.size()) + "]";
    texts.push_back(NamedValue{element, content_->file, name}.text());
  }
  return texts;
}

YamlMap YamlMap::map(const std::string& key) const {
  const std::string path = content_->path.empty() ? key : content_->path + "." + key;
  return YamlMap(std::make_shared<Content>(Content{value(key), content_->file, path, {}}));
}

std::optional<YamlMap> YamlMap::map_if_present(const std::string& key) const {
  if (!has(key)) return std::nullopt;
  return map(key);
}

std::vector<YamlMap> YamlMap::maps(const std::string& key) const {
  const YAML::Node node = value(key);
  if (!node.IsSequence()) NamedValue{node, content_->file, key}.fail_type("a list of mappings");
  const std::string path = content_->path.empty() ? key : content_->path + "." + key;
  std::vector<YamlMap> maps;
  for (const auto& element : node) {
    const std::string name = path + "[" + std::to_string(maps.size()) + "]";
    maps.push_back(YamlMap(std::make_shared<Content>(Content{element, content_->file, name, {}})));
  }
  return maps;
}

std::vector<std::string> YamlMap::keys() const {
  std::vector<std::string> keys;
  for (const auto& entry : content_->node) keys.push_back(entry.first.Scalar());
  return keys;
}

int YamlMap::integer_key(const std::string& key, ValidRange range) const {
  for (const auto& entry : content_->node) {
    if (entry.first.Scalar() != key) continue;
    return NamedValue{entry.first, content_->file, key}.integer(range);
  }
  return NamedValue{value(key), content_->file, key}.integer(range);
}

void YamlMap::finish() const {
  for (const auto& entry : content_->node) {
    const std::string& key = entry.first.Scalar();
    if (content_->asked.contains(key)) continue;
    const std::vector<std::string> known(content_->asked.begin(), content_->asked.end());
    throw InputError(place_of(content_->file, entry.first.Mark()), "unknown key '" + key + "'",
                     suggestion(key, known, "known keys are "));
  }
}

InputError YamlMap::error(const std::string& key, const std::string& cause,
                          const std::string& remedy) const {
  YAML::Mark mark = content_->node.Mark();
  for (const auto& entry : content_->node) {
    if (entry.first.Scalar() == key) mark = entry.first.Mark();
  }
  return {place_of(content_->file, mark), cause, remedy};
}

const std::string& YamlMap::file() const { return content_->file; }

}  // namespace nadir::vision
