#pragma once

#include <ros/time.h>

#include <map>
#include <string>
#include <vector>

#include "src/ros/environment/environment_inputs.hpp"
#include "src/ros/inputs/input_set.hpp"
#include "src/ros/support/unknown.hpp"

namespace fiber_proximity_ros {

/// How complete an answer is, and what it lacks. It is complete if all that it was asked about was
/// there, and all of that was looked at.
class Completeness {
 public:
  /// Something that it was asked about was not there.
  void add(const std::vector<Unknown>& unknown);

  /// Some pairs were not looked at.
  /// @param why empty if all were
  void add_cut_off(const std::string& why);

  bool is_complete() const { return unknown_.empty(); }

  /// Whether all was there that it was asked about.
  bool was_all_there() const { return was_all_there_; }

  /// The things that it lacks, each with since when and why; the first of very many.
  const std::vector<std::string>& unknown() const { return unknown_; }

  /// A bound from below that holds for what was there, as one for all: what was not could be
  /// anywhere.
  /// @param if_unknown the bound where nothing is known
  double lower(double bound, double if_unknown) const {
    return was_all_there_ ? bound : if_unknown;
  }

 private:
  std::vector<std::string> unknown_;
  bool was_all_there_ = true;
};

/// Tracks which of the things that answers are about are unknown. This is the one place that judges
/// whether all of them are there.
class Knowledge {
 public:
  /// The things that an answer is about.
  enum class About { FIBERS, ENVIRONMENT, FIBERS_AND_ENVIRONMENT };

  /// @param fibers, environment must outlive this
  Knowledge(const InputSet& fibers, const EnvironmentInputs& environment)
      : fibers_(fibers), environment_(environment) {}

  /// Takes in what is known now; the log is told of what has been unknown for a while, and of what
  /// is known again.
  /// @returns true if other things are unknown than before
  bool update();

  bool is_all_known() const { return unknown_fibers_.empty() && unknown_objects_.empty(); }

  /// All that is unknown that contacts are about.
  const std::vector<Unknown>& unknown_fibers() const { return unknown_fibers_; }
  const std::vector<Unknown>& unknown_objects() const { return unknown_objects_; }

  /// Whether a body that was there is unknown now, all of it or a part, so that nobody knows
  /// whether it touches what it touched.
  /// @param name of a fibre or an object
  bool is_lost(const std::string& name) const;

  /// @param of_shapes of an answer about shapes: what fibres may touch counts, too
  Completeness completeness(About about, bool of_shapes = false) const;

 private:
  /// Something unknown that the log has to be told of.
  struct Noted {
    ros::SteadyTime since = ros::SteadyTime::now();
    bool is_logged = false;
    bool is_unknown = true;
  };

  void note(const std::vector<Unknown>& unknown);

  const InputSet& fibers_;
  const EnvironmentInputs& environment_;
  std::vector<Unknown> unknown_fibers_;
  std::vector<Unknown> unknown_objects_;
  std::map<std::string, Noted> noted_;  // by what is unknown
};

}  // namespace fiber_proximity_ros
