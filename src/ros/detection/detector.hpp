#pragma once

#include <cstddef>
#include <limits>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "fiber_proximity/query/contact.hpp"
#include "fiber_proximity/query/engine.hpp"
#include "fiber_proximity/query/options.hpp"
#include "src/ros/detection/budget.hpp"
#include "src/ros/detection/uncertainty.hpp"

namespace fiber_proximity_ros {

/// Contacts and closest pair of whatever can be queried: the fibres among themselves, or the fibres
/// and the environment.
class Detection {
 public:
  /// Asks for the contacts and, where these do not tell, for the closest pair whatever the margin.
  /// A deadline is one for both.
  /// @param wants_minimum whether to ask for the closest pair
  /// @param uncertainty   of the bodies: contacts are the possible ones then
  /// @throws std::invalid_argument for options that do not validate
  void detect(const fiber::QueryOptions& options, bool wants_minimum,
              const Uncertainty& uncertainty, const Ask& ask);

  /// Nothing could be asked: nothing is known.
  void fail(const std::string& reason);

  // These are about the last detect():
  const fiber::QueryResult& contacts() const { return contacts_; }
  const fiber::Contact* minimum() const { return minimum_; }  ///< nullptr if there is no pair
  bool has_failed() const { return !failure_.empty(); }       ///< nothing could be asked
  bool is_complete() const { return complete_; }  ///< no deadline or limit came before its end
  bool are_contacts_complete() const { return !has_failed() && contacts_.complete; }
  /// Whether no pair can be closer than minimum() for want of looking.
  bool is_minimum_complete() const { return !has_failed() && minimum_complete_; }
  bool is_limit_reached() const { return limit_reached_; }
  /// Contacts that are not certain as their bodies are uncertain.
  std::size_t uncertain_contacts() const { return uncertain_contacts_; }
  /// Whether these options asked for all contacts, and there are no others.
  bool has_all_of(const fiber::QueryOptions& options) const {
    return options.type == fiber::QueryType::ALL && contacts_.complete && !contacts_.limit_reached;
  }
  /// The warning for a user who has not asked for so few contacts or pairs; empty if no limit of
  /// the options but that of LIMITED is reached.
  std::string limit_problem(const fiber::QueryOptions& options) const;
  /// Why not all pairs have been looked at; empty if they have.
  std::string cut_off(const fiber::QueryOptions& options) const;
  /// [m] Bounds of the true distance of the closest pair; infinite where there is no pair.
  double minimum_lower() const { return minimum_lower_; }
  double minimum_upper() const { return minimum_upper_; }
  double contact_error() const;  ///< [m] by which a contact's distance is wrong at most
  const fiber::QueryCounts& counts() const { return counts_; }

  double contact_time() const { return contact_time_; }  ///< [s] to find the contacts
  double minimum_time() const { return minimum_time_; }  ///< [s] to find the closest pair, apart

 private:
  fiber::QueryResult contacts_;
  fiber::QueryResult closest_;
  const fiber::Contact* minimum_ = nullptr;
  bool complete_ = true;
  bool minimum_complete_ = true;
  bool limit_reached_ = false;
  std::size_t uncertain_contacts_ = 0;
  std::string failure_;
  double minimum_lower_ = 0.0;
  double minimum_upper_ = std::numeric_limits<double>::infinity();
  fiber::QueryCounts counts_;
  double contact_time_ = 0.0;
  double minimum_time_ = 0.0;
};

/// The text in an answer about pairs that a deadline or a limit has left out.
std::string cut_off_text(const std::string& pairs, const fiber::PairOptions& options);

/// Why a part of an answer was left out.
std::string no_time_text(const fiber::PairOptions& options);

/// Contacts and closest pair of the newest fibres, from one engine whose update waits until it is
/// asked something.
class Detector {
 public:
  /// @throws std::invalid_argument for an unknown engine, or for options that are not allowed
  explicit Detector(const std::string& engine, const fiber::EngineOptions& options = {})
      : engine_name_(engine), engine_(fiber::make_engine(engine, options)) {}

  const std::string& engine_name() const { return engine_name_; }

  /// The fibres to ask about from now on; they must live, unchanged, until the next call.
  /// @param uncertainties [m] by fibre; empty for none
  void set_fibers(const fiber::FiberAssembly& fibers, std::vector<double> uncertainties = {}) {
    new_fibers_ = &fibers;
    uncertainty_ = Uncertainty(std::move(uncertainties), Uncertainty::Bodies::BOTH);
  }

  /// The engine, updated to the fibres.
  /// @throws std::invalid_argument for fibres the engine cannot take (AL-threaded: unequal ones)
  const fiber::ProximityEngine& engine();

  /// Finds the contacts and, if it is wanted, the closest pair whatever the margin.
  /// @throws std::invalid_argument for options that do not validate, and as engine(); nothing is
  ///         known then
  /// @param budget of the answer, in whose current stage this is done
  void detect(const fiber::QueryOptions& options, bool wants_minimum, Budget& budget);

  /// Detects contacts and closest pair without other parts of an answer.
  void detect(const fiber::QueryOptions& options, bool wants_minimum = true) {
    Budget alone;
    detect(options, wants_minimum, alone);
  }

  /// The result of the last detect().
  const Detection& detection() const { return detection_; }

  double update_time() const { return update_time_; }  ///< [s] of the update for that
  double detect_time() const {                         ///< [s] of the last detection
    return detection_.contact_time() + detection_.minimum_time();
  }

 private:
  std::string engine_name_;
  std::unique_ptr<fiber::ProximityEngine> engine_;
  const fiber::FiberAssembly* new_fibers_ = nullptr;
  Uncertainty uncertainty_;
  Detection detection_;
  double update_time_ = 0.0;
};

}  // namespace fiber_proximity_ros
