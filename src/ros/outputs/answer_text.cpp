#include "src/ros/outputs/answer_text.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <cstdlib>

#include "src/text/join.hpp"

namespace fiber_proximity_ros {
namespace {

enum class Rounding { DOWN, NEAREST, UP };

/// Whether a number that was rounded to another one was rounded that way.
bool is_rounded(double value, double to, Rounding rounding) {
  return rounding == Rounding::NEAREST || (rounding == Rounding::DOWN ? to <= value : to >= value);
}

/// With two digits, for what is too small or too large for a ruler.
std::string scientific(double value, Rounding rounding) {
  const double step = (rounding == Rounding::UP ? 0.01 : -0.01) * std::abs(value);
  std::array<char, 32> text{};
  for (double shifted = value;; shifted += step) {
    std::snprintf(text.data(), text.size(), "%.1e", shifted);
    if (is_rounded(value, std::strtod(text.data(), nullptr), rounding)) {
      return text.data();
    }
  }
}

/// With three digits, and no more than three of them behind the point.
/// @param units in a metre
std::string decimal(double metres, double units, Rounding rounding) {
  const double in_units = std::abs(metres) * units;
  const int digits = in_units < 1.0 ? 3 : std::max(2 - static_cast<int>(std::log10(in_units)), 0);
  const double steps = std::pow(10.0, digits);  // in a unit
  double count = std::rint(metres * units * steps);
  // Powers of ten are exact, so that this is the number that the decimals are read as.
  const double as_read = count / (units * steps);
  if (!is_rounded(metres, as_read, rounding)) {
    count += rounding == Rounding::UP ? 1.0 : -1.0;
  }
  std::array<char, 32> text{};
  std::snprintf(text.data(), text.size(), "%.*f", digits, count / steps);
  return text.data();
}

/// A distance as people read it: in mm, from 1 m on in m.
std::string length_text(double metres, Rounding rounding = Rounding::NEAREST) {
  constexpr double shortest = 1e-5;
  constexpr double longest = 1e4;
  const double length = std::abs(metres);
  if (metres == 0.0) {
    return "0 mm";
  }
  if (length < shortest || length >= longest) {
    return scientific(metres, rounding) + " m";
  }
  return length < 1.0 ? decimal(metres, 1000.0, rounding) + " mm"
                      : decimal(metres, 1.0, rounding) + " m";
}

/// Why there may be more than is told; empty if there is not.
std::string reason_for_more(const PairsAnswer& answer) {
  std::string reason = answer.is_cut_off ? ", cut off" : "";
  return answer.was_all_there ? reason : reason + ", of what is known";
}

/// That there are no contacts, as far as it is known.
std::string no_contact_text(const PairsAnswer& answer) {
  const double margin = answer.asked.margin;
  const std::string more = reason_for_more(answer);
  const std::string within =
      margin > 0.0 && std::isfinite(margin) ? " within " + length_text(margin) : "";
  return "no contact" + within + (more.empty() ? "" : " found" + more);
}

/// By how much another pair of the same bodies may be closer than the one that is reported.
std::string tolerance_text(const fiber::QueryOptions& asked) {
  const bool is_relative = asked.relative_tolerance > 0.0;
  if (asked.tolerance <= 0.0 && !is_relative) {
    return "";
  }
  std::string text = ", each may be closer by " + length_text(asked.tolerance, Rounding::UP);
  if (is_relative) {
    text += " or the part " + scientific(asked.relative_tolerance, Rounding::UP);
  }
  return text;
}

/// How many contacts of inputs with an uncertainty are certain.
std::string certain_text(const PairsAnswer& answer) {
  return answer.uncertain == 0
             ? ""
             : ", " + std::to_string(answer.contacts - answer.uncertain) + " of them certain";
}

/// The contacts: how many, and whether that is all.
std::string contacts_text(const PairsAnswer& answer) {
  const bool is_of_fiber_pairs = answer.asked.type == fiber::QueryType::FIBER_PAIRS;
  const std::string count = std::to_string(answer.contacts);
  const std::string noun = std::string(answer.uncertain == 0 ? " " : " possible ") +
                           (is_of_fiber_pairs ? "pairs of bodies" : "contacts") +
                           certain_text(answer);
  const std::string error =
      answer.contacts == 0 ? ""
                           : " (each to " + length_text(answer.contact_error, Rounding::UP) + ")";
  const std::string more = reason_for_more(answer);
  if (!more.empty()) {
    return "at least " + count + noun + error + more;
  }
  if (answer.contacts == 0) {
    return no_contact_text(answer);
  }
  const std::string tolerance = is_of_fiber_pairs ? tolerance_text(answer.asked) : "";
  if (!answer.limit_reached) {
    return (answer.uncertain == 0 ? count + " of " + count : count) + noun + error + tolerance;
  }
  return "the closest " + count + noun + error + tolerance +
         ", any other >= " + length_text(answer.others_lower, Rounding::DOWN);
}

/// The closest pair: its distance, and what is proven of the true one.
std::string closest_text(const PairsAnswer& answer) {
  const double lower = answer.minimum_lower;
  if (!answer.minimum) {
    return lower == -HUGE_VAL  ? "closest unknown"
           : lower == HUGE_VAL ? "no pair"
                               : "closest true >= " + length_text(lower, Rounding::DOWN);
  }
  const double distance = *answer.minimum;
  const bool is_deep = distance < 0.0;
  const std::string name = is_deep ? "penetration " : "closest ";
  const std::string told = length_text(std::abs(distance));
  if (lower == -HUGE_VAL) {
    return name + "known " + told + (is_deep ? ", true may be deeper" : ", true may be closer");
  }
  constexpr double visible_part = 0.01;
  constexpr double visible = 1e-6;  // [m]
  const double small = std::max(visible_part * std::abs(distance), visible);
  const double error = std::max(distance - lower, answer.minimum_upper - distance);
  if (error <= small) {
    return name + told + " (to " + length_text(error, Rounding::UP) + ")";
  }
  if (answer.minimum_upper - distance > small) {
    return name + told + ", true " + length_text(lower, Rounding::DOWN) + " to " +
           length_text(answer.minimum_upper, Rounding::UP);
  }
  return name + told +
         (is_deep ? ", true <= " + length_text(-lower, Rounding::UP)
                  : ", true >= " + length_text(lower, Rounding::DOWN));
}

std::string pairs_text(const PairsAnswer& answer) {
  if (answer.has_failed) {
    return "no answer";
  }
  const bool is_found = answer.contacts > 0;
  switch (answer.asked.type) {
    case fiber::QueryType::FIRST:
      // Which pair it is nobody has asked, and the closest may be another one.
      return (!is_found               ? no_contact_text(answer)
              : answer.uncertain == 0 ? "in contact"
                                      : "perhaps in contact") +
             (answer.minimum ? ", " + closest_text(answer) : "");
    case fiber::QueryType::CLOSEST:
      return (is_found ? "" : no_contact_text(answer) + ", ") + closest_text(answer);
    case fiber::QueryType::LIMITED:
    case fiber::QueryType::ALL:
    case fiber::QueryType::FIBER_PAIRS:
      break;
  }
  return contacts_text(answer) + ", " + closest_text(answer);
}

/// The time of the whole answer and of those parts that took a good share of it or were cut off.
std::string time_text(const Answer& answer) {
  constexpr double good_share = 0.05;
  const auto in_ms = [](double seconds) {
    std::array<char, 32> text{};
    std::snprintf(text.data(), text.size(), "%.2f", 1e3 * seconds);
    return std::string(text.data());
  };
  std::vector<std::string> told;
  double others = answer.total_time;
  for (const AnswerPart& part : answer.parts) {
    if (!part.is_complete || part.seconds >= good_share * answer.total_time) {
      told.push_back(part.name + " " + in_ms(part.seconds) +
                     (part.is_complete ? "" : " (incomplete)"));
      others -= part.seconds;
    }
  }
  told.push_back("others " + in_ms(std::max(others, 0.0)));
  const bool has_deadline = answer.deadline > 0.0;
  const bool is_too_short = has_deadline && update_time(answer) > answer.deadline;
  return in_ms(answer.total_time) + (has_deadline ? " of " + in_ms(answer.deadline) : "") + " ms" +
         (answer.goes_on ? " so far: " : ": ") + fiber::join(told) +
         (is_too_short ? "; updates alone take longer" : "");
}

}  // namespace

double update_time(const Answer& answer) {
  double time = 0.0;
  for (const AnswerPart& part : answer.parts) {
    const bool is_update =
        part.name == "merge" || part.name == "update" || part.name == "environment_update";
    time += is_update ? part.seconds : 0.0;
  }
  return time;
}

std::string answer_text(const Answer& answer) {
  std::string text =
      std::string(name_of(answer.fibers.asked.kernel)) + ": " + pairs_text(answer.fibers) + "\n";
  if (answer.objects) {
    text += "objects: " + pairs_text(*answer.objects) + "\n";
  }
  return text + time_text(answer);
}

}  // namespace fiber_proximity_ros
