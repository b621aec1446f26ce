// Points a tracker has lost sight of, in every type of input, through the running node.
#include <utility>

#include "test/ros/messages.hpp"
#include "test/ros/node_test.hpp"
#include "test/support/not_finite.hpp"

namespace {

using fiber_proximity::FiberArray;
using fiber_proximity::InputStatistics;
using fiber_proximity_ros::to_vector;
using test_messages::header;
using test_messages::Points;
using visualization_msgs::Marker;

using Names = std::vector<std::string>;

using fiber::test::nan;

class MissingPointsTest : public node_test::NodeTest {
 protected:
  void SetUp() override {
    probe_ = advertise<FiberArray>("probe");
    connect(probe_, probe_message());
  }

  static FiberArray probe_message() {
    return test_messages::fiber_array(header("world", new_stamp()), {{0, 0, 9}, {1, 0, 9}});
  }

  /// A zigzag that comes near itself, with a point missing before, two within and one behind.
  static Points chain() {
    const Eigen::Vector3d missing(nan, nan, nan);
    return {missing,   {0.25, 0, 0}, {0.5, 0.125, 0}, {0.75, 0, 0},     missing,
            {1, 0, 0}, missing,      {0.75, 0.25, 0}, {0.5, 0.1875, 0}, missing};
  }

  static Points known(const std::vector<std::size_t>& indices) {
    Points points;
    for (const std::size_t i : indices) {
      points.push_back(chain()[i]);
    }
    return points;
  }

  /// The fibres of one input in an answer, by their names.
  static std::vector<std::pair<std::string, Points>> fibers_of(const FiberArray& message,
                                                               const std::string& input) {
    std::vector<std::pair<std::string, Points>> found;
    for (std::size_t i = 0; i < message.names.size(); ++i) {
      if (message.names[i] == input || message.names[i].rfind(input + "[", 0) == 0) {
        found.emplace_back(message.names[i], Points());
        for (std::uint32_t p = message.offsets[i]; p < message.offsets[i + 1]; ++p) {
          found.back().second.push_back(to_vector(message.points[p]));
        }
      }
    }
    return found;
  }

  /// What the node says about an input after it has handled what came before.
  InputStatistics statistics_of(const std::string& input) {
    const FiberArray message = probe_message();
    probe_.publish(message);
    const fiber_proximity::Statistics* now = statistics.wait_for(message.header.stamp);
    return now == nullptr ? InputStatistics() : *input_of(*now, input);
  }

  /// Sends the chain on the input's topic and expects these fibres, and contacts about them.
  template <class Message>
  void expect_fibers(const std::string& input, Message (*make)(const std_msgs::Header&),
                     const std::vector<std::pair<std::string, Points>>& expected) {
    SCOPED_TRACE(input);
    const ros::Time stamp = new_stamp();
    const ros::Publisher publisher = advertise<Message>(input);
    publisher.publish(make(header("world", stamp)));
    const FiberArray* merged = fibers.wait_for(stamp);
    const fiber_proximity::ContactArray* answer = contacts.wait_for(stamp);
    ASSERT_NE(merged, nullptr) << "the whole frame is lost";
    ASSERT_NE(answer, nullptr);
    EXPECT_EQ(fibers_of(*merged, input), expected);
    EXPECT_EQ(answer->fiber_names, merged->names);
    node_test::expect_brute_force(*answer, *merged);
    const InputStatistics counted = statistics_of(input);
    EXPECT_EQ(counted.received, 1U);
    EXPECT_EQ(counted.refused, 0U);
    EXPECT_EQ(counted.missing_points, 4U);
    EXPECT_EQ(counted.missing_fibers, 0U);
    EXPECT_EQ(counted.lone_points, input.rfind("split", 0) == 0 ? 1U : 0U);
    EXPECT_EQ(counted.fibers, expected.size());
  }

  ros::Publisher probe_;
};

FiberArray fiber_array_of(const std_msgs::Header& header, const Points& points) {
  return test_messages::fiber_array(header, points);
}

TEST_F(MissingPointsTest, EveryTypeIsBridgedOrSplitAndContactsAreThoseOfBruteForce) {
  for (const std::string policy : {"bridge", "split"}) {
    const auto expected = [&policy](const std::string& type) {
      const std::string name = policy + "/" + type;
      return policy == "bridge"
                 ? std::vector<std::pair<std::string, Points>>{{name, known({1, 2, 3, 5, 7, 8})}}
                 : std::vector<std::pair<std::string, Points>>{{name, known({1, 2, 3})},
                                                               {name + "[7]", known({7, 8})}};
    };
    const auto expect = [&](const std::string& type, auto make) {
      expect_fibers(policy + "/" + type, make, expected(type));
    };
    expect(
        "fiber_array",
        +[](const std_msgs::Header& header) { return fiber_array_of(header, chain()); });
    expect(
        "point_cloud2", +[](const std_msgs::Header& header) {
          return test_messages::point_cloud2(header, chain());
        });
    expect(
        "point_cloud", +[](const std_msgs::Header& header) {
          return test_messages::point_cloud(header, chain());
        });
    expect(
        "pose_array",
        +[](const std_msgs::Header& header) { return test_messages::pose_array(header, chain()); });
    expect(
        "path",
        +[](const std_msgs::Header& header) { return test_messages::path(header, chain()); });
    expect(
        "line_list", +[](const std_msgs::Header& header) {
          Points pairs;
          for (std::size_t i = 0; i + 1 < chain().size(); ++i) {
            pairs.push_back(chain()[i]);
            pairs.push_back(chain()[i + 1]);
          }
          return test_messages::marker(header, Marker::LINE_LIST, pairs);
        });
    expect(
        "spheres", +[](const std_msgs::Header& header) {
          return test_messages::spheres_and_cylinders(header, chain());
        });
  }
}

TEST_F(MissingPointsTest, RadiiAndNamesGoWithTheirPointsAndAnAbsentFibreIsNoError) {
  const ros::Publisher publisher = advertise<FiberArray>("radii");
  FiberArray message = test_messages::fiber_array(header("world", new_stamp()), {{0, 0, 0},
                                                                                 {1, 0, 0},
                                                                                 {nan, 0, 0},
                                                                                 {3, 0, 0},
                                                                                 {4, 0, 0},
                                                                                 {0, nan, 0},
                                                                                 {0, 0, nan},
                                                                                 {9, 9, 9}});
  message.offsets = {0, 5, 8};
  message.names = {"left", "right"};
  message.radii = {0.1, 0.2, nan, 0.4, 0.5, nan, nan, 0.8};
  publisher.publish(message);
  const FiberArray* merged = fibers.wait_for(message.header.stamp);
  ASSERT_NE(merged, nullptr);
  const auto first = std::find(merged->names.begin(), merged->names.end(), "left");
  ASSERT_NE(first, merged->names.end());
  ASSERT_EQ(merged->names.end() - first, 2) << "the input stands last, as its order is";
  EXPECT_EQ(*(first + 1), "left[3]");
  EXPECT_EQ(std::vector<double>(merged->radii.end() - 4, merged->radii.end()),
            (std::vector<double>{0.1, 0.2, 0.4, 0.5}));
  const InputStatistics some = statistics_of("radii");
  EXPECT_EQ(some.missing_points, 3U);
  EXPECT_EQ(some.missing_fibers, 1U);
  EXPECT_EQ(some.lone_points, 1U);

  // Nothing left: the fibres are gone at once, and the input goes on.
  for (geometry_msgs::Point& point : message.points) {
    point.x = nan;
  }
  message.header.stamp = new_stamp();
  publisher.publish(message);
  merged = fibers.wait_for(message.header.stamp);
  ASSERT_NE(merged, nullptr);
  EXPECT_EQ(std::count(merged->names.begin(), merged->names.end(), "left"), 0);
  const InputStatistics none = statistics_of("radii");
  EXPECT_EQ(none.fibers, 0U);
  EXPECT_EQ(none.refused, 0U);
  EXPECT_EQ(none.missing_points, 11U);
  EXPECT_EQ(none.missing_fibers, 3U);
  EXPECT_FALSE(none.stale);
}

TEST_F(MissingPointsTest, RefusedIsTheDefaultAndTheMissingAreCounted) {
  const ros::Publisher publisher = advertise<sensor_msgs::PointCloud2>("refused");
  publisher.publish(test_messages::point_cloud2(header("world", new_stamp()), chain()));
  ASSERT_TRUE(node_test::wait_for([&] { return statistics_of("refused").received == 1; }));
  const InputStatistics counted = statistics_of("refused");
  EXPECT_EQ(counted.refused, 1U);
  EXPECT_EQ(counted.missing_points, 4U);
  EXPECT_EQ(counted.fibers, 0U);
  EXPECT_EQ(counted.last_error.rfind("fibre 0, point 0: x is nan", 0), 0U) << counted.last_error;
  EXPECT_NE(counted.last_error.find("missing_points: bridge or split"), std::string::npos);
}

}  // namespace
