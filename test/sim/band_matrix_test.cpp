#include "fiber_proximity/sim/band_matrix.hpp"

#include <gtest/gtest.h>

#include <Eigen/Dense>

#include "support/random.hpp"

namespace fiber::test {
namespace {

using Eigen::MatrixXd;
using Eigen::VectorXd;

class BandMatrixTest : public testing::TestWithParam<std::size_t> {
 protected:
  /// A sum of squares of vectors that are nowhere longer than the band is wide.
  static MatrixXd random_matrix(Random& random, Eigen::Index size, Eigen::Index width) {
    MatrixXd matrix = MatrixXd::Identity(size, size) * random.uniform(1e-3, 1.0);
    for (Eigen::Index first = 0; first < size; ++first) {
      const Eigen::Index count = std::min(width + 1, size - first);
      VectorXd part(count);
      for (double& x : part) {
        x = random.uniform(-1.0, 1.0);
      }
      matrix.block(first, first, count, count) += part * part.transpose();
    }
    return matrix;
  }

  static BandMatrix band_of(const MatrixXd& matrix, std::size_t width) {
    const auto size = static_cast<std::size_t>(matrix.rows());
    BandMatrix band(size, width);
    for (std::size_t c = 0; c < size; ++c) {
      for (std::size_t r = c; r < std::min(size, c + width + 1); ++r) {
        band.at(r, c) = matrix(static_cast<Eigen::Index>(r), static_cast<Eigen::Index>(c));
      }
    }
    return band;
  }

  static VectorXd solve(const BandMatrix& band, const VectorXd& right_hand_side) {
    VectorXd values =
        VectorXd::Zero(right_hand_side.size() + static_cast<Eigen::Index>(band.half_bandwidth()));
    values.head(right_hand_side.size()) = right_hand_side;
    band.solve(values.data());
    return values.head(right_hand_side.size());
  }

  static VectorXd random_vector(Random& random, Eigen::Index size) {
    VectorXd values(size);
    for (double& x : values) {
      x = random.uniform(-1.0, 1.0);
    }
    return values;
  }
};

TEST_P(BandMatrixTest, SolvesAsEigenDoes) {
  SCOPED_TRACE(seed_message());
  Random random(GetParam());
  for (int round = 0; round < 200; ++round) {
    const Eigen::Index size = random.integer(1, 60);
    const MatrixXd matrix = random_matrix(random, size, static_cast<Eigen::Index>(GetParam()));
    const VectorXd right_hand_side = random_vector(random, size);
    BandMatrix band = band_of(matrix, GetParam());
    ASSERT_TRUE(band.factorise());
    const VectorXd expected = matrix.ldlt().solve(right_hand_side);
    const VectorXd found = solve(band, right_hand_side);
    ASSERT_LE((found - expected).norm(), 1e-10 * expected.norm()) << "size " << size;
  }
}

TEST_P(BandMatrixTest, SolvesForTheRestWhereUnknownsAreDecoupled) {
  SCOPED_TRACE(seed_message());
  Random random(10 + GetParam());
  for (int round = 0; round < 200; ++round) {
    const Eigen::Index size = random.integer(1, 60);
    MatrixXd matrix = random_matrix(random, size, static_cast<Eigen::Index>(GetParam()));
    const VectorXd right_hand_side = random_vector(random, size);
    BandMatrix band = band_of(matrix, GetParam());
    for (Eigen::Index i = random.integer(0, 3); i < size; i += random.integer(1, 20)) {
      band.decouple(static_cast<std::size_t>(i));
      matrix.row(i).setZero();
      matrix.col(i).setZero();
      matrix(i, i) = 1.0;
    }
    ASSERT_TRUE(band.factorise());
    const VectorXd expected = matrix.ldlt().solve(right_hand_side);
    ASSERT_LE((solve(band, right_hand_side) - expected).norm(), 1e-10 * expected.norm());
  }
}

TEST_P(BandMatrixTest, SaysWhenItIsNotPositiveDefinite) {
  Random random(20 + GetParam());
  for (const Eigen::Index at : {0, 5, 29}) {
    MatrixXd matrix = random_matrix(random, 30, static_cast<Eigen::Index>(GetParam()));
    matrix(at, at) = -1e-3;
    BandMatrix band = band_of(matrix, GetParam());
    EXPECT_FALSE(band.factorise());
  }
  BandMatrix zero(4, GetParam());
  EXPECT_FALSE(zero.factorise());
}

TEST_P(BandMatrixTest, CanBeFilledAgain) {
  Random random(30 + GetParam());
  const MatrixXd matrix = random_matrix(random, 20, static_cast<Eigen::Index>(GetParam()));
  const VectorXd right_hand_side = random_vector(random, 20);
  BandMatrix band = band_of(matrix, GetParam());
  ASSERT_TRUE(band.factorise());
  band.set_zero();
  for (std::size_t i = 0; i < band.size(); ++i) {
    band.at(i, i) = 2.0;
  }
  ASSERT_TRUE(band.factorise());
  EXPECT_EQ(solve(band, right_hand_side), 0.5 * right_hand_side);
}

INSTANTIATE_TEST_SUITE_P(Widths, BandMatrixTest,
                         testing::Values(BandMatrix::without_twist, BandMatrix::with_twist),
                         [](const auto& width) { return std::to_string(width.param); });

}  // namespace
}  // namespace fiber::test
