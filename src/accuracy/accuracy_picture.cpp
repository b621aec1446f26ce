#include "src/accuracy/accuracy_picture.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <filesystem>
#include <limits>
#include <map>
#include <vector>

#include "src/accuracy/number_text.hpp"
#include "src/accuracy/svg_drawing.hpp"

namespace fiber {
namespace {

// [px]
constexpr double panel_width = 480;
constexpr double panel_height = 330;
constexpr double top = 30;  // of the drawing, for the title
constexpr double left_space = 66;
constexpr double right_space = 18;
constexpr double upper_space = 30;
constexpr double lower_space = 46;
constexpr double exact_space = 56;  // below the axis of errors, for those that are none
constexpr int columns = 2;

// [mm] Smaller errors are drawn at the edge of the axis, which goes up to the other one at least.
constexpr double min_error = 1e-6;
constexpr double min_top_error = 100.0;

const char* const grey = "#888888";
const char* const light = "#e4e4e4";

/// How a setting is drawn.
struct Look {
  std::string colour;
  SettingKind kind = SettingKind::KERNEL;
};

/// Colours of a kind, for its settings one after another; dark to light.
const std::vector<std::string>& colours_of(SettingKind kind) {
  static const std::map<SettingKind, std::vector<std::string>> colours{
      {SettingKind::KERNEL, {"#000000", "#3b5bdb"}},
      {SettingKind::TOLERANCE, {"#0b4f24", "#1f8f45", "#4fc06f", "#98dcaa"}},
      {SettingKind::DEADLINE, {"#8c1d18", "#d64541", "#f19a8e"}},
      {SettingKind::ENGINE, {"#e08a00", "#f2b134", "#b86e00", "#8a5a00"}},
      {SettingKind::SKIN, {"#6a1b9a", "#b36ad1"}},
      {SettingKind::THREADS, {"#7a4a2b", "#b98a6a"}},
      {SettingKind::RESAMPLING, {"#00606b", "#0097a7", "#4dc4cf", "#a5e1e6"}}};
  return colours.at(kind);
}

/// Looks by the names of settings, and the names in their order.
struct Looks {
  std::map<std::string, Look> by_name;
  std::vector<std::string> names;
};

Looks looks_of(const AccuracyReport& report) {
  Looks looks;
  std::map<SettingKind, std::size_t> counts;
  for (const QuestionReport& question : report.questions) {
    for (const SettingOutcome& outcome : question.outcomes) {
      const AnswerSetting& setting = outcome.setting;
      if (looks.by_name.count(setting.name) == 0) {
        const std::vector<std::string>& colours = colours_of(setting.kind);
        looks.by_name[setting.name] = {colours[counts[setting.kind]++ % colours.size()],
                                       setting.kind};
        looks.names.push_back(setting.name);
      }
    }
  }
  std::stable_sort(looks.names.begin(), looks.names.end(),
                   [&](const std::string& x, const std::string& y) {
                     return looks.by_name[x].kind < looks.by_name[y].kind;
                   });
  return looks;
}

/// A logarithmic axis.
struct LogAxis {
  double min;
  double max;
  double begin;  // [px]
  double end;    // [px]

  double place(double value) const {
    const double part = std::log(std::clamp(value, min, max) / min) / std::log(max / min);
    return begin + part * (end - begin);
  }
};

/// [ms] From the fastest to the slowest of a question, and the time of a frame.
LogAxis time_axis(const QuestionReport& question, std::optional<double> frame_time) {
  double min = std::numeric_limits<double>::infinity();
  double max = 0.0;
  for (const SettingOutcome& outcome : question.outcomes) {
    min = std::min(min, outcome.p50_ms);
    max = std::max(max, outcome.p99_ms);
  }
  if (frame_time) {
    max = std::max(max, 1e3 * *frame_time);
  }
  return {0.8 * min, 1.25 * max, left_space, panel_width - right_space};
}

/// [mm] From the power of ten below the smallest error that is one, or the noise.
LogAxis error_axis(const AccuracyReport& report) {
  double min = 1.0;
  double max = min_top_error;
  const auto include = [&](double error) {
    if (error >= min_error && std::isfinite(error)) {
      min = std::min(min, std::pow(10.0, std::floor(std::log10(error))));
      max = std::max(max, 2.0 * error);
    }
  };
  include(1e3 * report.track.noise.value_or(0.0));
  for (const QuestionReport& question : report.questions) {
    for (const SettingOutcome& outcome : question.outcomes) {
      include(1e3 * outcome.error);
    }
  }
  return {min, max, panel_height - lower_space - exact_space, upper_space};
}

/// Values 1, 2 and 5 of each power of ten on an axis, or where these are too many 1.
std::vector<double> ticks_of(const LogAxis& axis, bool is_coarse) {
  std::vector<double> ticks;
  const bool is_long = axis.max / axis.min > 300.0;
  for (int power = -9; power < 9; ++power) {
    for (const double digit : {1.0, 2.0, 5.0}) {
      const double value = digit * std::pow(10.0, power);
      if (value >= axis.min && value <= axis.max && (digit == 1.0 || !(is_coarse || is_long))) {
        ticks.push_back(value);
      }
    }
  }
  return ticks;
}

std::string points_around(double x, double y, const std::vector<std::array<double, 2>>& corners) {
  std::string points;
  for (const auto& [dx, dy] : corners) {
    points += (points.empty() ? "" : " ") + rounded_text(x + dx, 6) + ',' + rounded_text(y + dy, 6);
  }
  return points;
}

/// A shape for each kind, so that colours need not tell alone.
void draw_mark(SvgDrawing& drawing, double x, double y, const Look& look) {
  constexpr double r = 5.5;
  const std::string edge = "stroke=\"white\" stroke-width=\"0.8\"";
  const auto polygon = [&](const std::vector<std::array<double, 2>>& corners) {
    drawing.polygon(points_around(x, y, corners), look.colour, edge);
  };
  switch (look.kind) {
    case SettingKind::KERNEL:
      drawing.circle(x, y, r, look.colour, edge);
      break;
    case SettingKind::TOLERANCE:
      polygon({{-r, r}, {r, r}, {0, -r}});
      break;
    case SettingKind::DEADLINE:
      polygon({{-r, -r}, {r, -r}, {0, r}});
      break;
    case SettingKind::ENGINE:
      polygon({{-r, -r}, {r, -r}, {r, r}, {-r, r}});
      break;
    case SettingKind::SKIN:
      polygon({{0, -1.3 * r}, {1.3 * r, 0}, {0, 1.3 * r}, {-1.3 * r, 0}});
      break;
    case SettingKind::THREADS:
      polygon({{-r, -r}, {0, -r / 2}, {r, -r}, {r, r}, {0, r / 2}, {-r, r}});
      break;
    case SettingKind::RESAMPLING:
      polygon({{-r, -0.5 * r},
               {0, -1.2 * r},
               {r, -0.5 * r},
               {r, 0.6 * r},
               {0, 1.2 * r},
               {-r, 0.6 * r}});
      break;
  }
}

class Panel {
 public:
  Panel(SvgDrawing& drawing, const AccuracyReport& report, const QuestionReport& question,
        const Looks& looks)
      : drawing_(drawing),
        report_(report),
        question_(question),
        looks_(looks),
        times_(time_axis(question, report.frame_time)),
        errors_(error_axis(report)) {}

  void draw() {
    for (const SettingOutcome& outcome : question_.outcomes) {
      exact_count_ += is_exact(outcome) ? 1 : 0;
    }
    draw_axes();
    draw_lines();
    // Pale ones first: those that matter lie above.
    for (const bool is_pale : {true, false}) {
      for (std::size_t i = 0; i < question_.outcomes.size(); ++i) {
        if (question_.dominated[i] == is_pale) {
          draw_outcome(i);
        }
      }
    }
  }

 private:
  static bool is_exact(const SettingOutcome& outcome) { return 1e3 * outcome.error < min_error; }

  void draw_axes() {
    drawing_.text(left_space, upper_space - 10, question_.question, TextAnchor::START,
                  "font-weight=\"bold\" font-size=\"14\"");
    for (const double tick : ticks_of(times_, false)) {
      const double x = times_.place(tick);
      drawing_.line(x, bottom, x, errors_.end, light);
      drawing_.text(x, bottom + 15, rounded_text(tick), TextAnchor::MIDDLE);
    }
    for (const double tick : ticks_of(errors_, true)) {
      const double y = errors_.place(tick);
      drawing_.line(times_.begin, y, times_.end, y, light);
      drawing_.text(times_.begin - 6, y + 4, rounded_text(tick), TextAnchor::END);
    }
    drawing_.text(times_.begin - 6, errors_.begin + 0.5 * exact_space + 4, "exact",
                  TextAnchor::END);
    drawing_.line(times_.begin, errors_.begin, times_.end, errors_.begin, grey);
    drawing_.line(times_.begin, bottom, times_.end, bottom, grey);
    drawing_.line(times_.begin, bottom, times_.begin, errors_.end, grey);
    const double middle = 0.5 * (errors_.begin + errors_.end);
    drawing_.text(0.5 * (times_.begin + times_.end), panel_height - 12,
                  "time of an answer [ms], median and 99th percentile", TextAnchor::MIDDLE);
    drawing_.text(16, middle, "largest error [mm]", TextAnchor::MIDDLE,
                  "transform=\"rotate(-90 16 " + rounded_text(middle, 5) + ")\"");
  }

  void draw_lines() {
    const std::string dashed = "stroke-dasharray=\"6 4\"";
    if (report_.track.noise && 1e3 * *report_.track.noise > min_error) {
      const double y = errors_.place(1e3 * *report_.track.noise);
      drawing_.line(times_.begin, y, times_.end, y, grey, dashed);
      drawing_.text(times_.end - 2, y - 4, "tracker's noise " + millimetres(*report_.track.noise),
                    TextAnchor::END, "fill=\"#555555\"");
    }
    if (report_.frame_time) {
      const double x = times_.place(1e3 * *report_.frame_time);
      drawing_.line(x, bottom, x, errors_.end, grey, dashed);
      drawing_.text(x - 4, errors_.end + 12, "next frame", TextAnchor::END, "fill=\"#555555\"");
    }
  }

  void draw_outcome(std::size_t index) {
    const SettingOutcome& outcome = question_.outcomes[index];
    const Look& look = looks_.by_name.at(outcome.setting.name);
    const double x = times_.place(outcome.p50_ms);
    const double y = is_exact(outcome) ? exact_place(index) : errors_.place(1e3 * outcome.error);
    drawing_.begin_group(outcome.setting.name + ": " + rounded_text(outcome.p50_ms, 3) + " ms, " +
                             millimetres(outcome.error) + ", missed " +
                             rounded_text(outcome.missed_percent, 3) + " %",
                         question_.dominated[index] ? "opacity=\"0.25\"" : "");
    drawing_.line(x, y, times_.place(outcome.p99_ms), y, look.colour);
    if (outcome.doubt > outcome.error && 1e3 * outcome.doubt >= min_error) {
      drawing_.line(x, y, x, errors_.place(1e3 * outcome.doubt), look.colour,
                    "stroke-dasharray=\"1 3\"");
    }
    if (index == question_.recommendation.index) {
      drawing_.circle(x, y, 10, "none", "stroke=\"#000000\" stroke-width=\"1.3\"");
    }
    draw_mark(drawing_, x, y, look);
    drawing_.end_group();
  }

  /// Those without an error lie below each other, so that all are seen.
  double exact_place(std::size_t index) const {
    const auto before =
        std::count_if(question_.outcomes.begin(),
                      question_.outcomes.begin() + static_cast<std::ptrdiff_t>(index), is_exact);
    return errors_.begin +
           exact_space * static_cast<double>(before + 1) / static_cast<double>(exact_count_ + 1);
  }

  static constexpr double bottom = panel_height - lower_space;

  SvgDrawing& drawing_;
  const AccuracyReport& report_;
  const QuestionReport& question_;
  const Looks& looks_;
  const LogAxis times_;
  const LogAxis errors_;
  std::size_t exact_count_ = 0;
};

void draw_legend(SvgDrawing& drawing, const Looks& looks) {
  constexpr double row = 22;
  const std::size_t half = (looks.names.size() + 1) / 2;
  for (std::size_t i = 0; i < looks.names.size(); ++i) {
    const double x = left_space + (i < half ? 0.0 : 200.0);
    const double y = upper_space + row * static_cast<double>(i < half ? i : i - half);
    draw_mark(drawing, x, y - 4, looks.by_name.at(looks.names[i]));
    drawing.text(x + 14, y, looks.names[i]);
  }
  const double below = upper_space + row * static_cast<double>(half) + 6;
  drawing.circle(left_space, below - 4, 8, "none", "stroke=\"#000000\" stroke-width=\"1.3\"");
  drawing.text(left_space + 14, below, "what to take; left and low is good");
  drawing.text(left_space + 14, below + 18, "pale: another one is as accurate and faster");
  drawing.text(left_space + 14, below + 36, "dotted: up to what the answer states itself");
  drawing.text(left_space + 14, below + 54, "at the upper edge: no answer at all, or beyond it");
}

}  // namespace

std::string picture_of(const AccuracyReport& report) {
  const std::size_t cells = report.questions.size() + 1;
  const std::size_t rows = (cells + columns - 1) / columns;
  SvgDrawing drawing(columns * panel_width, top + panel_height * static_cast<double>(rows));
  drawing.text(left_space, 20,
               std::filesystem::path(report.file).filename().string() + ": " +
                   std::to_string(report.segments) + " segments, margin " +
                   millimetres(report.margin),
               TextAnchor::START, "font-size=\"14\"");
  const Looks looks = looks_of(report);
  for (std::size_t cell = 0; cell < cells; ++cell) {
    const double x = panel_width * static_cast<double>(cell % columns);
    const double y = top + panel_height * static_cast<double>(cell / columns);
    // The question that matters most is the last one of a report, and the first panel.
    const QuestionReport* const question =
        cell < report.questions.size() ? &report.questions.rbegin()[cell] : nullptr;
    drawing.begin_group(
        question != nullptr ? question->question : "settings",
        "transform=\"translate(" + rounded_text(x, 6) + ' ' + rounded_text(y, 6) + ")\"");
    if (question != nullptr) {
      Panel(drawing, report, *question, looks).draw();
    } else {
      draw_legend(drawing, looks);
    }
    drawing.end_group();
  }
  return drawing.document();
}

}  // namespace fiber
