#include <tbb/task_arena.h>

#include <limits>
#include <map>
#include <string>

#include "benchmark/environment/cell_checker.hpp"
#include "src/query/run_tree_engine.hpp"
#include "src/query/threads.hpp"

namespace fiber {
namespace {

class OwnChecker final : public CellChecker {
 public:
  OwnChecker(const std::vector<EnvironmentObject>& objects, const FiberAssembly& cables,
             const CellQuestions& questions)
      : cables_(cables),
        engine_({questions.threads, std::nullopt}),
        arena_(arena_concurrency(questions.threads)) {
    std::vector<ObjectChange> changes;
    for (const EnvironmentObject& object : objects) {
      changes.push_back({ObjectChange::Operation::ADD, object});
    }
    world_.apply(changes);
    all_.margin = questions.margin;
    closest_.type = QueryType::CLOSEST;
    closest_.margin = std::numeric_limits<double>::infinity();
    for (std::uint32_t i = 0; i < objects.size(); ++i) {
      places_.emplace(objects[i].name, i);
    }
  }

  void move_objects(const std::vector<ObjectChange>& moves) override {
    world_.apply(moves);
    environment_ = world_.environment();
  }
  void move_cables(const FiberAssembly& cables) override { engine_.update(cables); }
  void find_self_contacts() override { engine_.query(all_, self_contacts_); }
  void find_contacts() override { ask(all_, contacts_); }
  void find_nearest() override { ask(closest_, nearest_); }

  CellAnswer answer() const override {
    CellAnswer answer;
    const std::vector<std::uint32_t>& first = cables_.offsets();
    for (const Contact& contact : self_contacts_.contacts) {
      answer.self_contacts.push_back({first[contact.fiber_a] + contact.segment_a,
                                      first[contact.fiber_b] + contact.segment_b,
                                      contact.distance});
    }
    // The world has its objects by name, the cell in an order of its own.
    for (const Contact& contact : contacts_.contacts) {
      const std::string& name = environment_->objects()[contact.fiber_b].name;
      answer.contacts.push_back(
          {first[contact.fiber_a] + contact.segment_a, places_.at(name), contact.distance});
    }
    sort_pairs(answer.contacts);
    const Contact* nearest = nearest_.closest();
    answer.nearest =
        nearest == nullptr ? std::numeric_limits<double>::infinity() : nearest->distance;
    return answer;
  }

 private:
  void ask(const QueryOptions& options, QueryResult& result) {
    arena_.execute([&] { environment_->query(cables_, options, {}, result); });
  }

  const FiberAssembly& cables_;
  std::map<std::string, std::uint32_t> places_;  // in the cell's order
  World world_;
  std::shared_ptr<const Environment> environment_;
  RunTreeEngine engine_;
  tbb::task_arena arena_;
  QueryOptions all_;
  QueryOptions closest_;
  QueryResult self_contacts_;
  QueryResult contacts_;
  QueryResult nearest_;
};

}  // namespace

std::unique_ptr<CellChecker> make_own_checker(const std::vector<EnvironmentObject>& objects,
                                              const FiberAssembly& cables,
                                              const CellQuestions& questions) {
  return std::make_unique<OwnChecker>(objects, cables, questions);
}

}  // namespace fiber
