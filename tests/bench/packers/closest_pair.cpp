// The closest pair of spheres in a periodic cube, whoever packed them:
//   closest_pair FILE EDGE
// reads x, y, z and diameter of each as doubles, and prints how many there are, their packing fraction, and
// the least distance of two centres in sums of their radii. It shares nothing with bernal.
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <fstream>
#include <numbers>
#include <vector>

namespace {

struct Ball {
  double x[3], diameter;
};

double squared_distance(const Ball& a, const Ball& b, double edge) {
  double sum = 0;
  for (int k = 0; k < 3; ++k) {
    const double d = a.x[k] - b.x[k];
    sum += std::pow(d - edge * std::round(d / edge), 2);
  }
  return sum;
}

}  // namespace

int main(int words, char** word) {
  if (words != 3) return 2;
  const double edge = std::strtod(word[2], nullptr);
  std::ifstream file(word[1], std::ios::binary);
  std::vector<Ball> balls;
  for (Ball ball; file.read(reinterpret_cast<char*>(&ball), sizeof ball);) balls.push_back(ball);
  if (balls.empty() || !(edge > 0)) return 1;

  double largest = 0, volume = 0;
  for (const Ball& ball : balls) {
    largest = std::max(largest, ball.diameter);
    volume += std::numbers::pi / 6 * ball.diameter * ball.diameter * ball.diameter;
  }
  const long cells = std::max(1L, static_cast<long>(edge / largest));  // none is smaller than a sphere
  const auto cell_of = [&](const Ball& ball, int k) {
    const double turns = ball.x[k] / edge;
    return std::min(cells - 1, static_cast<long>((turns - std::floor(turns)) * static_cast<double>(cells)));
  };
  std::vector<std::vector<const Ball*>> grid(static_cast<std::size_t>(cells * cells * cells));
  const auto at = [&](long i, long j, long k) -> std::vector<const Ball*>& {
    const auto wrapped = [&](long c) { return (c + cells) % cells; };
    return grid[static_cast<std::size_t>((wrapped(i) * cells + wrapped(j)) * cells + wrapped(k))];
  };
  for (const Ball& ball : balls) at(cell_of(ball, 0), cell_of(ball, 1), cell_of(ball, 2)).push_back(&ball);

  double least = 2;
  for (const Ball& ball : balls)
    for (long i = -1; i <= 1; ++i)
      for (long j = -1; j <= 1; ++j)
        for (long k = -1; k <= 1; ++k)
          for (const Ball* other : at(cell_of(ball, 0) + i, cell_of(ball, 1) + j, cell_of(ball, 2) + k))
            if (other != &ball)
              least = std::min(least, std::sqrt(squared_distance(ball, *other, edge)) * 2 /
                                          (ball.diameter + other->diameter));
  std::printf("spheres %zu\nphi %.6f\nclosest %.12f\n", balls.size(), volume / std::pow(edge, 3), least);
}
