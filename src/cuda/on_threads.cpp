#include "src/cuda/on_threads.hpp"

#include "src/query/threads.hpp"

namespace fiber {

void on_threads(std::size_t count, const std::function<void(std::size_t)>& call) {
  for_each_of(count, call);
}

}  // namespace fiber
