// The markers of the running node.
#include <dynamic_reconfigure/Reconfigure.h>
#include <visualization_msgs/MarkerArray.h>

#include <map>
#include <utility>

#include "test/ros/messages.hpp"
#include "test/ros/node_test.hpp"

namespace {

using test_messages::header;
using visualization_msgs::Marker;
using visualization_msgs::MarkerArray;

/// The markers on the screen of a viewer.
class Screen {
 public:
  void show(const MarkerArray& message) {
    for (const Marker& marker : message.markers) {
      const auto key = std::pair(marker.ns, marker.id);
      if (marker.action == Marker::DELETE) {
        EXPECT_EQ(markers_.erase(key), 1U) << "deletes " << marker.ns << " " << marker.id;
      } else {
        markers_[key] = marker;
      }
    }
  }

  std::vector<std::string> names() const {
    std::vector<std::string> all;
    for (const auto& [key, marker] : markers_) {
      all.push_back(key.first + "/" + std::to_string(key.second));
    }
    return all;
  }

  const Marker& operator[](const std::string& ns) const { return markers_.at({ns, 0}); }

  bool is_of(const ros::Time& stamp) const {
    return !markers_.empty() && markers_.begin()->second.header.stamp == stamp;
  }

 private:
  std::map<std::pair<std::string, std::int32_t>, Marker> markers_;
};

class DrawTest : public node_test::NodeTest {
 protected:
  /// Also until markers come: what is drawn before is never seen.
  void connect(const ros::Publisher& publisher) {
    NodeTest::connect(publisher, cross(), [this] { return !markers_.messages.empty(); });
  }

  /// Publishes the fibres and waits until they are on the screen.
  void show(const ros::Publisher& publisher, fiber_proximity::FiberArray message) {
    message.header = header("world", new_stamp());
    publisher.publish(message);
    ASSERT_TRUE(node_test::wait_for([&] {
      for (; shown_ < markers_.messages.size(); ++shown_) {
        screen.show(*markers_.messages[shown_]);
      }
      return screen.is_of(message.header.stamp);
    }));
    answer = contacts.wait_for(message.header.stamp);
    ASSERT_NE(answer, nullptr);
  }

  /// Two fibres of the same input, 10 mm apart where they cross.
  static fiber_proximity::FiberArray cross() {
    fiber_proximity::FiberArray message = test_messages::fiber_array(
        header("world"), {{-1, 0, 0}, {0, 0, 0}, {1, 0, 0}, {0.5, -1, 0.03}, {0.5, 1, 0.03}});
    message.offsets = {0, 3, 5};
    message.radii = {0.01};
    return message;
  }

  static void switch_texts(bool on) {
    dynamic_reconfigure::Reconfigure call;
    for (const char* name : {"show_names", "show_legend"}) {
      dynamic_reconfigure::BoolParameter parameter;
      parameter.name = name;
      parameter.value = static_cast<unsigned char>(on);
      call.request.config.bools.push_back(parameter);
    }
    ASSERT_TRUE(node_test::call_service("/proximity/set_parameters", call));
  }

  Screen screen;
  const fiber_proximity::ContactArray* answer = nullptr;

 private:
  struct MarkerRecorder {
    MarkerRecorder(ros::NodeHandle& node, const std::string& topic)
        : subscriber(node.subscribe<MarkerArray>(
              topic, 1000,
              [this](const MarkerArray::ConstPtr& message) { messages.push_back(message); })) {}
    std::vector<MarkerArray::ConstPtr> messages;
    ros::Subscriber subscriber;
  };
  MarkerRecorder markers_{node, "/proximity/markers"};
  std::size_t shown_ = 0;
};

TEST_F(DrawTest, MarkersShowTheAnswerAndGoWithIt) {
  const ros::Publisher publisher = advertise<fiber_proximity::FiberArray>("fibers");
  connect(publisher);

  show(publisher, cross());
  ASSERT_EQ(answer->contacts.size(), 1U);
  EXPECT_EQ(screen.names(),
            (std::vector<std::string>{"boxes/0", "contacts/0", "fibers/0", "fibers/1", "nearest/0",
                                      "nearest_leader/0", "nearest_text/0", "normals/0"}));
  EXPECT_EQ(screen["contacts"].points.size(), 1U);
  EXPECT_NEAR(screen["contacts"].points[0].x, 0.5, 1e-12);
  EXPECT_NEAR(screen["contacts"].points[0].z, 0.015, 1e-12);
  EXPECT_EQ(screen["nearest_text"].text, "10.0 mm");
  EXPECT_EQ(screen["boxes"].points.size() % 24, 0U);

  const fiber_proximity::FiberArray lone =
      test_messages::fiber_array(header("world"), {{0, 0, 0}, {1, 0, 0}});
  show(publisher, lone);
  EXPECT_EQ(screen.names(), (std::vector<std::string>{"boxes/0", "fibers/0"}));

  show(publisher, cross());
  EXPECT_EQ(screen.names().size(), 8U);
}

TEST_F(DrawTest, NamesAndLegendAreShownWhileSomebodyWantsThem) {
  const ros::Publisher publisher = advertise<fiber_proximity::FiberArray>("fibers");
  connect(publisher);
  switch_texts(true);
  show(publisher, cross());
  EXPECT_EQ(screen.names(),
            (std::vector<std::string>{"axes/0", "boxes/0", "contacts/0", "fibers/0", "fibers/1",
                                      "legend/0", "legend/1", "legend/2", "legend/3", "legend/4",
                                      "names/0", "names/1", "nearest/0", "nearest_leader/0",
                                      "nearest_text/0", "normals/0"}));
  EXPECT_EQ(screen["names"].text, "fibers/0");
  EXPECT_NE(screen["legend"].text.find("red"), std::string::npos);
  switch_texts(false);
  show(publisher, cross());
  EXPECT_EQ(screen.names().size(), 8U);
}

TEST_F(DrawTest, DiscsAreBoundByTheFibersNotByTheMargin) {
  const ros::Publisher publisher = advertise<fiber_proximity::FiberArray>("fibers");
  connect(publisher);
  fiber_proximity::FiberArray apart = cross();
  apart.points[3].z = apart.points[4].z = 0.06;  // 40 mm between them, the margin is 50
  show(publisher, apart);
  ASSERT_EQ(answer->contacts.size(), 1U);
  EXPECT_LT(screen["contacts"].scale.x, 2 * apart.radii[0]) << "less wide than the fibres";
  show(publisher, cross());
  EXPECT_GT(screen["contacts"].scale.x, 2 * apart.radii[0]) << "to be seen between the fibres";
}

}  // namespace
