// Tests the memory that the program uses, estimates, and refuses to use.
#include "frontend/files/memory_limit.hpp"
#include "grelha/geometry.hpp"
#include "tests/frontend/cli/program.hpp"

#include <nlohmann/json.hpp>

#include <algorithm>
#include <cstdio>
#include <filesystem>

namespace grelha {
namespace {

using Json = nlohmann::json;

using test::kBall;
using test::Outcome;
using test::Program;

/// Files that claim what they do not hold, and pictures no machine has room for, end in one line
/// and take no memory for it.
TEST_F(Program, HostileFilesAreBounded) {
  folder_.write("claims.ply",
                "ply\nformat ascii 1.0\nelement vertex 4000000000\nproperty float x\nproperty "
                "float y\nproperty float z\n"
                "end_header\n0 0 0\n");
  folder_.write("faces.ply",
                "ply\nformat binary_little_endian 1.0\nelement face 4000000000\nproperty list "
                "uchar int vertex_indices\n"
                "end_header\n....");
  folder_.write("mesh.nff", std::string(kBall) + "mesh 4000000000 4000000000\n0 0 0\n");
  folder_.write("corners.nff", std::string(kBall) + "p 4000000000\n0 0 0\n");
  for (const char* name : {"claims.ply", "faces.ply", "mesh.nff", "corners.nff"}) {
    const Outcome outcome = run(std::string("info --max-memory 64M ") + name);
    EXPECT_EQ(outcome.status, 2) << name;
    EXPECT_NE(outcome.err.find("4000000000"), std::string::npos) << outcome.err;
    EXPECT_EQ(std::count(outcome.err.begin(), outcome.err.end(), '\n'), 1) << outcome.err;
  }
  if (!memory_can_be_limited())
    GTEST_SKIP() << "sanitizers own more memory than there is";
  const Outcome large = run("render ball.nff --size 6000x6000 -o x.pfm --max-memory 300M");
  EXPECT_EQ(large.status, 1);
  EXPECT_TRUE(large.err.starts_with("ball.nff: error: expected about 1.7")) << large.err;
  EXPECT_TRUE(large.err.ends_with(" GB of memory to render it, found 0.315 GB (--max-memory)\n"))
      << large.err;
  EXPECT_EQ(folder_.list(), "ball.nff claims.ply corners.nff faces.ply mesh.nff");
}

/// A row of a picture of 900 million pixels takes megabytes, the whole picture 21.6 GB. The error
/// message names the limit that applies: --max-memory, ulimit -d or the memory of the machine.
TEST_F(Program, ARowOfAHugePictureTakesLittle) {
  if (!memory_can_be_limited())
    GTEST_SKIP() << "sanitizers own more memory than there is";
  const std::string huge = "render ball.nff --quiet --threads 2 --size 30000x30000 -o x.grelha ";
  const Outcome row = run(huge + "--rows 0:1 --max-memory 100M");
  EXPECT_EQ(row.status, 0) << row.err;
  const Outcome all = run(huge + "--max-memory 100M");
  EXPECT_EQ(all.status, 1);
  EXPECT_TRUE(all.err.starts_with("ball.nff: error: expected about 21.6 GB of memory")) << all.err;
  EXPECT_TRUE(all.err.ends_with(", found 0.105 GB (--max-memory)\n")) << all.err;
  const Outcome by_system = test::run(folder_, huge, "ulimit -d 204800 &&");
  EXPECT_TRUE(by_system.err.ends_with(", found 0.21 GB (ulimit -d)\n")) << by_system.err;
  constexpr std::uint64_t kLargest = std::uint64_t{65536} * 65536 * 24;
  if (system_memory() > kLargest)
    GTEST_SKIP() << "this machine has room for the largest picture";
  const Outcome by_machine = run("render ball.nff --quiet --size 65536x65536 -o x.pfm");
  EXPECT_EQ(by_machine.status, 1);
  EXPECT_NE(by_machine.err.find(", all that this machine has"), std::string::npos)
      << by_machine.err;
}

/// An error for lack of memory names an amount that is enough and less than twice the memory used.
/// Tests pictures of all kinds.
TEST_F(Program, WhatMemoryIsWantedIsEnough) {
  if (!memory_can_be_limited())
    GTEST_SKIP() << "sanitizers own more memory than there is";
  constexpr double kTold = 1.01;  // three digits
  for (const std::string kind :
       {"-o x.pfm",
        "-o x.png",
        "-o x.hdr",
        "-o x.grelha",
        "-o x.grelha --rows 100:1690",
        "-o x.pfm --checkpoint c",
        "-o x.pfm --error 1 --samples-map s.pfm --error-map e.pfm --checkpoint d",
        "-o x.pfm --aa adaptive:.1,2",
        "-o x.pfm --aa adaptive:.1,2 --checkpoint c"}) {
    const std::string command =
        "render ball.nff --quiet --threads 2 --size 1700x1700 --stats s.json " + kind +
        " --max-memory ";
    const Outcome refused = run(command + "64M");
    double wanted = 0;
    ASSERT_EQ(std::sscanf(refused.err.c_str(), "ball.nff: error: expected about %lf GB", &wanted),
              1)
        << kind << ": " << refused.err;
    const Outcome enough = run(command + std::to_string(std::uint64_t(kTold * wanted * 1e9)));
    EXPECT_EQ(enough.status, 0) << kind << ": " << enough.err;
    EXPECT_GT(double(Json::parse(folder_.read("s.json"))["bytes"]["peak"]), wanted * 1e9 / 2)
        << kind;
  }
}

/// 205,000 triangles take 40 MB. The estimate contains 12 MB for the program itself, its least
/// certain term. An error of a third of these and of a fifth of the build's memory amounts to a
/// quarter.
TEST_F(Program, SaysWhatMemoryItWillTake) {
  if (!memory_can_be_limited())
    GTEST_SKIP() << "sanitizers own more memory than there is";
  ASSERT_EQ(run("scene terrain -o t.nff").status, 0);
  const Outcome info = run("info t.nff --json");
  ASSERT_EQ(info.status, 0) << info.err;
  ASSERT_EQ(run("render t.nff --threads 2 --stats s.json").status, 0);
  const Json said = Json::parse(info.out)["memory"],
             took = Json::parse(folder_.read("s.json"))["bytes"];
  EXPECT_NEAR(double(took["peak"]) / double(said["peak"]), 1, .25);
  EXPECT_NEAR(double(took["grids"]) / double(said["grids"]), 1, .2);
  EXPECT_EQ(took["geometry"],
            Json(std::uint64_t(said["scene"]) -
                 std::uint64_t(Json::parse(info.out)["scene"]["materials"]) * sizeof(Material)));
  std::filesystem::remove(folder_.file("t.png"));

  // Too little of it: told before anything is built, and by info without building at all.
  const auto enough = std::uint64_t(1.5 * double(said["peak"]));
  EXPECT_EQ(run("render t.nff --quiet --threads 2 -o x.png --max-memory " +
                std::to_string(std::max<std::uint64_t>(enough, 1 << 27)))
                .status,
            0);
  ASSERT_EQ(run("scene terrain --size 60 -o t.nff").status, 0);
  const Outcome refused = run("render t.nff --max-memory 150M");
  EXPECT_EQ(refused.status, 1);
  EXPECT_TRUE(refused.err.starts_with("t.nff: error: expected about 0.") &&
              refused.err.ends_with(" found 0.157 GB (--max-memory)\n"))
      << refused.err;
  EXPECT_EQ(std::count(refused.err.begin(), refused.err.end(), '\n'), 1);
  const Outcome unbuilt = run("info t.nff --max-memory 150M");
  EXPECT_EQ(unbuilt.status, 0) << unbuilt.err;
  EXPECT_NE(unbuilt.out.find("\ngrid          not built: "), std::string::npos) << unbuilt.out;
  EXPECT_FALSE(std::filesystem::exists(folder_.file("t.png")));
}

}  // namespace
}  // namespace grelha
