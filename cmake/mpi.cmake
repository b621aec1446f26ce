# The same contacts on a cluster: MPI for the ranks, Zoltan for the split, parallel HDF5 for the files. Left out
# where one of them is missing.

option(FIBER_PROXIMITY_BUILD_MPI "Build the library for clusters, where MPI, Zoltan and parallel HDF5 are installed"
  ON)

if(NOT FIBER_PROXIMITY_BUILD_MPI)
  message(STATUS "Library for clusters: left out, FIBER_PROXIMITY_BUILD_MPI is off")
  return()
endif()
set(MPI_CXX_SKIP_MPICXX ON)  # the C++ bindings, which newer versions of MPI have no more
#catkin_lint: ignore_once missing_cmake_modules
find_package(MPI QUIET COMPONENTS CXX)
find_path(ZOLTAN_INCLUDE_FOLDER zoltan.h PATH_SUFFIXES trilinos)
find_library(ZOLTAN_LIBRARY NAMES trilinos_zoltan zoltan)
# Not by find_package: it asks the compiler wrapper that comes first, which may be that of a serial HDF5.
find_path(PARALLEL_HDF5_INCLUDE_FOLDER hdf5.h PATH_SUFFIXES hdf5/openmpi hdf5/mpich)
find_library(PARALLEL_HDF5_LIBRARY hdf5 PATH_SUFFIXES hdf5/openmpi hdf5/mpich)
set(hdf5_is_parallel "")
if(PARALLEL_HDF5_INCLUDE_FOLDER AND EXISTS ${PARALLEL_HDF5_INCLUDE_FOLDER}/H5pubconf.h)
  file(STRINGS ${PARALLEL_HDF5_INCLUDE_FOLDER}/H5pubconf.h hdf5_is_parallel
    REGEX "^#define H5_HAVE_PARALLEL 1" LIMIT_COUNT 1)
endif()
set(mpi_missing "")
if(NOT MPI_CXX_FOUND)
  list(APPEND mpi_missing "MPI (Debian's libopenmpi-dev)")
endif()
if(NOT ZOLTAN_INCLUDE_FOLDER OR NOT ZOLTAN_LIBRARY)
  list(APPEND mpi_missing "Zoltan (Debian's libtrilinos-zoltan-dev)")
endif()
if(NOT hdf5_is_parallel OR NOT PARALLEL_HDF5_LIBRARY)
  list(APPEND mpi_missing "parallel HDF5 (Debian's libhdf5-openmpi-dev)")
endif()
if(mpi_missing)
  list(JOIN mpi_missing ", " mpi_missing)
  message(STATUS "Library for clusters: left out, missing: ${mpi_missing}; see scripts/setup.sh --mpi")
  return()
endif()
message(STATUS "Library for clusters: MPI ${MPI_CXX_VERSION}, ${ZOLTAN_LIBRARY}, ${PARALLEL_HDF5_LIBRARY}")

add_library(fiber_proximity_mpi SHARED
  src/mpi/box_tree.cpp
  src/mpi/closest_of_fibers.cpp
  src/mpi/communicator.cpp
  src/mpi/contact_search.cpp
  src/mpi/contact_sort.cpp
  src/mpi/contact_writer.cpp
  src/mpi/distributed_engine.cpp
  src/mpi/distributed_options.cpp
  src/mpi/fiber_chains.cpp
  src/mpi/fiber_data.cpp
  src/mpi/fiber_name_data.cpp
  src/mpi/fiber_name_text.cpp
  src/mpi/fiber_pair_search.cpp
  src/mpi/fiber_reader.cpp
  src/mpi/fiber_writer.cpp
  src/mpi/frame_files.cpp
  src/mpi/gather_fibers.cpp
  src/mpi/global_joints.cpp
  src/mpi/halo_exchange.cpp
  src/mpi/hdf5_file.cpp
  src/mpi/joined_fibers.cpp
  src/mpi/kth_smallest.cpp
  src/mpi/load_balance.cpp
  src/mpi/local_fibers.cpp
  src/mpi/loop_questions.cpp
  src/mpi/motion_search.cpp
  src/mpi/ordered_pairs.cpp
  src/mpi/owned_fibers.cpp
  src/mpi/part_topology.cpp
  src/mpi/partial_file.cpp
  src/mpi/partition.cpp
  src/mpi/piece_boxes.cpp
  src/mpi/piece_routes.cpp
  src/mpi/select_contacts.cpp
  src/mpi/send_lists.cpp
  src/mpi/work_queue.cpp
)
target_include_directories(fiber_proximity_mpi SYSTEM PRIVATE
  ${ZOLTAN_INCLUDE_FOLDER} ${PARALLEL_HDF5_INCLUDE_FOLDER})
target_link_libraries(fiber_proximity_mpi
  PUBLIC fiber_proximity MPI::MPI_CXX PRIVATE ${ZOLTAN_LIBRARY} ${PARALLEL_HDF5_LIBRARY} fiber_proximity_options)
fiber_proximity_parse_once(fiber_proximity_mpi ${core_headers})
fiber_proximity_component(mpi fiber_proximity_mpi)
install(DIRECTORY include/fiber_proximity/mpi DESTINATION ${include_folder}/fiber_proximity
  FILES_MATCHING PATTERN "*.hpp")
