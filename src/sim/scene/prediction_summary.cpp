// The results of a prediction, in lines.

#include <sstream>

#include "src/sim/scene/prediction_observer.hpp"
#include "src/text/quote.hpp"

namespace fiber {
namespace {

class Summary {
 public:
  Summary(const SimScene& scene, double margin)
      : scene_(scene), objects_(scene.objects()), margin_(margin) {}

  std::string of(const Prediction& prediction) {
    text_ << "prediction: " << prediction.time << " s, by the ends of frames";
    if (prediction.unbalanced_frames > 0) {
      text_ << "; " << prediction.unbalanced_frames << " frame(s) ended before forces balanced";
    }
    if (!prediction.problem.empty()) {
      text_ << "; no further: " << prediction.problem;
    }
    text_ << '\n';
    for (const PredictedClearance& clearance : prediction.clearances) {
      add(clearance);
    }
    text_ << "clearance: all other bodies stay further apart than " << margin_ << " m\n";
    for (const PredictedTouch& touch : prediction.touches) {
      text_ << "contact: " << pair(touch.rod, touch.is_object, touch.other) << " from "
            << touch.first << " s to " << touch.last << " s, at most " << touch.max_force
            << " N, at " << touch.time_of_max << " s\n";
    }
    if (prediction.touches.empty()) {
      text_ << "contact: none\n";
    }
    for (const GreatestForce& tension : prediction.tensions) {
      add("tension", "edge", tension);
    }
    for (const GreatestForce& hold : prediction.holds) {
      add("hold", "node", hold);
    }
    for (const GreatestForce& joint : prediction.joints) {
      add("joint", "node", joint);
    }
    return text_.str();
  }

 private:
  std::string fiber(std::uint32_t rod) const { return "fibre " + quote(scene_.fiber_names[rod]); }

  std::string pair(std::uint32_t rod, bool is_object, std::uint32_t other) const {
    if (is_object) {
      return fiber(rod) + " and obstacle " + quote(objects_[other].name);
    }
    return fiber(rod) + " and " + (other == rod ? "itself" : fiber(other));
  }

  void add(const PredictedClearance& clearance) {
    const Contact& contact = clearance.contact;
    text_ << "clearance: " << contact.distance << " m of "
          << pair(contact.fiber_a, clearance.is_object, contact.fiber_b) << ", segment "
          << contact.segment_a;
    if (!clearance.is_object) {
      text_ << " and segment " << contact.segment_b;
    }
    text_ << ", at " << clearance.time << " s\n";
  }

  void add(const char* kind, const char* place, const GreatestForce& greatest) {
    text_ << kind << ": at most " << greatest.force << " N at " << place << ' ' << greatest.node
          << " of " << fiber(greatest.rod) << ", at " << greatest.time << " s\n";
  }

  const SimScene& scene_;
  const std::vector<EnvironmentObject> objects_;
  const double margin_;  // [m]
  std::ostringstream text_;
};

}  // namespace

std::string summary(const Prediction& prediction, const SimScene& scene, double margin) {
  return Summary(scene, margin).of(prediction);
}

}  // namespace fiber
