#include <mujoco/mujoco.h>

#include <Eigen/Geometry>
#include <cstring>
#include <sstream>
#include <stdexcept>

#include "benchmark/peers/cable_peers.hpp"

namespace fiber {

using Eigen::Vector3d;

namespace {

struct MujocoSetting {
  const char* integrator = "Euler";
  int substeps = 1;
  const char* solver = "Newton";
  bool is_stiff = false;  // contacts as fast as two steps, not 20 ms
};

[[noreturn]] void give_up(const char* message) { throw std::runtime_error(message); }

/// The model as its users write it.
///
/// A ball joint between two capsules of length l has the stiffness EI/l, the one at a clamp twice
/// as much, as it stands for half an edge. MuJoCo integrates springs explicitly. It integrates
/// damping implicitly, so that a damping of one step times the stiffness keeps stiff joints stable;
/// not so with RK4, where joints have none.
std::string model_of(const CableScene& scene, int segments, const MujocoSetting& setting) {
  const RodSection section = scene.section();
  const double edge = scene.length() / segments;
  const double step = CableScene::step / setting.substeps;
  const double mass = section.mass_per_length * edge;
  const double across = mass * (edge * edge / 12.0 + scene.radius * scene.radius / 4.0);
  const int contacts = 200 + 8 * segments * static_cast<int>(scene.cables.size());
  std::ostringstream xml;
  xml.precision(17);
  const double damping_time = std::strcmp(setting.integrator, "RK4") == 0 ? 0.0 : step;
  const auto joint = [&](double stiffness) {
    xml << "<joint type='ball' stiffness='" << stiffness << "' damping='"
        << damping_time * stiffness << "'/>";
  };
  xml << "<mujoco><size nconmax='" << contacts << "' njmax='" << 4 * contacts << "'/>"
      << "<option timestep='" << step << "' integrator='" << setting.integrator << "' solver='"
      << setting.solver << "' gravity='0 0 " << -CableScene::gravity << "'/><default><geom size='"
      << scene.radius << "' friction='" << scene.friction << "'";
  if (!scene.touches) {
    xml << " contype='0' conaffinity='0'";
  }
  if (setting.is_stiff) {
    xml << " solref='" << 2.0 * step << " 1' solimp='0.99 0.999 0.0001'";
  }
  xml << "/></default><worldbody>";
  if (scene.touches) {
    xml << "<geom type='plane' size='5 5 0.1'/>";
  }
  for (const auto& [first, last] : scene.cables) {
    const Eigen::Quaterniond turn =
        Eigen::Quaterniond::FromTwoVectors(Vector3d::UnitX(), last - first);
    for (int i = 0; i < segments; ++i) {
      if (i > 0) {
        xml << "<body pos='" << edge << " 0 0'>";
        joint(section.bending_stiffness / edge);
      } else {
        xml << "<body pos='" << first.transpose() << "' quat='" << turn.w() << ' '
            << turn.vec().transpose() << "'>";
        if (scene.first_end == CableEnd::FREE) {
          xml << "<freejoint/>";
        } else {
          joint(scene.first_end == CableEnd::CLAMPED ? 2.0 * section.bending_stiffness / edge
                                                     : 0.0);
        }
      }
      xml << "<inertial pos='" << 0.5 * edge << " 0 0' mass='" << mass << "' diaginertia='"
          << 0.5 * mass * scene.radius * scene.radius << ' ' << across << ' ' << across
          << "'/><geom type='capsule' fromto='0 0 0 " << edge << " 0 0'/>";
    }
    for (int i = 0; i < segments; ++i) {
      xml << "</body>";
    }
  }
  xml << "</worldbody></mujoco>";
  return xml.str();
}

mjModel* load(const std::string& xml) {
  const auto files = std::make_unique<mjVFS>();
  mj_defaultVFS(files.get());
  const char* const name = "cables.xml";
  mj_makeEmptyFileVFS(files.get(), name, static_cast<int>(xml.size()));
  std::memcpy(files->filedata[0], xml.data(), xml.size());
  char error[1000] = "";
  mjModel* const model = mj_loadXML(name, files.get(), error, sizeof(error));
  mj_deleteVFS(files.get());
  if (model == nullptr) {
    throw std::runtime_error(error);
  }
  return model;
}

class MujocoChain final : public CableSimulation {
 public:
  MujocoChain(const CableScene& scene, int segments, const MujocoSetting& setting)
      : segments_(segments),
        substeps_(setting.substeps),
        edge_(scene.length() / segments),
        fade_(scene.fade(CableScene::step / setting.substeps)) {
    // Otherwise it writes a log to the current folder, and goes on from the beginning where it
    // diverges.
    mju_user_error = give_up;
    mju_user_warning = give_up;
    model_.reset(load(model_of(scene, segments, setting)));
    data_.reset(mj_makeData(model_.get()));
  }

  void step() override {
    for (int i = 0; i < substeps_; ++i) {
      mj_step(model_.get(), data_.get());
      if (fade_ < 1.0) {
        mju_scl(data_->qvel, data_->qvel, fade_, model_->nv);
      }
    }
  }

  std::vector<Vector3d> positions() override {
    mj_kinematics(model_.get(), data_.get());
    std::vector<Vector3d> nodes;
    for (int body = 1; body < model_->nbody; ++body) {  // 0 is the world
      const Eigen::Map<const Vector3d> first(data_->xpos + 3 * body);
      nodes.emplace_back(first);
      if (body % segments_ == 0) {
        const Eigen::Map<const Eigen::Matrix<double, 3, 3, Eigen::RowMajor>> turn(data_->xmat +
                                                                                  9 * body);
        nodes.emplace_back(first + edge_ * turn.col(0));
      }
    }
    return nodes;
  }

 private:
  struct Delete {
    void operator()(mjModel* model) const { mj_deleteModel(model); }
    void operator()(mjData* data) const { mj_deleteData(data); }
  };

  int segments_;
  int substeps_;
  double edge_;  // [m]
  double fade_;  // of a substep
  std::unique_ptr<mjModel, Delete> model_;
  std::unique_ptr<mjData, Delete> data_;
};

std::string words(const CableScene& scene, const MujocoSetting& setting) {
  std::string text = setting.integrator;
  text += ", 1/" + std::to_string(240 * setting.substeps) + " s";
  if (scene.touches) {
    text += std::string(", ") + setting.solver;
    text += setting.is_stiff ? ", stiff contacts" : "";
  }
  return text;
}

}  // namespace

std::vector<CableMethod> mujoco_chains(const CableScene& scene, const std::vector<int>& segments) {
  const std::vector<MujocoSetting> settings =
      scene.touches ? std::vector<MujocoSetting>{{"Euler", 1, "Newton", false},
                                                 {"Euler", 1, "CG", false},
                                                 {"Euler", 1, "PGS", false},
                                                 {"Euler", 1, "Newton", true},
                                                 {"Euler", 4, "Newton", true}}
                    : std::vector<MujocoSetting>{
                          {"Euler", 1}, {"Euler", 4}, {"implicit", 1}, {"RK4", 1}, {"RK4", 4}};
  std::vector<CableMethod> methods;
  for (const int count : segments) {
    for (const MujocoSetting& setting : settings) {
      methods.push_back(
          {"mujoco", words(scene, setting), count, [count, setting](const CableScene& of) {
             return std::make_unique<MujocoChain>(of, count, setting);
           }});
    }
  }
  return methods;
}

}  // namespace fiber
