// SPDX-License-Identifier: GPL-3.0-or-later
// Tests of the parts beneath cutting and packing: the linear solver of relaxation, and the search for free places in a
// grid.

#include <Eigen/Dense>
#include <gtest/gtest.h>
#include <random>

#include "atlas/block_cholesky.h"
#include "atlas/free_runs.h"
#include "atlas/place.h"

namespace kiln {
namespace test_atlas_solvers {

/// Lists the edges of a grid of squares, each with a diagonal, in random order and numbering.
struct GridGraph {
  std::size_t vertices;
  std::vector<BlockCholesky::Edge> edges;
};

GridGraph grid_graph(std::uint32_t side, std::mt19937& random) {
  std::vector<std::uint32_t> number(side * side);
  for (std::uint32_t v = 0; v < number.size(); ++v) number[v] = v;
  std::shuffle(number.begin(), number.end(), random);
  GridGraph graph{number.size(), {}};
  for (std::uint32_t y = 0; y < side; ++y)
    for (std::uint32_t x = 0; x < side; ++x) {
      const std::uint32_t v = y * side + x;
      if (x + 1 < side) graph.edges.emplace_back(number[v], number[v + 1]);
      if (y + 1 < side) graph.edges.emplace_back(number[v], number[v + side]);
      if (x + 1 < side && y + 1 < side) graph.edges.emplace_back(number[v], number[v + side + 1]);
    }
  std::shuffle(graph.edges.begin(), graph.edges.end(), random);
  return graph;
}

TEST(BlockCholesky, SolvesWhatADenseSolverSolves) {
  std::mt19937 random(3);
  std::uniform_real_distribution<double> number(-1, 1);
  const GridGraph graph = grid_graph(9, random);
  BlockCholesky solver(graph.vertices, graph.edges);
  for (int values = 0; values < 3; ++values) {  // one pattern, several matrices
    std::vector<SymmetricBlock> diagonal, off_diagonal;
    const auto size = static_cast<Eigen::Index>(2 * graph.vertices);
    Eigen::MatrixXd dense = Eigen::MatrixXd::Zero(size, size);
    const auto put = [&](std::uint32_t a, std::uint32_t b, const SymmetricBlock& block) {
      dense.block<2, 2>(2 * a, 2 * b) << block.xx, block.xy, block.xy, block.yy;
    };
    for (std::uint32_t v = 0; v < graph.vertices; ++v) {
      diagonal.push_back({14 + number(random), number(random), 14 + number(random)});  // dominates six neighbours
      put(v, v, diagonal.back());
    }
    for (const auto& [a, b] : graph.edges) {
      off_diagonal.push_back({number(random), number(random), number(random)});
      put(a, b, off_diagonal.back());
      put(b, a, off_diagonal.back());
    }
    std::vector<Eigen::Vector2d> right_side(graph.vertices);
    Eigen::VectorXd dense_right_side(size);
    for (std::size_t v = 0; v < graph.vertices; ++v) {
      right_side[v] = {number(random), number(random)};
      dense_right_side.segment<2>(2 * static_cast<Eigen::Index>(v)) = right_side[v];
    }
    ASSERT_TRUE(solver.factorise(diagonal, off_diagonal));
    const std::vector<Eigen::Vector2d> found = solver.solve(right_side);
    const Eigen::VectorXd expected = dense.ldlt().solve(dense_right_side);
    for (std::size_t v = 0; v < graph.vertices; ++v)  // a condition number of about 10 leaves all but two digits
      EXPECT_LT((found[v] - expected.segment<2>(2 * static_cast<Eigen::Index>(v))).norm(), 1e-13) << v;
  }
}

TEST(BlockCholesky, RefusesWhatIsNotPositiveDefinite) {
  BlockCholesky solver(2, {{0, 1}});
  const std::vector<SymmetricBlock> ones(2, {1, 0, 1});
  EXPECT_TRUE(solver.factorise(ones, {{0.5, 0, 0.5}}));
  EXPECT_FALSE(solver.factorise(ones, {{2, 0, 2}}));
  EXPECT_FALSE(solver.factorise({{1, 2, 1}, {1, 0, 1}}, {{0, 0, 0}}));
}

/// Makes a chart of one or two runs per row, unlike any rasterised one: no part of it is convex.
ChartBitmap ragged_bitmap(int width, int height, std::mt19937& random) {
  const auto pick = [&](int count) { return static_cast<int>(random() % static_cast<unsigned>(count)); };
  ChartBitmap bitmap;
  bitmap.width = width;
  bitmap.height = height;
  for (int row = 0; row < height; ++row) {
    const int middle = 1 + pick(width - 2), first = pick(middle), last = middle + 1 + pick(width - middle - 1);
    std::vector<TexelRun> runs = {{first, middle - 1}, {middle + 1, last}};
    if (row % 3 == 0) runs = {{0, width - 1}};
    for (const TexelRun& run : runs) {
      const int length = run.last - run.first + 1;
      bitmap.texels += length;
      if (length > bitmap.widest_run) bitmap.widest_run = length, bitmap.widest_row = row;
    }
    bitmap.rows.push_back(runs);
  }
  return bitmap;
}

TEST(Placer, FindsTheLowestThenLeftmostPlaceOfAll) {
  std::mt19937 random(5);
  // Wider than one word, than one span of places, and so wide that the lengths of runs grow fourfold.
  for (const int width : {50, 300, 700, 5000}) {
    const int height = 90, gutter = 2;
    std::vector<Shape> shapes;
    PlacePlan plan;
    for (std::uint32_t i = 0; i < 12; ++i) {
      const int chart_width = 4 + static_cast<int>(random() % static_cast<unsigned>(width / 3));
      shapes.push_back({ragged_bitmap(chart_width, 3 + static_cast<int>(random() % 12), random)});
      plan.order.push_back(i);
    }
    plan.objectives.assign(shapes.size(), Objective::top);
    plan.rotations.assign(shapes.size(), 0);
    Placer placer(shapes, width, height, gutter);
    ASSERT_TRUE(placer.place(plan, 0, height).fits()) << width;

    std::vector<std::uint8_t> blocked(static_cast<std::size_t>(width) * height, 0);
    const auto fits = [&](const ChartBitmap& bitmap, int x, int y) {
      for (int row = 0; row < bitmap.height; ++row)
        for (const TexelRun& run : bitmap.rows[row])
          for (int column = run.first; column <= run.last; ++column)
            if (blocked[static_cast<std::size_t>(y + row) * width + x + column]) return false;
      return true;
    };
    for (const std::uint32_t chart : plan.order) {
      const ChartBitmap& bitmap = shapes[chart][0];
      Spot expected{0, -1, -1};
      for (int y = gutter; expected.y < 0 && y + bitmap.height <= height - gutter; ++y)
        for (int x = gutter; expected.y < 0 && x + bitmap.width <= width - gutter; ++x)
          if (fits(bitmap, x, y)) expected = {0, x, y};
      const Spot& found = placer.spots()[chart];
      EXPECT_EQ(found.x, expected.x) << width << ' ' << chart;
      EXPECT_EQ(found.y, expected.y) << width << ' ' << chart;
      for (int row = 0; row < bitmap.height; ++row)
        for (const TexelRun& run : bitmap.rows[row])
          for (int y = found.y + row - gutter; y <= found.y + row + gutter; ++y)
            for (int x = found.x + run.first - gutter; x <= found.x + run.last + gutter; ++x)
              if (x >= 0 && x < width && y >= 0 && y < height) blocked[static_cast<std::size_t>(y) * width + x] = 1;
    }
  }
}

}  // namespace test_atlas_solvers
}  // namespace kiln
