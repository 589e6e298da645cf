#include "vision/colour_file.h"

#include <string>
#include <vector>

#include "vision/input/strict_yaml.h"

namespace nadir::vision {

ColourClasses load_colour_classes(const std::filesystem::path& file) {
  ColourClasses classes = default_colour_classes();
  const YamlMap top = YamlMap::load(file);
  const YamlMap colours = top.map("colours");
  for (std::size_t i = 0; i < kColourNames.size(); ++i) {
    if (!colours.has(kColourNames[i])) continue;
    const std::vector<double> bgr = colours.numbers(kColourNames[i], 3, {0.0, 255.0});
    classes.typical[i] = {static_cast<float>(bgr[0]), static_cast<float>(bgr[1]),
                          static_cast<float>(bgr[2])};
  }
  colours.finish();
  top.finish();
  return classes;
}

}  // namespace nadir::vision
