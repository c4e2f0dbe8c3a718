// Every file of the table beside the project gives the counts the table states.
#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <map>
#include <optional>
#include <regex>
#include <string>
#include <vector>

#include "frontend/input/read_scene.hpp"

namespace grelha {
namespace {

namespace fs = std::filesystem;
const fs::path kFolder = GRELHA_SHARED_SCENES;

struct Row {
  std::string file, content, lights, resolution;
};

std::vector<std::string> cells(const std::string& line) {
  std::vector<std::string> found;
  const std::regex cell(R"(\s*(.*?)\s*\|)");
  for (std::sregex_iterator it(line.begin() + 1, line.end(), cell), end; it != end; ++it)
    found.push_back((*it)[1]);
  return found;
}

std::vector<Row> table() {
  std::vector<Row> rows;
  std::ifstream readme(kFolder / "README.md");
  for (std::string line; std::getline(readme, line);) {
    if (!line.starts_with("| ") || line.find('/') == std::string::npos)
      continue;
    const std::vector<std::string> c = cells(line);
    if (c.size() >= 7)
      rows.push_back({c[0], c[3], c[4], c[5]});
  }
  return rows;
}

std::uint64_t number_behind(const std::string& text, const std::string& name) {
  std::smatch match;
  if (!std::regex_search(text, match, std::regex("(?:^|[ ,;])" + name + " (\\d+)")))
    return 0;
  return std::stoull(match[1]);
}

std::uint64_t faces_named_by(const fs::path& scene,
                             const std::map<std::string, std::uint64_t>& faces) {
  std::uint64_t sum = 0;
  std::ifstream text(scene);
  for (std::string word; text >> word;) {
    if (word != "ply" || !(text >> word))
      continue;
    sum += faces.at(fs::relative(scene.parent_path() / word, kFolder).generic_string());
  }
  return sum;
}

EntityCounts expected_counts(const Row& row, const std::map<std::string, std::uint64_t>& faces) {
  EntityCounts expected;
  if (row.file.ends_with(".ply")) {
    expected.ply = number_behind(row.content, "face");
    return expected;
  }
  const std::string& text = row.content;
  expected = {.s = number_behind(text, "s"),
              .p = number_behind(text, "p"),
              .pp = number_behind(text, "pp"),
              .c = number_behind(text, "c"),
              .pl = number_behind(text, "pl"),
              .box = number_behind(text, "box"),
              .lights = std::stoull(row.lights),
              .materials = number_behind(text, "materials")};
  std::smatch mesh;
  if (std::regex_search(text, mesh, std::regex(R"(mesh \d+ \(\d+ vertices (\d+) faces\))")))
    expected.mesh = std::stoull(mesh[1]);
  if (number_behind(text, "ply") > 0)
    expected.ply = faces_named_by(kFolder / row.file, faces);
  return expected;
}

std::string printed(const EntityCounts& c) {
  std::string text;
  for (const std::uint64_t n :
       {c.s, c.p, c.pp, c.c, c.pl, c.box, c.mesh, c.ply, c.lights, c.materials})
    text += std::to_string(n) + ' ';
  return text;
}

TEST(RealScenes, HoldWhatTheirTableSays) {
  if (!fs::exists(kFolder / "README.md"))
    GTEST_SKIP() << "no real scenes at " << kFolder;
  const std::vector<Row> rows = table();
  ASSERT_GE(rows.size(), 80u);
  std::map<std::string, std::uint64_t> faces;
  for (const Row& row : rows)
    if (row.file.ends_with(".ply"))
      faces[row.file] = number_behind(row.content, "face");
  for (const Row& row : rows) {
    SCOPED_TRACE(row.file);
    SceneFile file;
    ASSERT_NO_THROW(file = read_scene((kFolder / row.file).string(), nullptr));
    EXPECT_EQ(printed(file.counts), printed(expected_counts(row, faces)))
        << "order: s p pp c pl box mesh ply lights materials";
    EXPECT_EQ(file.dropped.not_finite, 0u);
    if (row.file.ends_with(".ply"))
      EXPECT_TRUE(file.default_camera && file.default_light);
    else
      EXPECT_EQ(std::to_string(file.camera.width) + 'x' + std::to_string(file.camera.height),
                row.resolution);
  }
}

TEST(RealScenes, EveryIndexOfEveryArrayIsInRange) {
  if (!fs::exists(kFolder / "README.md"))
    GTEST_SKIP() << "no real scenes at " << kFolder;
  for (const Row& row : table()) {
    SCOPED_TRACE(row.file);
    const SceneFile file = read_scene((kFolder / row.file).string(), nullptr);
    const Triangles& t = file.scene.geometry.triangles;
    EXPECT_TRUE(t.nx.empty() || t.nx.size() == t.vertex_count());
    bool sound = true;
    for (std::size_t i = 0; i < t.size(); ++i)
      sound = sound && t.a[i] < t.vertex_count() && t.b[i] < t.vertex_count() &&
              t.c[i] < t.vertex_count() && t.material[i] < file.scene.materials.size();
    EXPECT_TRUE(sound);
  }
}

}  // namespace
}  // namespace grelha
