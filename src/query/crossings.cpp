#include "fiber_proximity/query/crossings.hpp"

#include <algorithm>
#include <optional>

#include "src/query/crossing_test.hpp"
#include "src/query/view_image.hpp"

namespace fiber {
namespace {

EngineOptions with_threads(std::uint32_t threads) {
  EngineOptions options;
  options.threads = threads;
  return options;
}

}  // namespace

CrossingFinder::CrossingFinder(std::uint32_t threads)
    : engine_(make_engine("run_tree", with_threads(threads))) {}

void CrossingFinder::find(const FiberAssembly& fibers, const View& view,
                          std::vector<Crossing>& crossings) {
  validate(view);
  crossings.clear();
  make_view_image(fibers, view, image_);
  engine_->update(image_);
  QueryOptions options;
  options.neighbour_skip = 1;  // a loop seen from the side can be flat: crossings need none
  engine_->query(options, candidates_);
  const CrossingTest test(fibers, view);
  const std::vector<std::uint32_t>& offsets = fibers.offsets();
  for (const Contact& pair : candidates_.contacts) {
    // In the order of their keys, which crossings inherit.
    if (const std::optional<Crossing> crossing =
            test(offsets[pair.fiber_a] + pair.segment_a, offsets[pair.fiber_b] + pair.segment_b)) {
      crossings.push_back(*crossing);
    }
  }
}

std::vector<Crossing> find_crossings(const FiberAssembly& fibers, const View& view) {
  std::vector<Crossing> crossings;
  CrossingFinder().find(fibers, view, crossings);
  return crossings;
}

}  // namespace fiber
