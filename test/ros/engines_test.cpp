// The running node with every engine by its parameter.
#include "src/ros/detection/detector.hpp"
#include "test/ros/messages.hpp"
#include "test/ros/node_test.hpp"
#include "test/ros/running_node.hpp"
#include "test/support/answers.hpp"
#include "test/support/assemblies.hpp"
#include "test/support/engine_names.hpp"

namespace {

using fiber::test::Random;
using fiber_proximity::FiberArray;
using fiber_proximity::QueryProximity;

class EnginesTest : public node_test::NodeTest, public testing::WithParamInterface<std::string> {
 protected:
  /// Every point moved a little.
  static void move(FiberArray& message, Random& random) {
    for (geometry_msgs::Point& point : message.points) {
      const Eigen::Vector3d moved = fiber_proximity_ros::to_vector(point) + random.in_cube(0.05);
      point = fiber_proximity_ros::to_message(moved);
    }
  }

  /// Compares the contacts of a ball among these fibres with brute force.
  static void expect_query(const FiberArray& merged, const Eigen::Vector3d& center) {
    constexpr double radius = 0.2;
    QueryProximity query;
    query.request.type = QueryProximity::Request::ALL;
    query.request.margin = 0.1;
    query.request.shapes.resize(1);
    query.request.shapes[0].points.push_back(fiber_proximity_ros::to_message(center));
    query.request.shapes[0].radius = radius;
    ASSERT_TRUE(node_test::call_service("/proximity/query", query));
    ASSERT_TRUE(query.response.success) << query.response.message;
    fiber::QueryOptions options;
    options.margin = query.request.margin;
    const fiber::QueryResult expected = fiber::test::brute_force(
        {{center, center}, {0, 2}, {radius}}, node_test::to_assembly(merged), options);
    ASSERT_GT(expected.contacts.size(), 0U) << "the ball is around a point of a fibre";
    ASSERT_EQ(query.response.contacts.size(), expected.contacts.size());
    for (std::size_t i = 0; i < expected.contacts.size(); ++i) {
      node_test::expect_same(query.response.contacts[i], expected.contacts[i]);
    }
  }

  /// Compares the node's work with that of its engine: the contacts could be those of any.
  void expect_work(const fiber_proximity::ContactArray& answer,
                   const fiber::FiberAssembly& merged) {
    fiber::QueryOptions options;
    options.margin = answer.margin;
    reference_.set_fibers(merged);
    reference_.detect(options);
    EXPECT_EQ(answer.node_tests, reference_.detection().counts().node_tests);
    EXPECT_EQ(answer.node_overlaps, reference_.detection().counts().node_overlaps);
    EXPECT_EQ(answer.primitive_tests, reference_.detection().counts().primitive_tests);
  }

  fiber_proximity_ros::Detector reference_{GetParam()};
  node_test::Recorder<visualization_msgs::MarkerArray> markers{node, "/proximity/markers"};
};

TEST_P(EnginesTest, AnswerWhatBruteForceAnswers) {
  SCOPED_TRACE(fiber::test::seed_message());
  node_test::RunningNode proximity({PROXIMITY_NODE, "__name:=proximity", "_engine:=" + GetParam()});
  const ros::Publisher publisher = advertise<FiberArray>("fibers");
  Random random;
  std::size_t found = 0;
  // Other fibres, of another topology first; then the same ones moving, for the refit.
  connect(
      publisher,
      test_messages::fiber_array(test_messages::header("world"), {{0, 0, 0}, {1, 0, 0}, {2, 0, 0}}),
      [this] { return !markers.messages.empty(); });
  FiberArray message = test_messages::tangled_fibers(random);
  for (int frame = 0; frame < 5; ++frame) {
    SCOPED_TRACE(frame);
    message.header.stamp = new_stamp();
    publisher.publish(message);
    const fiber_proximity::ContactArray* answer = contacts.wait_for(message.header.stamp);
    const FiberArray* merged = fibers.wait_for(message.header.stamp);
    const fiber_proximity::Statistics* cost = statistics.wait_for(message.header.stamp);
    ASSERT_NE(answer, nullptr);
    ASSERT_NE(merged, nullptr);
    ASSERT_NE(cost, nullptr);
    EXPECT_EQ(cost->engine, GetParam());
    EXPECT_EQ(merged->points.size(), message.points.size());
    node_test::expect_brute_force(*answer, *merged);
    const fiber::FiberAssembly assembly = node_test::to_assembly(*merged);
    expect_work(*answer, assembly);
    expect_query(*merged, fiber_proximity_ros::to_vector(message.points[40]));
    found += answer->contacts.size();
    move(message, random);
  }
  fiber::test::expect_enough(found, std::size_t{1});
  EXPECT_EQ(proximity.stop(), 0);
}

std::vector<std::string> engines() {
  std::vector<std::string> names = fiber::test::all_engine_names();
  names.insert(names.end(), {"DL-6", "DS-14-classic", "DL-200"});
  return names;
}

INSTANTIATE_TEST_SUITE_P(Engines, EnginesTest, testing::ValuesIn(engines()),
                         [](const auto& instance) {
                           return fiber::test::test_name(instance.param);
                         });

}  // namespace
