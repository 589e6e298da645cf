#include <dds/ddsi/ddsi_serdata.h>

#include <memory>
#include <stdexcept>

#include "tests/bench/dds_latency.h"
#include "tests/support/loopback_dds.h"
#include "tests/support/test_poses.h"
#include "tracker/wire/dds_entities.h"
#include "tracker/wire/pose_codec.h"

namespace nadir::bench {

std::size_t pose_payload_bytes() {
  using tracker::DdsEntity;
  const test::LoopbackDds dds;
  const DdsEntity participant =
      tracker::make_participant({.domain = dds.domain(), .partition = ""});
  const DdsEntity topic =
      tracker::make_topic(participant, nadir_wire_RobotPose_desc, "nadir/payload_size");
  const DdsEntity reader(dds_create_reader(participant.handle(), topic.handle(), nullptr, nullptr),
                         "reader");
  const DdsEntity writer(dds_create_writer(participant.handle(), topic.handle(), nullptr, nullptr),
                         "writer");
  const tracker::WirePose pose = test::test_pose(1, 0, 0);
  nadir_wire_RobotPose sample{};
  ddsi_serdata* serialized = nullptr;
  dds_sample_info_t info;
  if (!tracker::encode(pose, &sample) || dds_write(writer.handle(), &sample) != DDS_RETCODE_OK ||
      dds_takecdr(reader.handle(), &serialized, 1, &info, DDS_ANY_STATE) != 1) {
    throw std::runtime_error("cannot serialize a pose");
  }
  constexpr std::size_t kHeader = 4;
  const std::size_t size = ddsi_serdata_size(serialized) - kHeader;
  ddsi_serdata_unref(serialized);
  return size;
}

}  // namespace nadir::bench
