#include "src/ros/server/measure_service.hpp"

#include <sys/resource.h>
#include <sys/syscall.h>
#include <unistd.h>

#include <chrono>
#include <cmath>
#include <optional>
#include <stdexcept>
#include <utility>

#include "fiber_proximity/io/fiber_file.hpp"
#include "src/accuracy/recommendation.hpp"
#include "src/accuracy/setting_measurement.hpp"

namespace fiber_proximity_ros {
namespace {

using fiber_proximity::MeasureSettings;

constexpr double default_seconds = 5.0;
constexpr double max_seconds = 60.0;
constexpr double collecting_part = 0.2;  // of the time
constexpr std::size_t max_frames = 100;

constexpr std::size_t max_answers = 500;  // of each setting

/// How much less than the node's thread this one weighs, where both want a core.
constexpr int niceness = 10;

double checked_seconds(double asked) {
  if (!(asked >= 0.0 && asked <= max_seconds)) {
    throw std::invalid_argument("seconds is " + std::to_string(asked) +
                                ", it must be above 0 and at most 60, or 0 for 5");
  }
  return asked > 0.0 ? asked : default_seconds;
}

std::optional<double> checked_noise(double asked) {
  if (!(asked >= 0.0 && std::isfinite(asked))) {
    throw std::invalid_argument("noise is " + std::to_string(asked) +
                                ", it must be finite and at least 0");
  }
  return asked > 0.0 ? std::optional<double>(asked) : std::nullopt;
}

fiber_proximity::SettingMeasurement setting_message(const fiber::SettingOutcome& outcome,
                                                    bool is_dominated) {
  fiber_proximity::SettingMeasurement message;
  message.question = outcome.setting.question;
  message.kind = fiber::name_of(outcome.setting.kind);
  message.name = outcome.setting.name;
  message.answers = static_cast<std::uint32_t>(outcome.answers);
  message.median_time = 1e-3 * outcome.p50_ms;
  message.p99_time = 1e-3 * outcome.p99_ms;
  message.error = outcome.error;
  message.doubt = outcome.doubt;
  message.missed_percent = outcome.missed_percent;
  message.invented_percent = outcome.invented_percent;
  message.complete_percent = outcome.complete_percent;
  message.bounds_kept_percent = outcome.bounds_kept_percent.value_or(100.0);
  message.dominated = static_cast<std::uint8_t>(is_dominated);
  return message;
}

/// The node's own question, and the closest pair, which tells errors best.
std::vector<std::string> questions_of(fiber::QueryType asked) {
  std::vector<std::string> questions;
  for (const std::string& question : fiber::compared_questions()) {
    const fiber::QueryType type = fiber::query_type_from_name(question);
    if (type == asked || type == fiber::QueryType::CLOSEST) {
      questions.push_back(question);
    }
  }
  return questions;
}

}  // namespace

MeasureService::MeasureService(const ros::NodeHandle& private_node, std::string engine)
    : engine_(std::move(engine)) {
  ros::NodeHandle node(private_node);
  node.setCallbackQueue(&queue_);
  server_ = node.advertiseService("measure_settings", &MeasureService::measure, this);
  spinner_.start();
}

MeasureService::~MeasureService() {
  is_ending_ = true;
  has_more_.notify_all();
  spinner_.stop();
}

void MeasureService::offer(const std::shared_ptr<const FiberMessage>& fibers,
                           const fiber::QueryOptions& asked) {
  if (!is_collecting_ || fibers->fibers.segment_count() == 0) {
    return;
  }
  const std::lock_guard<std::mutex> lock(mutex_);
  auto& frames = material_.frames;
  if (frames.size() < max_frames && (frames.empty() || frames.back() != fibers)) {
    frames.push_back(fibers);
    material_.asked = asked;
    has_more_.notify_all();
  }
}

MeasureService::Material MeasureService::collect(double seconds) {
  std::unique_lock<std::mutex> lock(mutex_);
  material_ = {};
  is_collecting_ = true;
  has_more_.wait_for(lock, std::chrono::duration<double>(seconds),
                     [this] { return is_ending_ || material_.frames.size() == max_frames; });
  is_collecting_ = false;
  if (material_.frames.empty()) {
    throw std::runtime_error("there are no fibres to measure with");
  }
  return std::exchange(material_, {});
}

bool MeasureService::measure(MeasureSettings::Request& request,
                             MeasureSettings::Response& response) {
  setpriority(PRIO_PROCESS, static_cast<id_t>(syscall(SYS_gettid)), niceness);
  try {
    const double seconds = checked_seconds(request.seconds);
    const std::optional<double> noise = checked_noise(request.noise);
    const fiber::TimeBudget budget(seconds);
    const Material material = collect(collecting_part * seconds);
    std::vector<fiber::FiberFrame> frames;
    for (const auto& message : material.frames) {
      frames.push_back({static_cast<std::int64_t>(frames.size()), message->fibers, {}});
    }
    fiber::SettingChoices choices;
    choices.options = material.asked;
    choices.options.tolerance = choices.options.relative_tolerance = 0.0;
    choices.options.deadline = 0.0;
    choices.engine = engine_;
    choices.engine_options.threads = 1;
    const std::vector<std::string> questions = questions_of(material.asked.type);
    const std::vector<fiber::AnswerSetting> settings = fiber::settings_of(questions, choices);
    const fiber::SettingMeasurement measured =
        fiber::measure_settings(frames, settings, budget, max_answers, [](const std::string&) {});
    for (const std::string& question : questions) {
      std::vector<fiber::SettingOutcome> outcomes;
      for (const fiber::SettingOutcome& outcome : measured.outcomes) {
        if (outcome.setting.question == question) {
          outcomes.push_back(outcome);
        }
      }
      const std::vector<bool> dominated = fiber::dominated(outcomes);
      for (std::size_t i = 0; i < outcomes.size(); ++i) {
        response.settings.push_back(setting_message(outcomes[i], dominated[i]));
      }
      response.questions.push_back(question);
      response.recommendations.push_back(fiber::recommend(outcomes, noise, std::nullopt).sentence);
    }
    response.frames = static_cast<std::uint32_t>(measured.frames);
    response.success = 1;
  } catch (const std::exception& error) {
    response = {};
    response.message = error.what();
  }
  return true;
}

}  // namespace fiber_proximity_ros
