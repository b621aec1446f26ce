#include <tbb/parallel_for.h>
#include <tbb/task_arena.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <optional>
#include <stdexcept>
#include <string>
#include <string_view>
#include <vector>

#include "fiber_proximity/environment/environment.hpp"
#include "fiber_proximity/query/for_engines/pair_collector.hpp"
#include "fiber_proximity/query/options.hpp"
#include "src/environment/allowed_contacts.hpp"
#include "src/environment/broad_phase.hpp"
#include "src/environment/moving_shapes.hpp"
#include "src/environment/shape_contact_time.hpp"
#include "src/geometry/swept_fibers.hpp"
#include "src/query/contact_evaluator.hpp"
#include "src/query/motion_evaluator.hpp"
#include "src/text/quote.hpp"

namespace fiber {
namespace {

double larger_radius(const FiberMotion& motion, std::uint32_t point) {
  return std::max(motion.before.segment_radius(point), motion.after.segment_radius(point));
}

WorldBox box_of_ways(const FiberMotion& motion, std::uint32_t first, std::uint32_t last) {
  WorldBox box;
  for (std::uint32_t point = first; point <= last; ++point) {
    box.extend(motion.before.points()[point]).extend(motion.after.points()[point]);
  }
  return box;
}

std::vector<ObjectPath> paths_between(const std::vector<EnvironmentObject>& before,
                                      const std::vector<EnvironmentObject>& after) {
  std::map<std::string_view, const EnvironmentObject*> later;
  for (const EnvironmentObject& object : after) {
    later.emplace(object.name, &object);
  }
  std::vector<ObjectPath> paths;
  paths.reserve(before.size());
  for (const EnvironmentObject& object : before) {
    const auto found = later.find(object.name);
    if (found != later.end() && !have_same_shapes(object, *found->second)) {
      throw std::invalid_argument("object " + quote(object.name) +
                                  " changes its shapes during the motion, it may only move");
    }
    paths.emplace_back(object.pose, found == later.end() ? object.pose : found->second->pose);
  }
  return paths;
}

void validate(const ObjectDisplacement& displacement) {
  if (!displacement.translation.unaryExpr(&FiberAssembly::is_valid_coordinate).all()) {
    throw std::invalid_argument(FiberAssembly::coordinate_rule);
  }
  const double turn = displacement.rotation.norm();
  if (!(turn <= ObjectDisplacement::max_rotation)) {
    throw std::invalid_argument("it turns by " + std::to_string(turn) +
                                " rad, it must be at most " +
                                std::to_string(ObjectDisplacement::max_rotation));
  }
}

std::vector<ObjectPath> paths_of(const std::vector<EnvironmentObject>& objects,
                                 const std::vector<ObjectDisplacement>& displacements) {
  if (displacements.size() != objects.size()) {
    throw std::invalid_argument("there are " + std::to_string(displacements.size()) +
                                " displacements of " + std::to_string(objects.size()) +
                                " objects, there must be one of each");
  }
  std::vector<ObjectPath> paths;
  paths.reserve(objects.size());
  for (std::size_t i = 0; i < objects.size(); ++i) {
    try {
      validate(displacements[i]);
    } catch (const std::invalid_argument& error) {
      throw std::invalid_argument("the displacement of object " + quote(objects[i].name) + ": " +
                                  error.what());
    }
    paths.emplace_back(objects[i].pose, displacements[i]);
  }
  return paths;
}

/// Where anything may come near to fibres during a motion.
WorldBox box_around(const FiberMotion& motion, double margin) {
  WorldBox box;
  double radius = 0.0;
  for (std::uint32_t fiber = 0; fiber < motion.before.fiber_count(); ++fiber) {
    const std::uint32_t last = motion.before.offsets()[fiber + 1] - 1;
    for (std::uint32_t point = motion.before.offsets()[fiber]; point < last; ++point) {
      radius = std::max(radius, larger_radius(motion, point));
    }
    box.extend(box_of_ways(motion, motion.before.offsets()[fiber], last));
  }
  if (!box.isEmpty()) {
    const double largest = box.min().cwiseAbs().cwiseMax(box.max().cwiseAbs()).maxCoeff();
    const double padding = (margin + radius) * (1.0 + 0x1p-30) + 0x1p-48 * largest;
    box.min().array() -= padding;
    box.max().array() += padding;
  }
  return box;
}

/// One query of an environment about a motion: first the pairs of segments and shapes that may
/// meet, then when these do.
class EnvironmentMotion {
 public:
  /// Holds references: they must outlive it.
  /// @param shapes by object, as WorldShape counts them
  /// @param moving those of them that move; null where all stand still
  EnvironmentMotion(const FiberMotion& motion, const std::vector<WorldShape>& shapes,
                    MovingShapes* moving, const std::vector<EnvironmentObject>& objects,
                    const MotionOptions& options, const AllowedPairs& allowed)
      : motion_(motion),
        shapes_(shapes),
        moving_(moving),
        options_(options),
        allowed_(allowed, objects),
        limits_(pairs_of(options)) {}

  static constexpr std::uint32_t segments_per_run = 4;  // they sweep more than those that stand

  WorldBox box_of(std::uint32_t point) const { return box_of_ways(motion_, point, point + 1); }
  double radius_of(std::uint32_t point) const { return larger_radius(motion_, point); }

  /// Considers the pairs of a run and a shape.
  /// @return [m] shapes further than this from the run's box do not matter; minus infinity when no
  ///         more are looked for
  double offer(const SegmentRun& run, const WorldShape& shape) {
    ++candidates_.counts.node_tests;
    const WorldBox& shape_box = moves(shape) ? moving_->box(shape) : shape.box;
    const BoxReach reach(within(run.radius));
    const EightBoxes::Distances squared_distances = run.boxes.squared_distances(shape_box);
    bool is_near = false;
    const auto index = static_cast<std::uint32_t>(&shape - shapes_.data());
    const std::uint32_t first = motion_.before.offsets()[run.fiber];
    for (std::uint32_t point = run.begin; point < run.end; ++point) {
      if (!reach.holds(squared_distances[point - run.begin])) {
        continue;
      }
      is_near = true;
      if (allowed_.holds(motion_.before, {run.fiber, point - first}, shape.object)) {
        continue;
      }
      if (candidates_.keys.size() >= limits_.pairs) {
        candidates_.are_too_many = true;
        return -std::numeric_limits<double>::infinity();
      }
      candidates_.keys.push_back(pair_key({point, index}));
    }
    candidates_.counts.node_overlaps += is_near ? 1 : 0;
    return within(run.radius);
  }

  /// [m] So far boxes may be apart that there is contact, with the rounding of their distance.
  double within(double radius) const { return (options_.margin + radius) * (1.0 + 0x1p-40); }

  bool moves(const WorldShape& shape) const { return moving_ != nullptr && moving_->moves(shape); }

  /// Whether the deadline has passed, or there are too many pairs.
  bool done() {
    candidates_.are_all = candidates_.are_all && !limits_.deadline.has_passed();
    return !candidates_.are_all || candidates_.are_too_many;
  }

  /// When the pairs meet, on several threads; the same for any number of them.
  void evaluate(MotionResult& result) {
    std::vector<std::uint64_t>& keys = candidates_.keys;
    if (candidates_.are_too_many) {
      keys.clear();
    }
    std::sort(keys.begin(), keys.end());
    // A pair takes longer here than one of two segments.
    constexpr std::size_t pairs_per_slice = motions_per_slice / 16;
    std::vector<MotionSlice> slices((keys.size() + pairs_per_slice - 1) / pairs_per_slice);
    const auto evaluate_slice = [&](std::size_t index) {
      const std::size_t begin = index * pairs_per_slice;
      evaluate(keys.data() + begin, std::min(pairs_per_slice, keys.size() - begin), slices[index]);
    };
    if (slices.size() == 1) {
      evaluate_slice(0);
    } else {
      // While it waits, a thread must not begin with another query of whoever asked this one.
      tbb::this_task_arena::isolate(
          [&] { tbb::parallel_for(std::size_t{0}, slices.size(), evaluate_slice); });
    }
    merge_slices(slices.data(), slices.size(), candidates_, options_, result);
  }

 private:
  void evaluate(const std::uint64_t* keys, std::size_t count, MotionSlice& slice) const {
    slice.complete = !limits_.deadline.has_passed();
    if (slice.complete) {
      std::for_each(keys, keys + count, [&](std::uint64_t key) { evaluate(key, slice); });
    }
  }

  void evaluate(std::uint64_t key, MotionSlice& slice) const {
    const PointPair pair = pair_of(key);
    const WorldShape& shape = shapes_[pair.b];
    const SegmentAndShape moving{motion_.before.capsule(pair.a), motion_.after.capsule(pair.a),
                                 shape, moves(shape) ? &moving_->path(shape) : nullptr};
    const double radius = larger_radius(motion_, pair.a);
    const double limit = options_.margin + radius;
    const AxisDistance axis = axis_distance(shape.shape, shape.to_shape * moving.before.p0,
                                            shape.to_shape * moving.before.p1, limit);
    const SegmentId id = motion_.before.segment_id(pair.a);
    MotionContact contact{{id.fiber, id.segment, shape.object, shape.index}, 0.0, 0.0, false};
    const bool is_any = axis.distance < std::numeric_limits<double>::infinity();
    if (is_any && axis.distance - radius <= options_.margin) {
      contact.certain = axis.distance + shape.error(moving.before) <= limit;
      slice.touching.push_back(contact);
      return;
    }
    const auto ask = [&](double tolerance) { return contact_time(moving, limit, tolerance); };
    ContactTime time = ask(options_.tolerance);
    narrow(time, options_, ask);
    if (time.hit) {
      contact.lower = time.lower;
      contact.upper = time.upper;
      contact.certain = time.certain;
      slice.contacts.push_back(contact);
    }
  }

  const FiberMotion& motion_;
  const std::vector<WorldShape>& shapes_;
  MovingShapes* const moving_;
  const MotionOptions& options_;
  const AllowedParts allowed_;
  const QueryLimits limits_;
  MotionCandidates candidates_;  // a segment's first point and the index of a shape
};

}  // namespace

void Environment::query_motion(const FiberAssembly& before, const FiberAssembly& after,
                               const Environment& later, const MotionOptions& options,
                               const AllowedPairs& allowed, MotionResult& result) const {
  const bool all_stand = &later == this;
  query_motion(all_stand ? std::vector<ObjectPath>() : paths_between(objects_, later.objects_),
               {before, after}, options, allowed, result);
}

void Environment::query_motion(const FiberAssembly& before, const FiberAssembly& after,
                               const std::vector<ObjectDisplacement>& displacements,
                               const MotionOptions& options, const AllowedPairs& allowed,
                               MotionResult& result) const {
  query_motion(paths_of(objects_, displacements), {before, after}, options, allowed, result);
}

/// @param paths by object; empty where all stand still
void Environment::query_motion(const std::vector<ObjectPath>& paths, const FiberMotion& motion,
                               const MotionOptions& options, const AllowedPairs& allowed,
                               MotionResult& result) const {
  const bool do_turn =
      std::any_of(paths.begin(), paths.end(), [](const ObjectPath& path) { return path.turns(); });
  if (do_turn && options.tolerance == 0.0) {
    throw std::invalid_argument("the tolerance is 0 m, where objects turn it must be more");
  }
  validate(options);
  require_same_topology(motion.before, motion.after);
  result.contacts.clear();
  result.touching.clear();
  std::optional<MovingShapes> moving;
  if (!paths.empty()) {
    moving.emplace(broad_phase_->shapes, paths, box_around(motion, options.margin));
  }
  EnvironmentMotion query(motion, broad_phase_->shapes, moving ? &*moving : nullptr, objects_,
                          options, allowed);
  for_each_run(motion.before, all_points(motion.before), query, [&](const SegmentRun& run) {
    const double within = query.within(run.radius);
    if (!moving || !moving->are_all()) {
      broad_phase_->boxes.visit_near(run.box, within, [&](const WorldShape& shape) {
        return query.moves(shape) ? within : query.offer(run, shape);
      });
    }
    if (moving) {
      moving->boxes().visit_near(run.box, within,
                                 [&](const WorldShape& shape) { return query.offer(run, shape); });
    }
  });
  query.evaluate(result);
}

}  // namespace fiber
