#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <string>
#include <vector>

#include "bernal/measure/contacts.hpp"
#include "support/folder.hpp"

// What another program counted in a packing of its own.
namespace bernal {
namespace published_contacts_test {

constexpr double edge = 20.0823593086113;

/// tests/published: x, y, z and diameter of each sphere as doubles.
Spheres<dynamic> baranau() {
  const std::filesystem::path file =
      std::filesystem::path(BERNAL_SOURCE) / "tests/published/baranau_10000.xyzd";
  std::ifstream in(file, std::ios::binary);
  Spheres<dynamic> spheres(3);
  double row[4];
  while (in.read(reinterpret_cast<char*>(row), sizeof row))
    spheres.push_back(Vector<3>(row[0], row[1], row[2]), 0.5 * row[3]);
  return spheres;
}

/// `contraction_energies.txt` of the same folder as the packing: radii divided by a ratio, spheres with fewer
/// than four contacts taken out one after the other, and the contacts of those left counted from both ends.
TEST(PublishedContacts, OfTenThousandSpheresAreThoseThatTheirAuthorCounted) {
  const Spheres<dynamic> spheres = baranau();
  ASSERT_EQ(spheres.size(), 10'000u);
  struct Row {
    double ratio;
    std::uint64_t ends, spheres;
  };
  const Row rows[] = {{0.98, 71310, 9978},  {0.982, 70522, 9973}, {0.984, 69646, 9968}, {0.986, 68726, 9963},
                      {0.988, 67840, 9955}, {0.99, 66790, 9942},  {0.992, 65740, 9931}, {0.994, 64446, 9913},
                      {0.996, 63036, 9894}, {0.998, 61178, 9866}, {0.999, 59618, 9831}};
  std::vector<double> gaps;
  for (const Row& row : rows) gaps.push_back(1 / row.ratio - 1);
  const std::vector<Contacts> counted =
      measure_contacts(spheres, periodic_box(Vector<3>::Constant(edge)), gaps);
  for (std::size_t k = 0; k < gaps.size(); ++k) {
    EXPECT_EQ(counted[k].backbone, rows[k].spheres) << rows[k].ratio;
    EXPECT_EQ(2 * counted[k].backbone_pairs, rows[k].ends) << rows[k].ratio;
  }
}

}  // namespace published_contacts_test
}  // namespace bernal
