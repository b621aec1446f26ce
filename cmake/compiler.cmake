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
set(kernel_definition "HWY_DISABLED_TARGETS=(HWY_SSSE3)")
if(FIBER_PROXIMITY_SANITIZE MATCHES thread)
  # Threads share the same data on each of them: the plain code, alone, takes a third of the time to compile.
  set(kernel_definition HWY_COMPILE_ONLY_STATIC)
elseif(FIBER_PROXIMITY_SANITIZE)
  # The plain code and one that is wider: all go through the same blocks, in other steps.
  set(kernel_definition "HWY_DISABLED_TARGETS=(HWY_SSSE3|HWY_SSE4|HWY_AVX3|HWY_AVX3_DL)")
endif()
target_compile_definitions(fiber_proximity_options INTERFACE ${kernel_definition})
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
    # A quarter of the rest goes into whether each object lies where its type may. Somebody else's bytes are taken for
    # objects by the Python module alone, which asks for it, and by what reads files and messages, which is fuzzed with it.
    target_compile_options(fiber_proximity_options INTERFACE
      $<$<NOT:$<BOOL:$<TARGET_PROPERTY:SANITIZE_ALIGNMENT>>>:-fno-sanitize=alignment>)
  endif()
  target_link_options(fiber_proximity_options INTERFACE -fsanitize=${FIBER_PROXIMITY_SANITIZE})
endif()
