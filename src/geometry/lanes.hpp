#pragma once

// Code for lanes of numbers, written with Highway's functions, is compiled once per instruction
// set; or, where FIBER_ONE_LANE is defined before it is included, for one lane that is a plain
// number, by any compiler: that of CUDA, too. One source, the same operations in the same order:
// the same bits.
//
// FIBER_LANES_BEGIN and FIBER_LANES_END open and close the namespace it stands in.

#ifdef FIBER_ONE_LANE

#include "src/geometry/one_lane.hpp"

#define FIBER_LANES_BEGIN \
  namespace fiber {       \
  namespace one_lane {
#define FIBER_LANES_END \
  }                     \
  }
#define FIBER_LANE_INLINE FIBER_ON_DEVICE inline
#define FIBER_LANE_MEMBER FIBER_ON_DEVICE

#else

#include <hwy/highway.h>

#define FIBER_LANES_BEGIN   \
  HWY_BEFORE_NAMESPACE();   \
  namespace fiber {         \
  namespace HWY_NAMESPACE { \
  namespace hn = hwy::HWY_NAMESPACE;
#define FIBER_LANES_END \
  }                     \
  }                     \
  HWY_AFTER_NAMESPACE();
#define FIBER_LANE_INLINE HWY_INLINE
#define FIBER_LANE_MEMBER

#endif
