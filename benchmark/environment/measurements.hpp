#pragma once

#include <cstdint>

#include "benchmark/environment/cell_checker.hpp"
#include "benchmark/report.hpp"

namespace fiber {

/// Settings of the measurement of the environment; all counts are at least 1, points at least 2.
struct EnvironmentMeasurement {
  CellSize size;
  CellQuestions questions;
  bool beside_fcl = true;            ///< in the cell
  std::uint32_t pixels = 300'000;    ///< of the depth camera
  std::uint32_t candidates = 1'000;  ///< cables to check
  std::uint32_t repeats = 61;        ///< frames of the cell, repeats of the others
  std::uint64_t seed = 1;            ///< of the cloud and the candidates
};

/// The cell checked in every frame by this library and by FCL alone, in turns.
void measure_cell(const EnvironmentMeasurement& what, const ReportRow& report);

/// A cloud into octrees of 1 cm and of 2 cm, in turns.
void measure_octree(const EnvironmentMeasurement& what, const ReportRow& report);

/// Candidate cables against the cell's objects, any contact, on one thread and on several, in
/// turns.
void measure_batch(const EnvironmentMeasurement& what, const ReportRow& report);

/// Candidate cables that move by 5 cm against the cell's objects, their first contact on the way,
/// on one thread and on several, in turns.
void measure_motions(const EnvironmentMeasurement& what, const ReportRow& report);

}  // namespace fiber
