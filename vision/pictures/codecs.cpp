#include "vision/pictures/codecs.h"

#include <dlfcn.h>

#include <stdexcept>

namespace nadir::vision {
namespace {

constexpr const char* kLibrary = "libnadir_codecs.so";  // found by the program's RUNPATH
constexpr const char* kEntry = "nadir_codecs";

const Codecs& loaded() {
  void* const library = dlopen(kLibrary, RTLD_NOW | RTLD_LOCAL);
  void* const entry = library == nullptr ? nullptr : dlsym(library, kEntry);
  if (entry == nullptr) {
    throw std::runtime_error(std::string("pictures cannot be read or written: ") + dlerror() +
                             "; build or install nadir again");
  }
  return *reinterpret_cast<const Codecs* (*)()>(entry)();
}

}  // namespace

const Codecs& codecs() {
  static const Codecs& those = loaded();
  return those;
}

}  // namespace nadir::vision
