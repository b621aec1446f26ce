#include "src/mpi/partition.hpp"

#include <zoltan.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <chrono>
#include <cstdio>
#include <memory>
#include <string>
#include <thread>
#include <utility>

namespace fiber {
namespace {

using Objects = std::vector<PartitionObject>;

const Objects& objects_of(void* data) { return *static_cast<const Objects*>(data); }

int count_of(void* data, int* error) {
  *error = ZOLTAN_OK;
  return static_cast<int>(objects_of(data).size());
}

void list_of(void* data, int /*global_entries*/, int /*local_entries*/, ZOLTAN_ID_PTR global_ids,
             ZOLTAN_ID_PTR local_ids, int /*weight_size*/, float* weights, int* error) {
  int rank = 0;
  MPI_Comm_rank(MPI_COMM_WORLD, &rank);
  const Objects& objects = objects_of(data);
  for (std::size_t i = 0; i < objects.size(); ++i) {
    global_ids[2 * i] = static_cast<ZOLTAN_ID_TYPE>(rank);
    global_ids[2 * i + 1] = static_cast<ZOLTAN_ID_TYPE>(i);
    local_ids[i] = static_cast<ZOLTAN_ID_TYPE>(i);
    weights[i] = objects[i].weight;
  }
  *error = ZOLTAN_OK;
}

int dimension_of(void* /*data*/, int* error) {
  *error = ZOLTAN_OK;
  return 3;
}

void centres_of(void* data, int /*global_entries*/, int /*local_entries*/, int count,
                ZOLTAN_ID_PTR /*global_ids*/, ZOLTAN_ID_PTR local_ids, int dimension,
                double* centres, int* error) {
  const Objects& objects = objects_of(data);
  for (int i = 0; i < count; ++i) {
    for (int axis = 0; axis < dimension; ++axis) {
      centres[i * dimension + axis] = objects[local_ids[i]].centre[static_cast<std::size_t>(axis)];
    }
  }
  *error = ZOLTAN_OK;
}

/// Zoltan stretches the box around all objects to a cube, and so parts of a flat box to slices. Two
/// objects without weight, at the ends of a cube, keep it from that.
Objects with_cube(const Communicator& ranks, const Objects& objects) {
  Eigen::AlignedBox3d box;
  for (const PartitionObject& object : objects) {
    box.extend(object.centre);
  }
  Eigen::Vector3d lower;
  double edge = 0.0;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    lower[axis] = ranks.min(box.min()[axis]);
    edge = std::max(edge, ranks.max(box.max()[axis]) - lower[axis]);
  }
  Objects all = objects;
  if (ranks.rank() == 0) {
    all.push_back({lower, 0x1p-10F});
    all.push_back({lower.array() + edge, 0x1p-10F});
  }
  return all;
}

struct DestroyZoltan {
  void operator()(Zoltan_Struct* zoltan) const { Zoltan_Destroy(&zoltan); }
};

/// How long a rank in which Zoltan has failed waits for the others to come out of it, too.
constexpr std::chrono::seconds patience{10};

/// "" if that is none.
std::string zoltan_error(int code) {
  switch (code) {
    case ZOLTAN_OK:
    case ZOLTAN_WARN:
      return "";
    case ZOLTAN_MEMERR:
      return "Zoltan cannot split the fibres: not enough memory";
    default:
      return "Zoltan cannot split the fibres: error " + std::to_string(code);
  }
}

/// Communicator::throw_on_all() after Zoltan. Its functions talk to other ranks, and one of them
/// leaves where it fails: others may wait for it in Zoltan for ever. The one that has failed then
/// ends all.
void throw_on_all_after_zoltan(const Communicator& ranks, const std::string& error) {
  const int has_failed = error.empty() ? 0 : 1;
  int one_has_failed = 0;
  MPI_Request all_came = MPI_REQUEST_NULL;
  MPI_Iallreduce(&has_failed, &one_has_failed, 1, MPI_INT, MPI_MAX, ranks.handle(), &all_came);
  if (has_failed != 0) {
    const auto end = std::chrono::steady_clock::now() + patience;
    int have_come = 0;
    while (MPI_Request_get_status(all_came, &have_come, MPI_STATUS_IGNORE), have_come == 0) {
      if (std::chrono::steady_clock::now() > end) {
        std::fprintf(stderr, "rank %d: %s; others wait for it there: all end\n", ranks.rank(),
                     error.c_str());
        MPI_Abort(ranks.handle(), 2);
      }
      std::this_thread::sleep_for(std::chrono::milliseconds(1));
    }
  }
  MPI_Wait(&all_came, MPI_STATUS_IGNORE);
  if (one_has_failed != 0) {
    ranks.throw_on_all(error);
  }
}

/// Zoltan's list of objects that change ranks, in memory of its own.
struct Moves {
  int count = 0;
  ZOLTAN_ID_PTR global_ids = nullptr;
  ZOLTAN_ID_PTR local_ids = nullptr;
  int* ranks = nullptr;
  int* parts = nullptr;

  Moves() = default;
  Moves(const Moves&) = delete;
  Moves& operator=(const Moves&) = delete;
  ~Moves() { Zoltan_LB_Free_Part(&global_ids, &local_ids, &ranks, &parts); }
};

}  // namespace

std::vector<int> partition(const Communicator& ranks, const std::vector<PartitionObject>& objects,
                           int parts) {
  if (parts == 1 || ranks.sum(objects.size()) == 0) {
    return std::vector<int>(objects.size(), 0);
  }
  float version = 0.0F;
  Zoltan_Initialize(0, nullptr, &version);
  const std::unique_ptr<Zoltan_Struct, DestroyZoltan> zoltan(Zoltan_Create(ranks.handle()));
  throw_on_all_after_zoltan(ranks, zoltan_error(zoltan ? ZOLTAN_OK : ZOLTAN_MEMERR));
  const std::string count = std::to_string(parts);
  for (const auto& [name, value] :
       {std::pair("DEBUG_LEVEL", "0"),  // first: it writes about the others
        std::pair("LB_METHOD", "HSFC"), std::pair("NUM_GID_ENTRIES", "2"),
        std::pair("NUM_LID_ENTRIES", "1"), std::pair("OBJ_WEIGHT_DIM", "1"),
        std::pair("NUM_GLOBAL_PARTS", count.c_str()), std::pair("RETURN_LISTS", "EXPORT")}) {
    Zoltan_Set_Param(zoltan.get(), name, value);
  }
  Objects all = with_cube(ranks, objects);
  Objects* const data = &all;
  Zoltan_Set_Num_Obj_Fn(zoltan.get(), count_of, data);
  Zoltan_Set_Obj_List_Fn(zoltan.get(), list_of, data);
  Zoltan_Set_Num_Geom_Fn(zoltan.get(), dimension_of, data);
  Zoltan_Set_Geom_Multi_Fn(zoltan.get(), centres_of, data);

  Moves imports;
  Moves exports;
  int changes = 0;
  int global_entries = 2;
  int local_entries = 1;
  const int error = Zoltan_LB_Partition(
      zoltan.get(), &changes, &global_entries, &local_entries, &imports.count, &imports.global_ids,
      &imports.local_ids, &imports.ranks, &imports.parts, &exports.count, &exports.global_ids,
      &exports.local_ids, &exports.ranks, &exports.parts);
  throw_on_all_after_zoltan(ranks, zoltan_error(error));
  // Objects that are not exported belong to the part of this rank's number.
  std::vector<int> part_of(objects.size(), ranks.rank());
  for (int i = 0; i < exports.count; ++i) {
    if (exports.local_ids[i] < part_of.size()) {
      part_of[exports.local_ids[i]] = exports.parts[i];
    }
  }
  return part_of;
}

}  // namespace fiber
