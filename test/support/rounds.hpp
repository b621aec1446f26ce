#pragma once

namespace fiber::test {

#if defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__)
/// Sanitizers make tests ten times slower and find in one round what they would find in many: what
/// rounds are for, rare numbers, is for the tests without them.
constexpr int rounds_less = 20;
#else
constexpr int rounds_less = 1;
#endif

/// The rounds that a test goes which should go `count`; at least 1.
constexpr int rounds(int count) { return (count + rounds_less - 1) / rounds_less; }

}  // namespace fiber::test
