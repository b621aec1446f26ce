#pragma once

#include <tbb/task_arena.h>

#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "fiber_proximity/environment/check_fibers.hpp"
#include "fiber_proximity/io/fiber_file.hpp"
#include "src/tools/command_line.hpp"
#include "src/tools/text_output.hpp"

namespace fiber {

/// The options of `check`, with ranks and without.
struct CheckRequest {
  std::string file;  // of candidates, each frame one
  ReadOptions reading;
  std::string environment;  // a YAML file, "" for none
  std::string fibers;       // a file with the fibres that there are, "" for none
  std::string type = "first";
  QueryOptions query;
  bool without_self = false;
  std::uint32_t threads = 0;
};

/// @param candidates help for their file
/// @param threads    help for the number of threads
void add_check_options(CLI::App& app, CheckRequest& request, const std::string& candidates,
                       const std::string& threads);

/// Completes the request once all options are read.
/// @throws std::invalid_argument for options that do not validate
void finish_check_options(CheckRequest& request);

/// So many candidates are checked together, which takes some milliseconds.
constexpr std::uint64_t candidates_at_once = 256;

/// The line with the columns of CandidateChecker::check().
std::string check_header(bool has_frames);

class CheckContext;

/// Checks candidates, and writes what they touch.
class CandidateChecker {
 public:
  /// @param fibers the first frame of request.fibers; nothing where that is ""
  /// @throws std::invalid_argument for an environment that is not valid, naming its file
  CandidateChecker(const CheckRequest& request, std::optional<FiberFrame> fibers);
  ~CandidateChecker();
  CandidateChecker(const CandidateChecker&) = delete;
  CandidateChecker& operator=(const CandidateChecker&) = delete;

  /// Writes a line of CSV for each contact of a candidate, or one without a contact if it is free:
  /// whether it is, what it touches (itself, `candidate`; a `fiber` or an `object`), the object's
  /// name, and the contact.
  void check(std::vector<FiberFrame> candidates, bool has_frames, TextOutput& output);

 private:
  using Frames = std::vector<FiberFrame>::iterator;

  void check_alike(Frames begin, Frames end, bool has_frames, TextOutput& output);

  const std::unique_ptr<CheckContext> context_;
  const QueryOptions options_;
  tbb::task_arena arena_;
  std::vector<FiberAssembly> candidates_;
  std::vector<FiberCheck> checks_;
};

}  // namespace fiber
