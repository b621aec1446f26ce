#include "src/rviz/answer_plot.hpp"

#include <QPainter>
#include <algorithm>
#include <cmath>

#include "src/rviz/plot_axes.hpp"

namespace fiber_proximity_rviz {
namespace {

const QColor unknown_color(200, 20, 20);
const QColor rest_color(205, 205, 205);

constexpr double lowest_uncertainty = 1e-15;  // [m] of the axis
constexpr double highest_uncertainty = 1.0;

/// 1, 2 or 5 times a power of ten, not below a value.
double round_up(double value) {
  const double power = std::pow(10.0, std::floor(std::log10(value)));
  for (const double factor : {1.0, 2.0, 5.0}) {
    if (value <= factor * power) {
      return factor * power;
    }
  }
  return 10.0 * power;
}

/// [s] Above all but the slowest of the answers, which a busy machine delays: those end there.
double highest_time(const AnswerHistory& history) {
  std::vector<double> totals{1e-6};
  for (const AnswerHistory::Answer& answer : history.answers()) {
    totals.push_back(answer.total);
  }
  const auto slow = totals.begin() + static_cast<std::ptrdiff_t>(totals.size() * 49 / 50);
  std::nth_element(totals.begin(), slow, totals.end());
  return round_up(*slow);
}

/// The times of parts, each on those before it.
void draw_times(QPainter& painter, const AnswerHistory& history, const PlotAxes& axes) {
  const double top = highest_time(history);
  axes.draw(painter, {{0.0, "0"}, {0.5, plot_number(0.5e3 * top)}, {1.0, plot_number(1e3 * top)}},
            "time of an answer by part [ms]");
  painter.setPen(Qt::NoPen);
  const auto& answers = history.answers();
  for (std::size_t i = 0; i < answers.size(); ++i) {
    // Each is drawn up to the next one, which a stall leaves for another second at most.
    const double until =
        std::min(i + 1 < answers.size() ? answers[i + 1].time : axes.end, answers[i].time + 1.0);
    double below = 0.0;
    const auto add = [&](double seconds, const QColor& color) {
      const QRectF bar(QPointF(axes.x(answers[i].time), axes.y((below + seconds) / top)),
                       QPointF(axes.x(until) + 0.5, axes.y(below / top)));
      painter.fillRect(bar, color);
      below += seconds;
    };
    for (std::size_t part = 0; part < answers[i].part_times.size(); ++part) {
      add(answers[i].part_times[part], plot_color(part));
    }
    add(std::max(0.0, answers[i].total - below), rest_color);
  }
}

/// The names of the parts in their colours, from here down.
/// @returns where they end
double draw_legend(QPainter& painter, const AnswerHistory& history, QPointF at, double right) {
  const QFontMetrics metrics(painter.font());
  const double left = at.x();
  at.ry() += metrics.lineSpacing();
  const auto add = [&](const QString& name, const QColor& color) {
    const double width = metrics.boundingRect(name).width() + 20.0;
    if (at.x() + width > right) {
      at = {left, at.y() + metrics.lineSpacing()};
    }
    painter.fillRect(QRectF(at.x(), at.y() - 8.0, 8.0, 8.0), color);
    painter.setPen(plot_ink());
    painter.drawText(QPointF(at.x() + 11.0, at.y()), name);
    at.rx() += width;
  };
  for (std::size_t part = 0; part < history.parts().size(); ++part) {
    add(QString::fromStdString(history.parts()[part]), plot_color(part));
  }
  add("rest", rest_color);
  return at.y() + metrics.descent();
}

void draw_uncertainties(QPainter& painter, const AnswerHistory& history, const PlotAxes& axes) {
  const double decades = std::log10(highest_uncertainty / lowest_uncertainty);
  const auto share = [&](double meters) {
    return std::log10(std::max(meters, lowest_uncertainty) / lowest_uncertainty) / decades;
  };
  axes.draw(painter,
            {{0.0, "0"},
             {share(1e-9), "1e-6"},
             {share(1e-6), "0.001"},
             {share(1e-3), "1"},
             {1.0, "unknown"}},
            "what is uncertain [mm]");
  for (const AnswerHistory::Answer& answer : history.answers()) {
    const bool is_known = std::isfinite(answer.uncertainty);
    painter.setPen(QPen(is_known ? QColor(0, 114, 178) : unknown_color, 3.0));
    painter.drawPoint(
        QPointF(axes.x(answer.time), axes.y(is_known ? share(answer.uncertainty) : 1.0)));
  }
}

/// @param has_texts whether what was changed is written beside the lines
void draw_marks(QPainter& painter, const AnswerHistory& history, const PlotAxes& axes,
                bool has_texts) {
  const QFontMetrics metrics(painter.font());
  int row = 0;
  for (const AnswerHistory::Mark& mark : history.marks()) {
    const double x = axes.x(mark.time);
    painter.setPen(QPen(unknown_color, 1.0, Qt::DashLine));
    painter.drawLine(QPointF(x, axes.area.top()), QPointF(x, axes.area.bottom()));
    if (has_texts) {
      const QString text = QString::fromStdString(mark.text);
      const double width = metrics.boundingRect(text).width() + 6.0;
      painter.setPen(unknown_color);
      painter.drawText(QPointF(std::min(x + 3.0, axes.area.right() - width),
                               axes.area.top() + metrics.lineSpacing() * (1 + row++ % 4)),
                       text);
    }
  }
}

}  // namespace

AnswerPlot::AnswerPlot(const AnswerHistory& history, QWidget* parent)
    : QWidget(parent), history_(history) {
  setMinimumSize(240, 220);
}

void AnswerPlot::show_at(double now) {
  now_ = now;
  update();
}

void AnswerPlot::paintEvent(QPaintEvent* /*event*/) {
  QPainter painter(this);
  QFont font("Sans");
  font.setPixelSize(11);
  painter.setFont(font);
  constexpr double left = 54.0;
  constexpr double title = 18.0;
  const double right = width() - 6.0;
  const PlotAxes times{QRectF(QPointF(left, title), QPointF(right, 0.5 * height())),
                       now_ - history_.length(), now_};
  draw_times(painter, history_, times);
  const double legend_end = draw_legend(painter, history_, times.area.bottomLeft(), right);
  const PlotAxes uncertainties{
      QRectF(QPointF(left, legend_end + title), QPointF(right, height() - 6.0)), times.begin, now_};
  draw_uncertainties(painter, history_, uncertainties);
  draw_marks(painter, history_, times, true);
  draw_marks(painter, history_, uncertainties, false);
  if (history_.answers().empty()) {
    painter.setPen(unknown_color);
    painter.drawText(times.area, Qt::AlignCenter, "no answer in the last 30 s");
  }
}

}  // namespace fiber_proximity_rviz
