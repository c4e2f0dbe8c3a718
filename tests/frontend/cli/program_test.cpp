// The built program as a user meets it: exit statuses, files, one line per error.
#include "frontend/images/image_file.hpp"
#include "grelha/geometry.hpp"
#include "tests/frontend/cli/program.hpp"

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <cmath>
#include <array>
#include <cstdlib>
#include <filesystem>
#include <cstring>
#include <sstream>

namespace grelha {
namespace {

using Json = nlohmann::json;

using test::kBall;
using test::Outcome;
using test::Program;

TEST_F(Program, RendersToADefaultName) {
  const Outcome outcome = run("render ball.nff");
  EXPECT_EQ(outcome.status, 0) << outcome.err;
  EXPECT_EQ(outcome.err, "");
  EXPECT_EQ(folder_.list(), "ball.nff ball.png");
  EXPECT_EQ(outcome.out.substr(0, 20), "ball.png: 1 sphere; ");
  EXPECT_EQ(std::count(outcome.out.begin(), outcome.out.end(), '\n'), 1);
}

TEST_F(Program, QuietSaysNothing) {
  const Outcome outcome = run("render ball.nff -o x.pfm --size 8x4 --quiet");
  EXPECT_EQ(outcome.status, 0);
  EXPECT_EQ(outcome.out + outcome.err, "");
  EXPECT_EQ(folder_.read("x.pfm").substr(0, 12), "PF\n8 4\n-1.0\n");
}

TEST_F(Program, PictureIsABallBeforeTheBackground) {
  ASSERT_EQ(run("render ball.nff -o x.pfm").status, 0);
  const std::string bytes = folder_.read("x.pfm");
  const std::size_t header = std::string("PF\n24 16\n-1.0\n").size();
  ASSERT_EQ(bytes.size(), header + 24 * 16 * 12);
  const auto pixel = [&](int x, int y_from_bottom) {
    std::array<float, 3> rgb;
    std::memcpy(rgb.data(), bytes.data() + header + std::size_t(y_from_bottom * 24 + x) * 12, 12);
    return rgb;
  };
  EXPECT_EQ(pixel(0, 0), (std::array<float, 3>{0, 0, 1}));
  EXPECT_GT(pixel(13, 9)[0], 0.3f);
  EXPECT_EQ(pixel(13, 9)[1], 0);
  EXPECT_GT(pixel(14, 10)[0], pixel(10, 6)[0]) << "the light stands up and to the right";
}

TEST_F(Program, StatsTellTheRun) {
  const Outcome outcome = run("render ball.nff --stats s.json --threads 1 --isa scalar");
  ASSERT_EQ(outcome.status, 0) << outcome.err;
  const Json json = Json::parse(folder_.read("s.json"));
  EXPECT_EQ(json["scene"]["s"], 1);
  EXPECT_EQ(json["scene"]["lights"], 1);
  EXPECT_EQ(json["rays"]["primary"], 24 * 16);
  EXPECT_GT(json["rays"]["shadow"], 0);
  EXPECT_EQ(json["rays"]["reflection"], 0);
  EXPECT_GT(json["tests"]["sphere"], 0);
  EXPECT_EQ(json["isa"], "scalar");
  EXPECT_EQ(json["threads"], 1);
  EXPECT_EQ(json["size"], Json::parse("[24,16]"));
  double phases = 0;
  for (const Json& seconds : json["phases"])
    phases += double(seconds);
  EXPECT_GT(json["phases"]["primary"], 0);
  EXPECT_GT(json["phases"]["shadow"], 0);
  EXPECT_EQ(json["phases"]["bounce"], 0);
  EXPECT_LE(phases, double(json["seconds"]["render"])) << "one thread is at one thing at a time";
}

/// Meshes beside scenes are mostly their parts.
TEST_F(Program, AFolderSaysWhichMeshesItLeavesOut) {
  ASSERT_EQ(run("scene boat -o boat.nff").status, 0);
  const std::string note =
      ".: left out 1 .ply or .stl beside scenes, whose parts they may be: name what is a scene "
      "itself\n";
  EXPECT_EQ(run("render . -o {}.pfm --size 4x4").err, note);
  EXPECT_EQ(run("render . -o {}.pfm --size 4x4 --quiet").err, "");
  EXPECT_EQ(run("info .").err, note);
  EXPECT_EQ(run("info . ./boat.ply").err, "");
  EXPECT_EQ(run("info ball.nff").err, "");
}

/// The most samples that a pixel can have do not always suffice.
TEST_F(Program, SaysThatAnErrorIsNotMet) {
  const std::string job = "render ball.nff -o x.pfm --quiet --size 4x4 --error 0.000001";
  const std::string why = "ball.nff: warning: --error 1e-06 is not met: RMSE about ";
  const Outcome let = run(job), strict = run(job + " --strict");
  EXPECT_EQ(let.status, 0);
  EXPECT_EQ(let.err.substr(0, why.size()), why);
  EXPECT_EQ(strict.status, 3);
  EXPECT_EQ(strict.err, let.err);
  EXPECT_EQ(folder_.list(), "ball.nff x.pfm");
  const std::string both = "render ball.nff missing.nff --quiet --size 4x4 --error 0.000001";
  EXPECT_EQ(run(both + " --strict").status, 1) << "a failure is worse";
  EXPECT_EQ(run("render ball.nff -o x.pfm --quiet --strict --error .1").status, 0);
}

TEST_F(Program, SpendsSamplesByErrorAndSaysSo) {
  const Outcome outcome = run(
      "render ball.nff -o a.pfm --error .02 --stats s.json --samples-map n.pfm --error-map e.pfm");
  ASSERT_EQ(outcome.status, 0) << outcome.err;
  EXPECT_NE(outcome.out.find("; RMSE about "), std::string::npos) << outcome.out;
  const Json error = Json::parse(folder_.read("s.json"))["error"];
  EXPECT_EQ(error["asked"], .02);
  EXPECT_LE(error["rmse_bound"], .02);
  EXPECT_GT(error["checks"], 0);
  const Image samples = read_image(folder_.file("n.pfm")),
              errors = read_image(folder_.file("e.pfm"));
  double all = 0, squares = 0;
  for (std::size_t i = 0; i < samples.rgb.size(); i += 3) {
    all += samples.rgb[i];
    squares += double(errors.rgb[i]) * errors.rgb[i];
  }
  EXPECT_EQ(all, error["samples"]);
  EXPECT_NEAR(std::sqrt(squares / (24 * 16)), double(error["rmse"]), 1e-6);

  const std::string again = "render ball.nff -o b.pfm --quiet --time samples:" +
                            std::to_string(std::uint64_t(error["samples"]));
  EXPECT_EQ(run(again).status, 0);
  EXPECT_EQ(run("render ball.nff -o c.pfm --quiet --time .2").status, 0);
}

TEST_F(Program, InfoAgreesWithTheStats) {
  ASSERT_EQ(run("render ball.nff --stats s.json").status, 0);
  const Outcome outcome = run("info ball.nff --json");
  ASSERT_EQ(outcome.status, 0) << outcome.err;
  const Json info = Json::parse(outcome.out), stats = Json::parse(folder_.read("s.json"));
  EXPECT_EQ(info["scene"], stats["scene"]);
  EXPECT_EQ(info["grids"], stats["grids"]);
  EXPECT_EQ(info["needs"]["spheres"], true);
  EXPECT_EQ(info["needs"]["reflection"], false);
  EXPECT_NE(run("info ball.nff").out.find("needs         spheres\n"), std::string::npos);
}

TEST_F(Program, MissingSceneIsStatusOne) {
  const Outcome outcome = run("render no.nff");
  EXPECT_EQ(outcome.status, 1);
  EXPECT_EQ(outcome.err.substr(0, 14), "no.nff: error:");
  EXPECT_EQ(std::count(outcome.err.begin(), outcome.err.end(), '\n'), 1);
  EXPECT_EQ(folder_.list(), "ball.nff");
}

TEST_F(Program, WrongSceneIsStatusTwo) {
  folder_.write("bad.nff", "b 0 0 1\nv\nfrom 0 0 x\n");
  const Outcome outcome = run("render bad.nff");
  EXPECT_EQ(outcome.status, 2);
  EXPECT_EQ(outcome.err.substr(0, 19), "bad.nff:3:10: error");
  EXPECT_EQ(std::count(outcome.err.begin(), outcome.err.end(), '\n'), 1);
}

TEST_F(Program, TakesFoldersAndSeveralScenes) {
  std::filesystem::create_directory(folder_.path() / "all");
  folder_.write("all/a.nff", kBall);
  folder_.write("all/b.NFF", kBall);
  folder_.write("all/c.ply", "not rendered: a part of a scene");
  const Outcome outcome = run("render all ball.nff -o all/ --size 8x4");
  EXPECT_EQ(outcome.status, 0) << outcome.err;
  EXPECT_EQ(std::count(outcome.out.begin(), outcome.out.end(), '\n'), 3);
  for (const char* name : {"all/a.png", "all/b.png", "all/ball.png"})
    EXPECT_EQ(folder_.read(name).substr(1, 3), "PNG") << name;
  EXPECT_EQ(Json::parse(run("info all --json").out)["all/a.nff"]["scene"]["s"], 1);
  const std::string text = run("info all").out;
  EXPECT_NE(text.find("all/a.nff: 24x16\n"), std::string::npos);
  EXPECT_NE(text.find("\n\nall/b.NFF: 24x16\n"), std::string::npos);
  EXPECT_EQ(run("render all/ -o {}.hdr --size 8x4 --quiet").status, 0);
  EXPECT_EQ(folder_.list(), "a.hdr all b.hdr ball.nff");
}

/// A picture of nothing has one warning and is made; with --strict it is not.
TEST_F(Program, StrictTakesWarningsForErrors) {
  const std::string start = std::string(kBall).substr(0, std::string(kBall).find("s 0"));
  folder_.write("empty.ply", "ply\nformat ascii 1.0\nend_header\n");
  folder_.write("word.nff", start + "sphere 0 0 0 1\n");
  for (const char* name : {"empty.ply", "word.nff"}) {
    for (const std::string& command :
         {std::string("render -o x.png --quiet "), std::string("info ")}) {
      std::filesystem::remove(folder_.file("x.png"));
      const Outcome let = run(command + name), strict = run(command + "--strict " + name);
      EXPECT_EQ(let.status, 0) << let.err;
      EXPECT_NE(let.err.find(": warning: "), std::string::npos) << let.err;
      EXPECT_EQ(strict.status, 2);
      EXPECT_TRUE(strict.err.starts_with(let.err)) << strict.err;
      EXPECT_TRUE(strict.err.substr(let.err.size())
                      .starts_with("grelha: error: --strict: expected no warning, found "))
          << strict.err;
    }
  }
  EXPECT_EQ(run("render -o x.png --quiet --strict empty.ply").status, 2);
  EXPECT_FALSE(std::filesystem::exists(folder_.file("x.png")));
  EXPECT_EQ(run("render -o x.png --quiet --strict ball.nff").status, 0);
}

/// Sums of light end somewhere, and no term is cut without a word.
TEST_F(Program, LightThatMayBeCutIsSaid) {
  const std::string ball = kBall;
  const auto lit = [&](const std::string& light) {
    folder_.write(
        "lit.nff",
        ball.substr(0, ball.find("l 5 5 5")) + light + "\nf 1 0 0 1 0 1 0 1\ns 0 0 0 1\n");
  };
  const auto said = [&](const std::string& options) {
    const Outcome outcome = run("render lit.nff -o x.pfm " + options);
    EXPECT_EQ(outcome.status, 0);
    return outcome.err;
  };
  lit("l 5 5 5 1e7 1e7 1e7");
  EXPECT_EQ(
      said(""),
      "lit.nff: warning: light may reach 1e+07 in a sample: what is beyond 1.04858e+06 is cut\n");
  EXPECT_EQ(run("render lit.nff -o x.pfm --strict").status, 2);
  lit("l 5 5 5 1e6 1e6 1e6");
  EXPECT_EQ(said(""), "");
  EXPECT_EQ(said("--samples 64"),
            "lit.nff: warning: light may reach 1e+06 in a sample: what is beyond 524288 is cut\n");
  lit("b 2e6 0 0 l 5 5 5 1 1 1");
  EXPECT_NE(said(""), "");
  lit("l 5 5 5 1000 1000 1000");
  EXPECT_NE(said("--error .1"), "") << "which may take 65536 samples a pixel";
}

TEST_F(Program, OneBadSceneDoesNotKeepTheOthers) {
  const Outcome outcome = run("render no.nff ball.nff -o {}.pfm --size 8x4");
  EXPECT_EQ(outcome.status, 1);
  EXPECT_EQ(outcome.err, "no.nff: error: cannot open: No such file or directory\n");
  EXPECT_EQ(folder_.list(), "ball.nff ball.pfm");
  std::filesystem::create_directory(folder_.path() / "empty");
  EXPECT_EQ(run("info empty").err,
            "empty: error: no .nff, .p3f, .ply or .stl file in this folder\n");
  EXPECT_EQ(run("info nothing/").err, "nothing/: error: cannot read: No such file or directory\n");
}

TEST_F(Program, ReadsOutsideOfAFolderOnlyWhenAllowed) {
  std::filesystem::create_directory(folder_.path() / "in");
  folder_.write("in/scene.nff", std::string(kBall) + "ply ../mesh.ply\n");
  folder_.write("mesh.ply", "ply\nformat ascii 1.0\nelement vertex 0\nend_header\n");
  for (const char* command : {"render in/scene.nff -o x.pfm ", "info in/scene.nff "}) {
    const Outcome refused = run(command);
    EXPECT_EQ(refused.status, 2);
    EXPECT_NE(refused.err.find("in/scene.nff:12:5: error: "), std::string::npos) << refused.err;
    EXPECT_NE(refused.err.find("--allow-outside"), std::string::npos) << refused.err;
    EXPECT_EQ(run(std::string(command) + "--allow-outside").status, 0);
  }
}

TEST_F(Program, SuggestsTheSceneThatWasMeant) {
  EXPECT_EQ(run("scene bals").err,
            "grelha: error: no scene \"bals\"; did you mean balls? (see grelha scene --list)\n");
  EXPECT_EQ(run("scene gears --spd").err,
            "grelha: error: --spd: expected a scene that SPD has in another form (balls, mount), "
            "found \"gears\"\n");
  EXPECT_EQ(run("scene teapot").err,
            "grelha: error: no scene \"teapot\" (see grelha scene --list)\n");
}

TEST_F(Program, WrongUsageIsStatusTwoAndOneLine) {
  for (const char* arguments : {"",
                                "rendr",
                                "render",
                                "render ball.nff -o x.jpg",
                                "render ball.nff --size 0x0",
                                "render ball.nff --isa neon",
                                "scene nothing",
                                "scene balls --size 8",
                                "scene mount --size 0"}) {
    const Outcome outcome = run(arguments);
    EXPECT_EQ(outcome.status, 2) << arguments;
    EXPECT_EQ(outcome.err.substr(0, 15), "grelha: error: ") << arguments;
    EXPECT_EQ(std::count(outcome.err.begin(), outcome.err.end(), '\n'), 1) << arguments;
    EXPECT_EQ(outcome.out, "") << arguments;
  }
  EXPECT_EQ(folder_.list(), "ball.nff");
}

TEST_F(Program, UnwritablePicturesAreFoundOutFirst) {
  const Outcome outcome = run("render ball.nff -o no/x.png");
  EXPECT_EQ(outcome.status, 1);
  EXPECT_EQ(outcome.err, "no/x.png: error: cannot write: No such file or directory\n");
  EXPECT_EQ(run("render missing.nff -o no/x.png").err, outcome.err) << "before the scene is read";
  EXPECT_EQ(run("render ball.nff --stats no/s.json").err,
            "no/s.json: error: cannot write: No such file or directory\n");
  EXPECT_EQ(folder_.list(), "ball.nff");
}

TEST_F(Program, TooLargeForPngIsSaidBeforeTheRender) {
  const Outcome outcome = run("render ball.nff --size 65536x65536");
  EXPECT_EQ(outcome.status, 2);
  EXPECT_EQ(outcome.err,
            "grelha: error: a picture of 65536x65536 is too large for .png and .hdr, write a .pfm "
            "or .exr\n");
}

TEST_F(Program, SceneGoesToStdoutOrAFile) {
  const Outcome outcome = run("scene balls --size 2");
  EXPECT_EQ(outcome.status, 0);
  ASSERT_EQ(run("scene balls --size 2 -o b.nff").status, 0);
  EXPECT_EQ(folder_.read("b.nff"), outcome.out);
  const Outcome info = run("info b.nff --json");
  ASSERT_EQ(info.status, 0) << info.err;
  EXPECT_EQ(Json::parse(info.out)["scene"]["s"], 91);
  EXPECT_EQ(Json::parse(info.out)["scene"]["pl"], 1);
}

TEST_F(Program, BoatComesWithItsMesh) {
  ASSERT_EQ(run("scene boat").status, 0);
  ASSERT_EQ(run("scene boat --size 4 -o small.nff").status, 0);
  EXPECT_EQ(folder_.list(), "ball.nff boat.nff boat.ply small.nff small.ply");
  const Outcome info = run("info boat.nff --json");
  ASSERT_EQ(info.status, 0) << info.err;
  const Json json = Json::parse(info.out);
  EXPECT_EQ(json["scene"]["ply"], 4700);
  EXPECT_EQ(json["scene"]["pl"], 3);
  EXPECT_EQ(json["dropped"], Json::parse(R"({"not_finite":0,"zero_area":0})"));
  EXPECT_EQ(json["needs"]["smooth_normals"], true);
  EXPECT_EQ(run("scene boat -o x.ply").status, 2);
}

/// Every generator's text is a scene to our own readers, at its least size too and without a
/// warning.
TEST_F(Program, EverySceneIsRead) {
  const Outcome list = run("scene --list");
  EXPECT_EQ(list.status, 0);
  std::istringstream lines(list.out);
  int scenes = 0;
  for (std::string name, word, size, rest;
       lines >> name >> word >> size && std::getline(lines, rest);
       ++scenes) {
    ASSERT_EQ(run("scene " + name + " --size " + size + " -o " + name + ".nff").status, 0) << name;
    const Outcome info = run("info " + name + ".nff --json");
    EXPECT_EQ(info.status, 0) << info.err;
    EXPECT_EQ(info.err.find("warning"), std::string::npos) << info.err;
  }
  EXPECT_EQ(scenes, 15);
}

TEST_F(Program, AFullOutputIsStatusOne) {
  if (!std::filesystem::exists("/dev/full"))
    GTEST_SKIP() << "no /dev/full";
  const std::string line =
      "'" GRELHA_PROGRAM "' scene balls --size 3 >/dev/full 2>'" + folder_.file("err") + "'";
  EXPECT_EQ(WEXITSTATUS(std::system(line.c_str())), 1);
  EXPECT_EQ(folder_.read("err"), "stdout: error: cannot write: No space left on device\n");
}

TEST_F(Program, HelpAndVersionAreStatusZero) {
  EXPECT_EQ(run("--help").status, 0);
  EXPECT_EQ(run("render --help").status, 0);
  EXPECT_EQ(run("--version").out.substr(0, 7), "grelha ");
}

/// The ready scenes say what they are for, and each is read without a complaint.
TEST_F(Program, ReadyScenesAreSound) {
  int scenes = 0;
  for (const auto& entry : std::filesystem::directory_iterator(GRELHA_SOURCE_DIR "/scenes/data")) {
    const std::string path = entry.path().string();
    const Outcome outcome = run("render '" + path + "' --size 32x32 --quiet -o x.png");
    EXPECT_EQ(outcome.status, 0) << path;
    EXPECT_EQ(outcome.out + outcome.err, "") << path;
    std::ifstream in(path);
    const std::string text{std::istreambuf_iterator<char>(in), {}};
    EXPECT_TRUE(text.starts_with("# ") || text.find("\ncomment ") < 100)
        << path << " does not say what it is for";
    ++scenes;
  }
  EXPECT_GE(scenes, 5);
}

}  // namespace
}  // namespace grelha
