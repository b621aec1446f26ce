#include "src/rviz/settings_chart.hpp"

#include <QPainter>
#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include "src/rviz/plot_axes.hpp"

namespace fiber_proximity_rviz {
namespace {

using fiber_proximity::SettingMeasurement;

constexpr double lowest_error = 1e-12;  // [m] of the axis; what is less is exact to the eye
constexpr double highest_error = 1.0;

using Settings = std::vector<const SettingMeasurement*>;

QColor color_of(std::size_t setting, bool is_pale) {
  QColor color = plot_color(setting);
  color.setAlpha(is_pale ? 90 : 255);
  return color;
}

/// Draws the panel of a question, and the names of its settings beside it.
void draw_question(QPainter& painter, const std::string& question, const Settings& settings,
                   const QRectF& area) {
  double fastest = 1.0;
  double slowest = 1e-7;
  for (const SettingMeasurement* setting : settings) {
    fastest = std::min(fastest, setting->median_time);
    slowest = std::max(slowest, setting->median_time);
  }
  const double begin = std::floor(4.0 * std::log10(fastest)) / 4.0;
  const double end = std::max(begin + 0.25, std::ceil(4.0 * std::log10(slowest)) / 4.0);
  const PlotAxes axes{area, begin, end};
  const double decades = std::log10(highest_error / lowest_error);
  const auto share = [&](double error) {
    return std::log10(std::max(error, lowest_error) / lowest_error) / decades;
  };
  axes.draw(painter,
            {{0.0, "exact"},
             {share(1e-9), "1e-6"},
             {share(1e-6), "0.001"},
             {share(1e-3), "1"},
             {1.0, "1000"}},
            QString::fromStdString(question + ": error [mm] by time [ms]"));
  const QFontMetrics metrics(painter.font());
  const auto label = [&](double power, Qt::AlignmentFlag side) {
    painter.drawText(QRectF(area.left(), area.bottom() + 1.0, area.width(), metrics.height()), side,
                     plot_number(1e3 * std::pow(10.0, power)));
  };
  label(begin, Qt::AlignLeft);
  label(end, Qt::AlignRight);
  for (std::size_t i = 0; i < settings.size(); ++i) {
    const SettingMeasurement& setting = *settings[i];
    const QColor color = color_of(i, setting.dominated != 0);
    painter.setPen(QPen(color, 1.5));
    painter.setBrush(setting.missed_percent > 0.0 ? QBrush(Qt::NoBrush) : QBrush(color));
    painter.drawEllipse(QPointF(axes.x(std::log10(std::max(setting.median_time, 1e-9))),
                                axes.y(share(setting.error))),
                        4.0, 4.0);
  }
  double y = area.top() + metrics.ascent();
  for (std::size_t i = 0; i < settings.size(); ++i) {
    const SettingMeasurement& setting = *settings[i];
    QString text = QString::fromStdString(setting.name);
    if (setting.missed_percent > 0.0) {
      text += ", misses " + plot_number(setting.missed_percent) + " %";
    }
    painter.fillRect(QRectF(area.right() + 6.0, y - 8.0, 8.0, 8.0),
                     color_of(i, setting.dominated != 0));
    painter.setPen(plot_ink());
    painter.drawText(QPointF(area.right() + 17.0, y), text);
    y += metrics.lineSpacing();
  }
}

}  // namespace

SettingsChart::SettingsChart(QWidget* parent) : QWidget(parent) { setMinimumSize(240, 220); }

void SettingsChart::show_measurement(const fiber_proximity::MeasureSettings::Response& measured) {
  measured_ = measured;
  update();
}

void SettingsChart::paintEvent(QPaintEvent* /*event*/) {
  QPainter painter(this);
  painter.setRenderHint(QPainter::Antialiasing);
  QFont font("Sans");
  font.setPixelSize(11);
  painter.setFont(font);
  if (measured_.questions.empty()) {
    painter.drawText(rect(), Qt::AlignCenter, "nothing has been measured yet");
    return;
  }
  constexpr double left = 46.0;
  constexpr double title = 18.0;
  const double names = 0.42 * width();
  const double text = 4.0 * painter.fontMetrics().lineSpacing();
  const double each = height() / static_cast<double>(measured_.questions.size());
  for (std::size_t q = 0; q < measured_.questions.size(); ++q) {
    Settings settings;
    for (const SettingMeasurement& setting : measured_.settings) {
      if (setting.question == measured_.questions[q]) {
        settings.push_back(&setting);
      }
    }
    const double top = each * static_cast<double>(q);
    const double bottom = top + each - text - title;
    draw_question(painter, measured_.questions[q], settings,
                  QRectF(QPointF(left, top + title), QPointF(width() - names, bottom)));
    painter.setPen(plot_ink());
    painter.drawText(QRectF(6.0, bottom + title, width() - 12.0, text), Qt::TextWordWrap,
                     QString::fromStdString(measured_.recommendations[q]));
  }
}

}  // namespace fiber_proximity_rviz
