#pragma once

#include <sensor_msgs/PointCloud2.h>

#include <Eigen/Geometry>
#include <condition_variable>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <thread>
#include <vector>

#include "src/ros/environment/cloud_cells.hpp"

namespace fiber_proximity_ros {

/// A cloud, and where it was seen from.
struct PlacedCloud {
  sensor_msgs::PointCloud2::ConstPtr message;
  Eigen::Isometry3d pose = Eigen::Isometry3d::Identity();  ///< of its frame in the fixed frame
  ros::Time stamp;
};

/// What a cloud has become.
struct CloudResult {
  std::shared_ptr<const fiber::OccupancyOctree> octree;  ///< null if no cell is occupied
  CloudCounts counts;
  ros::Time stamp;
  double work_time = 0.0;  ///< [s]
  std::string error;       ///< why the cloud was refused; empty if it was not
};

/// Makes octrees of clouds in a thread of its own, so that fibres need not wait for it.
class CloudWorker {
 public:
  /// @throws std::invalid_argument as CloudCells
  explicit CloudWorker(const CloudOptions& options);
  ~CloudWorker();
  CloudWorker(const CloudWorker&) = delete;
  CloudWorker& operator=(const CloudWorker&) = delete;

  /// Takes the newest cloud.
  /// @returns true if it has overtaken one that had not been begun
  bool submit(PlacedCloud cloud);

  /// The results that were not taken yet, the newest last.
  std::vector<CloudResult> take();

  /// True if a result is still to come or to be taken.
  bool is_busy() const;

 private:
  void run();
  CloudResult work(const PlacedCloud& cloud);

  CloudCells cells_;  // of the thread

  mutable std::mutex mutex_;
  std::condition_variable condition_;
  std::optional<PlacedCloud> next_;
  std::vector<CloudResult> results_;
  bool is_working_ = false;
  bool stops_ = false;

  std::thread thread_;  // last: it uses all of the above
};

}  // namespace fiber_proximity_ros
