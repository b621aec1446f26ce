# Compiler settings shared by every target.

if(NOT CMAKE_BUILD_TYPE AND NOT CMAKE_CONFIGURATION_TYPES)
  set(CMAKE_BUILD_TYPE Release CACHE STRING "Build type" FORCE)
endif()
set(CMAKE_CXX_STANDARD 17)
set(CMAKE_CXX_STANDARD_REQUIRED ON)
set(CMAKE_CXX_EXTENSIONS OFF)
set(CMAKE_EXPORT_COMPILE_COMMANDS ON)

option(FIBER_PROXIMITY_WERROR "Treat warnings as errors (CI does)" OFF)
set(FIBER_PROXIMITY_SANITIZE "" CACHE STRING "Sanitizers to build with, e.g. address,undefined")

# One interface target carries the flags, so that they reach our targets and nobody else's. Without
# contraction the same source gives the same bits with and without fused multiply-add.
add_library(fiber_proximity_options INTERFACE)
# Kernels are compiled for each instruction set: processors without SSE4 (before 2008) take the plain code.
set(left_out_targets HWY_SSSE3)
if(FIBER_PROXIMITY_SANITIZE)
  # As many lanes as the plain code has; a kernel takes sanitizers four times as long to compile.
  set(left_out_targets HWY_SSSE3|HWY_SSE4)
endif()
target_compile_definitions(fiber_proximity_options INTERFACE "HWY_DISABLED_TARGETS=(${left_out_targets})")
# gtest's macros for typed suites leave out their last argument, which clang 13 calls a GNU extension.
target_compile_options(fiber_proximity_options INTERFACE
  -Wall -Wextra -Wpedantic -Wshadow -Wnon-virtual-dtor -Wconversion -Wno-sign-conversion
  $<$<CXX_COMPILER_ID:Clang>:-Wno-gnu-zero-variadic-macro-arguments>
  -ffp-contract=off $<$<BOOL:${FIBER_PROXIMITY_WERROR}>:-Werror>)
if(FIBER_PROXIMITY_SANITIZE)
  target_compile_options(fiber_proximity_options INTERFACE
    -fsanitize=${FIBER_PROXIMITY_SANITIZE} -fno-sanitize-recover=all -fno-omit-frame-pointer)
  if(FIBER_PROXIMITY_SANITIZE MATCHES undefined)
    # AddressSanitizer sees what these see, and they take a third of the time to compile and to run.
    target_compile_options(fiber_proximity_options INTERFACE
      -fno-sanitize=null,object-size,vptr,pointer-overflow)
  endif()
  target_link_options(fiber_proximity_options INTERFACE -fsanitize=${FIBER_PROXIMITY_SANITIZE})
endif()
