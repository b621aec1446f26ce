#pragma once

#include <cstdint>
#include <nlohmann/json.hpp>
#include <vector>

#include "benchmark/environment/cell_checker.hpp"

namespace fiber {

/// What to measure of the environment; all counts at least 1, points at least 2.
struct EnvironmentMeasurement {
  CellSize size;
  CellQuestions questions;
  std::uint32_t pixels = 300'000;    ///< of the depth camera
  std::uint32_t candidates = 1'000;  ///< cables to check
  std::uint32_t repeats = 61;        ///< frames of the cell, repeats of the others
  std::uint64_t seed = 1;            ///< of the cloud and the candidates
};

/// A line of results, names to values.
using BenchmarkRow = nlohmann::ordered_json;

/// The cell checked in every frame by this library and by FCL alone, in turns.
std::vector<BenchmarkRow> measure_cell(const EnvironmentMeasurement& what);

/// A cloud into octrees of 1 cm and of 2 cm, in turns.
std::vector<BenchmarkRow> measure_octree(const EnvironmentMeasurement& what);

/// Candidate cables against the cell's objects, any contact, on one thread and on several, in
/// turns.
std::vector<BenchmarkRow> measure_batch(const EnvironmentMeasurement& what);

/// The same of candidates that go 5 cm, for their first contact on the way.
std::vector<BenchmarkRow> measure_steps(const EnvironmentMeasurement& what);

}  // namespace fiber
