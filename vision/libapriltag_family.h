#pragma once

#include <apriltag/apriltag.h>

#include <memory>

namespace nadir::vision {

/// One of libapriltag's families, which it creates and destroys each with a function of its own.
using LibraryFamily = std::unique_ptr<apriltag_family_t, void (*)(apriltag_family_t*)>;

/// `family` is an index into kTagFamilies; throws std::out_of_range for others.
LibraryFamily library_family(int family);

}  // namespace nadir::vision
