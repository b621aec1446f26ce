#include <gtest/gtest.h>
#include <ros/ros.h>

int main(int argc, char** argv) {
  testing::InitGoogleTest(&argc, argv);
  ros::init(argc, argv, "node_test");
  const ros::NodeHandle keep_alive;
  return RUN_ALL_TESTS();
}
