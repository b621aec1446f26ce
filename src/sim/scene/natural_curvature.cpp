// How fibres bend: options of the effect `bend`, and to which side materials are stiffer.
#include <cmath>

#include "src/sim/effects/natural_bend.hpp"
#include "src/sim/scene/keys.hpp"
#include "src/sim/scene/parts.hpp"

namespace fiber {
namespace {

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

}  // namespace

SimCurvature read_natural_curvature(const YamlField& bend, bool has_twist) {
  bend.require_map(key_names("bend"));
  const auto given = bend.find("natural_curvature");
  const auto towards = bend.find("towards");
  SimCurvature read;
  read.is_from_shape = given && given->is_text() && given->text() == "from_shape";
  if (given && !read.is_from_shape) {
    read.curvature = read_curvature(*given);
  }
  if (towards) {
    if (!has_twist) {
      towards->refuse(
          "absent where there is no twist: cross-sections that turn freely have no side");
    }
    if (read.is_from_shape) {
      towards->refuse("absent where the natural curvature is from_shape");
    }
    if (!given) {
      towards->refuse("absent where there is no natural_curvature");
    }
    read.towards = towards->vector();
    read.towards_statement = towards->statement();
  }
  return read;
}

namespace {

/// Gives a rod a side; errors name what says which.
template <class Set>
void set_side(const SimDescription& scene, std::uint32_t rod, const std::string& statement,
              const Set& set) {
  try {
    set();
  } catch (const std::invalid_argument&) {
    throw std::invalid_argument(statement +
                                ", it must be finite and a direction across the fibre's first "
                                "edge (fibre " +
                                quote(scene.fiber_names[rod]) + ")");
  }
}

/// Rigid parts have no natural curvature: what a node beside one turns by is that of its other
/// edge.
template <class Curvatures>
void leave_rigid_parts_out(const Rods& rods, Curvatures& curvatures) {
  for (std::uint32_t rod = 0; rod < rods.count() && !rods.mass_couplings.empty(); ++rod) {
    for (std::uint32_t i = rods.first(rod) + 1; i + 1 < rods.end(rod); ++i) {
      curvatures[i] *= rods.bending_share_at(i);
    }
  }
}

}  // namespace

void set_natural_curvature(const SimDescription& scene, Rods& rods) {
  const SimCurvature& natural = scene.natural_curvature;
  if (natural.is_from_shape) {
    set_natural_shape(rods);
  } else if (natural.towards) {
    for (std::uint32_t rod = 0; rod < rods.count(); ++rod) {
      set_side(scene, rod, natural.towards_statement,
               [&] { set_natural_arc(rods, rod, natural.curvature, *natural.towards); });
    }
    leave_rigid_parts_out(rods, rods.natural_curvature_vectors);
  } else if (natural.curvature > 0.0) {
    rods.natural_curvatures.assign(rods.positions.size(), natural.curvature);
    leave_rigid_parts_out(rods, rods.natural_curvatures);
  }
}

void set_stiff_sides(const SimDescription& scene, Rods& rods) {
  for (std::uint32_t rod = 0; rod < rods.count(); ++rod) {
    const std::optional<SimStiffSide>& side = scene.fibers[rod].stiff_side;
    if (!side) {
      continue;
    }
    if (!scene.has_effect("bend") || !scene.has_effect("twist")) {
      throw std::invalid_argument(side->statement +
                                  ", but a bending_ratio above 1 takes the effects bend and twist");
    }
    set_side(scene, rod, side->statement, [&] { rods.set_stiff_side(rod, side->towards); });
  }
}

}  // namespace fiber
