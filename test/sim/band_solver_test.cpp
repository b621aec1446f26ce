#include <gtest/gtest.h>

#include <Eigen/Dense>

#include "src/sim/solver/pack_kernels.hpp"
#include "test/support/random.hpp"

namespace fiber::test {
namespace {

using Eigen::MatrixXd;
using Eigen::VectorXd;

class BandSolver : public testing::TestWithParam<std::size_t> {
 protected:
  std::size_t unknowns() const { return GetParam(); }
  std::size_t width() const { return half_bandwidth(unknowns()); }
  Eigen::Index size_of(std::size_t nodes) const {
    return static_cast<Eigen::Index>(nodes * unknowns());
  }

  /// A sum of squares of vectors that are nowhere longer than the band is wide.
  MatrixXd random_matrix(Random& random, Eigen::Index size) const {
    MatrixXd matrix = MatrixXd::Identity(size, size) * random.uniform(1e-3, 1.0);
    for (Eigen::Index first = 0; first < size; ++first) {
      const VectorXd part =
          random_vector(random, std::min(static_cast<Eigen::Index>(width()) + 1, size - first));
      matrix.block(first, first, part.size(), part.size()) += part * part.transpose();
    }
    return matrix;
  }

  static VectorXd random_vector(Random& random, Eigen::Index size) {
    VectorXd values(size);
    for (Eigen::Index i = 0; i < size; ++i) {
      values[i] = random.uniform(-1.0, 1.0);
    }
    return values;
  }

  PackSystem zeros(std::size_t nodes) const {
    PackSystem system;
    system.resize(nodes, unknowns());
    system.set_zero();
    return system;
  }

  void fill(PackSystem& system, std::size_t lane, const MatrixXd& matrix) const {
    RodSystem of_lane(system, lane);
    const auto size = static_cast<std::size_t>(matrix.rows());
    for (std::size_t c = 0; c < size; ++c) {
      for (std::size_t r = c; r < std::min(size, c + width() + 1); ++r) {
        of_lane.add_hessian_entry(
            r, c, matrix(static_cast<Eigen::Index>(r), static_cast<Eigen::Index>(c)));
      }
    }
  }

  /// One solution a lane.
  std::vector<VectorXd> solve(const PackSystem& system,
                              const std::vector<VectorXd>& right_hand_sides) const {
    std::vector<SimdBatch> values(system.size() + width());
    for (std::size_t lane = 0; lane < lane_count; ++lane) {
      for (std::size_t i = 0; i < system.size(); ++i) {
        values[i][lane] = right_hand_sides[lane][static_cast<Eigen::Index>(i)];
      }
    }
    solve_band(system, values.data());
    std::vector<VectorXd> solutions(lane_count, VectorXd(static_cast<Eigen::Index>(system.size())));
    for (std::size_t lane = 0; lane < lane_count; ++lane) {
      for (std::size_t i = 0; i < system.size(); ++i) {
        solutions[lane][static_cast<Eigen::Index>(i)] = values[i][lane];
      }
    }
    return solutions;
  }
};

TEST_P(BandSolver, SolvesInEachLaneAsEigenDoes) {
  SCOPED_TRACE(seed_message());
  Random random(GetParam());
  for (int round = 0; round < 200; ++round) {
    const auto nodes = static_cast<std::size_t>(random.integer(1, 20));
    PackSystem system = zeros(nodes);
    std::vector<MatrixXd> matrices;
    std::vector<VectorXd> right_hand_sides;
    for (std::size_t lane = 0; lane < lane_count; ++lane) {
      matrices.push_back(random_matrix(random, size_of(nodes)));
      right_hand_sides.push_back(random_vector(random, size_of(nodes)));
      fill(system, lane, matrices.back());
    }
    factorise_band(system);
    const std::vector<VectorXd> found = solve(system, right_hand_sides);
    for (std::size_t lane = 0; lane < lane_count; ++lane) {
      const VectorXd expected = matrices[lane].ldlt().solve(right_hand_sides[lane]);
      ASSERT_LE((found[lane] - expected).norm(), 1e-10 * expected.norm())
          << nodes << " nodes, lane " << lane;
    }
  }
}

TEST_P(BandSolver, HasPositiveDefiniteFactorsOfWhatIsNot) {
  SCOPED_TRACE(seed_message());
  Random random(20 + GetParam());
  constexpr std::size_t nodes = 8;
  for (const Eigen::Index at : {0, 5, 23}) {
    MatrixXd matrix = random_matrix(random, size_of(nodes));
    matrix(at, at) = -1e-3;
    PackSystem system = zeros(nodes);
    fill(system, 1, matrix);  // beside matrices of zeros
    factorise_band(system);
    const VectorXd right_hand_side = random_vector(random, size_of(nodes));
    const std::vector<VectorXd> right_hand_sides(lane_count, right_hand_side);
    const std::vector<VectorXd> found = solve(system, right_hand_sides);
    EXPECT_TRUE(found[1].allFinite());
    EXPECT_GT(found[1].dot(right_hand_side), 0.0) << "it leads down";
    EXPECT_TRUE(found[0].allFinite());
    EXPECT_LT(found[0].norm(), 1e-100) << "nothing moves";
  }
}

TEST_P(BandSolver, CanBeFilledAgain) {
  SCOPED_TRACE(seed_message());
  Random random(30 + GetParam());
  constexpr std::size_t nodes = 7;
  const MatrixXd matrix = random_matrix(random, size_of(nodes));
  const VectorXd right_hand_side = random_vector(random, size_of(nodes));
  PackSystem system = zeros(nodes);
  for (std::size_t lane = 0; lane < lane_count; ++lane) {
    fill(system, lane, matrix);
  }
  factorise_band(system);
  system.set_zero();
  for (std::size_t lane = 0; lane < lane_count; ++lane) {
    fill(system, lane, 2.0 * MatrixXd::Identity(size_of(nodes), size_of(nodes)));
  }
  factorise_band(system);
  const std::vector<VectorXd> right_hand_sides(lane_count, right_hand_side);
  EXPECT_EQ(solve(system, right_hand_sides)[2], 0.5 * right_hand_side);
}

INSTANTIATE_TEST_SUITE_P(Unknowns, BandSolver, testing::Values(3, 4),
                         [](const auto& unknowns) { return std::to_string(unknowns.param); });

}  // namespace
}  // namespace fiber::test
