// Cables of four ranks side by side: each rank brings its own, and gets contacts of its own with
// all. Start it with `mpirun -n 4 contacts_over_ranks`.
#include <mpi.h>

#include <cstdio>
#include <fiber_proximity/mpi/distributed_engine.hpp>

namespace {

void report_contacts() {
  int rank = 0;
  MPI_Comm_rank(MPI_COMM_WORLD, &rank);
  // A cable beside that of the next rank, 5 mm thick [m].
  const double x = 0.011 * rank;
  const fiber::FiberAssembly cable({{x, 0, 0}, {x, 1, 0}, {x, 2, 0}}, {0, 3}, {0.005});

  fiber::DistributedEngine engine(MPI_COMM_WORLD);
  engine.update(cable, {{static_cast<std::uint64_t>(rank), 0}});  // the whole fibre, of this number

  fiber::QueryOptions options;
  options.margin = 0.002;  // [m] pairs whose surfaces are at most this far apart
  fiber::DistributedResult result;
  engine.query(options, result);
  for (const fiber::DistributedContact& contact : gather(MPI_COMM_WORLD, result).contacts) {
    std::printf("fibre %llu segment %llu and fibre %llu segment %llu: %.4f m apart\n",
                static_cast<unsigned long long>(contact.fiber_a),
                static_cast<unsigned long long>(contact.segment_a),
                static_cast<unsigned long long>(contact.fiber_b),
                static_cast<unsigned long long>(contact.segment_b), contact.distance);
  }
}

}  // namespace

int main(int argc, char** argv) {
  int support = 0;
  MPI_Init_thread(&argc, &argv, MPI_THREAD_FUNNELED, &support);
  report_contacts();  // its engine ends before MPI does
  MPI_Finalize();
}
