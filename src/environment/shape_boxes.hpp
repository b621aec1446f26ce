#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <utility>
#include <vector>

#include "src/environment/eight_boxes.hpp"
#include "src/environment/world_shape.hpp"

namespace fiber {

/// Finds the shapes near a box. Those that end somewhere are in a tree: eight boxes that are
/// neighbours on a space-filling curve share a box above them, and so on. Planes and half-spaces
/// are near everything.
class ShapeBoxes {
 public:
  /// Makes room for so many shapes to add.
  void reserve(std::size_t shapes);

  /// Adds one, of which it holds a reference.
  /// @param box around it, if it ends somewhere
  void add(const WorldShape& shape, const WorldBox& box);

  /// After all have been added, before the first visit.
  void build();

  /// Calls visit(shape) for the shapes whose boxes come as near as this [m] to a box, nearer ones
  /// first, roughly.
  /// @param visit returns how far shapes may be from then on [m]; boxes that overlap are never too
  ///              far, unless it returns minus infinity: that ends the search
  template <class Visit>
  void visit_near(const WorldBox& box, double within, const Visit& visit) const {
    Search search(box, within);
    for (std::size_t i = 0; i < unbounded_.size() && !search.is_over(); ++i) {
      search.set_within(visit(*unbounded_[i]));
    }
    if (!levels_.empty()) {
      visit_children(levels_.size() - 1, 0, search, visit);
    }
  }

 private:
  static constexpr std::size_t fan_out = EightBoxes::count;

  /// A search, and how far its result may be by now.
  class Search {
   public:
    Search(const WorldBox& around, double within) : box(around), reach_(within) {}

    void set_within(double within) {
      is_over_ = within == -std::numeric_limits<double>::infinity();
      reach_ = BoxReach(within);
    }
    bool is_over() const { return is_over_; }
    bool holds(double squared_distance) const { return reach_.holds(squared_distance); }

    const WorldBox& box;

   private:
    BoxReach reach_;
    bool is_over_ = false;
  };

  struct Level {
    std::size_t count = 0;
    std::vector<EightBoxes> boxes;  // by what is above them
  };

  /// Looks at the boxes of one level that share a box of the level above.
  template <class Visit>
  void visit_children(std::size_t index, std::size_t parent, Search& search,
                      const Visit& visit) const {
    const Level& level = levels_[index];
    const std::size_t first = fan_out * parent;
    const std::size_t count = std::min(fan_out, level.count - first);
    const EightBoxes::Distances squared = level.boxes[parent].squared_distances(search.box);
    std::array<std::uint8_t, fan_out> near;
    std::size_t near_count = 0;
    for (std::size_t i = 0; i < count; ++i) {
      if (search.holds(squared[i])) {
        std::size_t place = near_count++;
        for (; place > 0 && squared[near[place - 1]] > squared[i]; --place) {
          near[place] = near[place - 1];
        }
        near[place] = static_cast<std::uint8_t>(i);
      }
    }
    for (std::size_t i = 0; i < near_count && !search.is_over(); ++i) {
      if (!search.holds(squared[near[i]])) {
        return;  // nor are those behind it
      }
      if (index == 0) {
        search.set_within(visit(*bounded_[first + near[i]].first));
      } else {
        visit_children(index - 1, first + near[i], search, visit);
      }
    }
  }

  void sort_along_curve();
  void add_level(const std::vector<WorldBox>& boxes);

  std::vector<const WorldShape*> unbounded_;
  std::vector<std::pair<const WorldShape*, WorldBox>> bounded_;  // along the curve, once built
  std::vector<Level> levels_;                                    // the lowest one first
};

}  // namespace fiber
