#include "src/mpi/fiber_chains.hpp"

#include <algorithm>
#include <list>
#include <sstream>
#include <string>

#include "src/geometry/norm.hpp"
#include "src/mpi/fiber_runs.hpp"

namespace fiber {
namespace {

/// A part as the rank hears of it that puts its fibre together.
struct PartNotice {
  GlobalSegment first;
  std::uint64_t count = 0;
  std::uint32_t part = 0;  // of the rank that has it
  int rank = 0;
};

/// The end of a part.
struct Joint {
  Eigen::Vector3d point{};
  double arc = 0.0;
};

/// "" if the parts, sorted, make whole fibres.
std::string gap_in(const std::vector<PartNotice>& parts) {
  for (std::size_t i = 0; i < parts.size(); ++i) {
    const GlobalSegment& first = parts[i].first;
    const bool goes_on = i > 0 && parts[i - 1].first.fiber == first.fiber;
    const std::uint64_t expected = goes_on ? parts[i - 1].first.segment + parts[i - 1].count : 0;
    if (first.segment != expected) {
      std::ostringstream text;
      text << "fibre " << first.fiber << ": rank " << parts[i].rank << " has a part from segment "
           << first.segment << " on, ";
      if (first.segment < expected) {
        text << "which rank " << parts[i - 1].rank << " has as well";
      } else {
        text << "but no rank has segment " << expected;
      }
      return text.str();
    }
  }
  return "";
}

std::string text_of(const Eigen::Vector3d& point) {
  std::ostringstream text;
  text.precision(17);
  text << '(' << point[0] << ", " << point[1] << ", " << point[2] << ')';
  return text.str();
}

}  // namespace

FiberChains::FiberChains(const Communicator& ranks, const FiberAssembly& parts,
                         const std::vector<FiberPart>& names) {
  const auto size = static_cast<std::size_t>(ranks.size());
  PerRank<PartNotice> notices(size);
  for (std::uint32_t part = 0; part < names.size(); ++part) {
    const std::uint64_t count = parts.offsets()[part + 1] - parts.offsets()[part] - 1;
    notices[names[part].fiber % size].push_back(
        {{names[part].fiber, names[part].first_segment}, count, part, ranks.rank()});
  }
  std::vector<PartNotice> sorted = joined(ranks.exchange(std::move(notices)));
  std::stable_sort(sorted.begin(), sorted.end(),
                   [](const PartNotice& x, const PartNotice& y) { return x.first < y.first; });
  ranks.throw_on_all(gap_in(sorted));

  PerRank<Link> links(size);
  for (std::size_t i = 0; i < sorted.size(); ++i) {
    const PartNotice& part = sorted[i];
    const bool goes_on = i > 0 && sorted[i - 1].first.fiber == part.first.fiber;
    const bool is_followed = i + 1 < sorted.size() && sorted[i + 1].first.fiber == part.first.fiber;
    links[static_cast<std::size_t>(part.rank)].push_back(
        {part.part, goes_on ? sorted[i - 1].rank : -1, is_followed ? sorted[i + 1].rank : -1});
  }
  links_ = joined(ranks.exchange(std::move(links)));
  // On every rank in the same order: then no two wait for each other, and messages come as awaited.
  std::sort(links_.begin(), links_.end(), [&](const Link& x, const Link& y) {
    const auto name_of = [&](const Link& link) {
      return GlobalSegment{names[link.part].fiber, names[link.part].first_segment};
    };
    return name_of(x) < name_of(y);
  });
}

ArcLengths FiberChains::arc_lengths(const Communicator& ranks, const FiberAssembly& parts,
                                    const std::vector<FiberPart>& names,
                                    std::uint32_t every) const {
  ArcLengths lengths;
  std::vector<std::size_t> first_pieces(names.size() + 1, 0);  // by part
  for (std::size_t part = 0; part < names.size(); ++part) {
    const std::uint32_t segments = parts.offsets()[part + 1] - parts.offsets()[part] - 1;
    first_pieces[part + 1] = first_pieces[part] + (segments + every - 1) / every;
  }
  lengths.of_pieces.resize(first_pieces.back());
  std::list<Joint> sent;  // stay where they are until they have been sent
  std::vector<MPI_Request> requests;
  std::string error;
  for (const Link& link : links_) {
    const std::uint32_t begin = parts.offsets()[link.part];
    const std::uint32_t last = parts.offsets()[link.part + 1] - 1;
    double length = 0.0;
    if (link.before >= 0) {
      Joint joint;
      MPI_Recv(&joint, sizeof(Joint), MPI_BYTE, link.before, static_cast<int>(MessageTag::CHAIN),
               ranks.handle(), MPI_STATUS_IGNORE);
      length = joint.arc;
      const Eigen::Vector3d start = parts.points()[begin];
      if (start != joint.point && error.empty()) {
        error = "fibre " + std::to_string(names[link.part].fiber) + ": the part from segment " +
                std::to_string(names[link.part].first_segment) + " on starts at " + text_of(start) +
                " m, the part before ends at " + text_of(joint.point) +
                " m, which must be the same";
      }
    }
    for (std::uint32_t p = begin; p < last; ++p) {
      if ((p - begin) % every == 0) {
        lengths.of_pieces[first_pieces[link.part] + (p - begin) / every] = length;
      }
      length += norm_of(parts.points()[p + 1] - parts.points()[p]);
    }
    const double count = static_cast<double>(names[link.part].first_segment + (last - begin));
    lengths.roundings = std::max(lengths.roundings, count * length);
    if (link.after >= 0) {
      sent.push_back({parts.points()[last], length});
      MPI_Isend(&sent.back(), sizeof(Joint), MPI_BYTE, link.after,
                static_cast<int>(MessageTag::CHAIN), ranks.handle(), &requests.emplace_back());
    }
  }
  MPI_Waitall(static_cast<int>(requests.size()), requests.data(), MPI_STATUSES_IGNORE);
  ranks.throw_on_all(error);
  lengths.roundings = ranks.max(lengths.roundings);
  return lengths;
}

}  // namespace fiber
