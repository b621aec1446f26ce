#include "benchmark/sim/validation.hpp"

#include <cmath>
#include <sstream>

#include "validation/sim/elastica.hpp"
#include "validation/sim/friction_scenes.hpp"
#include "validation/sim/impacts.hpp"
#include "validation/sim/instability.hpp"
#include "validation/sim/joints.hpp"
#include "validation/sim/loads.hpp"
#include "validation/sim/motion.hpp"
#include "validation/sim/rolling.hpp"
#include "validation/sim/statics.hpp"
#include "validation/sim/strips.hpp"

namespace fiber {
namespace {

using Report = std::function<void(const Validation&)>;

constexpr int segments = 50;
constexpr double two_percent = 0.02;  // of where a rod slides and a shape becomes unstable
constexpr double half_percent = 0.005;
constexpr double two_thousandths = 0.002;
constexpr double free_fall_part = 1e-11;

std::string text(const std::string& what, double value) {
  std::ostringstream out;
  out << what << " = " << value;
  return out.str();
}

/// Where a test turns from false to true as a load grows, by halving from 2 % below to 2 % above
/// what theory says; one of these ends if it does not turn between them.
template <class Test>
double threshold(double theory, const Test& test) {
  constexpr int halvings = 7;
  double low = (1.0 - two_percent) * theory;
  double high = (1.0 + two_percent) * theory;
  if (test(low)) {
    return low;
  }
  if (!test(high)) {
    return high;
  }
  for (int i = 0; i < halvings; ++i) {
    const double middle = 0.5 * (low + high);
    (test(middle) ? high : low) = middle;
  }
  return 0.5 * (low + high);
}

void validate_cantilevers(const Report& report) {
  for (const double load : {0.25, 1.0, 2.0, 3.0, 5.0, 10.0}) {
    const CantileverTip theory = cantilever_tip(load, 0.0);
    const CantileverTip tip = simulated_tip(segments, load, 0.0);
    const std::string scene = text("PL²/EI", load);
    report({"cantilever, tip load", scene, "drop / L", segments, theory.drop, tip.drop});
    report({"cantilever, tip load", scene, "reach / L", segments, theory.reach, tip.reach});
  }
  for (const double weight : {1.0, 2.0, 4.0, 8.0, 10.0, 20.0}) {
    report({"cantilever, own weight", text("ρAgL³/EI", weight), "drop / L", segments,
            cantilever_tip(0.0, weight).drop, simulated_tip(segments, 0.0, weight).drop});
  }
}

void validate_catenaries(const Report& report) {
  for (const double length : {1.01, 1.05, 1.1, 1.2, 1.5, 2.0}) {
    const HangingChain theory = exact_catenary(length);
    const HangingChain chain = simulated_catenary(length, segments);
    const std::string scene = text("length / span", length);
    report({"catenary", scene, "sag / span", segments, theory.sag, chain.sag});
    report({"catenary", scene, "pull / weight per span", segments, theory.pull, chain.pull});
  }
}

void validate_loads(const Report& report) {
  for (const double turns : {0.25, 0.5, 1.0}) {
    const double moment = 2.0 * M_PI * turns;
    const CantileverTip theory = exact_arc_tip(moment);
    const CantileverTip tip = simulated_arc_tip(segments, moment);
    report({"cantilever, end moment", text("turn [1]", turns), "way of the tip / L", segments,
            std::hypot(theory.drop, theory.reach - 1.0), std::hypot(tip.drop, tip.reach - 1.0),
            half_percent});
  }
  for (const double step : {0.4, 0.473}) {
    const CantileverTip theory = exact_stepped_arc_tip(2.0, step);
    const CantileverTip tip = simulated_stepped_arc_tip(segments, 2.0, step);
    const std::string scene = text("EI 4 and 1, step at L", step);
    report({"stepped cantilever", scene, "drop / L by an end moment", segments, theory.drop,
            tip.drop, half_percent});
    report({"stepped cantilever", scene, "drop EI / PL³", segments, exact_stepped_compliance(step),
            simulated_stepped_compliance(segments, step), half_percent});
  }
  const StripDeflection strip = simulated_strip(35.0 * M_PI / 180.0);
  report({"cantilever of a flat cable", text("EI 4 and 1, side [°]", 35),
          "to the stiff side EI / PL³", strip_edges, 1.0 / 3.0 / strip_ratio, strip.stiff / 3.0,
          half_percent});
  report({"cantilever of a flat cable", text("EI 4 and 1, side [°]", 35), "across it EI / PL³",
          strip_edges, 1.0 / 3.0, strip.soft / 3.0, half_percent});
  for (const double place : {0.5, 0.2}) {
    const HangingChain theory = exact_loaded_catenary(1.2, 1.0, place);
    const HangingChain chain = simulated_loaded_catenary(1.2, 1.0, place, segments);
    const std::string scene = text("weight of 1, at", place);
    report({"catenary with a weight", scene, "sag / span", segments, theory.sag, chain.sag,
            half_percent});
    report({"catenary with a weight", scene, "pull / weight per span", segments, theory.pull,
            chain.pull, half_percent});
  }
  for (const double degrees : {10.0, 45.0}) {
    const double angle = degrees * M_PI / 180.0;
    constexpr double share = 0.01;
    constexpr double step = 0.005;
    constexpr double thousandth = 0.001;
    report({"pendulum with a weight", text("amplitude [°]", degrees), "period [s]", segments,
            exact_weight_pendulum_period(angle, share),
            simulated_weight_pendulum_period(segments, angle, share, step), thousandth});
  }
}

void validate_joints(const Report& report) {
  constexpr double thousandth = 0.001;
  // A heavy ring bends sharply where it hangs: its error at 50 segments is 0.6 %.
  constexpr int ring_segments = 2 * segments;
  for (const double weight : {20.0, 100.0, 500.0}) {
    const HungRing theory = exact_hung_ring(weight);
    const HungRing ring = simulated_hung_ring(weight, ring_segments);
    const std::string scene = text("ρAgL³/EI", weight);
    report({"ring, own weight", scene, "drop / L", ring_segments, theory.drop, ring.drop,
            half_percent});
    report({"ring, own weight", scene, "width / L", ring_segments, theory.width, ring.width,
            half_percent});
  }
  const auto theory = exact_truss();
  const auto truss = simulated_truss();
  report(
      {"truss of two bars", "the long one", "pull / weight", 1, theory[0], truss[0], thousandth});
  report(
      {"truss of two bars", "the short one", "pull / weight", 1, theory[1], truss[1], thousandth});
}

void validate_motion(const Report& report) {
  struct Mode {
    const char* name;
    double low;
    double high;
  };
  for (const Mode& mode : {Mode{"first mode", 1.5, 2.5}, Mode{"second mode", 4.0, 5.0}}) {
    const double root = cantilever_root(mode.low, mode.high);
    report({"cantilever, frequency", mode.name, "f · L² √(ρA/EI)", segments,
            root * root / (2.0 * M_PI), simulated_frequency(segments, root)});
  }
  constexpr double inertia = 1e-4;
  report({"torsion, frequency", "first mode", "f · L √(ρI/GJ)", segments, 0.25,
          simulated_torsion(segments, inertia) * std::sqrt(inertia)});
  for (const double degrees : {10.0, 45.0, 90.0}) {
    const double angle = degrees * M_PI / 180.0;
    const double period = simulated_pendulum_period(segments, angle, 0.01);
    report({"pendulum", text("amplitude [°]", degrees), "period / that of small ones", segments,
            exact_pendulum_ratio(angle), period / rod_pendulum_period()});
    constexpr double step = 0.005;
    constexpr double thousandth = 0.001;
    report({"pendulum that is a rigid part", text("amplitude [°]", degrees),
            "period / that of small ones", 1, exact_pendulum_ratio(angle),
            simulated_plug_period(angle, step) / rod_pendulum_period(), thousandth});
  }
  constexpr int steps = 50;
  constexpr double step = 0.01;
  for (const Integrator integrator : {Integrator::IMPLICIT_EULER, Integrator::BDF2}) {
    const bool is_euler = integrator == Integrator::IMPLICIT_EULER;
    report({"free fall", is_euler ? "implicit Euler, its bias included" : "BDF2",
            "height after 0.5 s [m]", 10, exact_fall(integrator, step, steps),
            fallen_rod(integrator, step, steps).positions.front().z(), free_fall_part});
  }
}

void validate_instability(const Report& report) {
  const double weight = critical_weight_of_column();
  const double buckling =
      threshold(weight, [](double load) { return growth_of_column(load) > 1.0; });
  report({"buckling under own weight", "clamped column", "ρAgL³/EI", segments, weight, buckling,
          two_percent});
  const double twist = critical_twist();
  report({"Greenhill's buckling", "twisted between clamps", "ML/EI", segments, twist,
          threshold(twist, [](double angle) { return growth_of_twisted(angle) > 1.0; }),
          two_percent});
  const double moment = critical_moment_of_hinged();
  report({"Greenhill's buckling", "twisted between hinges", "ML/EI", segments, moment,
          threshold(moment, [](double load) { return growth_of_hinged(load) > 1.0; }),
          two_percent});
  constexpr double twisting_stiffness = 2.0 / 3.0;
  for (const double mass : {20.0, 40.0, 80.0}) {
    const double curvature = critical_natural_curvature(mass, twisting_stiffness);
    report({"bend–twist", text("GJ/EI = 2/3, ρAgL³/EI", mass), "natural curvature × L", segments,
            curvature,
            threshold(curvature,
                      [&](double kappa) {
                        return growth_of_curved(mass, twisting_stiffness, kappa) > 1.0;
                      }),
            two_percent});
  }
  constexpr int ring_steps = 800;
  const double ring = critical_twist_of_ring();
  report({"Michell's ring", "GJ = EI", "twist [rad]", segments, ring,
          threshold(ring, [](double angle) { return end_of_ring(angle, ring_steps).height < 0.0; }),
          two_percent});
}

void validate_friction(const Report& report) {
  constexpr double moves = 1e-3;  // [m/s]
  for (const double friction : {0.1, 0.2, 0.3}) {
    const double slope = threshold(friction, [&](double tangent) {
      Incline incline(std::atan(tangent), friction);
      incline.run(2.0);
      return incline.speed() > moves;
    });
    report({"incline", text("μ", friction), "slope where it slides [°]", 10,
            std::atan(friction) * 180.0 / M_PI, std::atan(slope) * 180.0 / M_PI, two_percent});
  }
  for (const double friction : {0.1, 0.2, 0.3}) {
    report({"stick–slip", text("μ", friction), "lowering / L where the tip slides", segments,
            lowering_until_tip_slides(friction, 0.0), lowering_of_simulated_tip(friction, segments),
            two_percent});
  }
  constexpr double friction = 0.3;
  constexpr int edges_per_turn = 64;
  for (const double turns : {0.25, 0.5, 1.0}) {
    report({"capstan", text("μ = 0.3, turns", turns), "ratio of the tensions", edges_per_turn,
            std::exp(friction * 2.0 * M_PI * turns),
            tension_ratio({turns, edges_per_turn}, friction)});
  }
  for (const bool turns_large : {true, false}) {
    const BeltDrive theory = exact_belt_drive(turns_large, friction);
    const BeltDrive belt = simulated_belt_drive(turns_large, friction);
    const std::string scene = turns_large ? "the large drum turns" : "the small drum turns";
    report({"belt around two drums", scene, "ratio of the tensions", belt_edges_per_turn,
            theory.tension_ratio, belt.tension_ratio, two_percent});
    if (turns_large) {
      report({"belt around two drums", scene, "speed / that of the drum's surface",
              belt_edges_per_turn, theory.speed, belt.speed, two_thousandths});
    }
  }
  for (const double degrees : {10.0, 35.0}) {
    const double angle = degrees * M_PI / 180.0;
    const RodOnSlope rod(angle, 0.005, std::tan(angle), Integrator::IMPLICIT_EULER);
    rod.run(0.25);
    const double before = rod.speed();
    rod.run(0.5);
    report({"rolling", text("slope [°]", degrees), "acceleration / (g sin α)", 8, 2.0 / 3.0,
            (rod.speed() - before) / 0.5 / (standard_gravity * std::sin(angle))});
  }
}

/// What a step allows: the heights of rebounds are of first order in it.
void validate_impacts(const Report& report) {
  constexpr double allowed = 0.05;  // of the speed of the fall
  Drop drop;
  for (const double restitution : {0.2, 0.7}) {
    for (const double height : {0.05, 1.0}) {
      drop.height = height;
      drop.restitution = restitution;
      report({"drop on a table",
              text("restitution", restitution) + ", " + text("height [m]", height),
              "speed of rebound / of fall", 10, restitution,
              std::sqrt(std::max(0.0, simulated_rebound(drop)) / height), allowed / restitution});
    }
  }
  for (const Integrator integrator : {Integrator::IMPLICIT_EULER, Integrator::BDF2}) {
    constexpr double friction = 0.1;
    const Deflection found = simulated_deflection(integrator, 1.0 / 240.0, 0.2, friction);
    report({"oblique impact on a table",
            integrator == Integrator::BDF2 ? "μ = 0.1, BDF2" : "μ = 0.1, implicit Euler",
            "impulse along / across", 10, friction, found.along / found.across, two_percent});
  }
  const Push push = simulated_push(Integrator::IMPLICIT_EULER);
  constexpr double felt_part = 1e-4;
  report({"box that pushes a rod", "μ = 0.3, with its impact", "impulse of the box [N s]", 20,
          push.momentum.norm(), push.impulse.norm(), felt_part});
}

struct Subject {
  const char* name;
  void (*validate)(const Report&);
};

constexpr Subject subjects[] = {{"cantilevers", validate_cantilevers},
                                {"catenaries", validate_catenaries},
                                {"loads", validate_loads},
                                {"joints", validate_joints},
                                {"motion", validate_motion},
                                {"instability", validate_instability},
                                {"friction", validate_friction},
                                {"impacts", validate_impacts}};

}  // namespace

std::vector<std::string> validation_names() {
  std::vector<std::string> names;
  for (const Subject& subject : subjects) {
    names.emplace_back(subject.name);
  }
  return names;
}

void validate_simulation(const std::string& about, const Report& report) {
  for (const Subject& subject : subjects) {
    if (subject.name == about) {
      subject.validate(report);
    }
  }
}

}  // namespace fiber
