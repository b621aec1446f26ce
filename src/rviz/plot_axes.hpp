#pragma once

#include <QColor>
#include <QPainter>
#include <QRectF>
#include <QString>
#include <algorithm>
#include <array>
#include <utility>
#include <vector>

namespace fiber_proximity_rviz {

/// Colours that are told apart also with colour blindness (Okabe and Ito 2008), and darker ones of
/// some of them where these are not enough.
inline QColor plot_color(std::size_t index) {
  static const std::array<QColor, 12> colors{
      QColor(86, 180, 233), QColor(230, 159, 0),  QColor(0, 158, 115),   QColor(240, 228, 66),
      QColor(0, 114, 178),  QColor(213, 94, 0),   QColor(204, 121, 167), QColor(150, 150, 150),
      QColor(20, 90, 70),   QColor(120, 60, 110), QColor(130, 90, 0),    QColor(60, 60, 60)};
  return colors[index % colors.size()];
}

inline QColor plot_ink() { return {40, 40, 40}; }

inline QString plot_number(double value) { return QString::number(value, 'g', 2); }

/// Where a panel of a plot is, and how what is along its width and a share of its height get there.
struct PlotAxes {
  QRectF area;
  double begin;
  double end;

  double x(double value) const {
    return area.left() + area.width() * (value - begin) / (end - begin);
  }
  double y(double share) const {
    return area.bottom() - area.height() * std::clamp(share, 0.0, 1.0);
  }

  /// Draws the frame, lines and labels at some shares of the height, and a title above.
  void draw(QPainter& painter, const std::vector<std::pair<double, QString>>& ticks,
            const QString& title) const {
    painter.fillRect(area, QColor(252, 252, 252));
    for (const auto& [share, label] : ticks) {
      painter.setPen(QColor(220, 220, 220));
      painter.drawLine(QPointF(area.left(), y(share)), QPointF(area.right(), y(share)));
      painter.setPen(plot_ink());
      painter.drawText(QRectF(0.0, y(share) - 8.0, area.left() - 4.0, 16.0),
                       Qt::AlignRight | Qt::AlignVCenter, label);
    }
    painter.setPen(plot_ink());
    painter.setBrush(Qt::NoBrush);
    painter.drawRect(area);
    painter.drawText(QPointF(area.left(), area.top() - 4.0), title);
  }
};

}  // namespace fiber_proximity_rviz
