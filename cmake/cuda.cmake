# The engine of GPUs, cuda_tree: a library that all programs load, and a module with what runs on GPUs, which that library
# loads where it is installed. Without CUDA's compiler there is no module.

option(FIBER_PROXIMITY_BUILD_CUDA "Build the engine of GPUs, where CUDA's compiler is installed" ON)

set(cuda_missing "")
if(NOT FIBER_PROXIMITY_BUILD_CUDA)
  set(cuda_missing "FIBER_PROXIMITY_BUILD_CUDA is off")
elseif(FIBER_PROXIMITY_SANITIZE)
  set(cuda_missing "sanitizers do not see what a GPU does")
elseif(CMAKE_VERSION VERSION_LESS 3.18)
  set(cuda_missing "CMake is older than 3.18, which knows GPUs by their architecture")
else()
  include(CheckLanguage)
  check_language(CUDA)
  if(NOT CMAKE_CUDA_COMPILER)
    set(cuda_missing "CUDA's compiler, nvcc, is not found; see scripts/setup.sh --cuda")
  else()
    # Known before the language is enabled, which chooses architectures of its own.
    execute_process(COMMAND ${CMAKE_CUDA_COMPILER} --version OUTPUT_VARIABLE cuda_version)
    string(REGEX MATCH "release ([0-9.]+)" cuda_version "${cuda_version}")
    set(cuda_version "${CMAKE_MATCH_1}")
    if(cuda_version VERSION_LESS 11.4)
      set(cuda_missing "CUDA '${cuda_version}' of ${CMAKE_CUDA_COMPILER} is older than 11.4")
    endif()
  endif()
endif()

set(device_module_version ${PROJECT_VERSION_MAJOR}.${PROJECT_VERSION_MINOR})
add_library(fiber_proximity_cuda SHARED
  src/cuda/check_candidates.cpp
  src/cuda/cuda_engines.cpp
  src/cuda/cuda_tree_engine.cpp
  src/cuda/device_fibers.cpp
  src/cuda/device_module.cpp
  src/cuda/device_proximity.cpp
  src/cuda/host_device.cpp
  src/cuda/refuse_points.cpp
)
if(cuda_missing)
  message(STATUS "Engine of GPUs: left out, ${cuda_missing}")
else()
  # Machine code for what is common, and what newer ones compile when they start.
  if(NOT DEFINED CMAKE_CUDA_ARCHITECTURES)
    set(CMAKE_CUDA_ARCHITECTURES 75-real 80-real 86)
    if(cuda_version VERSION_GREATER_EQUAL 11.8)
      set(CMAKE_CUDA_ARCHITECTURES 75-real 80-real 86-real 89-real 90)
    endif()
  endif()
  enable_language(CUDA)
  message(STATUS "Engine of GPUs: CUDA ${CMAKE_CUDA_COMPILER_VERSION} for ${CMAKE_CUDA_ARCHITECTURES}")
  # Alone: the other compiler's options are not for it. Nothing is fused: the same bits as on the processor. Divisions
  # of single precision, which the filter alone has, may be off by two roundings: what they give is a parameter of a
  # point, and any serves.
  add_library(fiber_proximity_cuda_kernels OBJECT src/cuda/cuda_device.cu)
  set_target_properties(fiber_proximity_cuda_kernels PROPERTIES CUDA_STANDARD 17 CUDA_STANDARD_REQUIRED ON
    CUDA_VISIBILITY_PRESET hidden POSITION_INDEPENDENT_CODE ON)
  target_compile_options(fiber_proximity_cuda_kernels PRIVATE --fmad=false --prec-div=false --expt-relaxed-constexpr --threads=0
    -Xcompiler=-Wall,-Wextra $<$<BOOL:${FIBER_PROXIMITY_WERROR}>:--Werror=all-warnings>)
  add_library(fiber_proximity_cuda_device MODULE src/cuda/on_threads.cpp src/cuda/refuse_points.cpp)
  target_link_libraries(fiber_proximity_cuda_device
    PRIVATE fiber_proximity fiber_proximity_cuda_kernels fiber_proximity_options)
  # By version, as libraries: modules have no link for that.
  set_target_properties(fiber_proximity_cuda_device PROPERTIES SUFFIX .so.${device_module_version} INSTALL_RPATH "$ORIGIN"
    CXX_VISIBILITY_PRESET hidden VISIBILITY_INLINES_HIDDEN ON)
  add_dependencies(fiber_proximity_cuda fiber_proximity_cuda_device)
  install(TARGETS fiber_proximity_cuda_device LIBRARY DESTINATION ${library_folder})
endif()
target_link_libraries(fiber_proximity_cuda PUBLIC fiber_proximity PRIVATE fiber_proximity_options ${CMAKE_DL_LIBS})
target_compile_definitions(fiber_proximity_cuda PRIVATE
  FIBER_PROXIMITY_DEVICE_MODULE="libfiber_proximity_cuda_device.so.${device_module_version}")
# As of the paper's engines.
target_link_options(fiber_proximity_cuda PRIVATE LINKER:-z,nodelete)
set_target_properties(fiber_proximity_cuda PROPERTIES CXX_VISIBILITY_PRESET hidden VISIBILITY_INLINES_HIDDEN ON)
fiber_proximity_parse_once(fiber_proximity_cuda ${core_headers})
fiber_proximity_component(cuda fiber_proximity_cuda)
