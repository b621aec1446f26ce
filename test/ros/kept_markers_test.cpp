#include <gtest/gtest.h>

#include "src/ros/inputs/marker_input.hpp"
#include "test/ros/marker_messages.hpp"

namespace fiber_proximity_ros {
namespace {

using namespace marker_test;  // NOLINT(google-build-using-namespace)

/// Messages one after another.
class KeptMarkers : public ::testing::Test {
 protected:
  /// Takes a message at a time.
  ReadResult take(double time, const MarkerArray& message) {
    const ReadResult result = input_.read(parts_of(message), ros::Time(time), buffer_);
    input_.keep();
    return result;
  }

  static MarkerArray one(const std::string& ns, double x, double stamp = 0.0) {
    MarkerArray message;
    message.markers = {strip_of(ns, chain(x))};
    message.markers[0].header.stamp = ros::Time(stamp);
    return message;
  }

  static MarkerArray deletion(std::int32_t action, const std::string& ns = "") {
    MarkerArray message;
    message.markers.resize(1);
    message.markers[0].action = static_cast<std::uint8_t>(action);
    message.markers[0].ns = ns;
    return message;
  }

  std::vector<double> places() const {
    std::vector<double> places;
    for (std::size_t i = 0; i + 1 < buffer_.offsets.size(); ++i) {
      places.push_back(buffer_.points[buffer_.offsets[i]].x());
    }
    return places;
  }

  static MarkerInputOptions options() {
    MarkerInputOptions options;
    options.name = "cable";
    options.timeout = 1.0;
    return options;
  }

  using Places = std::vector<double>;
  MarkerInput input_{options()};
  FiberBuffer buffer_;
};

TEST_F(KeptMarkers, EachCableMayComeInAMessageOfItsOwn) {
  take(1.0, one("a", 0.0, 1.0));
  EXPECT_EQ(places(), Places{0.0});
  EXPECT_EQ(buffer_.names, std::vector<std::string>{"cable"});
  EXPECT_TRUE(take(1.1, one("b", 5.0, 1.0)).is_news) << "though its stamp is the same";
  EXPECT_EQ(places(), (Places{0.0, 5.0}));
  EXPECT_EQ(buffer_.names, (std::vector<std::string>{"cable/a", "cable/b"}));
  EXPECT_TRUE(take(1.2, one("a", 1.0, 1.1)).is_news);
  EXPECT_EQ(places(), (Places{1.0, 5.0}));
  EXPECT_FALSE(take(1.3, one("a", 1.0, 1.1)).is_news) << "a tracker that has frozen";
}

TEST_F(KeptMarkers, DeletionsAreThoseOfRviz) {
  take(1.0, one("a", 0.0));
  take(1.0, one("b", 5.0));
  EXPECT_TRUE(take(1.1, deletion(Marker::DELETE, "a")).is_news);
  EXPECT_EQ(places(), Places{5.0});
  EXPECT_FALSE(take(1.1, deletion(Marker::DELETE, "a")).is_news) << "it is gone already";
  take(1.2, one("a", 1.0));
  EXPECT_EQ(places(), (Places{1.0, 5.0}));
  const ReadResult all = take(1.3, deletion(Marker::DELETEALL));
  EXPECT_TRUE(all.is_for_input);
  EXPECT_TRUE(all.is_news);
  EXPECT_EQ(places(), Places{});
  EXPECT_EQ(all.missing, "") << "the tracker has said so";
  EXPECT_EQ(buffer_.header.frame_id, "map");
  take(1.4, one("b", 2.0));
  EXPECT_EQ(places(), Places{2.0});
}

TEST_F(KeptMarkers, TheStampNeverGoesBackByADeletion) {
  take(1.0, one("a", 0.0, 10.0));
  take(1.0, one("b", 5.0, 12.0));
  EXPECT_EQ(buffer_.header.stamp, ros::Time(12.0));
  MarkerArray late = deletion(Marker::DELETE, "c");
  late.markers[0].header.stamp = ros::Time(11.0);
  take(1.05, late);
  EXPECT_EQ(buffer_.header.stamp, ros::Time(12.0)) << "though the deletion is of 11";
  MarkerArray gone = deletion(Marker::DELETE, "b");
  gone.markers[0].header.stamp = ros::Time(13.0);
  take(1.1, gone);
  EXPECT_EQ(buffer_.header.stamp, ros::Time(13.0)) << "though what is left is of 10";
  take(1.2, deletion(Marker::DELETE, "a"));
  EXPECT_EQ(buffer_.header.stamp, ros::Time()) << "when it arrives";
}

TEST_F(KeptMarkers, ALifetimeEnds) {
  MarkerArray message = one("a", 0.0);
  message.markers[0].lifetime = ros::Duration(0.5);
  take(1.0, message);
  const ReadResult later = take(1.6, one("b", 5.0));
  EXPECT_EQ(places(), Places{5.0});
  EXPECT_EQ(later.missing, "");
}

TEST_F(KeptMarkers, WhatIsNotSentAgainIsLeftOutAndMissed) {
  take(1.0, one("a", 0.0));
  take(1.5, one("b", 5.0));
  const ReadResult later = take(2.1, one("b", 6.0));
  EXPECT_EQ(places(), Places{6.0});
  EXPECT_EQ(later.missing, "marker a/0 was not sent again for 1 s");
  EXPECT_EQ(take(2.2, one("a", 1.0)).missing, "");
  EXPECT_EQ(places(), (Places{1.0, 6.0}));
  take(4.0, one("a", 1.0));
  EXPECT_EQ(take(4.1, deletion(Marker::DELETE, "b")).missing, "") << "now it is said to be gone";
}

TEST_F(KeptMarkers, WhatIsRefusedHasNotBeen) {
  take(1.0, one("a", 0.0));
  MarkerArray bad = one("b", 5.0);
  bad.markers.push_back(strip_of("c", {}));
  bad.markers.back().action = 7;
  EXPECT_THROW(take(1.1, bad), std::invalid_argument);
  input_.read(parts_of(one("d", 9.0)), ros::Time(1.2), buffer_);  // and is not kept
  take(1.3, one("a", 1.0));
  EXPECT_EQ(places(), Places{1.0});
}

TEST_F(KeptMarkers, TimeThatStartsAgainForgetsAll) {
  take(100.0, one("a", 0.0));
  take(1.0, one("b", 5.0));
  EXPECT_EQ(places(), Places{5.0});
}

TEST_F(KeptMarkers, TheLastOfSeveralWithTheSameIdCountsAndThatIsTold) {
  MarkerArray message = one("a", 0.0);
  message.markers.push_back(strip_of("a", chain(3.0)));
  const ReadResult result = take(1.0, message);
  EXPECT_EQ(places(), Places{3.0});
  ASSERT_EQ(result.remarks.size(), 1U);
  EXPECT_EQ(result.remarks[0].rfind("marker a/0 is in a message more than once", 0), 0U);
}

}  // namespace
}  // namespace fiber_proximity_ros
