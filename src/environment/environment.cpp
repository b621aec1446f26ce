#include "fiber_proximity/environment/environment.hpp"

#include <algorithm>
#include <limits>
#include <set>
#include <stdexcept>
#include <string>
#include <utility>

#include "fiber_proximity/query/motion.hpp"
#include "src/environment/broad_phase.hpp"
#include "src/environment/environment_query.hpp"
#include "src/environment/object_path.hpp"
#include "src/text/quote.hpp"

namespace fiber {
namespace {

/// Segments whose box is looked up at once.
constexpr std::uint32_t segments_per_run = 8;

/// A segment and a shape of this object, of which the index is that of the contact.
Contact contact_with(const EnvironmentObject& owner, std::uint32_t object, std::uint32_t shape,
                     const Capsule& segment) {
  static_cast<void>(owner.shapes.at(shape));
  const WorldShape placed(owner, object, shape);
  return contact_of(
      segment, placed,
      axis_distance(placed.shape, placed.to_shape * segment.p0, placed.to_shape * segment.p1,
                    std::numeric_limits<double>::infinity()));
}

}  // namespace

Environment::Environment(std::vector<EnvironmentObject> objects) : objects_(std::move(objects)) {
  std::set<std::string> names;
  for (const EnvironmentObject& object : objects_) {
    validate(object);
    if (!names.insert(object.name).second) {
      throw std::invalid_argument("there are two objects of the name " + quote(object.name));
    }
  }
  broad_phase_ = std::make_unique<BroadPhase>(objects_);
}

Environment::~Environment() = default;

void Environment::query(const FiberAssembly& fibers, const QueryOptions& options,
                        const AllowedPairs& allowed, QueryResult& result) const {
  validate(options);
  result.counts = QueryCounts();
  result.complete = true;
  EnvironmentQuery query(fibers, objects_, options, allowed, result);
  for (std::uint32_t fiber = 0; fiber < fibers.fiber_count(); ++fiber) {
    const std::uint32_t last = fibers.offsets()[fiber + 1] - 1;
    for (std::uint32_t first = fibers.offsets()[fiber]; first < last && !query.done();
         first += segments_per_run) {
      const SegmentRun run(fibers, fiber, first, std::min(first + segments_per_run, last));
      broad_phase_->visit_near(run.box,
                               [&](const WorldShape& shape) { return query.offer(run, shape); });
    }
  }
  query.finish();
}

Contact Environment::contact(const Capsule& segment, std::uint32_t object,
                             std::uint32_t shape) const {
  return contact_with(objects_.at(object), object, shape, segment);
}

Contact Environment::first_contact(const FiberMotion& motion, const Environment& later,
                                   const MotionContact& contact) const {
  const double time = time_of(contact);
  EnvironmentObject object = objects_.at(contact.fiber_b);
  const auto moved =
      std::find_if(later.objects_.begin(), later.objects_.end(),
                   [&](const EnvironmentObject& other) { return other.name == object.name; });
  if (moved != later.objects_.end()) {
    object.pose = ObjectPath(object.pose, moved->pose).pose(time);
  }
  const std::uint32_t point = motion.before.offsets()[contact.fiber_a] + contact.segment_a;
  Contact found =
      contact_with(object, contact.fiber_b, contact.segment_b, capsule_at(motion, point, time));
  found.fiber_a = contact.fiber_a;
  found.segment_a = contact.segment_a;
  return found;
}

}  // namespace fiber
