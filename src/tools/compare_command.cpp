#include <array>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <iostream>
#include <memory>
#include <optional>
#include <string>

#include "fiber_proximity/compare/fcl_comparer.hpp"
#include "fiber_proximity/io/fiber_file.hpp"
#include "src/tools/fiber_query.hpp"
#include "src/tools/text_output.hpp"

namespace fiber {
namespace {

constexpr Verdict verdicts[] = {Verdict::BOTH, Verdict::OURS, Verdict::FCL, Verdict::NEITHER};

struct CompareRequest : FiberRequest {
  std::string engine = "run_tree";
  QueryOptions query;
  std::string format = "text";
};

/// One frame of a file, compared.
struct FrameComparison {
  FrameNumber frame;
  const FiberNames& names;
  double update_time = 0.0;  // [s] of our engine
  Comparison comparison;
};

/// [ms] with four digits: a time is not known any better.
std::string milliseconds(double seconds) {
  std::array<char, 32> text{};
  std::snprintf(text.data(), text.size(), "%.4g ms", 1e3 * seconds);
  return text.data();
}

std::string segment(const FiberNames& names, const SegmentId& id) {
  return names.of(id.fiber) + "/" + std::to_string(id.segment);
}

std::string described(const std::optional<PairClaim>& claim) {
  return claim ? text_of(claim->gap) + " m" : "no contact";
}

const char* described(Verdict verdict) {
  switch (verdict) {
    case Verdict::BOTH:
      return "within what both are rounded by";
    case Verdict::OURS:
      return "ours is right";
    case Verdict::FCL:
      return "FCL is right, ours is wrong";
    case Verdict::NEITHER:
      break;
  }
  return "both are wrong";
}

std::string described(const FiberNames& names, const Disagreement& pair) {
  return segment(names, pair.a) + " - " + segment(names, pair.b) + ": ours " +
         described(pair.ours) + ", FCL " +
         (pair.fcl_has_answer ? described(pair.fcl) : "no answer") + ", true gap " +
         text_of(pair.gap) + " m" + (pair.is_contact ? " (contact)" : " (no contact)") + ": " +
         described(pair.verdict);
}

nlohmann::ordered_json json_of(const std::optional<PairClaim>& claim) {
  if (!claim || !std::isfinite(claim->gap)) {
    return nullptr;
  }
  return claim->gap;
}

nlohmann::ordered_json json_of(const FiberNames& names, const Disagreement& pair) {
  return {{"fiber_a", json_of(FiberCalled{names, pair.a.fiber})},
          {"segment_a", pair.a.segment},
          {"fiber_b", json_of(FiberCalled{names, pair.b.fiber})},
          {"segment_b", pair.b.segment},
          {"ours", json_of(pair.ours)},
          {"fcl", json_of(pair.fcl)},
          {"fcl_has_answer", pair.fcl_has_answer},
          {"gap", pair.gap},
          {"is_contact", pair.is_contact},
          {"verdict", name_of(pair.verdict)}};
}

nlohmann::ordered_json json_of(const FiberNames& names, const StyleComparison& style) {
  nlohmann::ordered_json object = {
      {"style", name_of(style.style)},    {"update_time", style.update_time},
      {"detect_time", style.detect_time}, {"pair_tests", style.pair_tests},
      {"contacts", style.contacts},       {"only_ours", style.only_ours},
      {"only_fcl", style.only_fcl},       {"in_both", style.in_both},
      {"no_answer", style.no_answer},     {"largest_difference", style.largest_difference}};
  object["disagreements"] = nlohmann::ordered_json::array();
  for (const Disagreement& pair : style.disagreements) {
    object["disagreements"].push_back(json_of(names, pair));
  }
  return object;
}

std::string csv_columns() {
  std::string text =
      "method,update_time,detect_time,pair_tests,contacts,only_ours,only_fcl,in_both,no_answer,"
      "largest_difference";
  for (const Verdict verdict : verdicts) {
    text += std::string(",right_") + name_of(verdict);
  }
  return text + '\n';
}

/// A line for our engine and one for each style of FCL; disagreements are counted, not listed.
void write_csv(TextOutput& output, const FrameComparison& frame) {
  const Comparison& ours = frame.comparison;
  const std::string none;
  output.write_row(frame.frame, std::string("ours"), frame.update_time, ours.detect_time,
                   ours.pair_tests, ours.contacts, none, none, none, none, none, none, none, none,
                   none);
  for (const StyleComparison& style : ours.styles) {
    output.write_row(frame.frame, std::string("fcl_") + name_of(style.style), style.update_time,
                     style.detect_time, style.pair_tests, style.contacts, style.only_ours,
                     style.only_fcl, style.in_both, style.no_answer, style.largest_difference,
                     style.count(verdicts[0]), style.count(verdicts[1]), style.count(verdicts[2]),
                     style.count(verdicts[3]));
  }
}

/// A line with one JSON object.
void write_json(TextOutput& output, const FrameComparison& frame) {
  const Comparison& comparison = frame.comparison;
  nlohmann::ordered_json object = object_of(frame.frame);
  object["ours"] = {{"update_time", frame.update_time},
                    {"detect_time", comparison.detect_time},
                    {"pair_tests", comparison.pair_tests},
                    {"contacts", comparison.contacts}};
  object["fcl"] = nlohmann::ordered_json::array();
  for (const StyleComparison& style : comparison.styles) {
    object["fcl"].push_back(json_of(frame.names, style));
  }
  object["ours_is_right"] = comparison.ours_is_right();
  output.write_line(object);
}

/// Lines to read: one for our engine, one for each style and for each disagreement.
void write_text(TextOutput& output, const FrameComparison& frame) {
  const Comparison& comparison = frame.comparison;
  std::string text =
      frame.frame.is_given ? "frame " + std::to_string(frame.frame.number) + "\n" : "";
  text += "  ours: " + std::to_string(comparison.contacts) + " contacts, update " +
          milliseconds(frame.update_time) + ", detection " + milliseconds(comparison.detect_time) +
          "\n";
  for (const StyleComparison& style : comparison.styles) {
    text += std::string("  FCL, ") + name_of(style.style) +
            " style: " + std::to_string(style.contacts) + " contacts, update " +
            milliseconds(style.update_time) + ", detection " + milliseconds(style.detect_time) +
            "; only ours " + std::to_string(style.only_ours) + ", only FCL " +
            std::to_string(style.only_fcl) + ", in both " + std::to_string(style.in_both) +
            ", no answer " + std::to_string(style.no_answer);
    if (style.largest_difference > 0.0) {
      text += "; distances differ by up to " + text_of(style.largest_difference) + " m (" +
              segment(frame.names, style.largest_a) + " - " +
              segment(frame.names, style.largest_b) + ")";
    }
    text += '\n';
    for (const Disagreement& pair : style.disagreements) {
      text += "    " + described(frame.names, pair) + '\n';
    }
  }
  output.write(text);
}

/// Counts the disagreements of a file, for its last line.
class Totals {
 public:
  void add(const Comparison& comparison) {
    ++frames_;
    for (std::size_t i = 0; i < counts_.size(); ++i) {
      counts_[i] += comparison.count(static_cast<Verdict>(i));
    }
  }

  std::string text() const {
    const auto& [both, ours, fcl, neither] = counts_;
    return std::to_string(frames_) + (frames_ == 1 ? " frame, " : " frames, ") +
           std::to_string(both + ours + fcl + neither) + " disagreements: ours is right in " +
           std::to_string(ours) + ", FCL in " + std::to_string(fcl) + ", none in " +
           std::to_string(neither) + ", within what both are rounded by " + std::to_string(both) +
           '\n';
  }

  ExitCode exit_code() const {
    const auto& [both, ours, fcl, neither] = counts_;
    return fcl + neither == 0 ? SUCCEEDED : DISAGREED;
  }

 private:
  std::uint64_t frames_ = 0;
  std::array<std::uint64_t, 4> counts_{};  // by Verdict
};

ExitCode run(const CompareRequest& request) {
  const std::unique_ptr<ProximityEngine> engine =
      make_engine(request.engine, request.engine_options);
  const bool csv = request.format == "csv";
  const auto write = csv ? write_csv : request.format == "json" ? write_json : write_text;
  FclComparer comparer;
  Totals totals;
  write_frames(
      request.file, request.reading, csv ? csv_columns() : "",
      [&](const FrameNumber& number, const FiberFrame& frame, TextOutput& output) {
        const auto begin = std::chrono::steady_clock::now();
        engine->update(frame.fibers);
        const std::chrono::duration<double> update = std::chrono::steady_clock::now() - begin;
        const FrameComparison found{number, frame.names, update.count(),
                                    comparer.compare(frame.fibers, *engine, request.query)};
        totals.add(found.comparison);
        write(output, found);
      });
  if (request.format == "text") {
    std::cout << totals.text();
  }
  return totals.exit_code();
}

void add_options(CLI::App& app, CompareRequest& request) {
  add_fiber_options(app, request, file_help,
                    "most threads for the engine, 0 for as many as there are cores; FCL has one");
  add_engine_option(app, request.engine);
  app.add_option("--margin", request.query.margin, "pairs with a gap of at most this; finite [m]")
      ->check(finite_number(0.0))
      ->capture_default_str();
  add_neighbour_options(app, request.query.neighbour_skip, request.query.neighbour_skip_length);
  app.get_option("--neighbour-skip")->check(whole_number(0));
  app.get_option("--neighbour-skip-length")->check(finite_number(0.0));
  add_kernel_option(app, request.query.kernel);
  app.add_option("--format", request.format,
                 "of the output; csv: a line per frame and method, disagreements only counted; "
                 "json: one object per frame; times in seconds")
      ->check(CLI::IsMember({"csv", "json", "text"}))
      ->capture_default_str();
}

}  // namespace

void add_compare(CLI::App& app, Command& command) {
  CLI::App* compare = app.add_subcommand(
      "compare",
      "our contacts beside those of FCL, used as it mostly is and as well as can be: pairs, "
      "distances, times, and who is right by exact arithmetic where they differ; exit 1 if we are "
      "wrong anywhere");
  const auto request = std::make_shared<CompareRequest>();
  add_options(*compare, *request);
  compare->callback([&command, request] { command = [request] { return run(*request); }; });
}

}  // namespace fiber
