#pragma once

#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "benchmark/environment/cell.hpp"

namespace fiber {

/// The questions of every frame.
struct CellQuestions {
  double margin = 0.005;      ///< [m] of contacts
  std::uint32_t threads = 1;  ///< most to use
};

/// Two things and how far apart their surfaces are.
struct FoundPair {
  std::uint32_t a = 0;    ///< first point of a segment
  std::uint32_t b = 0;    ///< first point of another, a < b, or index of an object
  double distance = 0.0;  ///< [m]
};

void sort_pairs(std::vector<FoundPair>& pairs);  ///< by a and b

/// All that was found in a frame; pairs sorted by a and b.
struct CellAnswer {
  std::vector<FoundPair> self_contacts;
  std::vector<FoundPair> contacts;  ///< with the objects
  double nearest = 0.0;             ///< [m] least distance from the objects
};

/// A way to check a cell. Everything is asked once per frame, in the order of the functions, which
/// are timed one by one.
class CellChecker {
 public:
  virtual ~CellChecker() = default;

  virtual void move_objects(const std::vector<ObjectChange>& moves) = 0;
  virtual void move_cables(const FiberAssembly& cables) = 0;
  virtual void find_self_contacts() = 0;
  virtual void find_contacts() = 0;
  virtual void find_nearest() = 0;

  /// Returns all that was found. This is not timed.
  virtual CellAnswer answer() const = 0;

  /// How often it has given up on a pair so far.
  virtual std::uint64_t exception_count() const { return 0; }
};

/// This library: World, Environment and run_tree.
/// @param cables they must live as long as the checker
std::unique_ptr<CellChecker> make_own_checker(const std::vector<EnvironmentObject>& objects,
                                              const FiberAssembly& cables,
                                              const CellQuestions& questions);

/// FCL alone, as its users write it: a capsule per segment, rotated and moved into place, meshes as
/// trees of OBBRSS, dynamic AABB trees for the segments and for the objects. FCL has no margin:
/// the broad phase has capsules that are thicker by the margin, and pairs whose boxes overlap are
/// asked for their distance. One thread.
std::unique_ptr<CellChecker> make_fcl_checker(const std::vector<EnvironmentObject>& objects,
                                              const FiberAssembly& cables,
                                              const CellQuestions& questions);

}  // namespace fiber
