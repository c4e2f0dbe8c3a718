// Tests the exact error message for each kind of broken file.
#include <gtest/gtest.h>

#include <string>
#include <vector>

#include "frontend/input/read_scene.hpp"
#include "frontend/files/text.hpp"
#include "frontend/ply/mesh_file.hpp"
#include "tests/support/reading.hpp"

namespace grelha {
namespace {

using test::kView;
using test::message_of;
using test::TemporaryFolder;

struct Case {
  std::string text, message;
};

void expect_messages(const std::string& name, const std::vector<Case>& cases) {
  const TemporaryFolder folder;
  const std::string start = (folder.path() / name).string();
  for (const Case& c : cases) {
    folder.add(name, c.text);
    const std::string message = message_of([&] { read_scene(start, nullptr); });
    EXPECT_EQ(message, start + c.message) << c.text.substr(0, 300);
    EXPECT_EQ(message.find('\n'), std::string::npos);
  }
}

/// Of scenes that begin with a view of seven lines.
void expect_after_view(std::vector<Case> cases) {
  for (Case& c : cases)
    c.text = kView + c.text;
  expect_messages("scene.nff", cases);
}

const std::vector<Case> kEntities{
    {"s 1 2 3 x", ":8:9: error: expected a number for the sphere's radius, found \"x\""},
    {"s 1 2", ":8:6: error: expected a number for the sphere's center, found end of file"},
    {"s 1 2 3 \n", ":9:1: error: expected a number for the sphere's radius, found end of file"},
    {"# s\n  s 1 2 # 3\ns", ":10:1: error: expected a number for the sphere's center, found \"s\""},
    {"b 0.0780.3610.753",
     ":8:3: error: expected a number for the background's color, found \"0.0780.3610.753\""},
    {"b 1 nan 0",
     ":8:5: error: expected a finite number, at most 1e18, for the background's color, found "
     "\"nan\""},
    {"c 0 0 0 1 0 0 1 ?",
     ":8:17: error: expected a number for the cone's apex radius, found \"?\""},
    {"c 0 0 0 z", ":8:9: error: expected a number for the cone's base radius, found \"z\""},
    {"p 2\n0 0 0\n1 1 1", ":8:3: error: expected at least 3 corners of a polygon, found \"2\""},
    {"p x", ":8:3: error: expected a whole number for the polygon's corners, found \"x\""},
    {"p -3 0 0 0", ":8:3: error: expected a whole number for the polygon's corners, found \"-3\""},
    {"p 3.5 0 0 0",
     ":8:3: error: expected a whole number for the polygon's corners, found \"3.5\""},
    {"p 1000000000 0 0 0",
     ":8:3: error: expected at most 1 for the polygon's corners (the file ends before), "
     "found \"1000000000\""},
    {"p 99999999999999999999 0 0 0",
     ":8:3: error: expected at most 1 for the polygon's corners (the file ends before), "
     "found \"99999999999999999999\""},
    {"p 3 0 0 0 1 1 1 2.0000 s",
     ":8:24: error: expected a number for the polygon's corner, found \"s\""},
    {"pp 3 0 0 0 0 0 1 1 0 0 0 0 1 0 1 0 0 0 q",
     ":8:40: error: expected a number for the corner's normal, found \"q\""},
    {"pl 0 0 0 1 0 0 s",
     ":8:16: error: expected a number for the plane's third point, found \"s\""},
    {"npl 0 0 1 s", ":8:11: error: expected a number for the plane's constant, found \"s\""},
    {"box 0 0 0 1 0",
     ":8:14: error: expected a number for the box's second corner, found end of file"},
    {"mesh 3 1\n0 0 0 1 0 0 0 1 0\n1 2 4",
     ":10:5: error: expected a vertex of the mesh, from 1 to 3 or -3 to -1, found \"4\""},
    {"mesh 3 1\n0 0 0 1 0 0 0 1 0\n1 2 0",
     ":10:5: error: expected a vertex of the mesh, from 1 to 3 or -3 to -1, found \"0\""},
    {"mesh 3 999999999999\n0 0 0 1 0 0 0 1 0\n",
     ":8:8: error: expected at most 3 for the mesh's faces (the file ends before), found "
     "\"999999999999\""},
    {"spp x",
     ":8:5: error: expected a whole number of samples per pixel, from 0 to 65536, found "
     "\"x\""},
    {std::string("ply a\0b.ply\n", 12),
     ":8:5: error: expected a file name after \"ply\", found \"a?b.ply\""},
    {"ply # none\n", ":8:5: error: expected a file name after \"ply\", found end of line"},
};

TEST(Errors, Entities) {
  expect_after_view(kEntities);
}

const std::vector<Case> kMaterialsAndLights{
    {"f 1 1\ns 0 0 0 1",
     ":9:1: error: expected a number for the material (field 3 of 3), found \"s\""},
    {"f 1 1 1 1 0 1 .5 0",
     ":8:18: error: expected an index of refraction above 0 for a material that transmits "
     "light, found \"0\""},
    {"f 1 1 1 1 1 1 1 1 0 .5 -1",
     ":8:24: error: expected an index of refraction above 0 for a material that transmits "
     "light, found \"-1\""},
    {"f 1 1 1 1 inf 1 0 1",
     ":8:11: error: expected a finite number, at most 1e18, for the material, found \"inf\""},
    {"f 1 1 1 1 0.1.2 1 0 1", ":8:11: error: expected a number for the material, found \"0.1.2\""},
    {"mat 1 1 1 1 0 1 0 1",
     ":8:20: error: expected a number for the material (field 9 of 11), found end of file"},
    {"l 0 0", ":8:6: error: expected a number for the light's position, found end of file"},
    {"l 0 0 0 1 1\n1", ":8:12: error: expected a number for the light's color, found end of line"},
    {"l 0 0 0 1 1 x\n", ":8:13: error: expected a number for the light's color, found \"x\""},
    {"light 0 0 0 1 1 1",
     ":8:7: error: expected \"punctual\" or \"quad\" after \"light\", found \"0\""},
    {"light quad 0 0 0 1 1 1 1 0 0 0 1 0 x",
     ":8:36: error: expected a whole number, at most 1000000, for the light's samples, found "
     "\"x\""},
    {"al 0 0 0 1 1 1",
     ":8:15: error: expected a number for the area light (field 7 of 11 or 12), found end of "
     "file"},
};

TEST(Errors, MaterialsAndLights) {
  expect_after_view(kMaterialsAndLights);
}

std::string view(
    const char* from, const char* at, const char* up, const char* angle, const char* resolution) {
  return std::string("v\nfrom ") + from + "\nat " + at + "\nup " + up + "\nangle " + angle +
         "\nhither 1\nresolution " + resolution + '\n';
}

TEST(Errors, Views) {
  expect_messages(
      "scene.p3f",
      {
          {"s 0 0 0 1\n", ":2:1: error: expected a view (\"v\" or \"camera\"), found end of file"},
          {" \n", ":2:1: error: expected a view (\"v\" or \"camera\"), found end of file"},
          {"v\nfrom 0 0 1\nat 0 0 0\nup 0 1 0\n",
           ":1:1: error: expected \"angle\" in the view, found none"},
          {"\n  camera\neye 0 0 1\nangle 45\nup 0 1 0\n",
           ":2:3: error: expected \"at\" in the view, found none"},
          {view("0 0 5", "0 0 5", "0 1 0", "45", "8 8"),
           ":3:1: error: expected a point to look at apart from the eye, found the same point"},
          {view("0 0 5", "0 0 0", "0 0 0", "45", "8 8"),
           ":4:1: error: expected an up direction, found 0 0 0"},
          {view("0 0 5", "0 0 0", "0 0 -2", "45", "8 8"),
           ":4:1: error: expected an up direction that is not along the view, found one that is"},
          {view("0 0 5", "0 0 0", "0 1 0", "0", "8 8"),
           ":5:7: error: expected an angle between 0 and 180 degrees, found \"0\""},
          {view("0 0 5", "0 0 0", "0 1 0", "180", "8 8"),
           ":5:7: error: expected an angle between 0 and 180 degrees, found \"180\""},
          {view("0 0 5", "0 0 0", "0 1 0", "nan", "8 8"),
           ":5:7: error: expected an angle between 0 and 180 degrees, found \"nan\""},
          {view("0 0 5", "0 0 0", "0 1 0", "wide", "8 8"),
           ":5:7: error: expected a number for the view's angle, found \"wide\""},
          {view("0 0 5", "0 0 0", "0 1 0", "45", "0 8"),
           ":7:12: error: expected a resolution from 1 to 65536 pixels a side, found \"0\""},
          {view("0 0 5", "0 0 0", "0 1 0", "45", "8 65537"),
           ":7:14: error: expected a resolution from 1 to 65536 pixels a side, found \"65537\""},
          {view("0 0 5", "0 0 0", "0 1 0", "45", "8.5 8"),
           ":7:12: error: expected a resolution from 1 to 65536 pixels a side, found \"8.5\""},
          {view("0 inf 5", "0 0 0", "0 1 0", "45", "8 8"),
           ":2:8: error: expected a finite number, at most 1e18, for the view's eye, found "
           "\"inf\""},
          {"v\nfrom 0 0", ":2:9: error: expected a number for the view's eye, found end of file"},
      });
}

TEST(Errors, LinesAreCountedByAnyEnd) {
  expect_messages("scene.nff",
                  {{"b 0 0 0\r\n\rs\r\n\r\n 1 2 x",
                    ":5:6: error: expected a number for the sphere's center, found \"x\""}});
}

TEST(Errors, WhatIsNoScene) {
  expect_messages(
      "scene.nff",
      {
          {"", ":1:1: error: expected a scene, found an empty file"},
          {"version https://git-lfs.github.com/spec/v1\noid sha256:00\nsize 3\n",
           ":1:1: error: expected a scene, found a Git LFS pointer: the file it stands for was not "
           "downloaded"},
          {"nff\nversion 2.1\n",
           ":1:1: error: expected Haines' Neutral File Format, found Sense8's (WorldToolKit) NFF"},
      });
  expect_messages("mesh.ply",
                  {
                      {"", ":1:1: error: expected a scene, found an empty file"},
                      {"version https://git-lfs.github.com/spec/v1\n",
                       ":1:1: error: expected a scene, found a Git LFS pointer: the file it stands "
                       "for was not downloaded"},
                  });
}

TEST(Errors, FilesThatAreNotThere) {
  const TemporaryFolder folder;
  const std::string scene = folder.add("scene.nff", kView + "ply none.ply\n"),
                    mesh = (folder.path() / "none.ply").string();
  EXPECT_EQ(message_of([&] { read_scene(scene, nullptr); }),
            mesh + ": error: cannot open: No such file or directory (named at " + scene + ":8:5)");
  EXPECT_THROW(read_scene(scene, nullptr), FileError);
}

/// A scene stands in home/, a mesh beside it and another outside; every way out is refused before
/// anything is opened.
TEST(Errors, AScenesMeshesLieInItsFolder) {
  namespace fs = std::filesystem;
  const TemporaryFolder folder;
  const std::string mesh =
      "ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\nproperty float y\nproperty float "
      "z\n"
      "element face 1\nproperty list uchar int vertex_indices\nend_header\n0 0 0\n1 0 0\n0 1 0\n3 "
      "0 1 2\n";
  const fs::path home = folder.path() / "home", other = folder.path() / "home2";
  fs::create_directories(home / "sub");
  fs::create_directory(other);
  folder.add("home/mesh.ply", mesh);
  folder.add("home/sub/mesh.ply", mesh);
  folder.add("home2/mesh.ply", mesh);
  fs::create_symlink("../home2/mesh.ply", home / "link.ply");
  fs::create_directory_symlink(other, home / "door");
  fs::create_symlink("sub/mesh.ply", home / "inner.ply");
  const auto reading = [&](const std::string& name, const ReadOptions& options) {
    const std::string scene = folder.add("home/scene.nff", kView + "ply " + name + "\n");
    return message_of([&] { read_scene(scene, nullptr, options); });
  };
  const std::string absolute = (other / "mesh.ply").string();
  for (const std::string& name : {std::string("../home2/mesh.ply"),
                                  absolute,
                                  std::string("link.ply"),
                                  std::string("door/mesh.ply"),
                                  std::string("sub/../../home2/mesh.ply")}) {
    EXPECT_EQ(reading(name, {}),
              (home / "scene.nff").string() +
                  ":8:5: error: expected a file in the scene's folder or below it (or "
                  "--allow-outside), found " +
                  grelha::quoted(name));
    EXPECT_EQ(reading(name, {.allow_outside = true}), "") << name;
  }
  const std::string beyond = reading("../nowhere.ply", {});
  EXPECT_NE(beyond.find("--allow-outside"), std::string::npos)
      << "nor does the scene learn what there is: " << beyond;
  for (const std::string& name : {std::string("mesh.ply"),
                                  std::string("sub/mesh.ply"),
                                  std::string("sub/../mesh.ply"),
                                  std::string("inner.ply"),
                                  (home / "mesh.ply").string()})
    EXPECT_EQ(reading(name, {}), "") << name;
  fs::create_symlink(home, folder.path() / "alias");
  EXPECT_EQ(
      message_of([&] { read_scene((folder.path() / "alias" / "scene.nff").string(), nullptr); }),
      "");
}

TEST(Errors, ErrorsOfAMeshNameTheMesh) {
  const TemporaryFolder folder;
  const std::string mesh = folder.add("mesh.ply", "plx\n"),
                    scene = folder.add("scene.nff", kView + "ply mesh.ply\n");
  EXPECT_EQ(message_of([&] { read_scene(scene, nullptr); }),
            mesh + ":1:1: error: expected \"ply\" on the first line, found \"plx\"");
}

TEST(Errors, PlyHeaders) {
  const std::string start = "ply\nformat ascii 1.0\n";
  expect_messages(
      "mesh.ply",
      {
          {"0.1 0.2 0.3\n", ":1:1: error: expected \"ply\" on the first line, found \"0.1\""},
          {"ply", ":1:4: error: expected \"end_header\", found end of file"},
          {"ply\nend_header\n",
           ":2:1: error: expected \"format\" before the end of the header, found \"end_header\""},
          {"ply\nelement vertex 1\n",
           ":2:1: error: expected \"format\" before elements, found \"element\""},
          {"ply\nformat text 1.0\n",
           ":2:8: error: expected ascii, binary_little_endian or binary_big_endian, found "
           "\"text\""},
          {"ply\nformat ascii 2.0\n", ":2:14: error: expected format version 1.0, found \"2.0\""},
          {"ply\nformat ascii\n", ":2:13: error: expected format version 1.0, found end of line"},
          {start + "element vertex 1\nproperty float x\nformat binary_little_endian 1.0\n",
           ":5:1: error: expected \"format\" once, found \"format\""},
          {start + "elephant\n", ":4:1: error: expected \"end_header\", found end of file"},
          {start + "elephant\3\n",
           ":3:1: error: expected a word of the header (format, comment, obj_info, element, "
           "property, end_header), found \"elephant\""},
          {start + "element vertex\n",
           ":3:15: error: expected a whole number of rows, found end of line"},
          {start + "element vertex -1\n",
           ":3:16: error: expected a whole number of rows, found \"-1\""},
          {start + "element\n", ":3:8: error: expected the element's name, found end of line"},
          {start + "element a 1\nelement a 1\n",
           ":4:9: error: expected each element once, found \"a\""},
          {start + "property float x\n",
           ":3:9: error: expected an element before its properties, found end of line"},
          {start + "element vertex 1\nproperty real x\n",
           ":4:10: error: expected a type such as uchar, int or float for the property, found "
           "\"real\""},
          {start + "element vertex 1\nproperty float\n",
           ":4:15: error: expected the property's name, found end of line"},
          {start + "element face 1\nproperty list float int vertex_indices\n",
           ":4:15: error: expected an integer type for the list's count, found \"float\""},
          {start + "element vertex 99999999999\nproperty float x\nend_header\n1 2\n",
           ":3:16: error: expected at most 2 rows of \"vertex\" (the file ends before), found "
           "\"99999999999\""},
          {start + "element vertex 1\nproperty float x\nproperty float y\nend_header\n1 2\n",
           ":3:9: error: expected a property \"z\" of \"vertex\", found none"},
          {start + "element face 1\nproperty float x\nend_header\n1 2\n",
           ":3:9: error: expected a list of integers \"vertex_indices\" in \"face\", found none"},
          {start + "element face 1\nproperty list int float vertex_indices\nend_header\n1 2\n",
           ":3:9: error: expected a list of integers \"vertex_indices\" in \"face\", found none"},
      });
}

const std::string kRows =
    "element vertex 2\nproperty float x\nproperty float y\nproperty float z\n"
    "element face 1\nproperty list uchar int vertex_indices\nend_header\n";

TEST(Errors, PlyAsciiRows) {
  const std::string h = "ply\nformat ascii 1.0\n" + kRows;  // nine lines
  expect_messages(
      "mesh.ply",
      {
          {h + "1 2 3\n4 5 six\n3 0 0 1",
           ":11:5: error: expected a number for \"z\" of \"vertex\", found \"six\""},
          {h + "1 2 3\n4 5 6\n3 0 1 2",
           ":12:7: error: expected the index of a vertex, 0 or more and below their number, found "
           "\"2\""},
          {h + "1 2 3\n4 5 6\n3 0 1 -1",
           ":12:7: error: expected the index of a vertex, 0 or more and below their number, found "
           "\"-1\""},
          {h + "1 2 3\n4 5 6\n3 0 1 0.5",
           ":12:7: error: expected the index of a vertex, 0 or more and below their number, found "
           "\"0.5\""},
          {h + "1 2 3\n4 5 6\n-3 0 1 0",
           ":12:1: error: expected a whole number of items for \"vertex_indices\", found \"-3\""},
          {h + "1 2 3\n4 5 6\n999 0 1 0",
           ":12:1: error: expected at most 3 items for \"vertex_indices\" (the file ends before), "
           "found \"999\""},
          {h + "1 2 3\n4 5 6\n3 0 1 ",
           ":12:7: error: expected row 1 of 1 of \"face\", found end of file"},
          {h + "1.000 2.000 3.000",
           ":10:18: error: expected row 2 of 2 of \"vertex\", found end of file"},
      });
}

TEST(Errors, PlyBinaryRows) {
  using std::string_literals::operator""s;
  const std::string h = "ply\nformat binary_little_endian 1.0\n" + kRows;
  const auto byte = [&](std::size_t n) { return ":byte " + std::to_string(h.size() + n); };
  const std::string vertices(24, '\0');
  expect_messages(
      "mesh.ply",
      {
          {h + vertices + "\3\0\0\0\0\1\0\0\0\2\0\0\0"s,
           byte(33) + ": error: expected the index of a vertex, 0 or more and below their number, "
                      "found 2"},
          {h + vertices + "\3\0\0\0\0\xff\xff\xff\xff\1\0\0\0"s,
           byte(29) + ": error: expected the index of a vertex, 0 or more and below their number, "
                      "found -1"},
          {h + vertices + "\3\0\0\0\0\1\0\0\0\1\0\0"s,
           byte(36) + ": error: expected row 1 of 1 of \"face\", found end of file"},
          {h + vertices,
           ":7:14: error: expected at most 0 rows of \"face\" (the file ends before), found \"1\""},
      });
  const std::string lists =
      "ply\nformat binary_big_endian 1.0\nelement a 1\nproperty list char int k\nelement vertex "
      "1\nproperty float x\n"
      "property float y\nproperty float z\nend_header\n";
  expect_messages("mesh.ply",
                  {
                      {lists + "\xff" + std::string(12, '\0'),
                       ":byte " + std::to_string(lists.size()) +
                           ": error: expected 0 or more items for \"k\", found -1"},
                      {lists + "\1\0\0\0\0"s + std::string(11, '\0'),
                       ":byte " + std::to_string(lists.size() + 16) +
                           ": error: expected row 1 of 1 of \"vertex\", found end of file"},
                  });
}

}  // namespace
}  // namespace grelha
