#include "report/report.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "bernal/report/json.hpp"
#include "bernal/result/read_packing.hpp"
#include "bernal/result/write_packing.hpp"
#include "support/written_files.hpp"

namespace bernal {
namespace report_test {

using testing::example;
using testing::example_box;
using testing::Folder;
using testing::packing_of;
using testing::text_of;

TEST(CertificateJson, HasNullWhereThereIsNothing) {
  const auto json = nlohmann::json::parse(certificate_as_json(Certificate{}));
  EXPECT_EQ(json.at("certified"), false);
  EXPECT_TRUE(json.at("worst_pair").is_null());
  EXPECT_TRUE(json.at("worst_wall").is_null());
  EXPECT_TRUE(json.at("min_wall_gap").is_null());

  Certificate own;
  own.worst_pair = {4, 4};
  own.max_overlap = 0.5;
  own.worst_wall = 0;
  own.min_wall_gap = -0.25;
  const auto full = nlohmann::json::parse(certificate_as_json(own));
  EXPECT_EQ(full.at("worst_pair"), (std::vector<int>{4, 4}));
  EXPECT_EQ(full.at("max_overlap"), 0.5);
  EXPECT_EQ(full.at("worst_wall"), 0);
  EXPECT_EQ(full.at("min_wall_gap"), -0.25);
}

TEST(ReportJson, HasEveryKeyOfTheFormatWithTheRightType) {
  const Folder folder;
  Packing packing = example();
  packing.seed = 18446744073709551615u >> 1;
  packing.effects = {{"insertion", 12, 0.25}, {"collisions", 7, 0}};
  packing.history = {{"insert", 300, 0.1, 5, 0.2}};
  write_packing(packing, folder.path());
  const auto json = nlohmann::json::parse(text_of(folder / "report.json"));
  for (const char* key : {"phi", "coordination", "max_overlap", "min_wall_gap", "seconds", "contact_gap"}) {
    EXPECT_TRUE(json.at(key).is_number()) << key;
  }
  for (const char* key :
       {"seed", "threads", "n", "dimension", "contacts", "wall_contacts", "peak_memory_bytes"}) {
    EXPECT_TRUE(json.at(key).is_number_unsigned()) << key;
  }
  for (const char* key : {"version", "outcome", "reason", "unit", "hash"}) {
    EXPECT_TRUE(json.at(key).is_string()) << key;
  }
  for (const char* key : {"pairs_tested", "walls_tested", "centers_tested", "decided_double", "decided_exact",
                          "overlapping_pairs", "protruding_spheres", "worst_wall"}) {
    EXPECT_TRUE(json.at("certificate").at(key).is_number_unsigned()) << key;
  }
  EXPECT_TRUE(json.at("certificate").at("statement").is_string());
  EXPECT_TRUE(json.at("certificate").contains("worst_pair"));
  EXPECT_EQ(json.at("certified"), true);
  EXPECT_EQ(json.at("seed"), packing.seed);
  EXPECT_EQ(json.at("n"), packing.spheres.size());
  EXPECT_EQ(json.at("dimension"), 3);
  EXPECT_EQ(json.at("unit"), "mm");
  EXPECT_EQ(json.at("phi"), packing.packing_fraction());
  EXPECT_EQ(json.at("hash"), hash_of(packing.spheres));
  EXPECT_EQ(json.at("container").at("kind"), "box");
  EXPECT_EQ(json.at("container").at("volume"), 1000);
  EXPECT_EQ(json.at("container").at("bounds").at("upper"), (std::vector<double>{10, 10, 10}));
  EXPECT_EQ(json.at("effects").at(0),
            (nlohmann::json{{"name", "insertion"}, {"calls", 12}, {"seconds", 0.25}}));
  EXPECT_TRUE(json.at("effects").at(1).at("seconds").is_null()) << "only counted";
  EXPECT_EQ(json.at("history").at(0).at("stage"), "insert");
  EXPECT_GT(json.at("peak_memory_bytes"), 1'000'000);
}

TEST(ReportJson, NamesThePeriodsOfAContainerAndTheWallsOfABox) {
  Packing packing = example(1, 1);
  const auto written = [&] {
    return nlohmann::json::parse(json_of(Report{packing, Certificate{}, Measurements{}, nullptr, "0"}));
  };
  EXPECT_FALSE(written().at("container").contains("periods"));
  packing.domain = Cylinder{{0, 0, 1}, {0, 0, 2}, 3, 4, true};
  const auto column = written().at("container");
  EXPECT_EQ(column.at("kind"), "cylinder");
  EXPECT_EQ(column.at("periods"), (std::vector<double>{0, 0, 4}));
  EXPECT_EQ(column.at("bounds").at("lower"), (std::vector<double>{-3, -3, 1}));
  EXPECT_FALSE(written().contains("box"));
  packing.domain = periodic_box(Vector<3>(2, 3, 4), {false, true, false});
  EXPECT_EQ(written().at("box").at("edges"), (std::vector<double>{2, 3, 4}));
  EXPECT_EQ(written().at("box").at("walls"), std::vector<int>{1});
  EXPECT_FALSE(written().contains("container"));
}

TEST(CertificateJson, ListsWhatWasAskedFor) {
  Certificate certificate;
  certificate.allowed_overlap = 0.125;
  EXPECT_FALSE(nlohmann::json::parse(certificate_as_json(certificate)).contains("overlaps"));
  certificate.overlaps = {{{3, 7}, 0.5}, {{2, 2}, 0.25}};
  certificate.protrusions = {{9, -0.75}};
  const auto json = nlohmann::json::parse(certificate_as_json(certificate));
  EXPECT_EQ(json.at("allowed_overlap"), 0.125);
  EXPECT_EQ(json.at("overlaps"),
            nlohmann::json::parse(R"([{"pair": [3, 7], "ratio": 0.5}, {"pair": [2, 2], "ratio": 0.25}])"));
  EXPECT_EQ(json.at("protrusions"), nlohmann::json::parse(R"([{"sphere": 9, "gap": -0.75}])"));
}

TEST(Report, OfAPeriodicCylinderIsWrittenAndReadBack) {
  Packing packing = example(1, 0);
  packing.domain = Cylinder{{1, 2, 3}, {0, 0, 1}, 2, 4, true};
  packing.volume = volume_of(packing.domain);
  for (int k = 0; k < 4; ++k) packing.spheres.push_back(Vector<3>(1, 2, 4 + 5 * k), 0.5);
  wrap(packing.spheres, packing.domain);
  packing.history = {{"insert", 2, 0.1, 5, 0, 0.1}, {"compress", 4, 0.2, 4, 0, 0.2}};
  const Folder folder;
  const WrittenPacking written = write_packing(packing, folder.path());
  EXPECT_TRUE(written.certificate.certified) << written.certificate.statement;
  EXPECT_EQ(read_csv(folder / "spheres.csv").spheres, packing.spheres);
  for (const double z : packing.spheres.x[2]) EXPECT_TRUE(z >= 3 && z < 7) << z;
  const auto json = nlohmann::json::parse(text_of(folder / "report.json"));
  EXPECT_EQ(json.at("contacts"), 4);  // 1 apart, round the period
  EXPECT_EQ(json.at("wall_contacts"), 0);
  EXPECT_FALSE(json.at("walls").is_null());
  EXPECT_EQ(json.at("chambers").at("list").size(), 1u);
  const std::string html = text_of(folder / "report.html");
  for (const char* words :
       {"4 spheres in a periodic cylinder", "repeated without end along its axis", "container’s volume",
        "images in the neighbouring periods", "does this sphere cross", "The height is measured"})
    EXPECT_NE(html.find(words), std::string::npos) << words;
}

TEST(ReportJson, WritesWhatIsNotFiniteAsNullAndNoPairAsNull) {
  const Packing packing = example(1, 1);
  Certificate certificate;
  certificate.min_wall_gap = std::numeric_limits<double>::infinity();
  certificate.max_overlap = std::numeric_limits<double>::quiet_NaN();
  const Measurements measured;
  const auto json = nlohmann::json::parse(json_of(Report{packing, certificate, measured, nullptr, "0"}));
  EXPECT_TRUE(json.at("min_wall_gap").is_null());
  EXPECT_TRUE(json.at("max_overlap").is_null());
  EXPECT_TRUE(json.at("certificate").at("worst_pair").is_null());
  EXPECT_EQ(json.at("certified"), false);
}

TEST(ReportHtml, IsOnePageThatAsksForNothingElse) {
  Packing packing = example();
  packing.reason = "<script>alert(1)</script>";
  packing.effects = {{"a < b", 1, 1}};
  packing.history = {{"insert", 1, 0.1, 5, 0.1}, {"compress", 1, 0.2, 4, 0.2}, {"compress", 1, 0.2, 4, 0.2}};
  const Folder folder;
  write_packing(packing, folder.path(), {.view = false});
  const std::string html = text_of(folder / "report.html");
  for (const char* outside : {"<script", "<link", "<img", "<iframe", "src=", "href=", "@import", "https:"}) {
    EXPECT_EQ(html.find(outside), std::string::npos) << outside;
  }
  EXPECT_NE(html.find("a &lt; b"), std::string::npos);
  for (const char* picture : {"packing.svg", "section.svg"})
    EXPECT_NE(html.find(text_of(folder / picture)), std::string::npos) << picture;
  EXPECT_EQ(html.find("nan"), std::string::npos);
}

TEST(ReportHtml, ManagesWithoutSpheresWithOneAndWithClasses) {
  Spheres<3> one, two;
  one.push_back({5, 5, 5}, 1);
  two.push_back({2, 2, 2}, 1);
  two.push_back({7, 7, 7}, 2);
  for (const Spheres<3>& spheres : {Spheres<3>{}, one, two}) {
    const Folder folder;
    write_packing(packing_of(spheres, example_box), folder.path(), {.view = false});
    const std::string html = text_of(folder / "report.html");
    EXPECT_NE(html.find("</html>"), std::string::npos);
    EXPECT_EQ(html.find("nan"), std::string::npos);
    EXPECT_EQ(html.find("inf"), std::string::npos);
  }
}

TEST(ReportHtml, DrawsWhatHardlyVaries) {
  // A history that stands still up to rounding and radii that differ in their last bit: axes of no length.
  Packing packing = example();
  for (double& r : packing.spheres.r) r = 0.05;
  for (std::size_t i = 1; i < 30; ++i) packing.spheres.r[i] = std::nextafter(packing.spheres.r[i - 1], 1);
  packing.history = {{"insert", 1, 0.3, 1e9, 0},
                     {"insert", 1, std::nextafter(0.3, 1), 1e9, 0},
                     {"refill", 1, 0.3, std::nextafter(1e9, 0), 0}};
  const Folder folder;
  write_packing(packing, folder.path(), {.view = false});
  const std::string html = text_of(folder / "report.html");
  EXPECT_EQ(html.find("nan"), std::string::npos);
  EXPECT_LT(html.size(), 1'000'000u);
}

}  // namespace report_test
}  // namespace bernal
