// The service ~query of the running node.
#include <Eigen/Geometry>
#include <algorithm>
#include <limits>

#include "test/ros/messages.hpp"
#include "test/ros/node_test.hpp"

namespace {

using fiber_proximity::FiberArray;
using fiber_proximity::QueryProximity;
using fiber_proximity::QueryShape;
using test_messages::header;
using test_messages::Points;

class QueryTest : public node_test::NodeTest {
 protected:
  static QueryShape shape(const std::string& frame, const Points& points, double radius) {
    QueryShape shape;
    shape.header.frame_id = frame;
    shape.radius = radius;
    for (const Eigen::Vector3d& point : points) {
      shape.points.push_back(fiber_proximity_ros::to_message(point));
    }
    return shape;
  }

  static QueryProximity::Response call(const QueryProximity::Request& request) {
    QueryProximity query;
    query.request = request;
    EXPECT_TRUE(node_test::call_service("/proximity/query", query));
    return query.response;
  }

  /// Sends random fibres and keeps what the node made of them.
  void send_fibers() {
    std::cout << fiber::test::seed_message() << '\n';
    fiber::test::Random random;
    Points points(40);
    for (Eigen::Vector3d& point : points) {
      point = random.in_cube();
    }
    FiberArray message = test_messages::fiber_array(header("world"), points);
    message.offsets = {0, 10, 25, 40};
    publisher_ = advertise<FiberArray>("fibers");
    connect(publisher_, message);
    stamp_ = new_stamp();
    message.header.stamp = stamp_;
    publisher_.publish(message);
    const FiberArray* merged = fibers.wait_for(stamp_);
    ASSERT_NE(merged, nullptr);
    assembly_ = node_test::to_assembly(*merged);
  }

  /// Compares the answer about one shape with brute force.
  void expect_brute_force(const QueryProximity::Response& response, std::uint32_t index,
                          const Points& points, double radius,
                          const fiber::QueryOptions& options) const {
    const fiber::FiberAssembly shape(points, {0, static_cast<std::uint32_t>(points.size())},
                                     {radius});
    fiber::QueryResult expected;
    fiber::brute_force_shape(shape, assembly_, options, expected);
    const std::uint32_t begin = response.offsets[index];
    ASSERT_EQ(response.offsets[index + 1] - begin, expected.contacts.size());
    for (std::size_t i = 0; i < expected.contacts.size(); ++i) {
      const fiber_proximity::Contact& contact = response.contacts[begin + i];
      const fiber::Contact& wanted = expected.contacts[i];
      EXPECT_EQ(contact.type_a, fiber_proximity::Contact::SHAPE);
      EXPECT_EQ(contact.fiber_a, index);
      EXPECT_EQ(contact.segment_a, wanted.segment_a);
      EXPECT_EQ(contact.fiber_b, wanted.fiber_b);
      EXPECT_EQ(contact.segment_b, wanted.segment_b);
      EXPECT_NEAR(contact.distance, wanted.distance, 1e-12);
      EXPECT_LT((fiber_proximity_ros::to_vector(contact.point_b) - wanted.point_b).norm(), 1e-9);
    }
  }

  ros::Publisher publisher_;
  ros::Time stamp_;
  fiber::FiberAssembly assembly_;
};

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
    fiber::QueryResult expected;
    fiber::brute_force_shape(shapes[i / 3], only, closest, expected);
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

TEST_F(QueryTest, AccuracyIsChosenByCall) {
  send_fibers();
  const Points line{{-1, 0, 0}, {0, 0, 0}, {1, 0, 0}};
  const fiber::FiberAssembly asked(line, {0, 3}, {0.1});
  fiber::QueryOptions options;
  options.type = fiber::QueryType::CLOSEST;
  options.margin = std::numeric_limits<double>::infinity();
  fiber::QueryResult truth;
  fiber::brute_force_shape(asked, assembly_, options, truth);
  const double minimum = truth.contacts.front().distance;
  QueryProximity::Request request;
  request.margin = options.margin;
  request.shapes = {shape("world", line, 0.1)};
  request.type = QueryProximity::Request::CLOSEST;
  for (const char* kernel : {"", "fast", "robust", "exact"}) {
    for (const double tolerance : {0.0, 0.05, 10.0}) {
      request.kernel = kernel;
      request.tolerance = tolerance;
      const QueryProximity::Response response = call(request);
      ASSERT_TRUE(response.success) << response.message;
      EXPECT_TRUE(response.complete);
      ASSERT_EQ(response.contacts.size(), 1U);
      const fiber_proximity::Contact& contact = response.contacts.front();
      EXPECT_LE(contact.lower, contact.distance);
      EXPECT_LE(contact.distance, contact.upper);
      EXPECT_LE(contact.distance, minimum + tolerance + 1e-12);
      ASSERT_EQ(response.minimum_lower.size(), 1U);
      EXPECT_LE(response.minimum_lower.front(), minimum + 1e-15);
      EXPECT_GE(response.minimum_lower.front(), contact.distance - tolerance - 1e-12);
    }
  }
  request.tolerance = 0.0;
  request.kernel = "exact";
  // The surfaces' distance, but for its last digits: the kernels know better than brute force.
  EXPECT_NEAR(call(request).contacts.front().distance, minimum, 1e-15);
}

TEST_F(QueryTest, TheKernelOfTheVersionBeforeIsRobust) {
  std::string kernel;
  EXPECT_TRUE(ros::param::get("/proximity/kernel", kernel));
  EXPECT_EQ(kernel, "robust") << "the launch file says fast";
  send_fibers();
  QueryProximity::Request request;
  request.type = QueryProximity::Request::ALL;
  request.margin = std::numeric_limits<double>::infinity();
  request.shapes = {shape("world", {{-1, 0, 0}, {1, 0, 0}}, 0.1)};
  request.kernel = "robust";
  const QueryProximity::Response robust = call(request);
  request.kernel = "fast";
  const QueryProximity::Response fast = call(request);
  ASSERT_FALSE(robust.contacts.empty());
  ASSERT_EQ(fast.contacts.size(), robust.contacts.size());
  EXPECT_EQ(fast.contacts.front().lower, robust.contacts.front().lower);
  EXPECT_EQ(fast.contacts.front().upper, robust.contacts.front().upper);
}

TEST_F(QueryTest, ADeadlineCutsTheAnswerOffAndSaysSo) {
  send_fibers();
  QueryProximity::Request request;
  request.type = QueryProximity::Request::ALL;
  request.margin = std::numeric_limits<double>::infinity();
  request.shapes = {shape("world", {{-1, 0, 0}, {1, 0, 0}}, 0.1),
                    shape("world", {{0, -1, 0}, {0, 1, 0}}, 0.1)};
  request.deadline = 1e-9;
  const QueryProximity::Response cut = call(request);
  ASSERT_TRUE(cut.success) << cut.message;
  EXPECT_FALSE(cut.complete);
  EXPECT_EQ(cut.offsets.size(), 3U);
  EXPECT_EQ(cut.minimum_lower.size(), 2U);
  for (const double lower : cut.minimum_lower) {
    EXPECT_LT(lower, 0.0) << "no more is known than how thick they are";
  }
  request.deadline = 1000.0;
  const QueryProximity::Response whole = call(request);
  EXPECT_TRUE(whole.complete);
  EXPECT_EQ(whole.contacts.size(), 2U * assembly_.segment_count());
}

TEST_F(QueryTest, BadRequestsAreAnsweredWithTheReason) {
  send_fibers();
  constexpr double nan = std::numeric_limits<double>::quiet_NaN();
  QueryProximity::Request good;
  good.type = QueryProximity::Request::ALL;
  good.margin = 0.5;
  good.shapes = {shape("world", {{0, 0, 0}}, 0.1), shape("world", {{0, 0, 0}, {1, 0, 0}}, 0.1)};
  const auto expect_error = [&](const std::function<void(QueryProximity::Request&)>& change,
                                const std::string& message) {
    QueryProximity::Request request = good;
    change(request);
    const QueryProximity::Response response = call(request);
    EXPECT_FALSE(response.success);
    EXPECT_EQ(response.message.substr(0, message.size()), message);
    EXPECT_TRUE(response.contacts.empty());
    EXPECT_TRUE(response.offsets.empty());
    EXPECT_TRUE(call(good).success) << "the node does not live on";
  };
  expect_error(
      [](auto& request) { request.type = 7; },
      "type is 7, it must be 0 (FIRST), 1 (CLOSEST), 2 (LIMITED), 3 (ALL) or 4 (FIBER_PAIRS)");
  expect_error([](auto& request) { request.type = 5; }, "type is 5, it must be 0 (FIRST)");
  expect_error([](auto& request) { request.margin = -0.25; }, "margin is -0.25");
  expect_error([](auto& request) { request.margin = nan; }, "margin is nan");
  expect_error([](auto& request) { request.type = QueryProximity::Request::LIMITED; },
               "max_contacts is 0");
  expect_error([](auto& request) { request.kernel = "double"; },
               "unknown kernel 'double', known are: robust, exact");
  expect_error([](auto& request) { request.tolerance = -1.0; },
               "tolerance is -1.000000, it must be finite and at least 0 m");
  expect_error([](auto& request) { request.relative_tolerance = nan; },
               "relative_tolerance is nan, it must be finite and at least 0");
  expect_error([](auto& request) { request.deadline = -1.0; },
               "deadline is -1.000000, it must be finite and at least 0 s (0 for none)");
  expect_error([](auto& request) { request.shapes[1].points.clear(); },
               "shape 1: has no points, it needs at least 1");
  expect_error([](auto& request) { request.shapes[1].points[1].z = nan; },
               "shape 1: fibre 0, point 1: z is nan");
  expect_error([](auto& request) { request.shapes[0].radius = -1.0; }, "shape 0: the radius is -1");
  expect_error([](auto& request) { request.shapes[1].radius = nan; }, "shape 1: the radius is nan");
  expect_error([](auto& request) { request.shapes[1].header.frame_id = "nowhere"; },
               "shape 1: no transform from frame 'nowhere' to 'world': unknown frame: ");
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
