#pragma once

#include <dynamic_reconfigure/Config.h>
#include <dynamic_reconfigure/ConfigDescription.h>
#include <ros/node_handle.h>
#include <rosgraph_msgs/Log.h>
#include <rviz/panel.h>

#include <QLabel>
#include <QLineEdit>
#include <QPushButton>
#include <QTabWidget>
#include <QTimer>
#include <future>
#include <optional>
#include <string>

#include "fiber_proximity/MeasureSettings.h"
#include "fiber_proximity/Statistics.h"
#include "src/rviz/answer_history.hpp"
#include "src/rviz/answer_plot.hpp"
#include "src/rviz/parameter_form.hpp"
#include "src/rviz/settings_chart.hpp"

namespace fiber_proximity_rviz {

/// Shows the cost of accuracy while one watches: the settings of a proximity node, and beside them
/// what its answers of the last 30 s took, by part, and what is uncertain of them.
class AccuracyPanel : public rviz::Panel {
 public:
  explicit AccuracyPanel(QWidget* parent = nullptr);
  ~AccuracyPanel() override;

  void load(const rviz::Config& config) override;
  void save(rviz::Config config) const override;

 private:
  void subscribe();
  void process(const fiber_proximity::StatisticsConstPtr& answer);
  void process_log(const rosgraph_msgs::LogConstPtr& log);

  /// Asks the node to change a setting, without waiting for it.
  /// @param config the one parameter; empty if what was written is none
  /// @param text   its name and value
  void change(const dynamic_reconfigure::Config& config, const std::string& text);

  /// Shows what has become of the last change.
  void show_change();

  /// Has the node measure all settings on the fibres it has, without waiting for it.
  void measure();
  void show_measurement();
  void say(const std::string& text, bool is_error);
  void update_plot();

  ros::NodeHandle handle_;
  std::string node_ = "/proximity";
  ros::Subscriber answers_;
  ros::Subscriber descriptions_;
  ros::Subscriber values_;
  ros::Subscriber log_;

  AnswerHistory history_{30.0};
  dynamic_reconfigure::Config current_;              // of the node
  std::optional<std::future<std::string>> pending_;  // an error, or empty

  std::optional<std::future<fiber_proximity::MeasureSettings::Response>> measuring_;

  // Qt owns widgets through their parents.
  QLineEdit* name_;
  ParameterForm* form_;
  QLabel* answer_;
  QLabel* status_;
  AnswerPlot* plot_;
  QTabWidget* tabs_;
  QPushButton* measure_button_;
  QTimer* timer_;
};

}  // namespace fiber_proximity_rviz
