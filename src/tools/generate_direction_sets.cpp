// Makes src/paper/bounds/direction_table.inc, the direction sets of the k-DOPs.

#include <CLI/CLI.hpp>
#include <algorithm>
#include <atomic>
#include <cstdint>
#include <cstdio>
#include <exception>
#include <fstream>
#include <stdexcept>
#include <string>
#include <thread>
#include <vector>

#include "src/io/number.hpp"
#include "src/paper/bounds/direction_set.hpp"
#include "src/tools/direction_search.hpp"

namespace fiber {
namespace {

using Lines = std::vector<Eigen::Vector3d>;

constexpr int fewest_lines = 3;
constexpr int most_lines = 100;
constexpr double least_gain = 1e-9;  // [rad] what counts as a better set

struct Arguments {
  std::uint64_t seed = 1;
  int starts = 1000;
  int up_to = most_lines;
  bool from_scratch = false;
  unsigned threads = std::max(1U, std::thread::hardware_concurrency());
  std::string file;
};

/// All the sets by their number of lines; those below the fewest stay empty.
std::vector<Lines> current_sets(bool from_scratch) {
  std::vector<Lines> sets(most_lines + 1);
  for (int n = fewest_lines; n <= most_lines && !from_scratch; ++n) {
    sets[n] = grassmannian_directions(2 * n);
  }
  return sets;
}

/// Every number of lines has random numbers of its own, so the threads' order does not matter.
std::vector<Lines> search_all(const std::vector<Lines>& known, const Arguments& arguments) {
  std::vector<Lines> sets = known;
  std::atomic<int> next{arguments.up_to};
  const auto work = [&] {
    for (int n = next--; n >= fewest_lines; n = next--) {
      Random random(arguments.seed + 0x9E3779B97F4A7C15U * static_cast<std::uint64_t>(n));
      sets[n] = search_directions(n, known[n], arguments.starts, random);
      std::fprintf(stderr, "%d lines: %.6f degrees\n", n, in_degrees(smallest_angle(sets[n])));
    }
  };
  std::vector<std::thread> threads;
  for (unsigned i = 0; i < arguments.threads; ++i) {
    threads.emplace_back(work);
  }
  for (std::thread& thread : threads) {
    thread.join();
  }
  for (int n = most_lines - 1; n >= fewest_lines; --n) {
    sets[n] = better_of_fewer(sets[n], sets[n + 1]);
  }
  return sets;
}

/// Sets that are no better keep every bit, those that are get their place among the axes.
void arrange_new(std::vector<Lines>& sets, const std::vector<Lines>& known, std::uint64_t seed) {
  Random random(seed);
  for (int n = fewest_lines; n <= most_lines; ++n) {
    if (known[n].empty() || smallest_angle(sets[n]) > smallest_angle(known[n]) + least_gain) {
      sets[n] = arranged_directions(sets[n], random);
    } else {
      sets[n] = known[n];
    }
  }
}

constexpr const char* command_prefix = "//   generate_direction_sets ";

std::string command_line(const Arguments& arguments) {
  return command_prefix + ("--seed " + std::to_string(arguments.seed)) + " --starts " +
         std::to_string(arguments.starts) +
         (arguments.up_to < most_lines ? " --up-to " + std::to_string(arguments.up_to) : "") +
         (arguments.from_scratch ? " --from-scratch" : "") +
         " src/paper/bounds/direction_table.inc\n";
}

/// The commands that made the table this one improves on, as it states them.
std::string earlier_commands(const Arguments& arguments) {
  std::string commands;
  if (!arguments.from_scratch) {
    std::ifstream file(arguments.file);
    for (std::string line; std::getline(file, line);) {
      if (line.rfind(command_prefix, 0) == 0) {
        commands += line + '\n';
      }
    }
  }
  return commands;
}

std::string table_text(const std::vector<Lines>& sets, const Arguments& arguments) {
  std::string text =
      "// Packings of N = 3 ... 100 lines through the origin of R^3, a unit vector for every "
      "line,\n"
      "// one set after another. Generated, do not edit; made by, one after the other:\n" +
      earlier_commands(arguments) + command_line(arguments);
  for (int n = fewest_lines; n <= most_lines; ++n) {
    char heading[80];
    std::snprintf(heading, sizeof(heading), "// N = %d: %.6f degrees\n", n,
                  in_degrees(smallest_angle(sets[n])));
    text += heading;
    for (const Eigen::Vector3d& line : sets[n]) {
      text += '{';
      for (int axis = 0; axis < 3; ++axis) {
        append_number(text, line[axis]);
        text += axis < 2 ? ", " : "},\n";
      }
    }
  }
  return text;
}

void generate(const Arguments& arguments) {
  const std::vector<Lines> known = current_sets(arguments.from_scratch);
  std::vector<Lines> sets = search_all(known, arguments);
  arrange_new(sets, known, arguments.seed);
  const std::string text = table_text(sets, arguments);
  std::ofstream file(arguments.file);
  file << text << std::flush;
  if (!file) {
    throw std::runtime_error(arguments.file + ": cannot be written");
  }
}

int run(int argc, char** argv) {
  Arguments arguments;
  CLI::App app(
      "Packs 3 to 100 lines through the origin of R^3 so that the smallest angle between "
      "two is as large as possible, and writes the table of the k-DOPs' directions. "
      "Starts from the sets it was built with and keeps the better ones.");
  app.add_option("FILE", arguments.file, "table to write, src/paper/bounds/direction_table.inc")
      ->required();
  app.add_option("--seed", arguments.seed, "of the random starts")->capture_default_str();
  app.add_option("--starts", arguments.starts, "for each number of lines")
      ->check(CLI::Range(1, 1000000000))
      ->capture_default_str();
  CLI::Option* up_to = app.add_option("--up-to", arguments.up_to, "search no sets of more lines")
                           ->check(CLI::Range(fewest_lines, most_lines))
                           ->capture_default_str();
  app.add_flag("--from-scratch", arguments.from_scratch, "forget the sets it was built with")
      ->excludes(up_to);
  app.add_option("--threads", arguments.threads, "they do not change the result")
      ->check(CLI::Range(1, 1024))
      ->capture_default_str();
  CLI11_PARSE(app, argc, argv);
  generate(arguments);
  return 0;
}

}  // namespace
}  // namespace fiber

int main(int argc, char** argv) {
  try {
    return fiber::run(argc, argv);
  } catch (const std::exception& error) {
    std::fprintf(stderr, "generate_direction_sets: %s\n", error.what());
    return 2;
  }
}
