#include <gtest/gtest.h>

#include <algorithm>
#include <string>
#include <thread>
#include <vector>

#include "tests/support/test_poses.h"
#include "tracker/wire/bounded_queue.h"
#include "tracker/wire/instance_ledger.h"

namespace nadir::tracker {
namespace {

using std::chrono::milliseconds;

TEST(BoundedQueue, HandsOverInOrder) {
  BoundedQueue<std::string> queue(4);
  for (std::string text : {"a", "b", "c"}) queue.push(&text);
  std::string out;
  for (const char* expected : {"a", "b", "c"}) {
    ASSERT_TRUE(queue.pop(&out, milliseconds(0)));
    EXPECT_EQ(out, expected);
  }
  EXPECT_FALSE(queue.pop(&out, milliseconds(1)));
  EXPECT_EQ(queue.dropped(), 0U);
}

TEST(BoundedQueue, DropsTheOldestAndCounts) {
  BoundedQueue<int> queue(3);
  for (int i = 0; i < 10; ++i) {
    int value = i;
    queue.push(&value);
  }
  EXPECT_EQ(queue.dropped(), 7U);
  int out = -1;
  for (const int expected : {7, 8, 9}) {
    ASSERT_TRUE(queue.pop(&out, milliseconds(0)));
    EXPECT_EQ(out, expected);
  }
}

TEST(BoundedQueue, WakesAWaitingReader) {
  BoundedQueue<int> queue(1);
  std::thread writer([&queue] {
    int value = 42;
    queue.push(&value);
  });
  int out = 0;
  EXPECT_TRUE(queue.pop(&out, std::chrono::seconds(20)));
  EXPECT_EQ(out, 42);
  writer.join();
}

TEST(InstanceLedger, RetiresOnlyWhatWasNotSeen) {
  InstanceLedger ledger;
  const auto blue = test::test_pose(1, 0, 0);
  const auto yellow = test::test_pose(1, 0, 1);
  auto other_camera = blue;
  other_camera.camera = "cam1";
  ledger.touch(blue, 100);
  ledger.touch(yellow, 100);
  ledger.touch(other_camera, 100);
  ledger.touch(blue, 200);
  ASSERT_EQ(ledger.size(), 3U);
  std::vector<std::string> retired;
  const auto note = [&retired](const InstanceLedger::Instance& gone) {
    retired.push_back(gone.team + " " + gone.camera + " " + std::to_string(gone.robot));
  };
  ledger.retire_older(100, note);
  EXPECT_TRUE(retired.empty());
  ledger.retire_older(150, note);
  std::sort(retired.begin(), retired.end());
  EXPECT_EQ(retired, (std::vector<std::string>{"blue cam1 0", "yellow cam0 1"}));
  EXPECT_EQ(ledger.size(), 1U);
}

}  // namespace
}  // namespace nadir::tracker
