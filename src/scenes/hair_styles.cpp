#include "src/scenes/hair_styles.hpp"

namespace fiber {
namespace {

HairStyle make_tress_a() {
  HairStyle style;
  style.hair_count = 2'500;
  style.segments = 98;
  style.on_head = false;
  style.length = 0.25;
  style.length_variation = 0.04;
  style.gather = 8.0;
  style.stiffness = 0.02;
  style.lock_size = 0.006;
  style.clump = 0.5;
  style.curl_radius = 0.006;
  style.curl_flatness = 0.7;
  style.curl_pitch = 0.06;
  style.curl_start = 0.08;
  style.curl_variation = 0.15;
  style.wander = 0.004;
  style.sway = 0.01;
  return style;
}

HairStyle make_tress_b() {
  HairStyle style;
  style.hair_count = 500;
  style.segments = 2'000;
  style.on_head = false;
  style.length = 0.36;
  style.length_variation = 0.03;
  style.gather = 15.0;
  style.stiffness = 0.02;
  style.lock_size = 0.005;
  style.clump = 0.6;
  style.curl_radius = 0.009;
  style.curl_flatness = 0.0;
  style.curl_pitch = 0.036;
  style.curl_start = 0.1;
  style.curl_variation = 0.1;
  style.wander = 0.003;
  style.sway = 0.01;
  return style;
}

HairStyle make_tress_c() {
  HairStyle style = make_tress_b();
  style.hair_count = 1'000;
  return style;
}

HairStyle make_charming() {
  HairStyle style;
  style.hair_count = 49'000;
  style.segments = 49;
  style.length = 0.30;
  style.length_variation = 0.08;
  style.comb = {-0.9, 0.8, 0.0};
  style.stiffness = 0.02;
  style.coat = 0.025;
  style.lock_size = 0.006;
  style.clump = 0.35;
  style.curl_radius = 0.005;
  style.curl_flatness = 0.7;
  style.curl_pitch = 0.07;
  style.curl_start = 0.12;
  style.curl_variation = 0.15;
  style.wander = 0.004;
  style.sway = 0.01;
  return style;
}

HairStyle make_curly() {
  HairStyle style;
  style.hair_count = 47'000;
  style.segments = 100;
  style.length = 0.16;
  style.length_variation = 0.1;
  style.comb = {-0.3, 0.5, 0.3};
  style.stiffness = 0.03;
  style.coat = 0.03;
  style.lock_size = 0.005;
  style.clump = 0.4;
  style.curl_radius = 0.0045;
  style.curl_flatness = 0.0;
  style.curl_pitch = 0.016;
  style.curl_start = 0.03;
  style.curl_variation = 0.15;
  style.wander = 0.003;
  style.sway = 0.006;
  return style;
}

HairStyle make_windy() {
  HairStyle style;
  style.hair_count = 60'000;
  style.segments = 50;
  style.length = 0.25;
  style.length_variation = 0.12;
  style.pull = {-1.0, -0.7, 0.05};
  style.eddies = 0.25;
  style.stiffness = 0.03;
  style.coat = 0.02;
  style.lock_size = 0.006;
  style.clump = 0.5;
  style.curl_radius = 0.003;
  style.curl_flatness = 0.8;
  style.curl_pitch = 0.09;
  style.curl_start = 0.1;
  style.curl_variation = 0.2;
  style.wander = 0.01;
  style.sway = 0.02;
  return style;
}

HairStyle make_longish() {
  HairStyle style;
  style.hair_count = 39'000;
  style.segments = 54;
  style.length = 0.45;
  style.length_variation = 0.04;
  style.comb = {-0.9, 0.8, 0.0};
  style.stiffness = 0.02;
  style.coat = 0.012;
  style.lock_size = 0.006;
  style.clump = 0.4;
  style.curl_radius = 0.002;
  style.curl_flatness = 0.8;
  style.curl_pitch = 0.2;
  style.curl_start = 0.2;
  style.curl_variation = 0.2;
  style.wander = 0.004;
  style.sway = 0.01;
  return style;
}

}  // namespace

const HairStyle tress_a = make_tress_a();
const HairStyle tress_b = make_tress_b();
const HairStyle tress_c = make_tress_c();
const HairStyle charming = make_charming();
const HairStyle curly = make_curly();
const HairStyle windy = make_windy();
const HairStyle longish = make_longish();

}  // namespace fiber
