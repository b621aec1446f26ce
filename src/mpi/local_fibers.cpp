#include "src/mpi/local_fibers.hpp"

#include <algorithm>
#include <limits>
#include <numeric>
#include <stdexcept>
#include <string>

#include "src/geometry/norm.hpp"

namespace fiber {
namespace {

constexpr double unbounded = std::numeric_limits<double>::infinity();

/// Whether the second run begins where the first one ends.
bool goes_on(const FiberRun& run, const FiberRun& next) {
  return next.first.fiber == run.first.fiber && next.first.segment == run.first.segment + run.count;
}

}  // namespace

void LocalFibers::clear() {
  runs_.clear();
  numbers_.clear();
  first_ids_.clear();
  points_.clear();
  radii_.clear();
  offsets_.assign(1, 0);
  fibers_ = FiberAssembly();
}

void LocalFibers::assign(const FiberRuns& set) {
  assign(set.runs);
  for (std::size_t i = 0; i < set.runs.size(); ++i) {
    place(i, set.runs[i].arc, set.nodes.data() + set.runs[i].begin);
  }
  close();
}

void LocalFibers::assign(std::vector<FiberRun> runs) {
  clear();
  std::vector<std::uint32_t> order(runs.size());
  std::iota(order.begin(), order.end(), 0U);
  std::sort(order.begin(), order.end(),
            [&](std::uint32_t x, std::uint32_t y) { return runs[x].first < runs[y].first; });
  numbers_.resize(runs.size());
  runs_.reserve(runs.size());
  std::uint64_t point = 0;
  for (std::size_t i = 0; i < order.size(); ++i) {
    const FiberRun& run = runs[order[i]];
    if (point == offsets_.back()) {
      first_ids_.push_back(run.first);
    }
    numbers_[order[i]] = static_cast<std::uint32_t>(i);
    runs_.push_back({run.first, run.count, point, run.arc});
    point += run.count;
    if (i + 1 == order.size() || !goes_on(run, runs[order[i + 1]])) {
      ++point;
      offsets_.push_back(static_cast<std::uint32_t>(point));
    }
    if (point > std::numeric_limits<std::int32_t>::max()) {
      clear();
      throw std::invalid_argument("this rank would hold more than " +
                                  std::to_string(std::numeric_limits<std::int32_t>::max()) +
                                  " points: take more ranks or a smaller margin");
    }
  }
  points_.resize(point);
  moved_ = unbounded;
}

void LocalFibers::open() {
  const std::vector<double>& radii = fibers_.radii();
  radius_before_ = radii.size() == 1 ? radii.front() : unbounded;
  moved_ = 0.0;
  fibers_.exchange_segments(points_, offsets_, radii_);
}

/// Gives each segment a radius of its own. So far there is one for all.
void LocalFibers::expand_radii() {
  moved_ = unbounded;
  const double radius = radii_.front();
  radii_.assign(points_.size(), radius);
  for (std::size_t fiber = 1; fiber < offsets_.size(); ++fiber) {
    radii_[offsets_[fiber] - 1] = 0.0;
  }
}

const FiberNode* LocalFibers::place(std::size_t number, double arc, const FiberNode* nodes) {
  FiberRun& run = runs_[sorted_index(number)];
  run.arc = arc;
  if (radii_.empty()) {
    radii_.push_back(nodes->radius);
    moved_ = nodes->radius == radius_before_ ? moved_ : unbounded;
  }
  double moved = 0.0;
  for (std::uint64_t i = 0; i <= run.count; ++i) {
    const Eigen::Vector3d point = nodes[i].point;
    moved =
        std::max(moved, (point - points_[run.begin + i]).lpNorm<1>());  // which never underflows
    points_[run.begin + i] = point;
    if (i == run.count) {
      break;  // the next run may begin there, with its radius
    }
    if (radii_.size() == 1 && nodes[i].radius != radii_.front()) {
      expand_radii();
    }
    if (radii_.size() > 1) {
      double& radius = radii_[run.begin + i];
      moved_ = nodes[i].radius == radius ? moved_ : unbounded;
      radius = nodes[i].radius;
    }
  }
  moved_ = std::max(moved_, moved);
  return nodes + run.count + 1;
}

void LocalFibers::close() {
  try {
    fibers_.exchange_segments(points_, offsets_, radii_);
  } catch (const std::invalid_argument&) {
    clear();
    throw;
  }
}

void LocalFibers::add_to(FiberRuns& others, const FiberRun& run, std::uint64_t begin,
                         std::uint64_t end) const {
  others.runs.push_back({{run.first.fiber, run.first.segment + begin},
                         end - begin,
                         others.nodes.size(),
                         arc(run, begin)});
  for (std::uint64_t p = run.begin + begin; p <= run.begin + end; ++p) {
    others.nodes.push_back(node(p));
  }
  others.nodes.back().radius = 0.0;  // of the segment that would come next
}

std::size_t LocalFibers::run_of(std::uint32_t point) const {
  const auto after =
      std::upper_bound(runs_.begin(), runs_.end(), point,
                       [](std::uint64_t p, const FiberRun& run) { return p < run.begin; });
  return static_cast<std::size_t>(after - runs_.begin()) - 1;
}

double LocalFibers::arc(std::uint32_t point) const {
  const FiberRun& run = runs_[run_of(point)];
  return arc(run, point - run.begin);
}

double LocalFibers::arc(const FiberRun& run, std::uint64_t i) const {
  double length = run.arc;
  for (std::uint64_t p = run.begin + 1; p <= run.begin + i; ++p) {
    length += norm_of(fibers_.points()[p] - fibers_.points()[p - 1]);
  }
  return length;
}

}  // namespace fiber
