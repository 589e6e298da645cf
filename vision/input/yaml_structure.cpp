#include "vision/input/yaml_structure.h"

#include <yaml-cpp/eventhandler.h>
#include <yaml-cpp/yaml.h>

#include <map>
#include <sstream>
#include <vector>

#include "vision/input/input_error.h"

namespace nadir::vision {
namespace {

/// Follows the parser's events with a stack of open collections.
class StructureCheck final : public YAML::EventHandler {
 public:
  explicit StructureCheck(std::string file_name) : file_name_(std::move(file_name)) {}

  void OnDocumentStart(const YAML::Mark& mark) override {
    if (++documents_ > 1) fail(mark, "a second YAML document begins", "keep one document a file");
  }
  void OnDocumentEnd() override {}
  void OnNull(const YAML::Mark& mark, YAML::anchor_t anchor) override {
    refuse_anchor(mark, anchor);
    if (expects_key()) fail(mark, "a key is empty", "write a name before the colon");
    value_done();
  }
  void OnAlias(const YAML::Mark& mark, YAML::anchor_t) override {
    fail(mark, "aliases are not allowed", "write the value out");
  }
  void OnScalar(const YAML::Mark& mark, const std::string& /*tag*/, YAML::anchor_t anchor,
                const std::string& value) override {
    refuse_anchor(mark, anchor);
    if (!expects_key()) {
      value_done();
      return;
    }
    Collection& mapping = open_.back();
    const auto [known, is_new] = mapping.key_lines.emplace(value, mark.line + 1);
    if (!is_new) {
      fail(mark,
           "key '" + value + "' again; it is already on line " + std::to_string(known->second),
           "remove one of the two");
    }
    mapping.key_is_read = true;
  }
  void OnSequenceStart(const YAML::Mark& mark, const std::string& /*tag*/, YAML::anchor_t anchor,
                       YAML::EmitterStyle::value /*style*/) override {
    start(mark, anchor, false);
  }
  void OnSequenceEnd() override { end(); }
  void OnMapStart(const YAML::Mark& mark, const std::string& /*tag*/, YAML::anchor_t anchor,
                  YAML::EmitterStyle::value /*style*/) override {
    start(mark, anchor, true);
  }
  void OnMapEnd() override { end(); }

  int documents() const { return documents_; }

 private:
  struct Collection {
    bool is_map = false;
    bool key_is_read = false;
    std::map<std::string, int> key_lines;
  };

  bool expects_key() const {
    return !open_.empty() && open_.back().is_map && !open_.back().key_is_read;
  }
  void value_done() {
    if (!open_.empty()) open_.back().key_is_read = false;
  }
  void start(const YAML::Mark& mark, YAML::anchor_t anchor, bool is_map) {
    refuse_anchor(mark, anchor);
    if (expects_key()) fail(mark, "a key is a list or a mapping", "keys are plain texts");
    open_.push_back({is_map, false, {}});
  }
  void end() {
    open_.pop_back();
    value_done();
  }
  void refuse_anchor(const YAML::Mark& mark, YAML::anchor_t anchor) const {
    if (anchor != 0) fail(mark, "anchors are not allowed", "write the value out where it is used");
  }
  [[noreturn]] void fail(const YAML::Mark& mark, const std::string& cause,
                         const std::string& remedy) const {
    throw InputError({file_name_, mark.line + 1, mark.column + 1}, cause, remedy);
  }

  std::string file_name_;
  std::vector<Collection> open_;
  int documents_ = 0;
};

}  // namespace

void check_yaml_structure(const std::string& text, const std::string& file_name) {
  std::istringstream stream(text);
  StructureCheck check(file_name);
  try {
    YAML::Parser parser(stream);
    while (parser.HandleNextDocument(check)) {
    }
  } catch (const YAML::Exception& error) {
    throw InputError({file_name, error.mark.line + 1, error.mark.column + 1},
                     "not valid YAML: " + error.msg, "correct the syntax");
  }
  if (check.documents() == 0) throw InputError({file_name}, "is empty", "write the keys into it");
}

}  // namespace nadir::vision
