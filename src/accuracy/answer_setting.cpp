#include "src/accuracy/answer_setting.hpp"

#include <algorithm>
#include <cstddef>
#include <limits>

#include "src/accuracy/number_text.hpp"

namespace fiber {
namespace {

/// LIMITED stops here: most cables have more contacts.
constexpr std::uint32_t compared_contacts = 10;

AnswerSetting reference_of(const std::string& question, const SettingChoices& choices) {
  AnswerSetting reference;
  reference.question = question;
  reference.name = name_of(Kernel::ROBUST);
  reference.options = choices.options;
  reference.options.type = query_type_from_name(question);
  reference.options.kernel = Kernel::ROBUST;
  reference.options.max_contacts = compared_contacts;
  if (reference.options.type == QueryType::CLOSEST) {
    reference.options.margin = std::numeric_limits<double>::infinity();
  }
  reference.engine = choices.engine;
  reference.engine_options = choices.engine_options;
  return reference;
}

bool has_tolerance(QueryType type) {
  return type == QueryType::CLOSEST || type == QueryType::LIMITED || type == QueryType::FIBER_PAIRS;
}

/// Whether its answer is about fibres, and not about their segments.
bool is_about_fibers(QueryType type) {
  return type == QueryType::CLOSEST || type == QueryType::FIBER_PAIRS;
}

void add_accuracies(const AnswerSetting& reference, std::vector<AnswerSetting>& settings) {
  AnswerSetting exact = reference;
  exact.name = name_of(Kernel::EXACT);
  exact.options.kernel = Kernel::EXACT;
  settings.push_back(exact);
  if (has_tolerance(reference.options.type)) {
    for (const double tolerance : compared_tolerances()) {
      AnswerSetting setting = reference;
      setting.kind = SettingKind::TOLERANCE;
      setting.name = "tolerance of " + millimetres(tolerance);
      setting.options.tolerance = tolerance;
      settings.push_back(setting);
    }
  }
  for (const double part : {0.25, 0.5, 0.75}) {
    AnswerSetting setting = reference;
    setting.kind = SettingKind::DEADLINE;
    setting.name = "deadline at " + rounded_text(100.0 * part) + " %";
    setting.deadline_part = part;
    settings.push_back(setting);
  }
}

void add_engines(const AnswerSetting& reference, const SettingChoices& choices,
                 std::vector<AnswerSetting>& settings) {
  for (const std::string& engine : choices.other_engines) {
    AnswerSetting setting = reference;
    setting.kind = SettingKind::ENGINE;
    setting.name = "engine " + engine;
    setting.engine = engine;
    settings.push_back(setting);
  }
  for (const double skin : choices.skins) {
    AnswerSetting setting = reference;
    setting.kind = SettingKind::SKIN;
    setting.name = skin == 0.0 ? "no skin" : "skin of " + millimetres(skin);
    setting.engine_options.skin = skin;
    settings.push_back(setting);
  }
  for (const std::uint32_t threads : choices.threads) {
    AnswerSetting setting = reference;
    setting.kind = SettingKind::THREADS;
    setting.name = threads == 0   ? "all threads"
                   : threads == 1 ? "one thread"
                                  : std::to_string(threads) + " threads";
    setting.engine_options.threads = threads;
    settings.push_back(setting);
  }
}

}  // namespace

const std::vector<double>& compared_tolerances() {
  static const std::vector<double> tolerances{1e-5, 1e-4, 1e-3, 1e-2};
  return tolerances;
}

std::vector<AnswerSetting> settings_of(const std::string& question, const SettingChoices& choices) {
  AnswerSetting reference = reference_of(question, choices);
  std::vector<AnswerSetting> settings;
  add_accuracies(reference, settings);
  add_engines(reference, choices, settings);
  if (is_about_fibers(reference.options.type)) {
    for (const double chord_error : choices.chord_errors) {
      AnswerSetting setting = reference;
      setting.kind = SettingKind::RESAMPLING;
      setting.name = "resampled to " + millimetres(chord_error);
      setting.chord_error = chord_error;
      settings.push_back(setting);
    }
  }
  reference.is_reference = true;
  settings.insert(settings.begin(), reference);
  return settings;
}

std::vector<AnswerSetting> settings_of(const std::vector<std::string>& questions,
                                       const SettingChoices& choices) {
  std::vector<std::vector<AnswerSetting>> of_questions;
  std::size_t most = 0;
  for (const std::string& question : questions) {
    of_questions.push_back(settings_of(question, choices));
    most = std::max(most, of_questions.back().size());
  }
  std::vector<AnswerSetting> settings;
  for (std::size_t i = 0; i < most; ++i) {
    for (const std::vector<AnswerSetting>& of_question : of_questions) {
      if (i < of_question.size()) {
        settings.push_back(of_question[i]);
      }
    }
  }
  return settings;
}

const std::vector<std::string>& compared_questions() {
  static const std::vector<std::string> questions{"all", "closest", "fiber_pairs", "limited",
                                                  "first"};
  return questions;
}

const char* name_of(SettingKind kind) {
  switch (kind) {
    case SettingKind::KERNEL:
      return "kernel";
    case SettingKind::TOLERANCE:
      return "tolerance";
    case SettingKind::DEADLINE:
      return "deadline";
    case SettingKind::ENGINE:
      return "engine";
    case SettingKind::SKIN:
      return "skin";
    case SettingKind::THREADS:
      return "threads";
    case SettingKind::RESAMPLING:
      break;
  }
  return "resampling";
}

}  // namespace fiber
