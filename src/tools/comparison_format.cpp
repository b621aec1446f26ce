#include "src/tools/comparison_format.hpp"

#include <array>
#include <cmath>
#include <cstdio>
#include <nlohmann/json.hpp>

#include "src/io/number.hpp"

namespace fiber {
namespace {

constexpr Verdict verdicts[] = {Verdict::BOTH, Verdict::OURS, Verdict::FCL, Verdict::NEITHER};

/// [ms] with four digits: a time is not known any better.
std::string milliseconds(double seconds) {
  std::array<char, 32> text{};
  std::snprintf(text.data(), text.size(), "%.4g ms", 1e3 * seconds);
  return text.data();
}

std::string number(double value) {
  std::string text;
  append_number(text, value);
  return text;
}

std::string segment(const SegmentId& id) {
  return std::to_string(id.fiber) + "/" + std::to_string(id.segment);
}

std::string described(const std::optional<PairClaim>& claim) {
  return claim ? number(claim->gap) + " m" : "no contact";
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

std::string described(const Disagreement& pair) {
  return segment(pair.a) + " - " + segment(pair.b) + ": ours " + described(pair.ours) + ", FCL " +
         (pair.fcl_has_answer ? described(pair.fcl) : "no answer") + ", true gap " +
         number(pair.gap) + " m" + (pair.is_contact ? " (contact)" : " (no contact)") + ": " +
         described(pair.verdict);
}

nlohmann::ordered_json to_json(const std::optional<PairClaim>& claim) {
  if (!claim || !std::isfinite(claim->gap)) {
    return nullptr;
  }
  return claim->gap;
}

nlohmann::ordered_json to_json(const Disagreement& pair) {
  return {{"fiber_a", pair.a.fiber},
          {"segment_a", pair.a.segment},
          {"fiber_b", pair.b.fiber},
          {"segment_b", pair.b.segment},
          {"ours", to_json(pair.ours)},
          {"fcl", to_json(pair.fcl)},
          {"fcl_has_answer", pair.fcl_has_answer},
          {"gap", pair.gap},
          {"is_contact", pair.is_contact},
          {"verdict", name_of(pair.verdict)}};
}

nlohmann::ordered_json to_json(const StyleComparison& style) {
  nlohmann::ordered_json object = {
      {"style", name_of(style.style)},    {"update_time", style.update_time},
      {"detect_time", style.detect_time}, {"pair_tests", style.pair_tests},
      {"contacts", style.contacts},       {"only_ours", style.only_ours},
      {"only_fcl", style.only_fcl},       {"in_both", style.in_both},
      {"no_answer", style.no_answer},     {"largest_difference", style.largest_difference}};
  object["disagreements"] = nlohmann::ordered_json::array();
  for (const Disagreement& pair : style.disagreements) {
    object["disagreements"].push_back(to_json(pair));
  }
  return object;
}

void append_times(std::string& text, double update_time, double detect_time) {
  for (const double time : {update_time, detect_time}) {
    text += ',';
    append_number(text, time);
  }
}

void append_count(std::string& text, std::uint64_t count) { text += ',' + std::to_string(count); }

}  // namespace

std::string comparison_csv_header(bool has_frames) {
  std::string text = has_frames ? "frame," : "";
  text +=
      "method,update_time,detect_time,pair_tests,contacts,only_ours,only_fcl,in_both,no_answer,"
      "largest_difference";
  for (const Verdict verdict : verdicts) {
    text += std::string(",right_") + name_of(verdict);
  }
  return text + '\n';
}

void append_csv(std::string& text, const FrameComparison& frame) {
  const Comparison& comparison = frame.comparison;
  const std::string start = frame.frame ? std::to_string(*frame.frame) + "," : "";
  text += start + "ours";
  append_times(text, frame.update_time, comparison.detect_time);
  append_count(text, comparison.pair_tests);
  append_count(text, comparison.contacts);
  text += ",,,,,,,,,\n";
  for (const StyleComparison& style : comparison.styles) {
    text += start + "fcl_" + name_of(style.style);
    append_times(text, style.update_time, style.detect_time);
    for (const std::uint64_t count : {style.pair_tests, style.contacts, style.only_ours,
                                      style.only_fcl, style.in_both, style.no_answer}) {
      append_count(text, count);
    }
    text += ',' + number(style.largest_difference);
    for (const Verdict verdict : verdicts) {
      append_count(text, style.count(verdict));
    }
    text += '\n';
  }
}

void append_json(std::string& text, const FrameComparison& frame) {
  const Comparison& comparison = frame.comparison;
  nlohmann::ordered_json object;
  if (frame.frame) {
    object["frame"] = *frame.frame;
  }
  object["ours"] = {{"update_time", frame.update_time},
                    {"detect_time", comparison.detect_time},
                    {"pair_tests", comparison.pair_tests},
                    {"contacts", comparison.contacts}};
  object["fcl"] = nlohmann::ordered_json::array();
  for (const StyleComparison& style : comparison.styles) {
    object["fcl"].push_back(to_json(style));
  }
  object["ours_is_right"] = comparison.ours_is_right();
  text += object.dump() + '\n';
}

void append_text(std::string& text, const FrameComparison& frame) {
  const Comparison& comparison = frame.comparison;
  text += frame.frame ? "frame " + std::to_string(*frame.frame) + "\n" : "";
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
      text += "; distances differ by up to " + number(style.largest_difference) + " m (" +
              segment(style.largest_a) + " - " + segment(style.largest_b) + ")";
    }
    text += '\n';
    for (const Disagreement& pair : style.disagreements) {
      text += "    " + described(pair) + '\n';
    }
  }
}

}  // namespace fiber
