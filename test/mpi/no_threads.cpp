// Loaded before MPI: as if it had been started without thread support.
#include <mpi.h>

extern "C" int MPI_Query_thread(int* provided) {
  *provided = MPI_THREAD_SINGLE;
  return MPI_SUCCESS;
}
