// `fiber_query_mpi regions`: which rank owns each segment, and whose halo it is in.
#include <algorithm>
#include <cstdint>
#include <limits>
#include <memory>
#include <string>
#include <tuple>
#include <utility>
#include <vector>

#include "fiber_proximity/mpi/distributed_files.hpp"
#include "fiber_proximity/query/options.hpp"
#include "src/io/file_format.hpp"
#include "src/mpi/communicator.hpp"
#include "src/mpi/halo.hpp"
#include "src/mpi/named_fibers.hpp"
#include "src/mpi/rank_fibers.hpp"
#include "src/tools/fiber_query_mpi.hpp"
#include "src/tools/fiber_source.hpp"
#include "src/tools/mpi_tool.hpp"
#include "src/tools/rank_text.hpp"

namespace fiber {
namespace {

struct RegionsRequest {
  std::string file;
  double radius = 0.0;  // [m]
  QueryOptions query;
  std::string out;  // "" for stdout
};

/// That a rank has a segment.
struct SegmentHolder {
  GlobalSegment segment;
  std::int32_t is_guest = 0;  // in the rank's halo; otherwise the rank owns it
  std::int32_t rank = 0;

  auto key() const { return std::tie(segment.fiber, segment.segment, is_guest, rank); }
  bool operator<(const SegmentHolder& other) const { return key() < other.key(); }
};

/// Shares out the segments of all ranks so that a rank with a larger number gets later ones. Each
/// rank gets about what it has read, so that none has more than there is room for.
class SegmentRanges {
 public:
  /// Collective.
  SegmentRanges(const Communicator& ranks, const DistributedFibers& read) {
    constexpr std::uint64_t last = std::numeric_limits<std::uint64_t>::max();
    GlobalSegment first{last, last};
    for (const FiberPart& part : read.names) {
      first = std::min(first, {part.fiber, part.first_segment});
    }
    firsts_ = ranks.gather_all(first);
    std::sort(firsts_.begin(), firsts_.end());
  }

  std::size_t rank_of(const GlobalSegment& segment) const {
    const auto next = std::upper_bound(firsts_.begin() + 1, firsts_.end(), segment);
    return static_cast<std::size_t>(next - firsts_.begin()) - 1;
  }

 private:
  std::vector<GlobalSegment> firsts_;  // by rank; those before the first one are of rank 0, too
};

/// Of the segments in this rank's range all who have them, sorted. Collective.
std::vector<SegmentHolder> holders_of(const Communicator& ranks, const DistributedFibers& read,
                                      double margin) {
  RankFibers fibers;
  fibers.update(ranks, read.parts, read.names);
  const SegmentRanges ranges(ranks, read);
  PerRank<SegmentHolder> to(static_cast<std::size_t>(ranks.size()));
  const auto add = [&](const std::vector<FiberRun>& runs, std::int32_t is_guest) {
    for (const FiberRun& run : runs) {
      for (std::uint64_t i = 0; i < run.count; ++i) {
        const GlobalSegment segment{run.first.fiber, run.first.segment + i};
        to[ranges.rank_of(segment)].push_back({segment, is_guest, ranks.rank()});
      }
    }
  };
  add(fibers.own().runs(), 0);
  const FiberStates own = fibers.states();
  add(Halo(ranks, own, spans_near_others(ranks, own, fibers.fit_boxes(), margin)).take().runs, 1);
  std::vector<SegmentHolder> holders;
  for (const std::vector<SegmentHolder>& some : ranks.exchange(std::move(to))) {
    holders.insert(holders.end(), some.begin(), some.end());
  }
  std::sort(holders.begin(), holders.end());
  return holders;
}

/// A line per segment; the owner comes first among those who have it.
void write_rows(TextOutput& output, const FiberNames& names,
                const std::vector<SegmentHolder>& holders) {
  std::string guests;
  for (auto owner = holders.begin(); owner != holders.end();) {
    guests.clear();
    auto next = owner + 1;
    for (; next != holders.end() && next->is_guest != 0; ++next) {
      guests += (guests.empty() ? "" : ";") + std::to_string(next->rank);
    }
    output.write_row(FiberCalled{names, owner->segment.fiber}, owner->segment.segment, owner->rank,
                     guests);
    owner = next;
  }
}

ExitCode write_regions(const RegionsRequest& request) {
  validate(request.query);
  require_format(FileFormat::CSV, "--out", request.out);
  const Communicator ranks(MPI_COMM_WORLD);
  require_other_file(ranks, request.file, request.out);
  FiberSource source(ranks, request.file, request.radius);
  RankText text(ranks, request.out);
  DistributedFibers fibers;
  source.read(0, fibers);
  const std::vector<SegmentHolder> holders = holders_of(ranks, fibers, request.query.margin);
  text.append([&](TextOutput& output) {
    if (ranks.rank() == 0) {
      output.write("fiber,segment,owner,in_halo_of\n");
    }
    write_rows(output, fibers.fiber_names, holders);
  });
  text.finish();
  return SUCCEEDED;
}

}  // namespace

void add_regions(CLI::App& app, Command& command) {
  const auto request = std::make_shared<RegionsRequest>();
  CLI::App* const subcommand = app.add_subcommand(
      "regions",
      "which rank owns each segment of the first frame, and which have it in their halo");
  subcommand->add_option("FILE", request->file, "fibre file (.h5, .csv or .hair)")->required();
  subcommand
      ->add_option("--margin", request->query.margin, "of the query that the halos are for [m]")
      ->capture_default_str();
  subcommand->add_option("--radius", request->radius, "of all fibres, if the file has no radii [m]")
      ->capture_default_str();
  subcommand->add_option("--out", request->out,
                         "CSV to write, with a line per segment, sorted; ranks with the segment in "
                         "their halo are separated by semicolons");
  subcommand->callback(
      [&command, request] { command = [request] { return write_regions(*request); }; });
}

}  // namespace fiber
