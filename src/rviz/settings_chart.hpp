#pragma once

#include <QWidget>
#include <string>
#include <vector>

#include "fiber_proximity/MeasureSettings.h"

namespace fiber_proximity_rviz {

/// Plots the time and the error of each setting for one question, on logarithmic axes, one colour a
/// setting. An error of 0 is at the lower edge, and settings that miss contacts are hollow.
/// Dominated ones are pale. Below stand their names, and which to take, and why.
class SettingsChart : public QWidget {
 public:
  /// @param question as `type` of a query is called
  /// @param measured the settings of other questions are left out
  SettingsChart(const std::string& question,
                const fiber_proximity::MeasureSettings::Response& measured,
                QWidget* parent = nullptr);

  QSize sizeHint() const override { return {360, 300}; }

 protected:
  void paintEvent(QPaintEvent* event) override;

 private:
  /// @returns where they end
  double draw_names(QPainter& painter, double bottom) const;
  void draw_settings(QPainter& painter, const QRectF& area) const;

  std::string question_;
  std::string recommendation_;
  std::vector<fiber_proximity::SettingMeasurement> settings_;
};

}  // namespace fiber_proximity_rviz
