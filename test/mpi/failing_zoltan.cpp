// Loaded before Zoltan: it fails on rank 1 alone. With FAULT=early it does so before it
// has talked to the others, who wait for it, else when they are through.
#include <dlfcn.h>
#include <mpi.h>
#include <zoltan.h>

#include <cstdlib>
#include <string>

extern "C" int Zoltan_LB_Partition(
    Zoltan_Struct* zoltan, int* changes, int* global_entries, int* local_entries, int* import_count,
    ZOLTAN_ID_PTR* import_global_ids, ZOLTAN_ID_PTR* import_local_ids, int** import_ranks,
    int** import_parts, int* export_count, ZOLTAN_ID_PTR* export_global_ids,
    ZOLTAN_ID_PTR* export_local_ids, int** export_ranks, int** export_parts) {
  int rank = 0;
  MPI_Comm_rank(MPI_COMM_WORLD, &rank);
  const char* const when = std::getenv("FAULT");
  if (rank == 1 && when != nullptr && when == std::string("early")) {
    return ZOLTAN_MEMERR;
  }
  auto* const real =
      reinterpret_cast<decltype(&Zoltan_LB_Partition)>(dlsym(RTLD_NEXT, "Zoltan_LB_Partition"));
  const int code =
      real(zoltan, changes, global_entries, local_entries, import_count, import_global_ids,
           import_local_ids, import_ranks, import_parts, export_count, export_global_ids,
           export_local_ids, export_ranks, export_parts);
  return rank == 1 ? ZOLTAN_FATAL : code;
}
