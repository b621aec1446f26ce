#pragma once

#include <QWidget>

#include "fiber_proximity/MeasureSettings.h"

namespace fiber_proximity_rviz {

/// What each setting costs and errs: time against error, on logarithmic axes, a panel for each
/// question, one colour a setting. An error of 0 is at the lower edge, and what misses contacts is
/// hollow. What another setting dominates is pale. Below stands what to take, and why.
class SettingsChart : public QWidget {
 public:
  explicit SettingsChart(QWidget* parent = nullptr);

  void show_measurement(const fiber_proximity::MeasureSettings::Response& measured);

  QSize sizeHint() const override { return {360, 300}; }

 protected:
  void paintEvent(QPaintEvent* event) override;

 private:
  fiber_proximity::MeasureSettings::Response measured_;
};

}  // namespace fiber_proximity_rviz
