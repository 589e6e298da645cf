#pragma once

#include <cstdint>
#include <functional>
#include <string>

namespace nadir::control_client {

/// What an experiment found, in the forms in which nadir-client hands it out.
struct StudyResult {
  std::string text;  ///< a table for people
  std::string json;  ///< all figures: metres, radians, seconds
  std::string svg;   ///< the first runs as one figure that needs nothing else
};

/// How often it is run, from which seed on, and who hears of the cases that are done.
struct StudyRuns {
  std::uint64_t first_seed = 0;
  int runs = 1;
  std::function<void(std::size_t done, std::size_t cases)> progress;
};

/// An experiment of another robot than the omnidirectional one (experiment_catalogue.h): it brings
/// its own plant, controller and estimators along.
struct Study {
  std::string name;
  std::string description;  ///< one line
  std::uint64_t first_seed = 0;
  int runs = 20;
  std::function<StudyResult(const StudyRuns&)> run;
};

}  // namespace nadir::control_client
