#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "fiber_proximity/query/engine.hpp"
#include "fiber_proximity/query/options.hpp"

namespace fiber {

/// How a setting differs from the reference.
enum class SettingKind {
  KERNEL,
  TOLERANCE,
  DEADLINE,
  ENGINE,
  SKIN,
  THREADS,
  RESAMPLING  ///< fewer points a fibre, by the error of its chords
};

/// One way to ask a question about fibres.
struct AnswerSetting {
  SettingKind kind = SettingKind::KERNEL;
  std::string question;  ///< the name of the query's type
  std::string name;
  QueryOptions options;
  std::string engine;
  EngineOptions engine_options;
  double deadline_part = 0.0;  ///< deadline as a part of what the reference takes; 0 for none
  double chord_error = 0.0;    ///< [m] 0: all points
  bool is_reference = false;   ///< kernel robust, and nothing else that is chosen here
};

/// The values that settings are combined from.
struct SettingChoices {
  QueryOptions options;                    ///< margin and neighbours of all
  std::string engine;                      ///< of all but those that are about the engine
  std::vector<std::string> other_engines;  ///< to be compared
  EngineOptions engine_options;            ///< of all
  std::vector<std::uint32_t> threads;      ///< to be compared, 0 for as many as there are cores
  std::vector<double> skins;               ///< to be compared [m]
  std::vector<double> chord_errors;        ///< to be compared [m]
};

/// The tolerances that are compared [m]: what a machine tool, a tracker, and a hand would mind.
const std::vector<double>& compared_tolerances();

/// The questions that settings are compared for, by the names of their types.
const std::vector<std::string>& compared_questions();

/// All settings of a question, the reference first. `closest` has no margin: its answer is the
/// distance, however large.
/// @throws std::invalid_argument for a question that is no type of query
std::vector<AnswerSetting> settings_of(const std::string& question, const SettingChoices& choices);

/// The settings of several questions, the first of each question, then the second of each, and so
/// on: whoever runs out of time has seen something of every question.
std::vector<AnswerSetting> settings_of(const std::vector<std::string>& questions,
                                       const SettingChoices& choices);

/// A word for a kind: kernel, tolerance, deadline, engine, skin, threads or resampling.
const char* name_of(SettingKind kind);

}  // namespace fiber
