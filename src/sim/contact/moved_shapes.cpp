#include "src/sim/contact/moved_shapes.hpp"

#include <algorithm>

#include "src/sim/contact/contact_set.hpp"

namespace fiber {

void MovedShapes::assign(std::vector<ObstacleContact>& contacts, std::vector<ObstacleEdge>& edges,
                         const std::vector<std::uint32_t>& islands, std::size_t count) {
  shapes_.clear();
  of_contacts_.clear();
  of_edges_.clear();
  progress_.assign(count, 1.0);
  for (ObstacleContact& contact : contacts) {
    const ObstacleShape& shape = contact.piece.shape();
    of_contacts_.push_back(shape.moving == nullptr ? nullptr
                                                   : &placed(shape, islands[contact.rod]));
    if (of_contacts_.back() != nullptr) {
      contact.piece.place_at(of_contacts_.back()->now());
    }
  }
  for (ObstacleEdge& edge : edges) {
    of_edges_.push_back(edge.shape->moving == nullptr ? nullptr
                                                      : &placed(*edge.shape, islands[edge.rod]));
    if (of_edges_.back() != nullptr) {
      edge.shape = &of_edges_.back()->now();
    }
  }
}

MovedShape& MovedShapes::placed(const ObstacleShape& source, std::uint32_t island) {
  for (const Placed& each : shapes_) {
    if (each.source == &source && each.island == island) {
      return *each.shape;
    }
  }
  const std::size_t index = shapes_.size();
  if (index == memory_.size()) {
    memory_.push_back(std::make_unique<MovedShape>(source));
  } else {
    memory_[index]->assign(source);
  }
  MovedShape& shape = *memory_[index];
  shapes_.push_back({&source, island, &shape});
  progress_[island] = std::min(progress_[island], shape.progress());
  return shape;
}

const MovedShape* MovedShapes::of_object(const ContactPoints& points) const {
  if (points.is_of_rods()) {
    return nullptr;
  }
  for (const Placed& each : shapes_) {
    if (each.source->object == points.rod_b) {
      return each.shape;
    }
  }
  return nullptr;
}

void MovedShapes::go_to(std::size_t island, double progress) {
  progress_[island] = progress;
  for (const Placed& each : shapes_) {
    if (each.island == island && each.shape->moves()) {
      each.shape->go_to(progress);
    }
  }
}

void MovedShapes::wait(std::size_t island, bool waits) {
  for (const Placed& each : shapes_) {
    if (each.island == island) {
      each.shape->wait(waits);
    }
  }
}

std::vector<std::uint32_t> MovedShapes::objects_of(std::size_t island) const {
  std::vector<std::uint32_t> objects;
  for (const Placed& each : shapes_) {
    if (each.island == island && !each.shape->has_arrived()) {
      objects.push_back(each.source->object);
    }
  }
  return objects;
}

}  // namespace fiber
