#include "src/accuracy/accuracy_report.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <iterator>
#include <nlohmann/json.hpp>

#include "src/accuracy/number_text.hpp"
#include "src/io/number.hpp"

namespace fiber {
namespace {

using Json = nlohmann::ordered_json;

/// The fields of a row, with the names that CSV and JSON have for them.
Json row_of(const QuestionReport& question, std::size_t index) {
  const SettingOutcome& outcome = question.outcomes[index];
  const AnswerSetting& setting = outcome.setting;
  return {{"question", question.question},
          {"setting", setting.name},
          {"kind", name_of(setting.kind)},
          {"kernel", name_of(setting.options.kernel)},
          {"tolerance", setting.options.tolerance},
          {"deadline_ms", outcome.deadline_ms},
          {"engine", setting.engine},
          {"threads", setting.engine_options.threads},
          {"skin",
           setting.engine_options.skin ? Json(*setting.engine_options.skin) : Json("automatic")},
          {"chord_error", setting.chord_error},
          {"answers", outcome.answers},
          {"p50_ms", outcome.p50_ms},
          {"p99_ms", outcome.p99_ms},
          {"error_mm", 1e3 * outcome.error},
          {"doubt_mm", 1e3 * outcome.doubt},
          {"missed_percent", outcome.missed_percent},
          {"invented_percent", outcome.invented_percent},
          {"complete_percent", outcome.complete_percent},
          {"bounds_kept_percent",
           outcome.bounds_kept_percent ? Json(*outcome.bounds_kept_percent) : Json(nullptr)},
          {"dominated", static_cast<bool>(question.dominated[index])},
          {"recommended", index == question.recommendation.index}};
}

std::string csv_field_of(const Json& value) {
  if (value.is_null()) {
    return "";
  }
  if (value.is_boolean()) {
    return value.get<bool>() ? "1" : "0";
  }
  if (value.is_number_float()) {
    std::string text;
    append_number(text, value.get<double>());
    return text;
  }
  return value.is_string() ? value.get<std::string>() : value.dump();
}

Json number_or_null(double value) { return std::isfinite(value) ? Json(value) : Json(nullptr); }

std::string padded(const std::string& text, std::size_t width) {
  return text.size() < width ? std::string(width - text.size(), ' ') + text : text;
}

/// A table in which the first column begins, and the others end, on a line.
std::string table_of(const std::vector<std::vector<std::string>>& rows) {
  std::vector<std::size_t> widths(rows.front().size(), 0);
  for (const std::vector<std::string>& row : rows) {
    for (std::size_t i = 0; i < row.size(); ++i) {
      widths[i] = std::max(widths[i], row[i].size());
    }
  }
  std::string text;
  for (const std::vector<std::string>& row : rows) {
    text += "  " + row.front() + std::string(widths.front() - row.front().size(), ' ');
    for (std::size_t i = 1; i < row.size(); ++i) {
      text += "  " + padded(row[i], widths[i]);
    }
    text += '\n';
  }
  return text;
}

std::string percent_text(double percent) { return rounded_text(percent, 3); }

std::string table_of(const QuestionReport& question) {
  std::vector<std::vector<std::string>> rows{{question.question, "p50 [ms]", "p99 [ms]",
                                              "error [mm]", "doubt [mm]", "missed [%]",
                                              "invented [%]", "complete [%]", "bounds kept [%]"}};
  for (const SettingOutcome& outcome : question.outcomes) {
    rows.push_back(
        {outcome.setting.name, rounded_text(outcome.p50_ms, 3), rounded_text(outcome.p99_ms, 3),
         rounded_text(1e3 * outcome.error), rounded_text(1e3 * outcome.doubt),
         percent_text(outcome.missed_percent), percent_text(outcome.invented_percent),
         percent_text(outcome.complete_percent),
         outcome.bounds_kept_percent ? percent_text(*outcome.bounds_kept_percent) : "none stated"});
  }
  return table_of(rows);
}

std::string noise_text(const TrackNoise& track) {
  return track.noise ? "noise of a coordinate " + millimetres(*track.noise)
                     : "noise not known: " + track.reason;
}

std::string sentence_of(const QuestionReport& question) {
  return question.question + ": " + question.recommendation.sentence;
}

}  // namespace

QuestionReport report_of(const std::string& question, const std::vector<SettingOutcome>& outcomes,
                         std::optional<double> noise, std::optional<double> frame_time) {
  QuestionReport report;
  report.question = question;
  std::copy_if(outcomes.begin(), outcomes.end(), std::back_inserter(report.outcomes),
               [&](const SettingOutcome& outcome) { return outcome.setting.question == question; });
  report.dominated = dominated(report.outcomes);
  report.recommendation = recommend(report.outcomes, noise, frame_time);
  return report;
}

bool AccuracyReport::all_bounds_hold() const {
  for (const QuestionReport& question : questions) {
    for (const SettingOutcome& outcome : question.outcomes) {
      if (outcome.bounds_kept_percent.value_or(100.0) < 100.0) {
        return false;
      }
    }
  }
  return true;
}

DoubtSources AccuracyReport::doubt(const QuestionReport& question) const {
  const auto reference =
      std::find_if(question.outcomes.begin(), question.outcomes.end(),
                   [](const SettingOutcome& outcome) { return outcome.setting.is_reference; });
  return doubt_sources(track, question.taken(), *reference);
}

std::string text_of(const AccuracyReport& report) {
  std::string text =
      report.file + ": " + std::to_string(report.measured_frames) + " of " +
      std::to_string(report.frames) + (report.frames == 1 ? " frame, " : " frames, ") +
      std::to_string(report.fibers) + (report.fibers == 1 ? " fibre, " : " fibres, ") +
      std::to_string(report.segments) + " segments, margin " + millimetres(report.margin) + ", " +
      noise_text(report.track) + ", points move " + millimetres(report.track.step) + " a frame\n";
  for (const QuestionReport& question : report.questions) {
    text += '\n' + table_of(question);
  }
  text += '\n';
  for (const std::string& reason : report.left_out) {
    text += "left out: " + reason + '\n';
  }
  const DoubtSources doubt = report.doubt(report.questions.back());
  text += "doubt about a gap: " + text_of(doubt) + '\n';
  if (doubt.uncertainty().value_or(0.0) > 0.0) {
    text += "tell the node: uncertainty: " + rounded_text(*doubt.uncertainty()) +
            " [m], 4 standard deviations\n";
  }
  for (const QuestionReport& question : report.questions) {
    text += sentence_of(question) + '\n';
  }
  return text;
}

std::string csv_of(const AccuracyReport& report) {
  std::string text;
  for (const QuestionReport& question : report.questions) {
    for (std::size_t i = 0; i < question.outcomes.size(); ++i) {
      const Json row = row_of(question, i);
      std::string header;
      std::string line;
      for (const auto& [name, value] : row.items()) {
        header += (header.empty() ? "" : ",") + name;
        line += (line.empty() ? "" : ",") + csv_field_of(value);
      }
      text += (text.empty() ? header + '\n' : "") + line + '\n';
    }
  }
  for (const QuestionReport& question : report.questions) {
    text += "# " + sentence_of(question) + '\n';
  }
  return text;
}

std::string json_of(const AccuracyReport& report) {
  Json object = {{"file", report.file},
                 {"frames", report.frames},
                 {"measured_frames", report.measured_frames},
                 {"fibers", report.fibers},
                 {"segments", report.segments},
                 {"margin", report.margin},
                 {"noise", report.track.noise ? Json(*report.track.noise) : Json(nullptr)},
                 {"step", report.track.step},
                 {"frame_time", report.frame_time ? Json(*report.frame_time) : Json(nullptr)},
                 {"left_out", report.left_out}};
  object["settings"] = Json::array();
  object["recommendations"] = Json::object();
  for (const QuestionReport& question : report.questions) {
    for (std::size_t i = 0; i < question.outcomes.size(); ++i) {
      Json row = row_of(question, i);
      for (Json& value : row) {
        value = value.is_number_float() ? number_or_null(value.get<double>()) : value;
      }
      object["settings"].push_back(row);
    }
    const DoubtSources doubt = report.doubt(question);
    object["recommendations"][question.question] = {
        {"setting", question.taken().setting.name},
        {"sentence", question.recommendation.sentence},
        {"doubt",
         {{"tracker", doubt.tracker ? Json(*doubt.tracker) : Json(nullptr)},
          {"latency", doubt.latency},
          {"setting", number_or_null(doubt.setting)},
          {"kernel", number_or_null(doubt.kernel)}}}};
  }
  object["recommendation"] = sentence_of(report.questions.back());
  return object.dump(-1, ' ', false, Json::error_handler_t::replace) + '\n';
}

}  // namespace fiber
