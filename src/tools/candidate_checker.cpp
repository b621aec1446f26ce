#include "src/tools/candidate_checker.hpp"

#include <algorithm>
#include <filesystem>
#include <stdexcept>
#include <utility>

#include "fiber_proximity/environment/scene/environment_scene.hpp"
#include "src/query/threads.hpp"
#include "src/text/csv_field.hpp"
#include "src/text/quote.hpp"
#include "src/tools/contact_rows.hpp"
#include "src/tools/query_options.hpp"

namespace fiber {

/// Holds what candidates are checked against.
class CheckContext {
 public:
  CheckContext(const CheckRequest& request, std::optional<FiberFrame> fibers)
      : fibers_(std::move(fibers)) {
    if (!request.environment.empty()) {
      read_environment(request.environment);
      surroundings_.environment = &*environment_;
    }
    if (fibers_) {
      EngineOptions options;
      options.threads = request.threads;
      engine_ = make_engine("run_tree", options);
      engine_->update(fibers_->fibers);
      surroundings_.fibers = engine_.get();
    }
    surroundings_.self = !request.without_self;
  }
  CheckContext(const CheckContext&) = delete;
  CheckContext& operator=(const CheckContext&) = delete;

  /// @param fiber_count at least as many as each candidate has, whose fibres have these names
  const Surroundings& surroundings(const FiberNames& names, std::size_t fiber_count) {
    if (fiber_count > fiber_count_ || names != names_) {
      names_ = names;
      fiber_count_ = fiber_count;
      surroundings_.allowed = resolve(allowed_, names.list(fiber_count));
    }
    return surroundings_;
  }

  std::string object_name(std::uint32_t object) const {
    return environment_->objects()[object].name;
  }

  /// The names of the fibres that there are.
  const FiberNames& fiber_names() const { return fibers_->names; }

 private:
  void read_environment(const std::string& path) {
    const MeshSource meshes = mesh_files(std::filesystem::path(path).parent_path());
    EnvironmentScene scene = read_environment_scene(load_yaml(path), meshes);
    std::vector<EnvironmentObject> objects;
    for (SceneObstacle& obstacle : scene.obstacles) {
      const std::string& frame = scene.obstacles.front().frame_id;
      if (obstacle.frame_id != frame) {
        throw std::invalid_argument(path + ": obstacle " + quote(obstacle.object.name) +
                                    " is in frame " + quote(obstacle.frame_id) +
                                    ", all must be in that of the fibres, as the first one, " +
                                    quote(frame));
      }
      objects.push_back(std::move(obstacle.object));
    }
    environment_.emplace(std::move(objects));
    allowed_ = std::move(scene.allowed);
  }

  std::optional<Environment> environment_;
  std::vector<NamedPair> allowed_;
  const std::optional<FiberFrame> fibers_;
  std::unique_ptr<ProximityEngine> engine_;  // refers to them

  // Which pairs are allowed depends on the names of the candidates that were asked about last:
  Surroundings surroundings_;
  FiberNames names_;
  std::size_t fiber_count_ = 0;
};

namespace {

/// The line of a candidate that has no contact.
std::string row_of_free(const FrameNumber& frame) {
  const std::string columns = check_header(false);
  const auto commas = static_cast<std::size_t>(std::count(columns.begin(), columns.end(), ','));
  return (frame.is_given ? std::to_string(frame.number) + ',' : "") + '1' +
         std::string(commas, ',') + '\n';
}

void write_check(TextOutput& output, const FrameNumber& frame, const FiberCheck& check,
                 const FiberNames& names, const CheckContext& context) {
  if (check.is_free()) {
    output.write(row_of_free(frame));
  }
  const std::string none;
  for (const Contact& contact : check.self.contacts) {
    write_csv_contact(output, contact, {names, names}, frame, false, std::string("candidate"),
                      none);
  }
  for (const Contact& contact : check.fibers.contacts) {
    write_csv_contact(output, contact, {names, context.fiber_names()}, frame, false,
                      std::string("fiber"), none);
  }
  const FiberNames numbers;
  for (const Contact& contact : check.environment.contacts) {
    std::string object;
    append_csv_field(object, context.object_name(contact.fiber_b));
    write_csv_contact(output, contact, {names, numbers}, frame, false, std::string("object"),
                      object);
  }
}

}  // namespace

std::string check_header(bool has_frames) {
  return (has_frames ? "frame," : "") + std::string("free,with,object,") + contact_columns;
}

CandidateChecker::CandidateChecker(const CheckRequest& request, std::optional<FiberFrame> fibers)
    : context_(std::make_unique<CheckContext>(request, std::move(fibers))),
      options_(request.query),
      arena_(arena_concurrency(request.threads)) {}

CandidateChecker::~CandidateChecker() = default;

void CandidateChecker::check(std::vector<FiberFrame> candidates, bool has_frames,
                             TextOutput& output) {
  for (auto begin = candidates.begin(); begin != candidates.end();) {
    const auto end = std::find_if(begin, candidates.end(), [&](const FiberFrame& frame) {
      return frame.names != begin->names;
    });
    check_alike(begin, end, has_frames, output);
    begin = end;
  }
}

/// Checks candidates whose fibres have the same names, which say what they may touch.
void CandidateChecker::check_alike(Frames begin, Frames end, bool has_frames, TextOutput& output) {
  candidates_.clear();
  std::size_t fiber_count = 0;
  for (auto frame = begin; frame != end; ++frame) {
    fiber_count = std::max(fiber_count, frame->fibers.fiber_count());
    candidates_.push_back(std::move(frame->fibers));
  }
  const Surroundings& surroundings = context_->surroundings(begin->names, fiber_count);
  arena_.execute([&] { check_fibers(candidates_, surroundings, options_, checks_); });
  for (const FiberCheck& check : checks_) {
    write_check(output, {has_frames, begin->frame}, check, begin->names, *context_);
    ++begin;
  }
}

void add_check_options(CLI::App& app, CheckRequest& request, const std::string& candidates,
                       const std::string& threads) {
  app.add_option("CANDIDATES", request.file, candidates)->required();
  app.add_option("--environment", request.environment, "file with what stands around them (.yaml)");
  app.add_option("--fibers", request.fibers,
                 "fibre file whose first frame holds the fibres that there are");
  app.add_flag("--without-self", request.without_self,
               "a candidate's contacts with itself do not count");
  app.add_option("--margin", request.query.margin,
                 "pairs with a gap of at most this are contacts [m]; inf for no limit")
      ->capture_default_str();
  app.add_option("--type", request.type,
                 "first: a candidate's check ends at its first contact, which is the fastest; "
                 "closest, all, fiber_pairs: of it with itself, with the fibres and with objects")
      ->check(CLI::IsMember({"first", "closest", "all", "fiber_pairs"}))
      ->capture_default_str();
  add_read_options(app, request.reading);
  add_threads_option(app, request.threads, threads);
  add_neighbour_options(app, request.query.neighbour_skip, request.query.neighbour_skip_length);
  add_kernel_option(app, request.query.kernel);
}

void finish_check_options(CheckRequest& request) {
  request.query.type = query_type_from_name(request.type);
  validate(request.query);
}

}  // namespace fiber
