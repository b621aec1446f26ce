// Has an engine of the paper, as a program outside of the package would.
#include <exception>
#include <fiber_proximity/geometry/fiber_assembly.hpp>
#include <fiber_proximity/paper/paper_engines.hpp>
#include <fiber_proximity/query/engine.hpp>
#include <iostream>
#include <memory>

int main() {
  try {
    fiber::register_paper_engines();
    const fiber::FiberAssembly fibers({{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {1, 1, 0}}, {0, 2, 4},
                                      {0.25});
    const std::unique_ptr<fiber::ProximityEngine> engine = fiber::make_engine("AL");
    engine->update(fibers);
    fiber::QueryOptions options;
    options.type = fiber::QueryType::CLOSEST;
    options.margin = 1.0;
    fiber::QueryResult result;
    engine->query(options, result);
    std::cout << "AL: " << result.contacts.size() << " contact, " << result.closest()->distance
              << " m\n";
    return 0;
  } catch (const std::exception& error) {
    std::cerr << error.what() << '\n';
    return 1;
  }
}
