// Makes a scene to measure with, as a program outside of the package would.
#include <fiber_proximity/geometry/fiber_assembly.hpp>
#include <fiber_proximity/scenes/scene.hpp>
#include <iostream>

int main() {
  const fiber::Scene scene = fiber::make_scene("cables", {});
  std::cout << scene(0).fiber_count() << " cables\n";
}
