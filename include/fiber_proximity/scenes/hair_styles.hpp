#pragma once

#include "fiber_proximity/scenes/hair.hpp"

namespace fiber {

// The paper's hair (Fig. 1), with its numbers of hairs and segments, its density and its diameter.
// Shape, length and locks are our own: the paper shows a picture of each and says no more.

extern const HairStyle tress_a;   ///< 2 500 × 98: a wavy strand
extern const HairStyle tress_b;   ///< 500 × 2 000: long curls
extern const HairStyle tress_c;   ///< 1 000 × 2 000: tress B with twice the hairs
extern const HairStyle charming;  ///< 49 000 × 49: waves to the shoulders
extern const HairStyle curly;     ///< 47 000 × 100: tight helices
extern const HairStyle windy;     ///< 60 000 × 50: blown back and to one side
extern const HairStyle longish;   ///< 39 000 × 54: long and nearly straight

}  // namespace fiber
