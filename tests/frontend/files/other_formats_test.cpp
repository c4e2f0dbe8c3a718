// Files of other formats are named for what they are.
#include "frontend/files/other_formats.hpp"

#include <gtest/gtest.h>

#include <string>

#include "frontend/input/read_scene.hpp"
#include "tests/support/gzip.hpp"
#include "tests/support/reading.hpp"

namespace grelha {
namespace {

using test::kView;
using test::message_of;
using test::TemporaryFolder;
using std::string_literals::operator""s;

struct Other {
  const char* what;
  std::string text, name;
};

const std::string kMeshAdvice = ": convert it to PLY";

const std::vector<Other> kOthers{
    {"OBJ", "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n", "a Wavefront OBJ mesh" + kMeshAdvice},
    {"OBJ behind comments",
     "# Blender\n\nmtllib cube.mtl\no Cube\nv 1.0 1.0 -1.0\n",
     "a Wavefront OBJ mesh" + kMeshAdvice},
    {"OFF", "OFF\n8 6 12\n0 0 0\n", "an OFF mesh" + kMeshAdvice},
    {"OFF behind a comment", "# made\nNOFF 3 1 0\n", "an OFF mesh" + kMeshAdvice},
    {"glTF", "{\n \"asset\": {\"version\": \"2.0\"}\n}", "a glTF scene" + kMeshAdvice},
    {"binary glTF", "glTF\2\0\0\0"s, "a binary glTF scene" + kMeshAdvice},
    {"PCD", "# .PCD v.7 - Point Cloud Data\nVERSION .7\n", "a PCD point cloud" + kMeshAdvice},
    {"JSON", "{\"a\": 1}", "JSON"},
    {"COLLADA", "<?xml version=\"1.0\"?>\n<COLLADA>\n", "XML or a web page"},
    {"a page that came in place of a file", "<!DOCTYPE html>\n<html>404", "XML or a web page"},
    {"a picture", "\x89PNG\r\n\x1a\n", "a PNG picture"},
    {"an archive", "PK\3\4", "a ZIP archive: unpack it"},
    {"what Windows calls Unicode", "\xFF\xFE"s + "b\0 \0"s, "UTF-16 text: save it as UTF-8"},
};

TEST(OtherFormats, AreNamed) {
  const TemporaryFolder folder;
  for (const Other& other : kOthers)
    for (const std::string& text : {other.text, test::gzip(other.text)}) {
      const std::string scene = folder.add("scene.nff", text), mesh = folder.add("mesh.ply", text);
      const std::string found = ", found " + other.name;
      EXPECT_EQ(message_of([&] { read_scene(scene, nullptr); }),
                scene + ":1:1: error: expected NFF, PLY or STL" + found)
          << other.what;
      EXPECT_EQ(message_of([&] { read_scene(mesh, nullptr); }),
                mesh + ":1:1: error: expected PLY" + found)
          << other.what;
      folder.add("scene.nff", kView + "ply mesh.ply");
      EXPECT_EQ(message_of([&] { read_scene(scene, nullptr); }),
                mesh + ":1:1: error: expected PLY" + found)
          << other.what;
    }
}

TEST(OtherFormats, StlUnderTheNameOfPly) {
  const TemporaryFolder folder;
  const std::string mesh = folder.add(
      "mesh.ply", "solid cube\n  facet normal 0 0 1\n    outer loop\n      vertex 0 0 0\n");
  EXPECT_EQ(message_of([&] { read_scene(mesh, nullptr); }),
            mesh + ":1:1: error: expected PLY, found an STL mesh: give it a name ending in .stl");
}

TEST(OtherFormats, AreNoneOfOurs) {
  for (const std::string& text : {"v\nfrom 0 0 1\nat 0 0 0\n"s,
                                  "# v 1 2 3\nv from 0 0 1\n"s,
                                  "s 0 0 0 1\nf 1 1 1\nv\nfrom 0 0 1\n"s,
                                  "f 1 .5 .2 1 0 0 0 1\n"s,
                                  "solid ground\nb 0 0 0\n"s,
                                  "OFFSET 1\n"s,
                                  std::string(200, '1'),
                                  std::string(200, '\n'),
                                  std::string(200, '\0'),
                                  "ply\nformat ascii 1.0\n"s,
                                  ""s})
    EXPECT_EQ(other_format(text), "") << text.substr(0, 40);
}

/// A file with the name of a scene that begins as PLY does is a mesh.
TEST(OtherFormats, AMeshIsOneByAnyName) {
  const TemporaryFolder folder;
  const std::string mesh = test::kAsciiTriangle + "0 0 0\n1 0 0\n0 1 0\n3 0 1 2\n3 0 1 2\n";
  for (const char* name : {"mesh.nff", "mesh.p3f", "mesh"}) {
    EXPECT_EQ(read_scene(folder.add(name, mesh), nullptr).counts.ply, 2u) << name;
    EXPECT_EQ(read_scene(folder.add(name, "\xEF\xBB\xBF" + mesh), nullptr).counts.ply, 2u) << name;
  }
}

}  // namespace
}  // namespace grelha
