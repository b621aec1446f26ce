#pragma once

#include <QWidget>

#include "src/rviz/answer_history.hpp"

namespace fiber_proximity_rviz {

/// Draws the history of answers: above, their times by part [ms], one on the other; below, what is
/// uncertain of them [mm], on a logarithmic axis. An uncertainty of 0 is at its lower edge, and
/// what is unknown at its upper one, in red.
class AnswerPlot : public QWidget {
 public:
  /// @param history must outlive this
  explicit AnswerPlot(const AnswerHistory& history, QWidget* parent = nullptr);

  /// Draws what there is at a time.
  /// @param now [s]
  void show_at(double now);

  QSize sizeHint() const override { return {360, 300}; }

 protected:
  void paintEvent(QPaintEvent* event) override;

 private:
  const AnswerHistory& history_;
  double now_ = 0.0;
};

}  // namespace fiber_proximity_rviz
