#pragma once

#include <cstdint>
#include <memory>
#include <vector>

#include "src/sim/contact/contact_points.hpp"
#include "src/sim/contact/moved_shape.hpp"

namespace fiber {

struct ObstacleEdge;

/// The moving shapes among the obstacles of some contacts. Islands are solved for one by one, and
/// so each has its shapes for itself, which come along as its rods give way.
class MovedShapes {
 public:
  /// Begins a solve: makes the contacts those with the shapes that this has. Memory is reused.
  /// @param islands by rod
  /// @param count   of islands
  void assign(std::vector<ObstacleContact>& contacts, std::vector<ObstacleEdge>& edges,
              const std::vector<std::uint32_t>& islands, std::size_t count);

  /// Null where it stands still.
  const MovedShape* of_contact(std::size_t contact) const { return of_contacts_[contact]; }
  const MovedShape* of_edge(std::size_t edge) const { return of_edges_[edge]; }

  /// The shape of a rod's contact with an object, as its motion is that of the object: null where
  /// it stands still, or contacts are of rods.
  const MovedShape* of_object(const ContactPoints& points) const;

  /// Progress of an island's shapes: 1 where none is on its way.
  double progress(std::size_t island) const { return progress_[island]; }
  void go_to(std::size_t island, double progress);

  /// Has an island's shapes stand where they are, or go on.
  void wait(std::size_t island, bool waits);

  /// The objects that are on their way in an island, by index.
  std::vector<std::uint32_t> objects_of(std::size_t island) const;

 private:
  struct Placed {
    const ObstacleShape* source;
    std::uint32_t island;
    MovedShape* shape;
  };

  MovedShape& placed(const ObstacleShape& source, std::uint32_t island);

  std::vector<std::unique_ptr<MovedShape>> memory_;  // of the first so many, and for more
  std::vector<Placed> shapes_;
  std::vector<MovedShape*> of_contacts_;
  std::vector<MovedShape*> of_edges_;
  std::vector<double> progress_;  // by island
};

}  // namespace fiber
