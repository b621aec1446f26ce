// `fiber_query accuracy`: what each setting costs and errs on the user's own frames.
#include <algorithm>
#include <filesystem>
#include <iostream>
#include <memory>
#include <optional>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

#include "fiber_proximity/io/file.hpp"
#include "src/accuracy/accuracy_picture.hpp"
#include "src/accuracy/accuracy_report.hpp"
#include "src/accuracy/frame_survey.hpp"
#include "src/accuracy/number_text.hpp"
#include "src/accuracy/setting_choices.hpp"
#include "src/accuracy/setting_measurement.hpp"
#include "src/text/quote.hpp"
#include "src/tools/fiber_query.hpp"
#include "src/tools/progress.hpp"
#include "src/tools/read_input.hpp"

namespace fiber {
namespace {

/// Parts of the time that looking at the frames may take, before any setting is measured.
constexpr double survey_part = 0.1;

struct AccuracyRequest : FiberRequest {
  std::string engine = "run_tree";
  std::vector<std::string> engines;
  std::vector<std::string> questions = compared_questions();
  std::optional<double> margin;  // [m]
  std::optional<double> noise;   // [m]
  std::optional<double> rate;    // [Hz]
  QueryOptions options;
  double seconds = 40.0;
  std::size_t answers = 2000;
  std::string picture;
  std::string format = "text";
};

std::string frames_text(std::size_t count) {
  return std::to_string(count) + (count == 1 ? " frame" : " frames");
}

/// The frames of a file that have segments.
std::vector<FiberFrame> read_frames(const AccuracyRequest& request) {
  FiberFile file = read_input("fiber_query", request.file, request.reading);
  std::vector<FiberFrame> frames;
  for (FiberFrame& frame : file.frames) {
    if (frame.fibers.segment_count() > 0) {
      frames.push_back(std::move(frame));
    }
  }
  if (frames.empty()) {
    throw std::invalid_argument(quote(request.file) + " has no frame with fibres");
  }
  if (frames.size() < file.frames.size()) {
    std::cerr << "fiber_query: " << frames_text(file.frames.size() - frames.size())
              << " without fibres left out\n";
  }
  return frames;
}

/// The margin that is asked for, or one with contacts.
/// @throws std::invalid_argument if there is nothing to measure
double margin_of(const AccuracyRequest& request, const std::vector<FiberFrame>& frames) {
  const FrameSurvey survey =
      survey_frames(frames, request.options, TimeBudget(survey_part * request.seconds));
  const std::string looked_at =
      survey.frames == frames.size()
          ? frames_text(frames.size())
          : std::to_string(survey.frames) + " of " + frames_text(frames.size());
  if (survey.closest.empty()) {
    throw std::invalid_argument(
        quote(request.file) + " has no pair of segments in " + looked_at +
        ": all are of one fibre, or of fibres that are joined, and make no loop; "
        "--neighbour-skip 1 asks about all of them");
  }
  if (!request.margin) {
    return survey.suggested_margin();
  }
  if (survey.minimum() > *request.margin) {
    throw std::invalid_argument("nothing comes within a margin of " + millimetres(*request.margin) +
                                " in " + looked_at + ", the nearest pair to " +
                                millimetres(survey.minimum()) + "; try --margin " +
                                rounded_text(survey.suggested_margin(), 6));
  }
  return *request.margin;
}

/// Refuses a question that is named twice.
std::string refuse_again(const std::vector<std::string>& questions) {
  for (const std::string& question : questions) {
    if (std::count(questions.begin(), questions.end(), question) > 1) {
      return quote(question) + " is there twice";
    }
  }
  return "";
}

SettingChoices choices_of(const AccuracyRequest& request, const std::vector<FiberFrame>& frames,
                          AccuracyReport& report) {
  SettingChoices choices;
  choices.options = request.options;
  choices.options.margin = report.margin;
  choices.engine = request.engine;
  choices.other_engines = request.engines;
  choices.engine_options = request.engine_options;
  choose_by_frames(frames, report.track.step, choices, report.left_out);
  return choices;
}

/// Sorts what was measured by questions, in the order in which they are reported.
std::vector<QuestionReport> questions_of(const AccuracyRequest& request,
                                         const AccuracyReport& report,
                                         const std::vector<SettingOutcome>& outcomes) {
  std::vector<QuestionReport> questions;
  for (auto question = request.questions.rbegin(); question != request.questions.rend();
       ++question) {
    questions.push_back(report_of(*question, outcomes, report.track.noise, report.frame_time));
  }
  return questions;
}

AccuracyReport measure(const AccuracyRequest& request) {
  const std::vector<FiberFrame> frames = read_frames(request);
  Progress progress;
  progress.show("looking at the frames");
  AccuracyReport report;
  report.file = request.file;
  report.frames = frames.size();
  report.fibers = frames.front().fibers.fiber_count();
  report.segments = frames.front().fibers.segment_count();
  report.margin = margin_of(request, frames);
  report.track = estimate_noise(frames);
  if (frames.size() == 1) {
    std::cerr << "fiber_query: " << quote(request.file)
              << " has one frame: the tracker's noise and what a skin saves cannot be told\n";
  }
  if (request.noise) {
    report.track.noise = request.noise;
  }
  if (request.rate) {
    report.frame_time = 1.0 / *request.rate;
  }
  const SettingChoices choices = choices_of(request, frames, report);
  const std::vector<AnswerSetting> settings = settings_of(request.questions, choices);
  const SettingMeasurement measurement =
      measure_settings(frames, settings, TimeBudget((1.0 - survey_part) * request.seconds),
                       request.answers, [&](const std::string& text) { progress.show(text); });
  report.measured_frames = measurement.frames;
  if (measurement.frames < frames.size()) {
    report.left_out.push_back(std::to_string(frames.size() - measurement.frames) + " of " +
                              frames_text(frames.size()) + ", spread over all: there were " +
                              rounded_text(request.seconds, 3) + " s");
  }
  report.left_out.insert(report.left_out.end(), measurement.left_out.begin(),
                         measurement.left_out.end());
  report.questions = questions_of(request, report, measurement.outcomes);
  return report;
}

ExitCode run(const AccuracyRequest& request) {
  std::optional<OutputFile> picture;
  if (!request.picture.empty()) {
    if (std::filesystem::path(request.picture).extension() != ".svg") {
      throw std::invalid_argument("--picture is " + quote(request.picture) +
                                  ", its name must end in .svg");
    }
    picture.emplace(request.picture);  // before the long work, as it may not be writable
  }
  const AccuracyReport report = measure(request);
  std::cout << (request.format == "csv"    ? csv_of(report)
                : request.format == "json" ? json_of(report)
                                           : text_of(report));
  if (picture) {
    picture->write(picture_of(report));
    picture->close();
  }
  if (!report.all_bounds_hold()) {
    std::cerr << "fiber_query: BOUNDS DO NOT HOLD: answers excluded the exact distance, see the "
                 "bounds kept; please report this with the file\n";
    return DISAGREED;
  }
  return SUCCEEDED;
}

void add_options(CLI::App& app, AccuracyRequest& request) {
  add_fiber_options(app, request, file_help, threads_help);
  add_engine_option(app, request.engine);
  app.add_option("--engines", request.engines, "to be compared, with commas between them")
      ->delimiter(',')
      ->capture_default_str();
  app.add_option("--questions", request.questions,
                 "types of queries, the one that matters most first; the last line is about it")
      ->delimiter(',')
      ->check(CLI::IsMember(compared_questions()))
      ->capture_default_str();
  app.add_option("--margin", request.margin,
                 "contacts are pairs with a gap of at most this [m]; without, a round one with "
                 "contacts in half of the frames")
      ->check(length());
  add_neighbour_options(app, request.options.neighbour_skip, request.options.neighbour_skip_length);
  app.get_option("--neighbour-skip")->check(whole_number(0));
  app.get_option("--neighbour-skip-length")->check(finite_number(0.0));
  app.add_option("--noise", request.noise,
                 "of the tracked points, the standard deviation of a coordinate [m]; without, it "
                 "is estimated from the frames")
      ->check(length());
  app.add_option("--rate", request.rate,
                 "frames per second [Hz]: an answer should be there before "
                 "the next one")
      ->check(CLI::PositiveNumber);
  app.add_option("--seconds", request.seconds,
                 "to measure for; what there is no time for is left out and named")
      ->check(CLI::PositiveNumber)
      ->capture_default_str();
  app.add_option("--answers", request.answers,
                 "of each setting, where there is time; few frames are asked about again")
      ->check(whole_number(1))
      ->capture_default_str();
  app.add_option("--picture", request.picture, "time against error as SVG, to this file");
  app.add_option("--format", request.format,
                 "of the output; csv: a row per question and setting; json: one object; the last "
                 "line is or has the recommendation")
      ->check(CLI::IsMember({"csv", "json", "text"}))
      ->capture_default_str();
}

}  // namespace

void add_accuracy(CLI::App& app, Command& command, const std::vector<std::string>& engines) {
  CLI::App* const accuracy = app.add_subcommand(
      "accuracy",
      "what each setting costs and errs on these frames: time, largest error, contacts missed, "
      "beside the exact answer; and which one to take");
  const auto request = std::make_shared<AccuracyRequest>();
  request->engines = engines;
  add_options(*accuracy, *request);
  accuracy->callback([&command, request] {
    for (const std::string& engine : request->engines) {
      make_engine(engine);  // refuses an unknown one before anything is measured
    }
    if (const std::string reason = refuse_again(request->questions); !reason.empty()) {
      throw std::invalid_argument("--questions: " + reason);
    }
    validate(request->options);
    command = [request] { return run(*request); };
  });
}

}  // namespace fiber
