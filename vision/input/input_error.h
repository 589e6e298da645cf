#pragma once

#include <stdexcept>
#include <string>

namespace nadir::vision {

/// Where in a file something is wrong. Lines and columns count from 1; 0 means unknown or the whole
/// file.
struct InputPlace {
  std::string file;
  int line = 0;
  int column = 0;
};

/// Bad input at the edge: a file, a configuration, a message. what() is the one line that a person
/// needs: `file:line:column: what is wrong; what to do`. Executables print it and exit with 2.
class InputError : public std::runtime_error {
 public:
  InputError(InputPlace place, const std::string& cause, const std::string& remedy);

  const InputPlace& place() const { return place_; }

 private:
  InputPlace place_;
};

}  // namespace nadir::vision
