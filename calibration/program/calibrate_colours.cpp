// nadir-calibrate colours: how the layout's colours look to this camera in this light.

#include <algorithm>
#include <iostream>
#include <memory>
#include <optional>
#include <vector>

#include "calibration/calibration_file.h"
#include "calibration/colours/colours_picture.h"
#include "calibration/colours/colours_statistics.h"
#include "calibration/colours/colours_text.h"
#include "calibration/program/calibrate_colours_search.h"
#include "calibration/program/calibrate_commands.h"
#include "calibration/program/calibrate_pictures.h"
#include "vision/input/input_error.h"
#include "vision/input/text_file.h"

namespace nadir::calibration {
namespace {

using vision::InputError;

struct ColoursOptions {
  std::vector<std::string> images;
  std::string layout;
  std::string output;
  std::string calibration;
  std::string picture;
  std::string json;
};

std::vector<cv::Mat> load_images(const std::vector<std::string>& files) {
  std::vector<cv::Mat> images;
  for (const std::string& file : files) {
    images.push_back(load_picture(file));
    if (images.back().size() == images.front().size()) continue;
    throw InputError({file}, "has another size than " + files.front(),
                     "give pictures of one camera at a time");
  }
  return images;
}

std::optional<vision::PixelScaleGrid> scale_of(const std::string& file, const cv::Size& size) {
  if (file.empty()) return std::nullopt;
  const Calibration calibration = load_calibration(file);
  check_image_size(calibration, file, size.width, size.height);
  return vision::PixelScaleGrid(size.width, size.height, [&](const vision::PixelPoint& pixel) {
    return calibration.map.jacobian_m_per_px(pixel);
  });
}

void draw(const ColoursOptions& options, const std::vector<cv::Mat>& images,
          const vision::MarkerLayout& layout, const vision::ColourClasses& classes,
          const ColourSearchResult& found) {
  const auto most = std::max_element(
      found.frames.begin(), found.frames.end(),
      [](const auto& a, const auto& b) { return a.robots.size() < b.robots.size(); });
  write_picture(
      options.picture,
      classified_picture(images[static_cast<std::size_t>(most - found.frames.begin())],
                         colours_of(layout), classes, mean_surroundings(found.samples), *most));
}

void run(const ColoursOptions& options) {
  if (options.output == "-" && options.json == "-") {
    throw InputError({}, "-o and --json both want stdout", "give one of them a file");
  }
  const vision::MarkerLayout layout = vision::load_disc_layout(options.layout);
  const std::vector<cv::Mat> images = load_images(options.images);
  const std::string origin =
      options.images.size() == 1
          ? options.images.front()
          : options.images.front() + " and " + std::to_string(images.size() - 1) + " more";
  const ColourSearchResult found =
      search_colours(images, layout, scale_of(options.calibration, images.front().size()), origin);
  const ColourStudy study = study_colours(found.samples);
  const vision::ColourClasses classes = classes_from(study);
  const RobotCounts counts{static_cast<int>(images.size()), found.robots, found.robots_by_default};
  vision::write_text_file(options.output, colours_yaml(study, classes, origin));
  if (!options.picture.empty()) draw(options, images, layout, classes, found);
  if (!options.json.empty())
    vision::write_text_file(options.json, colours_json(study, classes, counts));
  std::cerr << colours_summary(study, counts);
}

}  // namespace

void add_colours_command(CLI::App& app) {
  const auto options = std::make_shared<ColoursOptions>();
  CLI::App* command =
      app.add_subcommand("colours", "measures how the robots' colours look to a camera");
  command->add_option("images", options->images, "pictures with robots, all of one camera")
      ->required();
  command->add_option("--layout", options->layout, "the robots' layout file")->required();
  command->add_option("-o,--output", options->output, "colour file to write; - is stdout")
      ->required();
  command->add_option("--calibration", options->calibration,
                      "the camera's calibration; without it the robots' size in the picture is "
                      "searched for");
  command->add_option("--picture", options->picture,
                      "PNG or JPEG of the picture with most robots, classified");
  command->add_option("--json", options->json, "statistics and margins as JSON; - is stdout");
  command->footer(
      "Example: nadir-calibrate colours frames/*.png --layout data/layouts/league.yaml -o "
      "colours.yaml\n"
      "Then: nadir-tracker --colours colours.yaml ...");
  command->callback([options] { run(*options); });
}

}  // namespace nadir::calibration
