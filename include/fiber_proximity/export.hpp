#pragma once

/// Marks what programs and other libraries may call of this one: all else that it is made of is
/// hidden from them. Headers below src/ carry it where other libraries of this package, or its
/// tests, need them.
#define FIBER_PROXIMITY_EXPORT [[gnu::visibility("default")]]
