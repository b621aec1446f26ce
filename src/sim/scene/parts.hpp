// Reading and making the parts of a scene.
#pragma once

#include <optional>
#include <sstream>
#include <stdexcept>
#include <string>
#include <vector>

#include "fiber_proximity/sim/scene/scene.hpp"
#include "src/text/quote.hpp"

namespace fiber {

/// Nothing in a scene moves faster than this by its own account [m/s].
constexpr double max_speed = 1000.0;

/// Joins words and numbers, those with three digits, to one text.
template <class... Parts>
std::string format(const Parts&... parts) {
  std::ostringstream text;
  text.precision(3);
  (text << ... << parts);
  return text.str();
}

/// A share in per cent, with two more digits: it may be little more than what is allowed.
inline std::string percent(double share) {
  constexpr int digits = 5;
  std::ostringstream text;
  text.precision(digits);
  text << 100.0 * share;
  return text.str();
}

/// Runs a function, and appends the fibre's name to its errors.
template <class Function>
auto with_fiber_name(const std::string& name, const Function& function) {
  try {
    return function();
  } catch (const std::invalid_argument& error) {
    throw std::invalid_argument(std::string(error.what()) + " (fibre " + quote(name) + ")");
  }
}

/// Reads one of two words; without a field it is the first one.
/// @returns whether it is the second one
/// @throws std::invalid_argument for any other
inline bool read_choice(const std::optional<YamlField>& field, const std::string& first,
                        const std::string& second) {
  if (field && field->text() != first && field->text() != second) {
    field->refuse(first + " or " + second);
  }
  return field && field->text() == second;
}

/// Reads a `shape`:
///   line:     {from, to}
///   arc:      {from, to, length, towards}     a circular arc, longer than it spans, that sags
///                                             towards a direction
///   helix:    {center, radius, pitch, turns}  about z, from the center up
///   polyline: [point, ...]
///   trefoil:  {center, size}                  an overhand knot about so wide, its ends up and
///                                             apart along x
/// @returns a polyline that is the curve, or as fine as to be measured for it [m]
/// @throws std::invalid_argument naming file, line, field and value, and what is allowed
std::vector<Eigen::Vector3d> read_shape(const YamlField& shape);

/// Points along a polyline at equal arc lengths, its ends among them; all at its beginning if it
/// has no length.
/// @param segments at least 1
/// @returns segments + 1 points [m]
std::vector<Eigen::Vector3d> resample(const std::vector<Eigen::Vector3d>& line,
                                      std::int64_t segments);

/// Reads the options of the effect `attachment`: a list of holds, each of
///   fiber:    name; that of a repeated fibre means each of them
///   node:     first, last, or an index; first if there is none
///   kind:     pin or clamp; pin if there is none
///   position, tangent, director: where and how it is held; where and how the fibre is if there are
///             none
///   path:     a list of {time, position, tangent, director}, in between straight lines; what is
///             not given stays as it was
///   period:   [s] after which the path begins again, to where it leads back from its last entry
///   frame:    of tf, that carries it: position, the frame's origin if there is none, tangent and
///             director are in this frame. As long as tf does not know it, the fibre stays where it
///             is
/// @param scene with its fibres and rods; gets the holds, and the speed of the fastest
/// @throws std::invalid_argument naming file, line, field and value, and what is allowed
void read_holds(const YamlField& list, SimDescription& scene);

/// Where a hold that does not follow a frame is at a time [s]: on its path, or at its end [m].
Eigen::Vector3d position_on(const SimHold& hold, double time);

/// The placement of a hold as a function of time [s].
/// @param rods   as the simulation begins; with twist, they have their frames already
/// @param frames gets the frame that is to be followed, if there is one
std::function<Placement(double)> placement_of(const SimHold& hold, const SimDescription& scene,
                                              const Rods& rods, std::vector<FollowedFrame>& frames);

/// Reads the options of the effect `load`: a list of loads, each of
///   fiber:    name; that of a repeated fibre means each of them
///   node:     first, last, or an index; or a part of the fibre:
///   from, to: [m] along the fibre; its ends if they are not given
///   force, moment, torque, mass: what acts there, per metre of a part
///   table:    a list of {time, force, moment, torque}, in between straight lines; what is not
///             given stays as it was
///   period:   [s] after which the table begins again, to where it leads back from its last entry
/// @param scene with its effects, fibres and rods; gets the loads
/// @throws std::invalid_argument naming file, line and value, what is allowed, and the fibre
void read_loads(const YamlField& list, SimDescription& scene);

/// Makes the effect `load`.
/// @param rods  with twist, have their angles already; get the masses of weights
/// @param scene gets the parameters: forces, moments and torques that do not change in time
/// @returns null if the scene does not name it
/// @throws std::invalid_argument naming file and line, for a load that Loads::add() refuses
std::shared_ptr<Loads> make_loads(const SimDescription& description, Rods& rods, SimScene& scene);

inline double number_of(const EffectOptions& options, const char* name) {
  return options.at(name).front();
}

inline Eigen::Vector3d vector_of(const EffectOptions& options, const char* name) {
  return Eigen::Vector3d(options.at(name).data());
}

/// The options of effects that are lists and are about fibres, which have to be cut first.
struct EffectLists {
  std::optional<YamlField> holds;  ///< of the effect attachment; none if there is none
  std::optional<YamlField> loads;
  std::optional<YamlField> joints;
};

/// Reads the list `effects` of a scene but for those lists: each entry is a name, or a map of a
/// name to options that replace the default ones.
/// The effect `bend` has the options
///   natural_curvature: [1/m], or from_shape: that which each fibre begins with; 0 if there is none
///   towards:           a direction, to which side the first edge of each fibre bends; to any side
///                      if there is none
/// @throws std::invalid_argument naming file, line, effect and value, and what is allowed
EffectLists read_effects(const YamlField& list, SimDescription& scene);

/// Reads the options of the effect `bend`.
/// @throws std::invalid_argument naming file, line and value, and what is allowed
SimCurvature read_natural_curvature(const YamlField& bend, bool has_twist);

/// Gives rods the natural curvature of a scene.
/// @param rods with twist, have their frames already
/// @throws std::invalid_argument naming file, line and fibre, for a fibre that does not have the
///         side to which it is to bend
void set_natural_curvature(const SimDescription& scene, Rods& rods);

/// Has the rods of fibres bend as their materials say.
/// @param rods with twist, have their frames already
/// @throws std::invalid_argument naming file, line and fibre, where an effect that this takes is
///         not named, or the fibre does not have the side
void set_stiff_sides(const SimDescription& scene, Rods& rods);

/// The size of the gravity that a scene names, where it changes in time the largest [m/s²]; 0
/// without.
double gravity_of(const SimDescription& scene);

/// Effects made for the rods of a scene.
struct MadeEffects {
  Effects effects;
  std::unique_ptr<Contacts> contacts;  ///< null without a contact effect
  std::unique_ptr<Joints> joints;      ///< null if nothing is joined or closed
};

/// Makes the effects that a scene names, and nothing for those it does not name.
/// @param rods   get the arrays that the effects need
/// @param scene  gets attachment, frames and parameters
/// @throws std::invalid_argument naming file and line, for effects that refuse their options; for
///         a fibre that does not have the side to which it is to bend, too
MadeEffects make_effects(const SimDescription& description, Rods& rods, SimScene& scene);

/// Makes sure that no fibre begins inside of itself, of another or of an obstacle, where the scene
/// names the effects for such contacts.
/// @param attachment that holds nodes which do not move; null for none
/// @param rods       are moved apart if the scene says so (separate_overlaps())
/// @returns how far rods were moved, for the log; empty if they were not
/// @throws std::invalid_argument naming file and line of both fibres, their names, segments and how
///         deep they are in each other
std::string resolve_overlaps(const SimDescription& scene, const Attachment* attachment, Rods& rods);

}  // namespace fiber
