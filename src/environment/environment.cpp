#include "fiber_proximity/environment/environment.hpp"

#include <tbb/task_arena.h>

#include <algorithm>
#include <limits>
#include <stdexcept>
#include <string_view>
#include <utility>

#include "fiber_proximity/query/for_engines/pair_collector.hpp"
#include "fiber_proximity/query/motion.hpp"
#include "src/environment/allowed_contacts.hpp"
#include "src/environment/broad_phase.hpp"
#include "src/query/search_jobs.hpp"
#include "src/text/quote.hpp"

namespace fiber {
namespace {

constexpr std::uint32_t points_per_job = 512;  // more than it takes to wake a thread for
constexpr std::uint32_t worth_several_threads = 4 * points_per_job;

/// The contact of a segment (a) and a shape (b); which segment it is is left open.
Contact contact_of(const Capsule& capsule, const WorldShape& shape, const AxisDistance& axis) {
  const Eigen::Vector3d nearest = capsule.p0 + axis.s * (capsule.p1 - capsule.p0);
  const Eigen::Vector3d away = shape.pose.linear() * axis.gradient;
  const double error = shape.error(capsule);
  Contact contact;
  contact.s = axis.s;
  contact.fiber_b = shape.object;
  contact.segment_b = shape.index;
  contact.distance = axis.distance - capsule.radius;
  contact.lower = axis.lower - error - capsule.radius;
  contact.upper = axis.distance + error - capsule.radius;
  contact.normal = -away;
  contact.point_a = nearest - capsule.radius * away;
  contact.point_b = nearest - axis.distance * away;
  return contact;
}

/// One query of an environment, or a part of one: decides which pairs of segments and shapes are
/// contacts.
class EnvironmentQuery {
 public:
  /// Holds references: they must outlive it.
  EnvironmentQuery(const FiberAssembly& fibers, const QueryOptions& options,
                   const AllowedParts& allowed, QueryResult& result)
      : accumulator_(options, result),
        options_(options),
        fibers_(fibers),
        allowed_(allowed),
        result_(result) {}

  /// A part, see ContactAccumulator.
  EnvironmentQuery(const EnvironmentQuery& whole, QueryResult& result)
      : accumulator_(whole.accumulator_, result),
        options_(whole.options_),
        fibers_(whole.fibers_),
        allowed_(whole.allowed_),
        result_(result) {}
  EnvironmentQuery(const EnvironmentQuery&) = delete;
  EnvironmentQuery& operator=(const EnvironmentQuery&) = delete;

  /// Considers the pairs of a run and a shape.
  /// @return [m] shapes further than this from the axes of the run do not matter from now on; minus
  ///         infinity when the query is done
  double offer(const SegmentRun& run, const WorldShape& shape) {
    ++result_.counts.node_tests;
    const double bound = accumulator_.bound_of(run.fiber, shape.object);
    const BoxReach reach(bound + run.radius);
    const EightBoxes::Distances squared_distances = run.boxes.squared_distances(shape.box);
    std::uint32_t near_count = 0;
    for (std::uint32_t point = run.begin; point < run.end; ++point) {
      if (!reach.holds(squared_distances[point - run.begin])) {
        continue;
      }
      ++near_count;
      if (accumulator_.done()) {
        return -std::numeric_limits<double>::infinity();
      }
      offer_segment(run, point, shape);
    }
    result_.counts.node_overlaps += near_count > 0 ? 1 : 0;
    if (near_count < run.end - run.begin) {
      accumulator_.leave_out(bound);
    }
    return reach_of(run);
  }

  /// [m] Shapes further than this from the axes of the run do not matter.
  double reach_of(const SegmentRun& run) const { return accumulator_.bound() + run.radius; }

  static constexpr std::uint32_t segments_per_run = 8;

  WorldBox box_of(std::uint32_t point) const {
    const Eigen::Vector3d& p0 = fibers_.points()[point];
    const Eigen::Vector3d& p1 = fibers_.points()[point + 1];
    return {p0.cwiseMin(p1), p0.cwiseMax(p1)};
  }
  double radius_of(std::uint32_t point) const { return fibers_.segment_radius(point); }

  // As SearchJobs asks for them.
  std::uint64_t pairs_taken() const { return accumulator_.pairs_taken(); }
  std::uint64_t pairs_left() const { return accumulator_.pairs_left(); }
  bool lacks_pairs() const { return accumulator_.lacks_pairs(); }
  bool wants_any() const { return options_.type == QueryType::FIRST; }
  bool done() { return accumulator_.done(); }
  bool done_by_now() { return accumulator_.done_by_now(); }
  void absorb(const EnvironmentQuery& part) {
    for (const Contact& contact : part.accumulator_.contacts()) {
      accumulator_.keep(contact);
    }
    accumulator_.absorb(part.accumulator_);
  }

  /// Whether what is found makes others not matter.
  bool shrinks() const { return options_.type != QueryType::ALL || accumulator_.lowers_bound(); }
  void stop() { accumulator_.stop(); }
  void finish() { accumulator_.finish(-std::numeric_limits<double>::infinity()); }

 private:
  void offer_segment(const SegmentRun& run, std::uint32_t point, const WorldShape& shape) {
    const std::uint32_t first = fibers_.offsets()[run.fiber];
    if (allowed_.holds(fibers_, {run.fiber, point - first}, shape.object)) {
      return;
    }
    const Capsule capsule = fibers_.capsule(point);
    const double bound = accumulator_.bound_of(run.fiber, shape.object);
    const double within = bound + capsule.radius;
    if (!accumulator_.takes_pair()) {
      return;
    }
    ++result_.counts.primitive_tests;
    const AxisDistance axis = axis_distance(shape.shape, shape.to_shape * capsule.p0,
                                            shape.to_shape * capsule.p1, within);
    if (axis.distance == std::numeric_limits<double>::infinity()) {
      accumulator_.leave_out(bound);
      return;
    }
    Contact found = contact_of(capsule, shape, axis);
    found.fiber_a = run.fiber;
    found.segment_a = point - first;
    if (found.distance <= bound) {
      accumulator_.keep(found);
    } else {
      accumulator_.leave_out(found.lower);
    }
  }

  ContactAccumulator accumulator_;
  const QueryOptions& options_;
  const FiberAssembly& fibers_;
  const AllowedParts& allowed_;
  QueryResult& result_;
};

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
  std::vector<std::string_view> names;
  names.reserve(objects_.size());
  for (const EnvironmentObject& object : objects_) {
    validate(object);
    names.emplace_back(object.name);
  }
  std::sort(names.begin(), names.end());
  const auto twice = std::adjacent_find(names.begin(), names.end());
  if (twice != names.end()) {
    throw std::invalid_argument("there are two objects of the name " + quote(*twice));
  }
  broad_phase_ = std::make_unique<BroadPhase>(objects_);
}

Environment::~Environment() = default;

void Environment::query(const FiberAssembly& fibers, const QueryOptions& options,
                        const AllowedPairs& allowed, QueryResult& result) const {
  validate(options);
  result.counts = QueryCounts();
  result.complete = true;
  const AllowedParts parts(allowed, objects_);
  EnvironmentQuery whole(fibers, options, parts, result);
  const auto offer = [&](EnvironmentQuery& query, const SegmentRun& run) {
    broad_phase_->boxes.visit_near(run.box, query.reach_of(run), [&](const WorldShape& shape) {
      return query.offer(run, shape);
    });
  };
  const auto alone = [&](std::uint32_t begin, std::uint32_t end) {
    for_each_run(fibers, {begin, end}, whole, [&](const SegmentRun& run) { offer(whole, run); });
  };
  const PointRange all = all_points(fibers);
  if (all.end < worth_several_threads) {
    alone(all.begin, all.end);
  } else {
    SearchJobs<EnvironmentQuery>().search(
        whole, all.end, points_per_job, whole.shrinks() ? points_per_job : all.end,
        // While it waits, a thread must not begin with another query of whoever asked this one.
        [](const auto& work) { tbb::this_task_arena::isolate(work); },
        [&](SearchJob<EnvironmentQuery>& job, std::uint32_t begin, std::uint32_t end) {
          for_each_run(fibers, {begin, end}, job.part(), [&](const SegmentRun& run) {
            if (job.goes_on(16)) {
              offer(job.part(), run);
            } else {
              job.part().stop();
            }
          });
        },
        alone);
  }
  whole.finish();
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
