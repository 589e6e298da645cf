#include "calibration/model_kind.h"

namespace nadir::calibration {
namespace {

struct ModelFacts {
  const char* name;
  int order;  // of a polynomial, else 0
  int parameters;
};

/// In the order of ModelKind.
constexpr std::array<ModelFacts, 7> kFacts = {{{"polynomial2", 2, 12},
                                               {"homography", 0, 8},
                                               {"radial", 0, 9},
                                               {"radial2", 0, 12},
                                               {"polynomial3", 3, 20},
                                               {"polynomial4", 4, 30},
                                               {"polynomial5", 5, 42}}};

const ModelFacts& facts(ModelKind model) { return kFacts.at(static_cast<std::size_t>(model)); }

}  // namespace

const char* model_name(ModelKind model) { return facts(model).name; }

std::optional<ModelKind> model_from_name(std::string_view name) {
  for (const ModelKind model : kAllModels) {
    if (name == model_name(model)) return model;
  }
  return std::nullopt;
}

int parameter_count(ModelKind model) { return facts(model).parameters; }

int polynomial_order(ModelKind model) { return facts(model).order; }

int least_points(ModelKind model) { return (parameter_count(model) + 1) / 2; }

}  // namespace nadir::calibration
