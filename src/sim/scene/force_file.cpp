#include "src/sim/scene/force_file.hpp"

#include <utility>

#include "src/io/number.hpp"

namespace fiber {

using Eigen::Vector3d;

ForceWriter::ForceWriter(const std::string& path) : file_(path) {
  file_.write("frame,kind,fiber,index,fx,fy,fz,mx,my,mz\n");
}

void ForceWriter::write(std::int64_t frame, const Rods& rods, const RodForces& forces) {
  std::string rows;
  const auto add_row = [&](const char* kind, std::uint32_t rod, std::uint32_t index,
                           const Vector3d& force, const Vector3d& moment) {
    append_number(rows, frame);
    rows += ',';
    rows += kind;
    for (const std::uint32_t number : {rod, index}) {
      rows += ',';
      append_number(rows, number);
    }
    for (const Vector3d& vector : {force, moment}) {
      for (const double component : {vector.x(), vector.y(), vector.z()}) {
        rows += ',';
        append_number(rows, component);
      }
    }
    rows += '\n';
  };
  const Vector3d zero = Vector3d::Zero();
  for (std::uint32_t rod = 0; rod < rods.count(); ++rod) {
    const std::uint32_t first = rods.first(rod);
    for (std::uint32_t i = first; i + 1 < rods.end(rod); ++i) {
      const Vector3d tangent = (rods.positions[i + 1] - rods.positions[i]).stableNormalized();
      add_row("tension", rod, i - first, forces.tensions[i] * tangent, zero);
      add_row("twisting", rod, i - first, zero, forces.twisting_moments[i] * tangent);
    }
    for (std::uint32_t i = first; i < rods.end(rod); ++i) {
      add_row("bending", rod, i - first, zero, forces.bending_moments[i]);
    }
  }
  for (const RodForces::ContactForce& contact : forces.contacts) {
    for (const auto& [kind, force] : {std::make_pair("normal", &contact.normal_force),
                                      std::make_pair("friction", &contact.friction_force)}) {
      add_row(kind, contact.rod, contact.edge, *force, zero);
      if (contact.other_rod != RodForces::ContactForce::obstacle) {
        add_row(kind, contact.other_rod, contact.other_edge, -*force, zero);
      }
    }
  }
  for (const RodForces::JointForce& joint : forces.joints) {
    add_row("joint", joint.rod, joint.node, joint.force, joint.moment);
  }
  for (const RodForces::HoldForce& hold : forces.holds) {
    add_row("hold", hold.rod, hold.node, hold.force, hold.moment);
  }
  for (const RodForces::LoadForce& load : forces.loads) {
    add_row("load", load.rod, load.node, load.force, load.moment);
  }
  for (const RodForces::ObstacleForce& obstacle : forces.obstacles) {
    add_row("obstacle", 0, obstacle.object, obstacle.force, obstacle.moment);
  }
  file_.write(rows);
}

void ForceWriter::finish() { file_.close(); }

}  // namespace fiber
