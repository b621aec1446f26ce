// fiber_simulate
#include "test/tools/simulate.hpp"

#include <algorithm>
#include <filesystem>
#include <sstream>

#include "fiber_proximity/sim/scene/scene.hpp"
#include "test/support/source_folder.hpp"

namespace fiber::test {
namespace {

TEST_F(Simulate, FramesAreThoseOfTheStepper) {
  const std::string file = write("scene.yaml", ropes);
  const std::vector<FiberFrame> written = frames(file, "--seconds 0.5");
  ASSERT_EQ(written.size(), 31U);
  EXPECT_EQ(read_file(path("out.csv")).substr(0, 26), "frame,fiber,x,y,z,radius\n0");
  SimScene scene = make_sim_scene(read_sim_scene(load_yaml(file), mesh_files("")), 1);
  const Rods& rods = scene.stepper->rods();
  for (std::size_t i = 0; i < written.size(); ++i) {
    if (i > 0) {
      for (std::uint32_t step = 0; step < 4; ++step) {
        scene.stepper->step(1.0 / 240.0);
      }
    }
    EXPECT_EQ(written[i].frame, static_cast<std::int64_t>(i));
    EXPECT_EQ(written[i].fibers.points(), rods.positions) << "frame " << i;
    EXPECT_EQ(written[i].fibers.offsets(), rods.offsets);
    EXPECT_EQ(written[i].fibers.segment_radius(0), 0.01);
    EXPECT_EQ(written[i].fibers.segment_radius(40), 0.005);
  }
}

TEST_F(Simulate, ThingsMoveAsTheyShould) {
  const std::vector<FiberFrame> written = frames(write("scene.yaml", ropes), "--seconds 0.25");
  ASSERT_EQ(written.size(), 16U);
  const std::vector<Eigen::Vector3d>& begin = written.front().fibers.points();
  const std::vector<Eigen::Vector3d>& end = written.back().fibers.points();
  // The hold is a spring, a thousand times as stiff as the edges.
  EXPECT_NEAR(end[0].z(), 0.02 + 0.125, 1e-6) << "the gripper rises by half a metre a second";
  EXPECT_NEAR(end[20].z(), 0.01, 2e-3) << "the other end falls on the table";
  for (std::size_t i = 21; i < end.size(); ++i) {
    // Implicit Euler falls a little further: g t (t + step) / 2.
    EXPECT_NEAR(begin[i].z() - end[i].z(), 0.5 * 9.81 * 0.25 * (0.25 + 1.0 / 240.0), 1e-6);
  }
}

TEST_F(Simulate, ThreadsMakeNoDifference) {
  const std::string scene = (source_folder() / "config/sim/demo.yaml").string();
  std::string first;
  for (const std::string tool : {FIBER_SIMULATE " ", "taskset -c 0 " FIBER_SIMULATE " "}) {
    for (const std::string threads : {"0", "1", "2", "7"}) {
      const ProcessResult result = run_process(tool + scene + " --seconds 0.1 --threads " +
                                               threads + " --out " + path("out.csv"));
      ASSERT_EQ(result.exit_code, 0) << result.err;
      const std::string bytes = read_file(path("out.csv"));
      first = first.empty() ? bytes : first;
      EXPECT_TRUE(bytes == first) << tool << threads;
    }
  }
  const std::vector<FiberFrame> written = read_csv(path("out.csv")).frames;
  ASSERT_EQ(written.size(), 7U);
  EXPECT_NE(written[5].fibers.points(), written[6].fibers.points());
}

TEST_F(Simulate, ParaViewGetsTheSameFrames) {
  const std::string file = write("scene.yaml", ropes);
  const std::vector<FiberFrame> written = frames(file, "--seconds 0.1");
  const ProcessResult result = simulate(file + " --seconds 0.1 --out " + path("run.pvd"));
  EXPECT_EQ(result.exit_code, 0) << result.err;
  EXPECT_EQ(result.out + result.err, "");
  ASSERT_EQ(written.size(), 7U);
  const std::string index = read_file(path("run.pvd"));
  for (std::size_t i = 0; i < written.size(); ++i) {
    const std::string name = "run_00000" + std::to_string(i) + ".vtp";
    EXPECT_NE(index.find("file=\"" + name + "\""), std::string::npos);
    const std::string frame = read_file(path(name));
    const std::size_t points = frame.find('\n', frame.find("NumberOfComponents=\"3\""));
    std::istringstream stream(frame.substr(points));
    for (const Eigen::Vector3d& expected : written[i].fibers.points()) {
      Eigen::Vector3d point;
      stream >> point.x() >> point.y() >> point.z();
      EXPECT_EQ(point, expected);
    }
  }
  EXPECT_FALSE(std::filesystem::exists(path("run_000007.vtp")));
}

TEST_F(Simulate, ASceneHearsWhatItLeavesOut) {
  std::string scene = ropes;
  const std::string effect = "  - environment_contact\n";
  scene.erase(scene.find(effect), effect.size());
  EXPECT_EQ(simulate(write("scene.yaml", scene) + " --seconds 0.1 --out " + path("out.csv")).err,
            "warning: fibres pass through the 1 obstacle(s): the effect environment_contact is not "
            "named\n");
}

TEST_F(Simulate, ASceneThatAsksForFewIterationsHearsHowFarFromBalanceItWas) {
  const std::string run = " --seconds 0.5 --out " + path("out.csv");
  const auto said = [&](const std::string& more) {
    return simulate(write("scene.yaml", ropes + more) + run).err;
  };
  EXPECT_EQ(said(""), "") << "forces balance";
  const std::string few = said("iterations: 1\n");
  for (const char* const part :
       {" of 30 frames end after 1 iterations", "before forces balance", " m/s a step (",
        " N at node ", " of fibre '", "energy that a step gained is "}) {
    EXPECT_NE(few.find(part), std::string::npos) << part << "\n" << few;
  }
}

TEST_F(Simulate, ASceneInRealTimeHearsWhatIsChosen) {
  std::string scene = std::string("real_time: true\n") + ropes;
  for (std::size_t at; (at = scene.find("segments:")) != std::string::npos;) {
    const std::size_t end = scene.find_first_of(",\n", at);
    scene.erase(at, end - at + 1);
  }
  const ProcessResult result =
      simulate(write("scene.yaml", scene) + " --seconds 0.01 --out " + path("out.csv"));
  EXPECT_EQ(result.exit_code, 0) << result.err;
  EXPECT_NE(result.err.find("real_time: the scene "), std::string::npos) << result.err;
  EXPECT_NE(result.err.find(" of the time there is on one core, with "), std::string::npos);
}

TEST_F(Simulate, FramesAreAsManyAsTheSecondsTake) {
  const auto count = [this](const std::string& time_step, const std::string& seconds) {
    const std::string scene =
        write("scene.yaml", std::string(ropes) + "time_step: " + time_step + "\nsubsteps: 1\n");
    return frames(scene, "--seconds " + seconds).size();
  };
  EXPECT_EQ(count("0.01", "0"), 1U);
  EXPECT_EQ(count("0.01", "0.1"), 11U);
  EXPECT_EQ(count("0.0166667", "0.1"), 7U);
  EXPECT_EQ(count("0.01", "0.105"), 12U);
}

/// Runs a command on a terminal of its own; what it writes there, on stdout or stderr.
std::string output_on_terminal(const std::string& command) {
  const ProcessResult result =
      run_process("/usr/bin/python3 -c 'import pty, sys\nsys.exit(pty.spawn(sys.argv[1:]))' " +
                  command + " </dev/null");
  EXPECT_EQ(result.exit_code, 0) << result.err;
  return result.out;
}

TEST_F(Simulate, ATerminalShowsHowFarItIs) {
  const std::string run = FIBER_SIMULATE " " + write("scene.yaml", ropes) + " --seconds 1 --out ";
  const std::string shown = output_on_terminal(run + path("out.csv"));
  EXPECT_NE(shown.find(" s of the scene, "), std::string::npos) << shown;
  EXPECT_EQ(shown.substr(shown.size() - 4), "\r\x1b[K") << "the line is cleared at the end";
  EXPECT_EQ(read_csv(path("out.csv")).frames.size(), 61U);
}

TEST_F(Simulate, RefusesBadCommandLines) {
  const std::string file = write("scene.yaml", ropes);
  const std::string out = " --out " + path("out.csv");
  EXPECT_TRUE(refused(simulate(""), "SCENE is required"));
  EXPECT_TRUE(refused(simulate(file + out), "--seconds is required"));
  EXPECT_TRUE(refused(simulate(file + " --seconds 1"), "--out is required"));
  EXPECT_TRUE(refused(simulate(file + out + " --seconds 1 --steps 3"), "--steps"));
  for (const std::string seconds : {"-1", "nan", "inf", "soon", "''"}) {
    EXPECT_TRUE(refused(simulate(file + out + " --seconds " + seconds), "--seconds"));
  }
  EXPECT_TRUE(refused(simulate(file + out + " --seconds 1e300"),
                      "--seconds is 1e+300: that is more than 1e+09 frames of 0.0166667 s"));
  EXPECT_TRUE(refused(simulate(file + out + " --seconds 1 --threads 1025"), "at most 1024"));
  EXPECT_FALSE(std::filesystem::exists(path("out.csv")));
  EXPECT_TRUE(refused(simulate(file + " --seconds 1 --out " + path("./scene.yaml")),
                      "--out is the scene itself"));
  EXPECT_EQ(read_file(file), ropes);
}

TEST_F(Simulate, RefusesBadScenesWithFileAndLine) {
  const std::string run = " --seconds 1 --out " + path("out.csv");
  EXPECT_TRUE(refused(simulate(path("none.yaml") + run), path("none.yaml")));
  const auto refusal = [&](const std::string& text, const std::string& reason) {
    const std::string file = write("bad.yaml", text);
    return refused(simulate(file + run), file + reason);
  };
  EXPECT_TRUE(refusal("fibers: [\n", ":2: "));
  EXPECT_TRUE(refusal("\nfiber: []\n", ":2: the document has the unknown key 'fiber'"));
  std::string text = ropes;
  text.replace(text.find("friction"), 8, "frictoin");
  EXPECT_TRUE(refusal(text, ":10: effects[5]: there is no effect 'frictoin'"));
  text = ropes;
  text.replace(text.find("path: [{time: 0}, {time: 1, position: [0, 0, 0.52]}]"), 52,
               "frame: tool");
  EXPECT_TRUE(refusal(text,
                      ":11: effects[6].attachment[0]: node 0 of fibre 'lifted' follows frame "
                      "'tool' of tf"));
  text = ropes;
  text.replace(text.find("half_spaces"), 11, "meshes: [{resource: a.stl}], half_spaces");
  EXPECT_TRUE(refusal(text,
                      ":12: obstacle 'table'.meshes[0].resource: mesh 'a.stl': there is no "
                      "file '" +
                          path("a.stl")));
  text = ropes;
  text.replace(text.find("obstacles: ["), 12, "obstacles: [{link: hand}, ");
  EXPECT_TRUE(refusal(text,
                      ":12: environment.obstacles[0].link is hand: links of robots are for "
                      "cable_sim"));
  EXPECT_FALSE(std::filesystem::exists(path("out.csv")));
}

TEST_F(Simulate, MeshesLieBesideTheScene) {
  write("corner.obj", "v 0.4 -1 0.3\nv 1 -1 0.3\nv 0.4 1 0.3\nv 1 1 0.3\nf 1 2 3\nf 2 4 3\n");
  std::string text = ropes;
  text.replace(text.find("half_spaces"), 11, "meshes: [{resource: corner.obj}], half_spaces");
  const auto written = frames(write("scene.yaml", text), "--seconds 1");
  EXPECT_GT(written.back().fibers.points()[26].z(), 0.29) << "what falls is caught by the mesh";
}

TEST_F(Simulate, WhatGoesWrongInAFrameIsAWarning) {
  std::string text = ropes;
  text.replace(text.find("{fiber: lifted, "), 16, "{fiber: lifted, max_force: 0.1, ");
  const ProcessResult result =
      simulate(write("scene.yaml", text) + " --seconds 1 --out " + path("out.csv"));
  EXPECT_EQ(result.exit_code, 0);
  EXPECT_EQ(result.err.find("warning: after 0.0"), 0U) << result.err;
  EXPECT_NE(
      result.err.find(" s: what holds node 0 of fibre 'lifted' pulls with 0.1 N, its greatest "
                      "force (max_force), and the node is "),
      std::string::npos)
      << result.err;
  EXPECT_NE(result.err.find("warning: so in "), std::string::npos) << result.err;
  EXPECT_EQ(std::count(result.err.begin(), result.err.end(), '\n'), 2) << result.err;
  EXPECT_EQ(read_csv(path("out.csv")).frames.size(), 61U) << "the scene lives on";

  // So far from the origin, coordinates are too coarse for that.
  const ProcessResult unbalanced = simulate(
      write("scene.yaml",
            "residual: 1.0e-9\n"
            "fibers:\n"
            "  - {name: far, shape: {line: {from: [1000, 0, 0], to: [1001, 0, 0]}}, segments: 20, "
            "radius: 0.01, material: power_cable}\n"
            "effects: [gravity, stretch, bend, attachment: [{fiber: far}]]\n") +
      " --seconds 0.1 --out " + path("out.csv"));
  EXPECT_EQ(unbalanced.exit_code, 0);
  EXPECT_NE(
      unbalanced.err.find("forces do not balance within 100 iterations: what is left at node "),
      std::string::npos)
      << unbalanced.err;
  EXPECT_NE(unbalanced.err.find(" of fibre 'far' would change its speed by "), std::string::npos)
      << unbalanced.err;
}

TEST_F(Simulate, RefusesOutputThatCannotBeWritten) {
  const std::string run = write("scene.yaml", ropes) + " --seconds 1 --out ";
  EXPECT_TRUE(refused(simulate(run + path("none/out.csv")),
                      path("none/out.csv") + ": cannot be opened for writing: No such file"));
  EXPECT_TRUE(refused(simulate(run + path("none/run.pvd")),
                      path("none/run.pvd") + ": cannot be opened for writing: No such file"));
  EXPECT_TRUE(refused(simulate(run + "/dev/full"), "/dev/full: cannot be written: No space left"));
  const std::string forces = run + path("out.csv") + " --forces ";
  EXPECT_TRUE(refused(simulate(forces + path("none/forces.csv")),
                      path("none/forces.csv") + ": cannot be opened for writing: No such file"));
  EXPECT_TRUE(refused(simulate(forces + "/dev/full"), "/dev/full: cannot be written: No space"));
  EXPECT_TRUE(refused(simulate(forces + path("./out.csv")), "--forces is --out itself"));
  EXPECT_TRUE(refused(simulate(forces + path("scene.yaml")), "--forces is the scene itself"));
  std::filesystem::create_symlink("/dev/full", path("run_000003.vtp"));
  EXPECT_TRUE(refused(simulate(run + path("run.pvd")),
                      path("run_000003.vtp") + ": cannot be written: No space left"));
  EXPECT_FALSE(std::filesystem::exists(path("run_000004.vtp")));
}

}  // namespace
}  // namespace fiber::test
