#pragma once

#include "src/scenes/hair.hpp"

namespace fiber {

// The paper's hair (Fig. 1), with its numbers of hairs and segments, its density and its diameter.
// Shape, length and locks are our own: the paper shows a picture of each and says no more. Hairs
// lie beside each other at distances around their diameter and, as interpolated styles do, partly
// in each other. Contacts are per segment, at scale 1, seed 1, frame 0 and margin 0, neighbours in
// a hair left out; a smaller scale has fewer, because fewer hairs fall on the same place.

extern const HairStyle tress_a;   ///< 2 500 × 98: a wavy strand; 0.75 contacts
extern const HairStyle tress_b;   ///< 500 × 2 000: long curls; 0.12 contacts
extern const HairStyle tress_c;   ///< 1 000 × 2 000: tress B with twice the hairs; 0.20 contacts
extern const HairStyle charming;  ///< 49 000 × 49: waves to the shoulders; 1.75 contacts
extern const HairStyle curly;     ///< 47 000 × 100: tight helices; 1.43 contacts
extern const HairStyle windy;     ///< 60 000 × 50: blown back and to one side; 0.50 contacts
extern const HairStyle longish;   ///< 39 000 × 54: long and nearly straight; 0.85 contacts

}  // namespace fiber
