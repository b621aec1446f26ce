#include "benchmark/device_candidates.hpp"

#include <tbb/parallel_for.h>
#include <tbb/task_arena.h>

#include <algorithm>
#include <iostream>
#include <memory>
#include <optional>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

#include "benchmark/environment/cell.hpp"
#include "benchmark/report.hpp"
#include "fiber_proximity/cuda/device_proximity.hpp"
#include "fiber_proximity/environment/check_fibers.hpp"
#include "fiber_proximity/query/engine.hpp"
#include "src/accuracy/statistics.hpp"
#include "src/cuda/device.hpp"
#include "src/query/threads.hpp"
#include "src/tools/progress.hpp"

namespace fiber {
namespace {

/// Cables that might be laid, of a batch that has so many before them.
FiberAssembly some_cables(const CandidateRequest& request, std::uint32_t count,
                          std::uint64_t first) {
  std::vector<Eigen::Vector3d> points;
  std::vector<std::uint32_t> offsets{0};
  for (std::uint32_t cable = 0; cable < count; ++cable) {
    const FiberAssembly one = candidate_cable(request.points, first + cable);
    points.insert(points.end(), one.points().begin(), one.points().end());
    offsets.push_back(static_cast<std::uint32_t>(points.size()));
  }
  return {std::move(points), std::move(offsets), {request.radius}};
}

/// Candidates on their own, as check_fibers() takes them, and all together.
struct CandidateBatch {
  std::vector<FiberAssembly> candidates;
  FiberAssembly still;
  std::vector<Eigen::Vector3d> points;  // of all
  std::vector<std::uint32_t> offsets{0};
  std::vector<std::uint32_t> begins{0};

  explicit CandidateBatch(const CandidateRequest& request)
      : candidates(request.count), still(some_cables(request, request.still, 0)) {
    tbb::parallel_for(std::size_t{0}, candidates.size(), [&](std::size_t i) {
      candidates[i] =
          some_cables(request, request.cables, request.still + std::uint64_t{request.cables} * i);
    });
    for (const FiberAssembly& candidate : candidates) {
      add(candidate);
      begins.push_back(static_cast<std::uint32_t>(offsets.size()) - 1);
    }
    add(still);
  }

 private:
  void add(const FiberAssembly& fibers) {
    const auto first = static_cast<std::uint32_t>(points.size());
    points.insert(points.end(), fibers.points().begin(), fibers.points().end());
    for (std::size_t fiber = 0; fiber < fibers.fiber_count(); ++fiber) {
      offsets.push_back(first + fibers.offsets()[fiber + 1]);
    }
  }
};

/// Whether contacts are those of check_fibers(), bit for bit.
bool are_same(const DeviceProximity::Contacts& found, const CandidateBatch& batch,
              const std::vector<FiberCheck>& checks) {
  const auto still = static_cast<std::uint32_t>(batch.points.size() - batch.still.point_count());
  std::uint32_t next = 0;
  for (std::size_t candidate = 0; candidate < checks.size(); ++candidate) {
    const FiberAssembly& fibers = batch.candidates[candidate];
    const std::uint32_t first = batch.offsets[batch.begins[candidate]];
    const auto is_next = [&](const Contact& contact, const FiberAssembly& other,
                             std::uint32_t first_other) {
      const std::uint32_t a = first + fibers.offsets()[contact.fiber_a] + contact.segment_a;
      const std::uint32_t b = first_other + other.offsets()[contact.fiber_b] + contact.segment_b;
      return next < found.count && found.a[next] == a && found.b[next] == b &&
             found.s[next] == contact.s && found.t[next] == contact.t &&
             found.distance[next] == contact.distance;
    };
    if (found.candidate_begins[candidate] != next) {
      return false;
    }
    // Both are sorted: those of a point with the candidate itself come first.
    auto own = checks[candidate].self.contacts.begin();
    auto other = checks[candidate].fibers.contacts.begin();
    while (own != checks[candidate].self.contacts.end() ||
           other != checks[candidate].fibers.contacts.end()) {
      if (own != checks[candidate].self.contacts.end() && is_next(*own, fibers, first)) {
        ++own;
      } else if (other != checks[candidate].fibers.contacts.end() &&
                 is_next(*other, batch.still, still)) {
        ++other;
      } else {
        return false;
      }
      ++next;
    }
  }
  return found.count == next;
}

bool touch_the_same(const std::vector<std::uint8_t>& touching,
                    const std::vector<FiberCheck>& checks) {
  return std::equal(touching.begin(), touching.end(), checks.begin(), checks.end(),
                    [](std::uint8_t touches, const FiberCheck& check) {
                      return (touches != 0) == check.has_contact();
                    });
}

/// [ms]
struct CandidateTimes {
  std::vector<double> first_checked;    // check_fibers(), whether they touch
  std::vector<double> all_checked;      // check_fibers(), all contacts
  std::vector<double> touching;         // points over, whether they touch, and back
  std::vector<double> touching_locked;  // the same from page-locked points
  std::vector<double> touching_device;  // of that what the GPU does, points over apart
  std::vector<double> contacts_locked;  // page-locked points over, all contacts back
  std::vector<double> contacts_device;  // of that what the GPU does
};

void print(const CandidateRequest& request, std::size_t touching, std::size_t contacts,
           const CandidateTimes& times) {
  RowPrinter printer({"candidates",
                      "segments",
                      "touching",
                      "contacts",
                      {"touching on GPU [ms]", "touching_device_ms"},
                      {"with points over [ms]", "touching_ms"},
                      {"page-locked [ms]", "touching_locked_ms"},
                      "threads",
                      {"check_fibers [ms]", "first_checked_ms"},
                      {"contacts on GPU [ms]", "contacts_device_ms"},
                      {"over and back [ms]", "contacts_locked_ms"},
                      {"check_fibers, all [ms]", "all_checked_ms"}},
                     request.json);
  const std::size_t cables = std::size_t{request.cables} * request.count + request.still;
  printer.print({{"candidates", request.count},
                 {"segments", cables * (request.points - 1)},
                 {"touching", touching},
                 {"contacts", contacts},
                 {"touching_device_ms", median(times.touching_device)},
                 {"touching_ms", median(times.touching)},
                 {"touching_locked_ms", median(times.touching_locked)},
                 {"threads", request.threads},
                 {"first_checked_ms", median(times.first_checked)},
                 {"contacts_device_ms", median(times.contacts_device)},
                 {"contacts_locked_ms", median(times.contacts_locked)},
                 {"all_checked_ms", median(times.all_checked)}});
}

}  // namespace

ExitCode measure_candidates(const CandidateRequest& request) {
  const std::uint64_t points = std::uint64_t{request.count} * request.cables * request.points;
  constexpr std::uint64_t most = std::uint64_t{1} << 27U;
  if (points > most) {
    throw std::invalid_argument("the candidates have " + std::to_string(points) +
                                " points together, at most " + std::to_string(most) +
                                " are measured");
  }
  Progress progress;
  progress.show("candidates");
  const CandidateBatch batch(request);
  DeviceProximity device(request.device == "host" ? make_host_device() : make_cuda_device(),
                         batch.offsets, {request.radius}, batch.begins);
  const std::shared_ptr<void> lock = device.lock_points(batch.points);
  const std::vector<Eigen::Vector3d> unlocked = batch.points;
  const std::unique_ptr<ProximityEngine> engine = make_engine("run_tree");
  engine->update(batch.still);
  Surroundings surroundings;
  surroundings.fibers = engine.get();
  tbb::task_arena arena(arena_concurrency(request.threads));
  QueryOptions first;
  first.type = QueryType::FIRST;
  QueryOptions all;
  all.neighbour_skip = 1;
  std::vector<FiberCheck> first_checks;
  std::vector<FiberCheck> all_checks;
  const auto check = [&](const QueryOptions& options, std::vector<FiberCheck>& checks) {
    arena.execute([&] { check_fibers(batch.candidates, surroundings, options, checks); });
  };
  const DeviceProximity::Options with_loops{0.0, std::nullopt};
  std::vector<std::uint8_t> touching;
  DeviceProximity::Contacts contacts;
  CandidateTimes times;
  for (std::uint32_t frame = 0; frame <= request.repeats; ++frame) {
    progress.show("batch " + std::to_string(frame) + " of " + std::to_string(request.repeats));
    const double first_checked = time_of([&] { check(first, first_checks); });
    const double all_checked = time_of([&] { check(all, all_checks); });
    const double over = time_of([&] {
      device.update_from_host(unlocked);
      device.check_candidates(with_loops, touching);
    });
    bool are_right = touch_the_same(touching, first_checks);
    const double locked = time_of([&] {
      device.update_from_host(batch.points);
      device.check_candidates(with_loops, touching);
    });
    constexpr double ms = 1e3;
    const double on_device = ms * device.device_seconds();
    are_right = are_right && touch_the_same(touching, first_checks);
    const double with_contacts = time_of([&] {
      device.update_from_host(batch.points);
      contacts = {};  // the next take its memory
      contacts = device.query_to_host({});
    });
    if (!are_right || !are_same(contacts, batch, all_checks)) {
      std::cerr << "fiber_bench: in batch " << frame << " check_fibers() has other contacts\n";
      return DISAGREED;
    }
    if (frame == 0) {
      continue;  // finds its memory
    }
    times.first_checked.push_back(first_checked);
    times.all_checked.push_back(all_checked);
    times.touching.push_back(over);
    times.touching_locked.push_back(locked);
    times.touching_device.push_back(on_device);
    times.contacts_locked.push_back(with_contacts);
    times.contacts_device.push_back(ms * device.device_seconds());
  }
  print(request,
        static_cast<std::size_t>(std::count(touching.begin(), touching.end(), std::uint8_t{1})),
        contacts.count, times);
  return SUCCEEDED;
}

}  // namespace fiber
