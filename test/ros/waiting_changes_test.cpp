// In which order changes of the environment are made that wait for transforms, for their
// preparation, and for each other.
#include "src/ros/environment/waiting_changes.hpp"

#include <algorithm>
#include <memory>
#include <mutex>
#include <random>

#include "test/ros/environment_fixture.hpp"
#include "test/ros/gate.hpp"

namespace environment_test {
namespace {

using fiber_proximity_ros::Change;
using fiber_proximity_ros::Prepared;
using fiber_proximity_ros::TouchedObjects;
using fiber_proximity_ros::WaitingChanges;
using fiber_proximity_ros::Worker;
using Labels = std::vector<std::string>;

TouchedObjects touching(const std::set<std::string>& names) {
  TouchedObjects touched;
  for (const std::string& name : names) {
    touched.add(name);
  }
  return touched;
}

TouchedObjects removing(const std::string& name) {
  TouchedObjects touched;
  name.empty() ? touched.remove_all() : touched.remove(name);
  return touched;
}

class WaitingChangesTest : public EnvironmentFixture {
 protected:
  /// A change that notes its label when it is made, in a frame.
  Change change(const std::string& label, TouchedObjects touched, const std::string& in = "world",
                double patience = 1000.0) {
    return with(label, std::move(touched), in, patience, Prepared<Change::Apply>(made(label)));
  }

  /// The same, prepared by a worker.
  Change change(const std::string& label, TouchedObjects touched, Worker& worker) {
    return with(label, std::move(touched), "world", 1000.0,
                Prepared<Change::Apply>(made(label), &worker));
  }

  bool update_until(const std::function<bool()>& condition) {
    return node_test::wait_for([&] {
      changes_.update();
      return condition();
    });
  }

  WaitingChanges changes_{frame};
  std::mutex mutex_;
  Labels prepared_;  // by several workers
  Labels applied_;
  Labels refused_;
  Labels overtaken_;
  std::string reason_;

 private:
  Prepared<Change::Apply>::Make made(const std::string& label) {
    return [this, label]() -> Change::Apply {
      {
        const std::lock_guard<std::mutex> lock(mutex_);
        prepared_.push_back(label);
      }
      return [this, label](const Change::Poses& /*poses*/, const Change::Names& /*cancelled*/) {
        applied_.push_back(label);
      };
    };
  }

  Change with(const std::string& label, TouchedObjects touched, const std::string& in,
              double patience, Prepared<Change::Apply> apply) {
    Change change{std::move(touched),
                  {{label, test_messages::header(in)}},
                  std::move(apply),
                  patience,
                  {},
                  {}};
    change.on_end = [this, label](Change::End end, const std::string& reason) {
      if (end != Change::End::APPLIED) {
        (end == Change::End::REFUSED ? refused_ : overtaken_).push_back(label);
        reason_ = reason;
      }
    };
    return change;
  }
};

TEST_F(WaitingChangesTest, OneInAnUnknownFrameHoldsUpItsOwnObjectsOnly) {
  changes_.receive(change("x1", touching({"x"}), "late"));
  changes_.receive(change("y1", touching({"y"})));
  changes_.receive(change("x2", touching({"x"})));
  changes_.receive(change("xz", touching({"x", "z"})));
  changes_.receive(change("z1", touching({"z"})));
  changes_.receive(change("y2", touching({"y"})));
  EXPECT_TRUE(changes_.update());
  EXPECT_EQ(applied_, (Labels{"y1", "y2"}));
  EXPECT_FALSE(changes_.update());
  EXPECT_TRUE(changes_.is_waiting());
  static_transforms.sendTransform(transform("late", 1.0));
  ASSERT_TRUE(update_until([&] { return !changes_.is_waiting(); }));
  EXPECT_EQ(applied_, (Labels{"y1", "y2", "x1", "x2", "xz", "z1"}));
  EXPECT_EQ(refused_, Labels());
}

TEST_F(WaitingChangesTest, OneThatIsRefusedLetsThoseBehindItGoOn) {
  changes_.receive(change("x1", touching({"x"}), "moon", 0.0));
  changes_.receive(change("x2", touching({"x"})));
  EXPECT_TRUE(changes_.update());
  EXPECT_EQ(refused_, Labels{"x1"});
  EXPECT_EQ(reason_.rfind("x1: no transform from frame 'moon' to 'world'", 0), 0U) << reason_;
  EXPECT_EQ(applied_, Labels{"x2"});
}

TEST_F(WaitingChangesTest, OneWithoutPatienceWaitsForNoTransformOfAnother) {
  Worker worker;
  Gate gate(worker);
  changes_.receive(change("x1", touching({"x"}), "moon"));
  changes_.receive(change("y1", touching({"y"}), worker));
  changes_.receive(change("x2", touching({"x"}), "world", 0.0));
  changes_.receive(change("y2", touching({"y"}), "world", 0.0));
  EXPECT_FALSE(changes_.update());
  EXPECT_EQ(refused_, Labels{"x2"});
  EXPECT_EQ(reason_.rfind("x1: no transform from frame 'moon'", 0), 0U) << reason_;
  gate.open();
  ASSERT_TRUE(update_until([&] { return applied_.size() == 2; }));
  EXPECT_EQ(applied_, (Labels{"y1", "y2"}));
}

TEST_F(WaitingChangesTest, ARemovalOvertakesWhatItUndoes) {
  Worker worker;
  Gate gate(worker);
  changes_.receive(change("x", touching({"x"}), worker));
  changes_.receive(change("xy", touching({"x", "y"}), worker));
  changes_.receive(change("z", touching({"z"}), "moon"));
  changes_.receive(change("-x", removing("x")));  // y would still be there
  EXPECT_FALSE(changes_.update());
  changes_.receive(change("-z", removing("z")));
  EXPECT_TRUE(changes_.update());
  EXPECT_EQ(applied_, Labels{"-z"});
  EXPECT_EQ(overtaken_, Labels{"z"});
  changes_.receive(change("z2", touching({"z"})));
  EXPECT_TRUE(changes_.update());
  TouchedObjects all = removing("");
  all.add("x");
  changes_.receive(change("-all +x", all));
  changes_.receive(change("x3", touching({"x"})));
  EXPECT_TRUE(changes_.update());
  EXPECT_EQ(applied_, (Labels{"-z", "z2", "-all +x", "x3"}));
  EXPECT_EQ(overtaken_, (Labels{"z", "x", "xy", "-x"}));
  EXPECT_FALSE(changes_.is_waiting());
  // Nothing of what is overtaken is prepared any more.
  changes_.receive(change("last", touching({"x"}), worker));
  gate.open();
  ASSERT_TRUE(update_until([&] { return !changes_.is_waiting(); }));
  EXPECT_EQ(prepared_, (Labels{"z", "-x", "-z", "z2", "-all +x", "x3", "last"}));
  EXPECT_EQ(refused_, Labels());
}

TEST_F(WaitingChangesTest, NoMoreWaitThanMay) {
  for (std::size_t i = 0; i <= WaitingChanges::max_waiting; ++i) {
    changes_.receive(change(std::to_string(i), touching({std::to_string(i)}), "moon"));
  }
  EXPECT_EQ(refused_, Labels{std::to_string(WaitingChanges::max_waiting)});
  EXPECT_EQ(reason_, "1000 changes are waiting already");
}

/// A change behind its own gate.
struct Held {
  std::set<std::string> names;
  bool is_open = false;
  bool is_applied = false;
  Worker worker;
  Gate gate{worker};
};

bool is_blocked(const Held& change, const std::vector<std::unique_ptr<Held>>& all) {
  for (const std::unique_ptr<Held>& earlier : all) {
    if (earlier.get() == &change) {
      return false;
    }
    for (const std::string& name : change.names) {
      if (!earlier->is_applied && earlier->names.count(name) > 0) {
        return true;
      }
    }
  }
  return false;
}

// Whatever becomes ready when: exactly those changes are made that are ready and have no earlier
// one of one of their objects before them, and those of one object in their order.
TEST_F(WaitingChangesTest, RandomChangesKeepTheOrderOfEachObjectAndNoOther) {
  std::mt19937 random(20261122);
  for (int round = 0; round < 20; ++round) {
    applied_.clear();
    std::vector<std::unique_ptr<Held>> all;
    std::vector<std::size_t> order;
    for (std::size_t i = 0; i < 12; ++i) {
      all.push_back(std::make_unique<Held>());
      for (const char* name : {"a", "b", "c", "d", "e"}) {
        if (random() % 4 == 0) {
          all.back()->names.insert(name);
        }
      }
      order.push_back(i);
      changes_.receive(change(std::to_string(i), touching(all.back()->names), all.back()->worker));
    }
    std::shuffle(order.begin(), order.end(), random);
    std::size_t expected = 0;
    for (const std::size_t opened : order) {
      all[opened]->is_open = true;
      all[opened]->gate.open();
      for (const std::unique_ptr<Held>& held : all) {
        if (held->is_open && !held->is_applied && !is_blocked(*held, all)) {
          held->is_applied = true;
          ++expected;
        }
      }
      ASSERT_TRUE(update_until([&] { return applied_.size() >= expected; }));
      std::set<std::string> made(applied_.begin(), applied_.end());
      ASSERT_EQ(made.size(), expected);
      for (std::size_t i = 0; i < all.size(); ++i) {
        ASSERT_EQ(made.count(std::to_string(i)) > 0, all[i]->is_applied) << "change " << i;
      }
    }
    EXPECT_FALSE(changes_.is_waiting());
    std::map<std::string, int> newest;
    for (const std::string& label : applied_) {
      for (const std::string& name : all[std::stoul(label)]->names) {
        EXPECT_LT(newest.emplace(name, -1).first->second, std::stoi(label));
        newest[name] = std::stoi(label);
      }
    }
  }
}

}  // namespace
}  // namespace environment_test
