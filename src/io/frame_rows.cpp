#include "src/io/frame_rows.hpp"

#include <algorithm>
#include <stdexcept>
#include <utility>

#include "src/io/radii.hpp"
#include "src/text/quote.hpp"

namespace fiber {
namespace {

constexpr std::uint32_t no_fiber = UINT32_MAX;

std::size_t end_of_run(const FrameRows& rows, std::size_t run) {
  return run + 1 < rows.runs.size() ? rows.runs[run + 1].begin : rows.points.size();
}

}  // namespace

std::uint32_t FrameBuilder::number_of(std::string_view name) {
  // Mostly the names of a frame come in the order of the frame before.
  const std::uint32_t next = last_ + 1 < names_.size() ? last_ + 1 : 0;
  if (next < names_.size() && names_[next] == name) {
    return last_ = next;
  }
  const auto known = numbers_.find(name);
  if (known != numbers_.end()) {
    return last_ = known->second;
  }
  last_ = static_cast<std::uint32_t>(names_.size());
  numbers_.emplace(names_.emplace_back(name), last_);
  return last_;
}

/// Which names there are, and how many points each has.
void FrameBuilder::find_fibers(const FrameRows& rows) {
  fibers_.resize(names_.size(), no_fiber);
  names_in_frame_.clear();
  offsets_.assign(1, 0);
  for (std::size_t run = 0; run < rows.runs.size(); ++run) {
    std::uint32_t& fiber = fibers_[rows.runs[run].name];
    if (fiber == no_fiber) {
      fiber = static_cast<std::uint32_t>(names_in_frame_.size());
      names_in_frame_.push_back(rows.runs[run].name);
      offsets_.push_back(0);
    }
    offsets_[fiber + 1] += static_cast<std::uint32_t>(end_of_run(rows, run) - rows.runs[run].begin);
  }
  for (std::size_t fiber = 1; fiber < offsets_.size(); ++fiber) {
    offsets_[fiber] += offsets_[fiber - 1];
  }
}

/// Where rows of a fibre do not stand one after another.
void FrameBuilder::bring_together(FrameRows& rows) {
  std::vector<Eigen::Vector3d> points(rows.points.size());
  std::vector<double> radii(rows.radii.size());
  std::vector<std::uint8_t> closed(rows.closed.size());
  std::vector<std::int32_t> joints(rows.joints.size());
  std::vector<std::uint32_t> places = offsets_;
  for (std::size_t run = 0; run < rows.runs.size(); ++run) {
    const std::uint32_t fiber = fibers_[rows.runs[run].name];
    std::uint32_t& place = places[fiber];
    if (scattered_.empty() && place != offsets_[fiber]) {
      scattered_ = names_[rows.runs[run].name];
    }
    for (std::size_t i = rows.runs[run].begin; i < end_of_run(rows, run); ++i, ++place) {
      points[place] = rows.points[i];
      if (!radii.empty()) {
        radii[place] = rows.radii[i];
      }
      if (!closed.empty()) {
        closed[place] = rows.closed[i];
      }
      if (!joints.empty()) {
        joints[place] = rows.joints[i];
      }
    }
  }
  rows.points = std::move(points);
  rows.radii = std::move(radii);
  rows.closed = std::move(closed);
  rows.joints = std::move(joints);
}

void FrameBuilder::require_segments(const FrameRows& rows, const std::string& file) const {
  for (const FrameRows::Run& run : rows.runs) {
    const std::uint32_t fiber = fibers_[run.name];
    if (offsets_[fiber + 1] - offsets_[fiber] < 2) {
      throw FileError(
          file, run.line,
          "fibre " + quote(names_[run.name]) + " has only this point, a fibre needs at least 2");
    }
  }
}

FiberNames FrameBuilder::names_of_fibers() {
  if (names_in_frame_ != names_before_) {
    std::vector<std::string> names;
    names.reserve(names_in_frame_.size());
    for (const std::uint32_t name : names_in_frame_) {
      names.push_back(names_[name]);
    }
    fiber_names_ = FiberNames(std::move(names));
    names_before_ = names_in_frame_;
  }
  return fiber_names_;
}

/// What is joined among rows that have been brought together.
FiberTopology FrameBuilder::topology_of(FrameRows& rows, const std::string& file) const {
  FiberTopology topology;
  topology.joints = std::move(rows.joints);
  for (std::size_t fiber = 0; !rows.closed.empty() && fiber + 1 < offsets_.size(); ++fiber) {
    const auto first = rows.closed.begin() + offsets_[fiber];
    const auto last = rows.closed.begin() + offsets_[fiber + 1];
    if (std::find(first, last, *first == 0 ? 1 : 0) != last) {
      throw FileError(file, "fibre " + quote(names_[names_in_frame_[fiber]]) +
                                " is closed in some of its rows and not in others");
    }
    topology.closed.push_back(*first);
  }
  return topology;
}

FiberFrame FrameBuilder::build(FrameRows rows, const std::string& file, double default_radius) {
  find_fibers(rows);
  require_segments(rows, file);
  if (rows.runs.size() > names_in_frame_.size()) {
    bring_together(rows);
  }
  for (const std::uint32_t name : names_in_frame_) {
    fibers_[name] = no_fiber;
  }
  if (rows.radii.empty()) {
    rows.radii.push_back(default_radius);
  }
  const FiberTopology topology = topology_of(rows, file);
  try {
    return {rows.number,
            FiberAssembly(std::move(rows.points), offsets_, shared_if_equal(std::move(rows.radii)),
                          topology),
            names_of_fibers()};
  } catch (const std::invalid_argument& error) {
    // Rows are right one by one by now: only what is joined can be wrong.
    throw FileError(file, "frame " + std::to_string(rows.number) + ": " + error.what());
  }
}

}  // namespace fiber
