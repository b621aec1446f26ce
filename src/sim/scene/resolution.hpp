// The segments and substeps of a scene: given, chosen for an accuracy, or for real time.
#pragma once

#include <functional>
#include <optional>

#include "src/sim/scene/fibers.hpp"
#include "src/sim/scene/joints.hpp"
#include "src/sim/scene/real_time.hpp"

namespace fiber {

/// The fibres of a scene, and how its segments and substeps are chosen.
class SceneResolution {
 public:
  /// Reads the keys `fibers`, `substeps`, `accuracy` (a number, or one with %) and `real_time`.
  /// @param gravity [m/s²]
  /// @param joints  for which fibres have nodes at shares of their lengths
  /// @throws std::invalid_argument naming file, line, field and value, and what is allowed
  SceneResolution(const YamlField& document, double gravity, const std::vector<JointEntry>& joints);

  /// Cuts the fibres of a scene.
  /// @param scene    with its time step, options and whether it has contacts; gets rods, names,
  ///                 substeps and accuracy
  /// @param complete finishes a scene that has its rods
  /// @param timer    measures scenes for real_time
  /// @throws std::invalid_argument naming file, line, field and value, and what is allowed; for an
  ///         accuracy that takes more substeps or segments than there may be, too
  SimDescription apply(const SimDescription& scene,
                       const std::function<void(SimDescription&)>& complete,
                       const FrameTimer& timer) const;

 private:
  std::uint32_t substeps_for(const SimDescription& scene, double accuracy) const;
  SimDescription cut(const SimDescription& scene,
                     const std::optional<Resolution>& resolution) const;
  std::string describe(const SimDescription& scene, const RealTimeChoice& choice) const;
  SimDescription for_real_time(const SimDescription& scene,
                               const std::function<void(SimDescription&)>& complete,
                               const FrameTimer& timer) const;

  YamlField document_;
  double gravity_;
  bool is_real_time_ = false;
  std::optional<double> accuracy_;
  std::optional<std::uint32_t> given_substeps_;
  std::vector<FiberEntry> fibers_;
};

}  // namespace fiber
