#include "src/rviz/settings_chart.hpp"

#include <QPainter>
#include <algorithm>
#include <cmath>

#include "src/rviz/plot_axes.hpp"

namespace fiber_proximity_rviz {
namespace {

using fiber_proximity::SettingMeasurement;

constexpr double lowest_error = 1e-12;  // [m] of the axis; what is less is exact to the eye
constexpr double highest_error = 1.0;

QColor color_of(std::size_t index, const SettingMeasurement& setting) {
  QColor color = plot_color(index);
  color.setAlpha(setting.dominated != 0 ? 90 : 255);
  return color;
}

double log_time(const SettingMeasurement& setting) {
  return std::log10(std::max(setting.median_time, 1e-9));
}

}  // namespace

SettingsChart::SettingsChart(const std::string& question,
                             const fiber_proximity::MeasureSettings::Response& measured,
                             QWidget* parent)
    : QWidget(parent), question_(question) {
  setMinimumSize(240, 220);
  for (const SettingMeasurement& setting : measured.settings) {
    if (setting.question == question) {
      settings_.push_back(setting);
    }
  }
  for (std::size_t i = 0; i < measured.questions.size(); ++i) {
    if (measured.questions[i] == question) {
      recommendation_ = measured.recommendations[i];
    }
  }
}

void SettingsChart::draw_settings(QPainter& painter, const QRectF& area) const {
  double begin = 0.0;
  double end = -9.0;
  for (const SettingMeasurement& setting : settings_) {
    begin = std::min(begin, log_time(setting));
    end = std::max(end, log_time(setting));
  }
  constexpr double beside = 0.05;
  const PlotAxes axes{area, begin - beside, std::max(begin + 0.2, end) + beside};
  const double decades = std::log10(highest_error / lowest_error);
  const auto share = [&](double error) {
    return std::log10(std::max(error, lowest_error) / lowest_error) / decades;
  };
  axes.draw(painter, {{0.0, "exact"}, {share(1e-6), "0.001"}, {share(1e-3), "1"}, {1.0, "1000"}},
            "error [mm] by time [ms]");
  const QFontMetrics metrics(painter.font());
  const auto label = [&](double power, Qt::AlignmentFlag side) {
    painter.drawText(QRectF(area.left(), area.bottom() + 1.0, area.width(), metrics.height()), side,
                     plot_number(1e3 * std::pow(10.0, power)));
  };
  label(axes.begin, Qt::AlignLeft);
  label(axes.end, Qt::AlignRight);
  for (std::size_t i = 0; i < settings_.size(); ++i) {
    const QColor color = color_of(i, settings_[i]);
    painter.setPen(QPen(color, 1.5));
    painter.setBrush(settings_[i].missed_percent > 0.0 ? QBrush(Qt::NoBrush) : QBrush(color));
    painter.drawEllipse(QPointF(axes.x(log_time(settings_[i])), axes.y(share(settings_[i].error))),
                        4.0, 4.0);
  }
}

double SettingsChart::draw_names(QPainter& painter, double bottom) const {
  const QFontMetrics metrics(painter.font());
  constexpr std::size_t columns = 2;
  const std::size_t rows = (settings_.size() + columns - 1) / columns;
  const double top = bottom - static_cast<double>(rows) * metrics.lineSpacing();
  for (std::size_t i = 0; i < settings_.size(); ++i) {
    QString text = QString::fromStdString(settings_[i].name);
    if (settings_[i].missed_percent > 0.0) {
      text += QString(": misses %1 %").arg(std::ceil(settings_[i].missed_percent));
    }
    const double x = 6.0 + static_cast<double>(i / rows) * 0.5 * width();
    const double y = top + static_cast<double>(i % rows) * metrics.lineSpacing() + metrics.ascent();
    painter.fillRect(QRectF(x, y - 8.0, 8.0, 8.0), color_of(i, settings_[i]));
    painter.setPen(plot_ink());
    painter.drawText(QPointF(x + 11.0, y), text);
  }
  return top;
}

void SettingsChart::paintEvent(QPaintEvent* /*event*/) {
  QPainter painter(this);
  painter.setRenderHint(QPainter::Antialiasing);
  QFont font("Sans");
  font.setPixelSize(11);
  painter.setFont(font);
  painter.setPen(plot_ink());
  const QString recommendation = QString::fromStdString(recommendation_);
  const QRectF all(6.0, 0.0, width() - 12.0, height() - 2.0);
  constexpr int wrapped = Qt::TextWordWrap | Qt::AlignBottom;
  const QRectF below = painter.boundingRect(all, wrapped, recommendation);
  painter.drawText(all, wrapped, recommendation);
  const double names = draw_names(painter, below.top() - 4.0);
  constexpr double left = 46.0;
  constexpr double title = 18.0;
  draw_settings(painter, QRectF(QPointF(left, title), QPointF(width() - 6.0, names - title)));
}

}  // namespace fiber_proximity_rviz
