#include "fiber_proximity/ros/sim_natural_curvature.hpp"

#include <cmath>

#include "fiber_proximity/sim/natural_curvature.hpp"

namespace fiber_proximity_ros {
namespace {

bool is_from_shape(const std::optional<YamlField>& curvature) {
  return curvature && curvature->is_text() && curvature->text() == "from_shape";
}

double read_curvature(const YamlField& field) {
  constexpr const char* allowed = "at least 0 and finite, or from_shape";
  double curvature = 0.0;
  try {
    curvature = field.number();
  } catch (const std::invalid_argument&) {
    field.refuse(allowed);
  }
  if (!(std::isfinite(curvature) && curvature >= 0.0)) {
    field.refuse(allowed);
  }
  return curvature;
}

void set_arcs(double curvature, const YamlField& towards, const std::vector<SimFiber>& fibers,
              fiber::Rods& rods) {
  const Eigen::Vector3d side = towards.vector();
  for (std::uint32_t rod = 0; rod < rods.count(); ++rod) {
    naming_fiber(fibers[rod].name, [&] {
      try {
        fiber::set_natural_arc(rods, rod, curvature, side);
      } catch (const std::invalid_argument&) {
        towards.refuse("finite and a direction across the fibre's first edge");
      }
    });
  }
}

}  // namespace

void read_natural_curvature(const YamlField& bend, const std::vector<SimFiber>& fibers,
                            fiber::Rods& rods) {
  bend.require_map({"natural_curvature", "towards"});
  const auto given = bend.find("natural_curvature");
  const auto towards = bend.find("towards");
  if (towards && rods.directors.empty()) {
    towards->refuse("absent where there is no twist: cross-sections that turn freely have no side");
  }
  if (is_from_shape(given)) {
    if (towards) {
      towards->refuse("absent where the natural curvature is from_shape");
    }
    fiber::set_natural_shape(rods);
    return;
  }
  const double curvature = given ? read_curvature(*given) : 0.0;
  if (towards && !given) {
    towards->refuse("absent where there is no natural_curvature");
  }
  if (towards) {
    set_arcs(curvature, *towards, fibers, rods);
  } else if (curvature > 0.0) {
    rods.natural_curvatures.assign(rods.positions.size(), curvature);
  }
}

}  // namespace fiber_proximity_ros
