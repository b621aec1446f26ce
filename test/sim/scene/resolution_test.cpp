#include <cmath>

#include "src/sim/scene/report.hpp"
#include "test/sim/scene/scene_fixture.hpp"

namespace fiber {
namespace {

TEST_F(SimSceneTest, AccuracyChoosesSegmentsAndSubsteps) {
  const SimScene coarse = read(open_text(line, "accuracy: 10 %\n"));
  const SimScene fine = read(open_text(line, "accuracy: 0.001\n"));
  const SimScene second_order = read(open_text(line, "accuracy: 0.1 %\nintegrator: bdf2\n"));
  const auto segments = [](const SimScene& scene) {
    return scene.stepper->rods().node_count(0) - 1;
  };
  EXPECT_NEAR(segments(fine), 10.0 * segments(coarse), 10.0);
  EXPECT_NEAR(fine.substeps, 100.0 * coarse.substeps, 100.0);
  EXPECT_LT(second_order.substeps, fine.substeps);
  EXPECT_EQ(fine.accuracy, 0.001);
  // With contacts, steps are no longer than 10 mm of radius allow.
  EXPECT_EQ(read(open_text(line, "accuracy: 50 %\nintegrator: bdf2\n")).substeps, 1U);
  std::string touching = open_text(line, "accuracy: 50 %\nintegrator: bdf2\n");
  touching.replace(touching.find("bend]"), 5, "bend, self_contact]");
  EXPECT_EQ(read(touching).substeps, 2U);
  // Given segments stay; a fibre that turns needs more.
  const SimScene given = read(scene_text(line, "[stretch]", "accuracy: 1 %\nsubsteps: 7\n"));
  EXPECT_EQ(segments(given), 4U);
  EXPECT_EQ(given.substeps, 7U);
  const SimScene coil = read(open_text(
      "{helix: {center: [0, 0, 0], radius: 0.1, pitch: 0.05, turns: 20}}", "accuracy: 1 %\n"));
  EXPECT_GT(segments(coil), 200U);
}

/// A made-up timer: each frame of many takes so long for each node and substep [s].
FrameTimer takes(double node_time, std::size_t frames = 100) {
  return [node_time, frames](const SimDescription& scene, double budget) {
    const double frame =
        node_time * static_cast<double>(scene.rods.positions.size()) * scene.substeps;
    const double affordable = std::max(1.0, budget / frame);
    return std::vector<double>(
        static_cast<std::size_t>(std::min(affordable, static_cast<double>(frames))), frame);
  };
}

/// The share of the time there is, by a timer.
double share(const SimDescription& scene, const FrameTimer& timer) {
  return timer(scene, 1.0).front() / scene.time_step;
}

TEST_F(SimSceneTest, RealTimeTakesHalfOfTheTimeThereIs) {
  for (const char* const integrator : {"implicit_euler", "bdf2"}) {
    for (const int count : {10, 40, 300}) {
      for (const double node_time : {3e-7, 1e-6, 5e-6}) {
        std::string text =
            open_text(line, std::string("real_time: true\nintegrator: ") + integrator + "\n");
        text.replace(text.find("effects"), 0,
                     "    repeat: {count: " + std::to_string(count) + ", offset: [0, 1, 0]}\n");
        const SimDescription scene = describe(text, takes(node_time));
        EXPECT_NEAR(share(scene, takes(node_time)), 0.5, 0.1)
            << integrator << ", " << count << ", " << node_time;
        EXPECT_NE(scene.real_time_note.find(" of the time there is on one core, with " +
                                            std::to_string(scene.substeps) + " substeps, " +
                                            std::to_string(scene.rods.node_count(0) - 1) +
                                            " segments of fibre 'cable'"),
                  std::string::npos)
            << scene.real_time_note;
        EXPECT_EQ(scene.real_time_warning, "");
      }
    }
  }
}

TEST_F(SimSceneTest, RealTimeLooksAheadAtWhatGetsDearer) {
  // The second half of the frames takes nine times as long, and more with finer segments.
  const FrameTimer falls = [](const SimDescription& scene, double budget) {
    const double work = static_cast<double>(scene.rods.positions.size()) * scene.substeps;
    std::vector<double> times;
    for (double used = 0.0; times.size() < 100 && used < budget; used += times.back()) {
      times.push_back((times.size() < 50 ? 1e-8 : 9e-8) * std::pow(work, 1.4));
    }
    return times;
  };
  const SimDescription scene = describe(open_text(line, "real_time: true\n"), falls);
  double mean = 0.0;
  for (const double time : falls(scene, 1e9)) {
    mean += time / 100.0;
  }
  EXPECT_NEAR(mean / scene.time_step, 0.5, 0.1);
}

/// What it extrapolates to is measured: from somewhere on, finer segments bring contacts that take
/// three times as long, which nothing coarser tells.
TEST_F(SimSceneTest, RealTimeMeasuresWhatItHasChosen) {
  for (double dearer_from = 3e3; dearer_from < 3e4; dearer_from *= 1.1) {
    SCOPED_TRACE(dearer_from);
    const FrameTimer touches = [&](const SimDescription& scene, double budget) {
      const double work = static_cast<double>(scene.rods.positions.size()) * scene.substeps;
      const double frame = 5e-7 * work * (work > dearer_from ? 3.0 : 1.0);
      std::vector<double> times;
      for (double used = 0.0; times.size() < 180 && used < budget; used += frame) {
        times.push_back(frame);
      }
      return times;
    };
    const SimDescription scene = describe(open_text(line, "real_time: true\n"), touches);
    const double taken = touches(scene, 1.0).front() / scene.time_step;
    EXPECT_LE(taken, 0.6) << scene.real_time_note;
    EXPECT_GE(taken, 0.15) << scene.real_time_note;
  }
}

TEST_F(SimSceneTest, WhatCannotBeHadInRealTimeSaysSo) {
  const SimDescription scene = describe(open_text(line, "real_time: true\n"), takes(0.01, 1));
  EXPECT_EQ(scene.real_time_note, "");
  EXPECT_EQ(scene.real_time_warning.find("real_time: the scene cannot be had in real time; it "
                                         "takes 3 of the time there is on one core, with 1 "
                                         "substeps, 4 segments of fibre 'cable'"),
            0U)
      << scene.real_time_warning;
  EXPECT_EQ(omissions(make_sim_scene(scene, 1)).front(), scene.real_time_warning);
}

TEST_F(SimSceneTest, RealTimeLooksBeyondWhatBeginsInAnObstacle) {
  // A wire between clips: coarse polygons pass beside them, finer ones begin in them.
  constexpr std::uint32_t first_free = 40;
  const FrameTimer clips = [](const SimDescription& scene, double budget) {
    const std::uint32_t segments = scene.rods.node_count(0) - 1;
    if (segments > 5 && segments < first_free) {
      throw std::invalid_argument("overlap");
    }
    return takes(1e-6)(scene, budget);
  };
  const SimDescription scene = describe(open_text(line, "real_time: true\n"), clips);
  EXPECT_GE(scene.rods.node_count(0) - 1, first_free);
  EXPECT_NEAR(share(scene, takes(1e-6)), 0.5, 0.1);
}

TEST_F(SimSceneTest, RealTimeOfAnOverlapInEachResolutionIsThatError) {
  const FrameTimer refuses = [](const SimDescription&, double) -> std::vector<double> {
    throw std::invalid_argument("overlap");
  };
  EXPECT_EQ(error_of([&] { describe(open_text(line, "real_time: true\n"), refuses); }), "overlap");
}

TEST_F(SimSceneTest, NumbersThatTakeForEverAreRefused) {
  EXPECT_EQ(error(open_text(line, "accuracy: 1e-6\n"))
                .find("7: accuracy is 1e-6, it must be "
                      "coarser: it takes "),
            0U);
  EXPECT_EQ(error(open_text(line, "accuracy: 1e-13\nsubsteps: 4\n")),
            "2: fibers[0]: the scene's accuracy takes 8220503 segments, 1000000 are the most "
            "(fibre 'cable')");
  EXPECT_LE(describe(open_text("{line: {from: [0, 0, 0], to: [0.01, 0, 0]}}", "real_time: true\n"),
                     takes(1e-9))
                .substeps,
            1000U);
  std::string text = scene_text(line, "[stretch]");
  text.replace(text.find("effects"), 0, "    repeat: {count: 100000, offset: [0, 1, 0]}\n");
  EXPECT_NO_THROW(read(text));
  text.replace(text.find("segments: 4"), 11, "segments: 11");
  EXPECT_EQ(error(text),
            "7: fibers[0].repeat: 100000 fibres of 11 segments are too many, a scene has at most "
            "1000000 segments");
  for (const char* const value : {"0", "-1", ".nan", ".inf", "1e-7", "1001"}) {
    EXPECT_EQ(
        error(scene_text(line, "[stretch]", std::string("time_step: ") + value + "\n")),
        std::string("8: time_step is ") + value + ", it must be at least 1e-06 and at most 1000");
  }
  EXPECT_EQ(error(scene_text(line, "[stretch]", "max_strain: 0\n")),
            "8: max_strain is 0, it must be above 0 and at most 10");
}

}  // namespace
}  // namespace fiber
