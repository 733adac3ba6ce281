#include "app/geometry/grid_marks.h"

namespace pregrasp {

std::array<int, 3> NodeNear(const ScalarGrid& grid, const Vector3& p) {
  std::array<int, 3> at{};
  for (int k = 0; k < 3; ++k) {
    at[k] = static_cast<int>(std::clamp(std::lround((p[k] - grid.p_min[k]) / grid.cell), 0L,
                                        static_cast<long>(grid.count[k] - 1)));
  }
  return at;
}

std::array<std::size_t, 3> StepsOf(const ScalarGrid& grid) {
  const auto x = static_cast<std::size_t>(grid.count[0]);
  return {1, x, x * grid.count[1]};
}

bool IsFront(const ScalarGrid& grid, const GridMarks& marks, std::size_t at, std::uint8_t value) {
  if (marks[at] != value) return false;
  const std::array<std::size_t, 3> steps = StepsOf(grid);
  return std::any_of(steps.begin(), steps.end(), [&](std::size_t step) {
    return marks[at - step] != value || marks[at + step] != value;
  });
}

void FloodFromCorner(const ScalarGrid& grid, GridMarks& marks) {
  if (marks[0] != 0) return;
  std::vector<std::array<int, 3>> open{{0, 0, 0}};
  marks[0] = 2;
  while (!open.empty()) {
    const std::array<int, 3> at = open.back();
    open.pop_back();
    for (int k = 0; k < 3; ++k) {
      for (const int step : {-1, 1}) {
        std::array<int, 3> to = at;
        to[k] += step;
        if (to[k] < 0 || to[k] >= grid.count[k]) continue;
        std::uint8_t& there = marks[grid.Index(to[0], to[1], to[2])];
        if (there != 0) continue;
        there = 2;
        open.push_back(to);
      }
    }
  }
}

void SpreadMark(const ScalarGrid& grid, std::uint8_t value, double distance, GridMarks& marks) {
  if (distance <= 0.0) return;
  const GridMarks before = marks;
  VisitInner(grid, [&](int x, int y, int z) {
    if (!IsFront(grid, before, grid.Index(x, y, z), value)) return;
    VisitBall(grid, grid.Node(x, y, z), distance,
              [&](int i, int j, int k) { marks[grid.Index(i, j, k)] = value; });
  });
}

}  // namespace pregrasp
