#include "src/tools/query_options.hpp"

#include <limits>

#include "src/io/number.hpp"

namespace fiber {

void add_fiber_options(CLI::App& app, FiberRequest& request, const std::string& file,
                       const std::string& threads) {
  app.add_option("FILE", request.file, file)->required();
  add_read_options(app, request.reading);
  add_threads_option(app, request.engine_options.threads, threads);
}

void add_read_options(CLI::App& app, ReadOptions& reading) {
  app.add_option("--radius", reading.default_radius, "of all fibres, if the file has no radii [m]")
      ->capture_default_str();
  app.add_flag("--skip-single-points", reading.skip_single_points,
               "leave out fibres of fewer than two points, and tell how many there were; without "
               "this such a file is refused");
}

std::string text_of(const ReadOptions& reading) {
  return "radius " + text_of(reading.default_radius) +
         (reading.skip_single_points ? ", single points skipped" : "");
}

void add_threads_option(CLI::App& app, std::uint32_t& threads, const std::string& help) {
  app.add_option("--threads", threads, help)->check(whole_number(0))->capture_default_str();
}

void add_kernel_option(CLI::App& app, Kernel& kernel) {
  app.add_option_function<std::string>(
         "--kernel", [&kernel](const std::string& name) { kernel = kernel_from_name(name); },
         "one of " + join(kernel_names()))
      ->default_str("robust");
}

void add_neighbour_options(CLI::App& app, std::optional<std::uint32_t>& skip,
                           std::optional<double>& skip_length) {
  app.add_option("--neighbour-skip", skip,
                 "segments of a fibre whose indices differ by at most this are no pair; without "
                 "this and the next option, those are that the fibre makes a loop between");
  app.add_option("--neighbour-skip-length", skip_length,
                 "segments of a fibre with less than this between them are no pair [m]; with one "
                 "of the two given, the other is 1 or 0 m, and no loop is needed");
}

const std::array<PairQuery, 4>& pair_queries() {
  constexpr double infinity = std::numeric_limits<double>::infinity();
  static const std::array<PairQuery, 4> queries{
      {{"contacts", "all pairs of segments within the margin", QueryType::ALL, 0.0},
       {"closest", "the closest pair", QueryType::CLOSEST, infinity},
       {"first", "any one pair within the margin", QueryType::FIRST, 0.0},
       {"fiber_pairs", "the closest pair of each pair of fibres, of a fibre with itself too",
        QueryType::FIBER_PAIRS, infinity}}};
  return queries;
}

void add_pair_options(CLI::App& app, const PairQuery& query, PairRequest& request) {
  app.add_option("--margin", request.margin,
                 "pairs with a gap of at most this [m]; inf for no limit")
      ->default_str(query.default_margin == 0.0 ? "0" : "inf");
  add_neighbour_options(app, request.options.neighbour_skip, request.options.neighbour_skip_length);
  add_kernel_option(app, request.options.kernel);
  app.add_option("--tolerance", request.options.tolerance,
                 "the closest pairs may be missed by less than this [m]")
      ->capture_default_str();
  app.add_option("--relative-tolerance", request.options.relative_tolerance,
                 "the closest pairs may be missed by less than this part of their distance")
      ->capture_default_str();
  app.add_option("--deadline", request.options.deadline,
                 "time to answer a frame [s]; what is found by then is the answer; 0 for none")
      ->capture_default_str();
}

QueryOptions options_of(const PairQuery& query, const PairRequest& request) {
  QueryOptions options = request.options;
  options.type = query.type;
  options.margin = request.margin.value_or(query.default_margin);
  validate(options);
  return options;
}

CLI::App* add_sweep_options(CLI::App& app, SweepRequest& request) {
  CLI::App* const sweep = app.add_subcommand(
      "sweep",
      "pairs of segments that come into contact from each frame to the next; fibres are the same "
      "that have the same names");
  sweep->add_option("--margin", request.motion.margin, "pairs with a gap of at most this [m]")
      ->capture_default_str();
  sweep
      ->add_option("--tolerance", request.motion.tolerance,
                   "pairs that come within the margin and this may be reported [m]")
      ->capture_default_str();
  sweep
      ->add_option("--time-tolerance", request.motion.time_tolerance,
                   "bounds on times that are further apart than this part of a step are brought "
                   "nearer; inf: as the tolerance makes them")
      ->capture_default_str();
  sweep
      ->add_option_function<std::string>(
          "--type",
          [&request](const std::string& type) {
            request.motion.type = type == "first" ? MotionType::FIRST : MotionType::ALL;
          },
          "all: each pair with the time of its first contact; first: the earliest pair")
      ->check(CLI::IsMember({"all", "first"}))
      ->default_str("all");
  sweep->add_flag("--new-only", request.new_only,
                  "without the pairs that are in contact in the frame already, at time 0");
  add_neighbour_options(*sweep, request.motion.neighbour_skip,
                        request.motion.neighbour_skip_length);
  return sweep;
}

}  // namespace fiber
