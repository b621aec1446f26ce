# The same contacts on a cluster: MPI for the ranks, Zoltan for the split. Left out where one of them is missing.

option(FIBER_PROXIMITY_BUILD_MPI "Build the library for clusters, where MPI and Zoltan are installed" ON)

if(NOT FIBER_PROXIMITY_BUILD_MPI)
  message(STATUS "Library for clusters: left out, FIBER_PROXIMITY_BUILD_MPI is off")
  return()
endif()
set(MPI_CXX_SKIP_MPICXX ON)  # the C++ bindings, which newer versions of MPI have no more
#catkin_lint: ignore_once missing_cmake_modules
find_package(MPI QUIET COMPONENTS CXX)
find_path(ZOLTAN_INCLUDE_FOLDER zoltan.h PATH_SUFFIXES trilinos)
find_library(ZOLTAN_LIBRARY NAMES trilinos_zoltan zoltan)
set(mpi_missing "")
if(NOT MPI_CXX_FOUND)
  list(APPEND mpi_missing "MPI (Debian's libopenmpi-dev)")
endif()
if(NOT ZOLTAN_INCLUDE_FOLDER OR NOT ZOLTAN_LIBRARY)
  list(APPEND mpi_missing "Zoltan (Debian's libtrilinos-zoltan-dev)")
endif()
if(mpi_missing)
  list(JOIN mpi_missing ", " mpi_missing)
  message(STATUS "Library for clusters: left out, missing: ${mpi_missing}; see scripts/setup.sh --mpi")
  return()
endif()
message(STATUS "Library for clusters: MPI ${MPI_CXX_VERSION}, ${ZOLTAN_LIBRARY}")

add_library(fiber_proximity_mpi SHARED
  src/mpi/box_tree.cpp
  src/mpi/closest_contacts.cpp
  src/mpi/communicator.cpp
  src/mpi/distributed_contacts.cpp
  src/mpi/distributed_engine.cpp
  src/mpi/distributed_options.cpp
  src/mpi/fiber_chains.cpp
  src/mpi/halo.cpp
  src/mpi/local_fibers.cpp
  src/mpi/loop_questions.cpp
  src/mpi/partition.cpp
  src/mpi/rank_fibers.cpp
  src/mpi/rank_search.cpp
)
target_include_directories(fiber_proximity_mpi SYSTEM PRIVATE ${ZOLTAN_INCLUDE_FOLDER})
target_link_libraries(fiber_proximity_mpi
  PUBLIC fiber_proximity MPI::MPI_CXX PRIVATE ${ZOLTAN_LIBRARY} fiber_proximity_options)
fiber_proximity_parse_once(fiber_proximity_mpi ${core_headers})
fiber_proximity_component(mpi fiber_proximity_mpi)
