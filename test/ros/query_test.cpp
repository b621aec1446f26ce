// The service ~query of the running node: what it answers. The first test runs before there are
// fibres.
#include <Eigen/Geometry>
#include <algorithm>
#include <limits>

#include "test/ros/query_fixture.hpp"
#include "test/support/answers.hpp"

namespace {

using fiber_proximity::QueryProximity;
using node_test::QueryTest;
using test_messages::Points;

TEST_F(QueryTest, AnswersOnlyOnceThereAreFibres) {
  QueryProximity::Request request;
  request.shapes.push_back(shape("world", {{0, 0, 0}}, 0.1));
  const QueryProximity::Response response = call(request);
  EXPECT_FALSE(response.success);
  EXPECT_EQ(response.message, "no fresh input: no fibres have arrived within the input_timeout");
}

TEST_F(QueryTest, EachShapeOfABatchIsAnsweredInItsOwnFrame) {
  send_fibers();
  // yaw, pitch, roll of the launch file's tool frame
  const Eigen::Isometry3d tool = Eigen::Translation3d(0.5, -0.25, 1.0) *
                                 Eigen::AngleAxisd(0.3, Eigen::Vector3d::UnitZ()) *
                                 Eigen::AngleAxisd(-0.4, Eigen::Vector3d::UnitY()) *
                                 Eigen::AngleAxisd(0.5, Eigen::Vector3d::UnitX());
  QueryProximity::Request request;
  request.shapes = {shape("world", {{0.1, 0.2, 0.3}}, 0.2),
                    shape("tool", {{0, 0, 0}, {-0.5, 0, -0.5}}, 0.05),
                    shape("", {{-1, -1, -1}, {0, 0, 0}, {1, 0, 0}, {1, 1, 1}}, 0.0)};
  const std::vector<Points> in_world{
      {{0.1, 0.2, 0.3}, {0.1, 0.2, 0.3}},
      {tool * Eigen::Vector3d(0, 0, 0), tool * Eigen::Vector3d(-0.5, 0, -0.5)},
      {{-1, -1, -1}, {0, 0, 0}, {1, 0, 0}, {1, 1, 1}}};
  // The static transform may still be on its way to the node.
  ASSERT_TRUE(node_test::wait_for([&] { return call(request).success; }));
  const std::pair<fiber::QueryType, std::uint8_t> types[] = {
      {fiber::QueryType::ALL, QueryProximity::Request::ALL},
      {fiber::QueryType::CLOSEST, QueryProximity::Request::CLOSEST},
      {fiber::QueryType::LIMITED, QueryProximity::Request::LIMITED},
      {fiber::QueryType::FIBER_PAIRS, QueryProximity::Request::FIBER_PAIRS}};
  for (const auto& [type, type_in_message] : types) {
    for (const double margin : {0.0, 0.2, std::numeric_limits<double>::infinity()}) {
      fiber::QueryOptions options;
      options.type = type;
      options.margin = margin;
      options.max_contacts = 3;
      request.type = type_in_message;
      request.margin = margin;
      request.max_contacts = 3;
      const QueryProximity::Response response = call(request);
      ASSERT_TRUE(response.success) << response.message;
      EXPECT_EQ(response.header.frame_id, "world");
      EXPECT_EQ(response.header.stamp, stamp_);
      EXPECT_EQ(response.fiber_names,
                (std::vector<std::string>{"fibers/0", "fibers/1", "fibers/2"}));
      ASSERT_EQ(response.offsets.size(), 4U);
      EXPECT_EQ(response.offsets.front(), 0U);
      EXPECT_EQ(response.offsets.back(), response.contacts.size());
      for (std::uint32_t i = 0; i < 3; ++i) {
        expect_brute_force(response, i, in_world[i], request.shapes[i].radius, options);
      }
    }
  }
  request.type = QueryProximity::Request::FIRST;
  EXPECT_EQ(call(request).offsets, (std::vector<std::uint32_t>{0, 1, 2, 3}));
  request.shapes.clear();
  EXPECT_EQ(call(request).offsets, std::vector<std::uint32_t>{0});
}

TEST_F(QueryTest, FiberPairsGiveEachShapeItsClosestSegmentOfEachFibre) {
  send_fibers();
  QueryProximity::Request request;
  request.type = QueryProximity::Request::FIBER_PAIRS;
  request.margin = std::numeric_limits<double>::infinity();
  const Points line{{-1, 0, 0}, {0, 0, 0}, {1, 0, 0}};
  request.shapes = {shape("world", {{0, 0, 0}}, 0.0), shape("world", line, 0.1)};
  const QueryProximity::Response response = call(request);
  ASSERT_TRUE(response.success) << response.message;
  ASSERT_EQ(response.offsets, (std::vector<std::uint32_t>{0, 3, 6}));
  fiber::QueryOptions closest;
  closest.type = fiber::QueryType::CLOSEST;
  closest.margin = request.margin;
  const std::vector<fiber::FiberAssembly> shapes{{{{0, 0, 0}, {0, 0, 0}}, {0, 2}, {0.0}},
                                                 {line, {0, 3}, {0.1}}};
  for (std::uint32_t i = 0; i < 6; ++i) {
    const std::uint32_t fiber = response.contacts[i].fiber_b;
    const auto begin = assembly_.points().begin();
    const Points points(begin + assembly_.offsets()[fiber], begin + assembly_.offsets()[fiber + 1]);
    const fiber::FiberAssembly only(points, {0, static_cast<std::uint32_t>(points.size())},
                                    {assembly_.segment_radius(assembly_.offsets()[fiber])});
    const fiber::QueryResult expected = fiber::test::brute_force(shapes[i / 3], only, closest);
    EXPECT_EQ(response.contacts[i].segment_b, expected.contacts.front().segment_b);
    EXPECT_NEAR(response.contacts[i].distance, expected.contacts.front().distance, 1e-12);
  }
  for (const std::uint32_t first : {0U, 3U}) {
    std::vector<std::uint32_t> seen;
    for (std::uint32_t i = first; i < first + 3; ++i) {
      seen.push_back(response.contacts[i].fiber_b);
    }
    std::sort(seen.begin(), seen.end());
    EXPECT_EQ(seen, (std::vector<std::uint32_t>{0, 1, 2}));
  }
}

TEST_F(QueryTest, ALimitedQueryAboutAPointGivesItsNearestSegments) {
  send_fibers();
  const Eigen::Vector3d point(0.3, -0.2, 0.1);
  std::vector<double> distances;
  for (std::uint32_t fiber = 0; fiber < 3; ++fiber) {
    for (std::uint32_t p = assembly_.offsets()[fiber]; p + 1 < assembly_.offsets()[fiber + 1];
         ++p) {
      const fiber::Capsule segment = assembly_.capsule(p);
      const Eigen::Vector3d axis = segment.p1 - segment.p0;
      const double s = (point - segment.p0).dot(axis) / axis.squaredNorm();
      const Eigen::Vector3d nearest = segment.p0 + std::clamp(s, 0.0, 1.0) * axis;
      distances.push_back((nearest - point).norm() - segment.radius);
    }
  }
  std::sort(distances.begin(), distances.end());
  QueryProximity::Request request;
  request.type = QueryProximity::Request::LIMITED;
  request.margin = std::numeric_limits<double>::infinity();
  request.shapes = {shape("world", {point}, 0.0)};
  for (const std::uint32_t k : {1U, 5U, 1000U}) {
    request.max_contacts = k;
    const QueryProximity::Response response = call(request);
    ASSERT_TRUE(response.success) << response.message;
    std::vector<double> found;
    for (const fiber_proximity::Contact& contact : response.contacts) {
      found.push_back(contact.distance);
      EXPECT_EQ(fiber_proximity_ros::to_vector(contact.point_a), point);
    }
    std::sort(found.begin(), found.end());
    ASSERT_EQ(found.size(), std::min<std::size_t>(k, distances.size()));
    for (std::size_t i = 0; i < found.size(); ++i) {
      EXPECT_NEAR(found[i], distances[i], 1e-12) << "rank " << i;
    }
  }
}

TEST_F(QueryTest, GradientsComeWhereTheyAreAskedFor) {
  send_fibers();
  QueryProximity::Request request;
  request.type = QueryProximity::Request::CLOSEST;
  request.margin = std::numeric_limits<double>::infinity();
  request.shapes = {shape("", {{0.1, 0.2, 0.3}, {0.4, 0.1, 0.2}}, 0.01)};
  ASSERT_EQ(call(request).contacts.size(), 1U);
  EXPECT_TRUE(call(request).contacts[0].gradients.empty());
  request.gradients = true;
  const fiber_proximity::Contact contact = call(request).contacts.at(0);
  ASSERT_EQ(contact.gradients.size(), 4U);
  EXPECT_EQ(contact.gradients[0].x, (contact.s - 1.0) * contact.normal.x);
  EXPECT_EQ(contact.gradients[1].y, -contact.s * contact.normal.y);
  EXPECT_EQ(contact.gradients[2].z, (1.0 - contact.t) * contact.normal.z);
  EXPECT_EQ(contact.gradients[3].x, contact.t * contact.normal.x);
}

}  // namespace
