#include "src/io/frame_rows.hpp"

#include <utility>

#include "src/io/radii.hpp"
#include "src/io/strands.hpp"
#include "src/text/quote.hpp"

namespace fiber {
namespace {

constexpr std::uint32_t no_fiber = UINT32_MAX;

/// The items of some rows, in this order; none where there are none.
template <class Item>
void take_items(const std::vector<std::size_t>& taken, std::vector<Item>& items) {
  std::vector<Item> found;
  if (!items.empty()) {
    found.reserve(taken.size());
    for (const std::size_t row : taken) {
      found.push_back(items[row]);
    }
  }
  items = std::move(found);
}

void take_rows(const std::vector<std::size_t>& taken, FrameRows& rows) {
  take_items(taken, rows.points);
  take_items(taken, rows.radii);
  take_items(taken, rows.closed);
  take_items(taken, rows.joints);
}

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

void FrameBuilder::forget_fibers() {
  for (const std::uint32_t name : names_in_frame_) {
    fibers_[name] = no_fiber;
  }
}

/// Where rows of a fibre do not stand one after another.
void FrameBuilder::bring_together(FrameRows& rows) {
  std::vector<std::size_t> rows_of_places(rows.points.size());
  std::vector<std::uint32_t> places = offsets_;
  for (std::size_t run = 0; run < rows.runs.size(); ++run) {
    const std::uint32_t fiber = fibers_[rows.runs[run].name];
    std::uint32_t& place = places[fiber];
    if (scattered_.empty() && place != offsets_[fiber]) {
      scattered_ = names_[rows.runs[run].name];
    }
    for (std::size_t i = rows.runs[run].begin; i < end_of_run(rows, run); ++i, ++place) {
      rows_of_places[place] = i;
    }
  }
  take_rows(rows_of_places, rows);
}

void FrameBuilder::require_segments(const FrameRows& rows, const std::string& file) const {
  for (const FrameRows::Run& run : rows.runs) {
    const std::uint32_t fiber = fibers_[run.name];
    if (offsets_[fiber + 1] - offsets_[fiber] < 2) {
      throw FileError(
          file, run.line,
          "fibre " + quote(names_[run.name]) + " has only this point, " + single_point_rule);
    }
  }
}

/// Leaves out the rows of fibres that have one point only.
/// @return whether there were any
bool FrameBuilder::skip_single_points(FrameRows& rows) {
  std::vector<std::size_t> kept;
  std::vector<FrameRows::Run> kept_runs;
  std::size_t skipped = 0;
  for (std::size_t run = 0; run < rows.runs.size(); ++run) {
    const std::uint32_t fiber = fibers_[rows.runs[run].name];
    if (offsets_[fiber + 1] - offsets_[fiber] < 2) {
      ++skipped;
      continue;
    }
    kept_runs.emplace_back(rows.runs[run]).begin = kept.size();
    for (std::size_t i = rows.runs[run].begin; i < end_of_run(rows, run); ++i) {
      kept.push_back(i);
    }
  }
  if (skipped > 0) {
    take_rows(kept, rows);
    rows.runs = std::move(kept_runs);
    skipped_ += skipped;
  }
  return skipped > 0;
}

/// Finds closed and joined fibres.
/// @param rows brought together
FiberTopology FrameBuilder::topology_of(const FrameRows& rows, const std::string& file) {
  FiberTopology topology;
  topology.joints = rows.joints;
  for (std::size_t fiber = 0; !rows.closed.empty() && fiber + 1 < offsets_.size(); ++fiber) {
    const std::uint8_t closed = rows.closed[offsets_[fiber]];
    for (std::uint32_t row = offsets_[fiber]; row < offsets_[fiber + 1]; ++row) {
      if (rows.closed[row] != closed) {
        throw FileError(file, "fibre " + quote(names_[names_in_frame_[fiber]]) +
                                  " is closed in some of its rows and open in others, closed must "
                                  "be the same in all");
      }
    }
    topology.closed.push_back(closed);
  }
  const std::vector<LonelyJoint> lonely = lonely_joints(topology.joints);
  if (!lonely_joint_ && !lonely.empty()) {
    lonely_joint_ = {rows.number, lonely.front().joint};
  }
  return topology;
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

FiberFrame FrameBuilder::build(FrameRows rows, const std::string& file,
                               const ReadOptions& options) {
  find_fibers(rows);
  if (options.skip_single_points && skip_single_points(rows)) {
    forget_fibers();
    find_fibers(rows);
  }
  require_segments(rows, file);
  if (rows.runs.size() > names_in_frame_.size()) {
    bring_together(rows);
  }
  forget_fibers();
  if (rows.radii.empty()) {
    rows.radii.push_back(options.default_radius);
  }
  const FiberTopology topology = topology_of(rows, file);
  try {
    return {rows.number,
            FiberAssembly(std::move(rows.points), offsets_, shared_if_equal(std::move(rows.radii)),
                          topology),
            names_of_fibers()};
  } catch (const std::invalid_argument& error) {
    throw FileError(file, "frame " + std::to_string(rows.number) + ": " + error.what());
  }
}

}  // namespace fiber
