#pragma once

#include <memory>

#include "benchmark/peers/peer.hpp"
#include "fiber_proximity/query/engine.hpp"

namespace fiber {

/// Makes a peer; null where this build is without it.
using PeerMaker = std::unique_ptr<ProximityEngine> (*)(const BenchEngineOptions& options);

#ifdef FIBER_BENCH_HAS_BULLET
std::unique_ptr<ProximityEngine> make_bullet(const BenchEngineOptions& options);
#else
constexpr PeerMaker make_bullet = nullptr;
#endif

#ifdef FIBER_BENCH_HAS_CGAL
std::unique_ptr<ProximityEngine> make_cgal(const BenchEngineOptions& options);
#else
constexpr PeerMaker make_cgal = nullptr;
#endif

#ifdef FIBER_BENCH_HAS_EMBREE
std::unique_ptr<ProximityEngine> make_embree_low(const BenchEngineOptions& options);
std::unique_ptr<ProximityEngine> make_embree_medium(const BenchEngineOptions& options);
std::unique_ptr<ProximityEngine> make_embree_refit(const BenchEngineOptions& options);
#else
constexpr PeerMaker make_embree_low = nullptr;
constexpr PeerMaker make_embree_medium = nullptr;
constexpr PeerMaker make_embree_refit = nullptr;
#endif

#ifdef FIBER_BENCH_HAS_FCL
std::unique_ptr<ProximityEngine> make_fcl(const BenchEngineOptions& options);
std::unique_ptr<ProximityEngine> make_fcl_naive(const BenchEngineOptions& options);
#else
constexpr PeerMaker make_fcl = nullptr;
constexpr PeerMaker make_fcl_naive = nullptr;
#endif

}  // namespace fiber
