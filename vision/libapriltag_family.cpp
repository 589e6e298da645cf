#include "vision/libapriltag_family.h"

#include <apriltag/tag16h5.h>
#include <apriltag/tag25h9.h>
#include <apriltag/tag36h11.h>
#include <apriltag/tagStandard41h12.h>

#include <array>

#include "vision/tag_family.h"

namespace nadir::vision {
namespace {

struct Maker {
  apriltag_family_t* (*create)();
  void (*destroy)(apriltag_family_t*);
};

// In the order of kTagFamilies.
constexpr std::array<Maker, kTagFamilies.size()> kMakers = {{
    {tag36h11_create, tag36h11_destroy},
    {tag25h9_create, tag25h9_destroy},
    {tag16h5_create, tag16h5_destroy},
    {tagStandard41h12_create, tagStandard41h12_destroy},
}};

}  // namespace

LibraryFamily library_family(int family) {
  const Maker& maker = kMakers.at(static_cast<std::size_t>(family));
  return {maker.create(), maker.destroy};
}

}  // namespace nadir::vision
