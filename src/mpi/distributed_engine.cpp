#include "fiber_proximity/mpi/distributed_engine.hpp"

#include <algorithm>
#include <exception>
#include <optional>
#include <stdexcept>
#include <string>
#include <utility>

#include "src/mpi/communicator.hpp"
#include "src/mpi/distributed_options.hpp"
#include "src/mpi/fiber_chains.hpp"
#include "src/mpi/fiber_runs.hpp"
#include "src/mpi/halo.hpp"
#include "src/mpi/local_fibers.hpp"
#include "src/mpi/loop_questions.hpp"
#include "src/mpi/partition.hpp"

namespace fiber {
namespace {

// What moves to a rank as a whole. Shorter pieces fit space better, and take more memory each.
constexpr std::uint32_t segments_per_piece = 16;

bool are_same(const std::vector<FiberPart>& x, const std::vector<FiberPart>& y) {
  return std::equal(x.begin(), x.end(), y.begin(), y.end(),
                    [](const FiberPart& a, const FiberPart& b) {
                      return a.fiber == b.fiber && a.first_segment == b.first_segment;
                    });
}

/// Cuts the parts of a rank into pieces.
FiberRuns pieces_of(const FiberAssembly& parts, const std::vector<FiberPart>& names,
                    const std::vector<double>& arcs) {
  FiberRuns pieces;
  const std::size_t most = parts.segment_count() / segments_per_piece + names.size();
  pieces.runs.reserve(most);
  pieces.nodes.reserve(parts.segment_count() + most);
  std::vector<FiberNode> nodes;
  for (std::size_t part = 0; part < names.size(); ++part) {
    const std::uint32_t begin = parts.offsets()[part];
    const std::uint32_t last = parts.offsets()[part + 1] - 1;
    for (std::uint32_t first = begin; first < last; first += segments_per_piece) {
      const std::uint32_t count = std::min(segments_per_piece, last - first);
      nodes.clear();
      for (std::uint32_t p = first; p <= first + count; ++p) {
        nodes.push_back(
            {plain(parts.points()[p]), arcs[p], p < first + count ? parts.segment_radius(p) : 0.0});
      }
      pieces.add({names[part].fiber, names[part].first_segment + (first - begin)}, nodes.data(),
                 count);
    }
  }
  return pieces;
}

std::vector<PartitionObject> objects_of(const FiberRuns& pieces) {
  std::vector<PartitionObject> objects;
  objects.reserve(pieces.runs.size());
  for (const FiberRun& run : pieces.runs) {
    objects.push_back(
        {pieces.nodes[run.begin + run.count / 2].point, static_cast<float>(run.count)});
  }
  return objects;
}

/// Most that sums along a fibre are rounded by, in units of ε [m].
double roundings_of(const FiberAssembly& parts, const std::vector<FiberPart>& names,
                    const std::vector<double>& arcs) {
  double most = 0.0;
  for (std::size_t part = 0; part < names.size(); ++part) {
    const std::uint32_t last = parts.offsets()[part + 1] - 1;
    const double count =
        static_cast<double>(names[part].first_segment + (last - parts.offsets()[part]));
    most = std::max(most, count * arcs[last]);
  }
  return most;
}

}  // namespace

struct DistributedEngine::State {
  State(MPI_Comm comm, const EngineOptions& options)
      : ranks(comm), engine(make_engine("run_tree", options)) {}

  Communicator ranks;
  std::unique_ptr<ProximityEngine> engine;

  // Of the parts that this rank brings:
  std::vector<FiberPart> names;
  std::vector<std::uint32_t> offsets;
  std::optional<FiberChains> chains;
  std::vector<int> destinations;  // of their pieces

  // What the split gave to it:
  FiberRuns own;
  double arc_roundings = 0.0;  // [m] of all fibres, in units of ε
  bool has_fibers = false;

  // What the engine has:
  LocalFibers local;
  std::uint64_t halo_segments = 0;
  std::optional<double> halo_margin;  // [m] none: to be found

  bool is_as_before(const FiberAssembly& parts, const std::vector<FiberPart>& new_names) const {
    return has_fibers && offsets == parts.offsets() && are_same(names, new_names);
  }
  void migrate(FiberRuns pieces, bool is_same);
  void fit_engine(double margin);
  QueryOptions local_options(const QueryOptions& options) const;
  bool is_left_out(const QueryOptions& options, const Contact& contact) const;
  void take(const QueryOptions& options, const QueryResult& found, DistributedResult& result) const;
};

/// Sends the pieces of all ranks to whom they belong; of the same pieces, only the nodes.
void DistributedEngine::State::migrate(FiberRuns pieces, bool is_same) {
  if (!is_same) {
    destinations = partition(ranks, objects_of(pieces));
  }
  std::vector<FiberRuns> to(static_cast<std::size_t>(ranks.size()));
  for (std::size_t i = 0; i < pieces.runs.size(); ++i) {
    const FiberRun& run = pieces.runs[i];
    to[static_cast<std::size_t>(destinations[i])].add(run.first, pieces.nodes.data() + run.begin,
                                                      run.count);
  }
  pieces = {};
  if (!is_same) {
    own = exchange_runs(ranks, std::move(to));
    return;
  }
  PerRank<FiberNode> nodes;
  for (FiberRuns& some : to) {
    nodes.push_back(std::move(some.nodes));
  }
  own.nodes = joined_nodes(ranks.exchange(nodes));
}

/// Gives the engine what pairs within the margin need.
void DistributedEngine::State::fit_engine(double margin) {
  if (halo_margin && *halo_margin >= margin) {
    return;
  }
  halo_margin.reset();
  const FiberRuns halo = find_halo(ranks, own, margin);
  halo_segments = halo.segment_count();
  std::string error;
  try {
    local.assign(own, halo);
    engine->update(local.fibers());
  } catch (const std::exception& failure) {
    error = failure.what();
  }
  ranks.agree(error);
  halo_margin = margin;
}

/// What leaves out no pair that the options want. Those that are too many are left out later.
QueryOptions DistributedEngine::State::local_options(const QueryOptions& options) const {
  QueryOptions here = options;
  if (options.pairing == Pairing::SAME_FIBER) {
    here.pairing = Pairing::ALL;  // stretches of one fibre may be several here
  }
  if (!options.needs_loops()) {
    here.neighbour_skip = options.neighbour_skip.value_or(1);
    // Sums along a stretch are rounded in another way than those along the whole fibre.
    const double surely =
        (1.0 - 0x1p-50) * options.neighbour_skip_length.value_or(0.0) - 0x1p-48 * arc_roundings;
    here.neighbour_skip_length = std::max(0.0, surely);
  }
  return here;
}

/// Whether segments that are a pair here are none along whole fibres.
bool DistributedEngine::State::is_left_out(const QueryOptions& options,
                                           const Contact& contact) const {
  const GlobalSegment a = local.name_of(contact.fiber_a, contact.segment_a);
  const GlobalSegment b = local.name_of(contact.fiber_b, contact.segment_b);
  if (a.fiber != b.fiber) {
    return options.pairing == Pairing::SAME_FIBER;
  }
  const std::uint32_t point_a = local.point_of(contact.fiber_a, contact.segment_a);
  const std::uint32_t point_b = local.point_of(contact.fiber_b, contact.segment_b);
  return options.pairing == Pairing::DIFFERENT_FIBERS ||
         b.segment - a.segment <= options.neighbour_skip.value_or(1) ||
         (options.neighbour_skip_length.value_or(0.0) > 0.0 &&
          local.arc(point_b) - local.arc(point_a + 1) < *options.neighbour_skip_length);
}

/// Of the contacts here those that this rank reports.
void DistributedEngine::State::take(const QueryOptions& options, const QueryResult& found,
                                    DistributedResult& result) const {
  std::vector<const Contact*> kept;
  std::vector<LoopQuestion> questions;
  std::vector<std::size_t> asked;  // places of theirs among those kept
  for (const Contact& contact : found.contacts) {
    const std::uint32_t point_a = local.point_of(contact.fiber_a, contact.segment_a);
    if (!local.is_own(point_a) || is_left_out(options, contact)) {
      continue;
    }
    const GlobalSegment a = local.name_of(contact.fiber_a, contact.segment_a);
    const GlobalSegment b = local.name_of(contact.fiber_b, contact.segment_b);
    // Where a stretch of the fibre holds both, the engine has seen the loop.
    if (options.needs_loops() && a.fiber == b.fiber && contact.fiber_a != contact.fiber_b) {
      const std::uint32_t point_b = local.point_of(contact.fiber_b, contact.segment_b);
      asked.push_back(kept.size());
      questions.push_back({a.fiber, a.segment, b.segment, local.fibers().capsule(point_a),
                           local.fibers().capsule(point_b)});
    }
    kept.push_back(&contact);
  }
  const std::vector<bool> loops = find_loops(ranks, own, questions);
  for (std::size_t i = 0; i < asked.size(); ++i) {
    if (!loops[i]) {
      kept[asked[i]] = nullptr;
    }
  }
  for (const Contact* const contact : kept) {
    if (contact != nullptr) {
      const GlobalSegment a = local.name_of(contact->fiber_a, contact->segment_a);
      const GlobalSegment b = local.name_of(contact->fiber_b, contact->segment_b);
      result.contacts.push_back({a.fiber, a.segment, b.fiber, b.segment, contact->s, contact->t,
                                 contact->distance, contact->lower, contact->upper,
                                 contact->point_a, contact->point_b, contact->normal});
    }
  }
}

DistributedEngine::DistributedEngine(MPI_Comm ranks, const EngineOptions& options)
    : state_(std::make_unique<State>(ranks, options)) {}

DistributedEngine::~DistributedEngine() = default;

void DistributedEngine::update(const FiberAssembly& parts, const std::vector<FiberPart>& names) {
  State& state = *state_;
  const Communicator& ranks = state.ranks;
  const bool is_same = ranks.all(state.is_as_before(parts, names));
  state.has_fibers = false;
  state.halo_margin.reset();
  ranks.agree(names.size() == parts.fiber_count()
                  ? ""
                  : std::to_string(names.size()) + " names for " +
                        std::to_string(parts.fiber_count()) + " parts, there must be one per part");
  if (!is_same) {
    state.chains.emplace(ranks, parts, names);
    state.names = names;
    state.offsets = parts.offsets();
  }
  const std::vector<double> arcs = state.chains->arc_lengths(ranks, parts, names);
  state.arc_roundings = ranks.largest(roundings_of(parts, names, arcs));
  state.migrate(pieces_of(parts, names, arcs), is_same);
  state.has_fibers = true;
}

void DistributedEngine::query(const QueryOptions& options, DistributedResult& result) {
  State& state = *state_;
  if (!state.has_fibers) {
    throw std::logic_error("the engine has no fibres yet: call update() first");
  }
  require_distributed_options(state.ranks, options);
  state.fit_engine(options.margin);
  QueryResult found;
  state.engine->query(state.local_options(options), found);
  result.contacts.clear();
  state.take(options, found, result);
  result.others_lower = state.ranks.smallest(found.others_lower);
}

DistributedFacts DistributedEngine::facts() const {
  return {state_->own.segment_count(), state_->halo_segments};
}

}  // namespace fiber
