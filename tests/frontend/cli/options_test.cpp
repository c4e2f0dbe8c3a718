#include "frontend/cli/command_line.hpp"

#include "frontend/commands/commands.hpp"
#include "frontend/commands/outputs.hpp"
#include "tests/support/parsing.hpp"
#include "tests/support/temporary_folder.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <vector>

namespace grelha {
namespace {

using test::error_of;
using test::parse;

TEST(Render, Defaults) {
  const auto command = std::get<RenderCommand>(parse("render dir/x.nff"));
  EXPECT_EQ(command.scenes, std::vector<std::string>{"dir/x.nff"});
  EXPECT_EQ(commands_for(command).at(0).scene, "dir/x.nff");
  EXPECT_EQ(commands_for(command).at(0).image, "x.png");
  EXPECT_EQ(command.input.max_memory, 0u);
  EXPECT_FALSE(command.input.read.allow_outside);
  EXPECT_EQ(command.width, 0);
  EXPECT_EQ(command.render.threads, 0);
  EXPECT_EQ(command.render.depth, 5);
  EXPECT_EQ(command.render.min_weight, 1. / 16384);
  EXPECT_EQ(command.render.packet, 256);
  EXPECT_TRUE(command.render.mailbox);
  EXPECT_EQ(command.render.isa, "best");
  EXPECT_TRUE(command.build.grid);
  EXPECT_EQ(command.build.density, 0);
  EXPECT_EQ(command.stats, "");
  EXPECT_FALSE(command.quiet);
  EXPECT_FALSE(command.srgb);
}

TEST(Render, Effects) {
  const Effects e = std::get<RenderCommand>(
                        parse("render x.nff --samples 288 --sampler jitter --seed 7 --aa jitter:3 "
                              "--shadows area:.5,4 --lens 20,1.5,32 --glossy .2,6"))
                        .effects;
  EXPECT_EQ(e.samples, 288);
  EXPECT_EQ(e.sampler, Sampler::kJitter);
  EXPECT_EQ(e.seed, 7u);
  EXPECT_EQ(e.jitter, 3);
  EXPECT_EQ(e.shadows->size, .5f);
  EXPECT_EQ(e.shadows->positions, 4);
  EXPECT_EQ(e.lens->aperture, 20);
  EXPECT_EQ(e.lens->focus, 1.5);
  EXPECT_EQ(e.lens->samples, 32);
  EXPECT_EQ(e.glossy->roughness, .2f);
  EXPECT_EQ(e.glossy->rays, 6);
  EXPECT_FALSE(e.adaptive.on);
  const Subdivision s =
      std::get<RenderCommand>(parse("render x.nff --aa adaptive:.25,4")).effects.adaptive;
  EXPECT_TRUE(s.on);
  EXPECT_EQ(s.threshold, .25f);
  EXPECT_EQ(s.depth, 4);
  EXPECT_TRUE(std::get<RenderCommand>(parse("render x.nff --shadows hard")).effects.shadows->hard);
  EXPECT_EQ(std::get<RenderCommand>(parse("render x.nff --shadows random:.25"))
                .effects.shadows->positions,
            1);
}

TEST(Render, ErrorAndTime) {
  const auto by_error = std::get<RenderCommand>(
      parse("render x.nff --error .02 --samples-map s.pfm --error-map e.png --seed 3"));
  EXPECT_EQ(by_error.render.refine.error, .02);
  EXPECT_EQ(by_error.samples_map, "s.pfm");
  EXPECT_EQ(by_error.error_map, "e.png");
  EXPECT_EQ(std::get<RenderCommand>(parse("render x.nff --time 1.5")).render.refine.seconds, 1.5);
  EXPECT_EQ(std::get<RenderCommand>(parse("render x.nff --time samples:12345678901"))
                .render.refine.samples,
            12345678901u);
  const auto all = std::get<RenderCommand>(parse("render x.nff --error .02 --time 9 --samples 64"));
  EXPECT_EQ(all.render.refine.error, .02);
  EXPECT_EQ(all.render.refine.seconds, 9);
  EXPECT_EQ(all.effects.samples, 64);
  EXPECT_FALSE(std::get<RenderCommand>(parse("render x.nff")).render.refine.on());
}

TEST(Render, EveryOption) {
  const auto command = std::get<RenderCommand>(
      parse("render x.nff -o y.png --size 640x480 --threads 7 --depth 3 --min-weight .25 --density "
            "2.5 --isa avx2 --packet 16 --stats s.json --quiet --srgb"));
  EXPECT_EQ(command.image, "y.png");
  EXPECT_EQ(command.width, 640);
  EXPECT_EQ(command.height, 480);
  EXPECT_EQ(command.render.threads, 7);
  EXPECT_EQ(command.render.depth, 3);
  EXPECT_EQ(command.render.min_weight, .25);
  EXPECT_EQ(command.render.packet, 16);
  EXPECT_EQ(command.render.isa, "avx2");
  EXPECT_FALSE(std::get<RenderCommand>(parse("render x.nff --accel none")).build.grid);
  EXPECT_EQ(command.build.density, 2.5f);
  EXPECT_EQ(command.stats, "s.json");
  EXPECT_TRUE(command.quiet);
  EXPECT_TRUE(command.srgb);
}

TEST(Render, OptionsMayStandBeforeTheSceneAndCarryTheirValue) {
  const auto command = std::get<RenderCommand>(parse("render --size=65536x1 --quiet x.ply"));
  EXPECT_EQ(command.width, 65536);
  EXPECT_EQ(command.scenes, std::vector<std::string>{"x.ply"});
}

TEST(Render, SizeTakesACapitalX) {
  const auto command = std::get<RenderCommand>(parse("render x.nff --size 32X16"));
  EXPECT_EQ(command.width, 32);
  EXPECT_EQ(command.height, 16);
}

TEST(Render, ValuesMayLookLikeOptions) {
  EXPECT_EQ(std::get<RenderCommand>(parse("render x.nff -o - --stats --s.json")).stats, "--s.json");
  EXPECT_EQ(std::get<InfoCommand>(parse("info -- --x.nff")).scenes,
            std::vector<std::string>{"--x.nff"});
}

TEST(Render, ShortOptionsTakeTheirValueAsInOtherTools) {
  for (const char* line :
       {"render x.nff -o=y.png -j=3", "render x.nff -oy.png -j3", "render -j 3 -o y.png x.nff"}) {
    const auto command = std::get<RenderCommand>(parse(line));
    EXPECT_EQ(command.image, "y.png") << line;
    EXPECT_EQ(command.render.threads, 3) << line;
    EXPECT_EQ(command.build.threads, 3) << line;
  }
  EXPECT_EQ(std::get<SceneCommand>(parse("scene balls -o=b.nff")).output, "b.nff");
  EXPECT_EQ(error_of("render x.nff -o="), "-o: expected a file name, found \"\"");
  EXPECT_TRUE(std::get<RenderCommand>(parse("render x.nff -q")).quiet);
  EXPECT_TRUE(std::get<MergeCommand>(parse("merge a.grelha -o b.png -q")).quiet);
  for (const char* line : {"-V", "render --version", "scene -V", "merge a --version"})
    EXPECT_EQ(std::get<TextCommand>(parse(line)).text,
              std::get<TextCommand>(parse("--version")).text);
}

TEST(Render, FormatNamesWhatTheNameDoesNot) {
  const auto image = [](const std::string& line) {
    return commands_for(std::get<RenderCommand>(parse("render a/x.nff " + line))).at(0).image;
  };
  EXPECT_EQ(image("--format hdr"), "x.hdr");
  EXPECT_EQ(image("--format pfm -o out/"), "out/x.pfm");
  EXPECT_EQ(image("--format pfm -o {}"), "x");
  EXPECT_EQ(image("-o -"), "-");
  EXPECT_EQ(format_of("-", {}), ImageFormat::png);
  EXPECT_EQ(format_of("-", ImageFormat::hdr), ImageFormat::hdr);
  EXPECT_EQ(format_of("x.pfm", {}), ImageFormat::pfm);
  EXPECT_EQ(format_of("x.grelha", {}), std::nullopt);
}

TEST(DefaultImage, TakesTheStemInTheCurrentFolder) {
  EXPECT_EQ(default_image("x.nff"), "x.png");
  EXPECT_EQ(default_image("/a/b/x.p3f"), "x.png");
  EXPECT_EQ(default_image("a/balls_6.nff.gz"), "balls_6.png");
  EXPECT_EQ(default_image("a/v1.2.nff"), "v1.2.png");
  EXPECT_EQ(default_image("plain"), "plain.png");
}

TEST(Render, ManyScenesHaveManyPictures) {
  const auto images = [](const std::string& line) {
    std::string all;
    for (const RenderCommand& c : commands_for(std::get<RenderCommand>(parse(line))))
      all += c.scene + '>' + c.image + ' ' + c.stats + ';';
    return all;
  };
  EXPECT_EQ(images("render a/x.nff b/y.p3f.gz"), "a/x.nff>x.png ;b/y.p3f.gz>y.png ;");
  EXPECT_EQ(images("render x.nff y.nff -o out/"), "x.nff>out/x.png ;y.nff>out/y.png ;");
  EXPECT_EQ(images("render x.nff y.nff -o out/{}.hdr --stats {}.json"),
            "x.nff>out/x.hdr x.json;y.nff>out/y.hdr y.json;");
  EXPECT_EQ(images("render x.nff -o one.hdr --stats s.json"), "x.nff>one.hdr s.json;");
  EXPECT_THROW(images("render x.nff y.nff -o one.png"), UsageError);
  EXPECT_THROW(images("render a/x.nff b/x.nff"), UsageError);
  EXPECT_THROW(images("render x.nff y.nff --stats s.json"), UsageError);
}

TEST(Render, MemoryIsCountedInBytes) {
  const auto size = [](const std::string& text) {
    return std::get<RenderCommand>(parse("render x --max-memory " + text)).input.max_memory;
  };
  EXPECT_EQ(size("67108864"), 67108864u);
  EXPECT_EQ(size("64M"), 67108864u);
  EXPECT_EQ(size("1.5G"), 1610612736u);
  EXPECT_EQ(std::get<InfoCommand>(parse("info x --max-memory 1T --allow-outside")).input.max_memory,
            std::uint64_t(1) << 40);
  for (const char* wrong : {"63M", "x", "G", "-1G", "nan", "1e30"})
    EXPECT_THROW(size(wrong), UsageError) << wrong;
}

TEST(Others, AreParsed) {
  EXPECT_TRUE(std::get<InfoCommand>(parse("info x.nff --json")).json);
  const auto compare = std::get<CompareCommand>(parse("compare a.png b.png --max-rmse 0"));
  EXPECT_EQ(compare.max_rmse, 0.0);
  EXPECT_FALSE(std::get<CompareCommand>(parse("compare a b")).max_rmse);
  EXPECT_FALSE(compare.display);
  EXPECT_TRUE(std::get<CompareCommand>(parse("compare a b --display")).display);
  const auto scene = std::get<SceneCommand>(parse("scene balls --size 4 -o b.nff --spd"));
  EXPECT_EQ(scene.name, "balls");
  EXPECT_EQ(scene.size, 4);
  EXPECT_TRUE(scene.spd);
  EXPECT_TRUE(std::get<SceneCommand>(parse("scene --list")).list);
}

struct Line {
  const char *line, *message;
};

const Line kWrong[] = {
    {"", "A subcommand is required (see --help)"},
    {"--hlp", "expected an option, found \"--hlp\"; did you mean --help? (see --help)"},
    {"help rendr",
     "command: expected one of render, info, compare, merge, scene, found \"rendr\"; did you "
     "mean render?"},
    {"render a --size 2x2 --depth 3 --size 3x3",
     "--size: expected once, found \"2x2\" and \"3x3\""},
    {"render a -o a.png --output=b.png", "--output: expected once, found \"a.png\" and \"b.png\""},
    {"render a --shadows hrd",
     "--shadows: expected hard, random:SIZE or area:SIZE,N, found \"hrd\"; did you mean hard?"},
    {"render a --aa adptive:1,2",
     "--aa: expected off, jitter:N or adaptive:THRESHOLD,DEPTH, found \"adptive:1,2\"; did you "
     "mean adaptive:1,2?"},
    {"render a --shadows random",
     "--shadows: expected hard, random:SIZE or area:SIZE,N, found \"random\""},
    {"rendr x.nff",
     "command: expected one of render, info, compare, merge, scene, found \"rendr\"; did you "
     "mean render?"},
    {"rend x.nff",
     "command: expected one of render, info, compare, merge, scene, found \"rend\"; did you "
     "mean render?"},
    {"RENDER x.nff",
     "command: expected one of render, info, compare, merge, scene, found \"RENDER\"; did you "
     "mean render?"},
    {"nothing x.nff",
     "command: expected one of render, info, compare, merge, scene, found \"nothing\""},
    {"render", "SCENE is required (see --help)"},
    {"render --hlep",
     "render: expected an option, found \"--hlep\"; did you mean --help? (see --help)"},
    {"compare a b c d e", "compare: expected no further word, found \"c\" (see --help)"},
    {"render a --foo", "render: expected an option, found \"--foo\" (see --help)"},
    {"render a -x", "render: expected an option, found \"-x\" (see --help)"},
    {"render a --sampels 3",
     "render: expected an option, found \"--sampels\"; did you mean --samples? (see --help)"},
    {"render a --dept=3",
     "render: expected an option, found \"--dept=3\"; did you mean --depth? (see --help)"},
    {"info a --jsno",
     "info: expected an option, found \"--jsno\"; did you mean --json? (see --help)"},
    {"render a --sampler sobl",
     "--sampler: expected one of sobol, blue, jitter, random, found \"sobl\"; did you "
     "mean "
     "sobol?"},
    {"render a -o", "--output: 1 required FILE missing (see --help)"},
    {"render a -o b.jpg",
     "-o: expected a name ending in .png, .hdr, .pfm, .exr or .grelha, found \"b.jpg\""},
    {"render a --size 640",
     "--size: expected WIDTHxHEIGHT, each from 1 to 65536, found \"640\"; did you mean 640x640?"},
    {"render a --size 640x", "--size: expected WIDTHxHEIGHT, each from 1 to 65536, found \"640x\""},
    {"render a --size 0x1", "--size: expected WIDTHxHEIGHT, each from 1 to 65536, found \"0x1\""},
    {"render a --size 1x65537",
     "--size: expected WIDTHxHEIGHT, each from 1 to 65536, found \"1x65537\""},
    {"render a --size 1x1x1",
     "--size: expected WIDTHxHEIGHT, each from 1 to 65536, found \"1x1x1\""},
    {"render a --size -1x1", "--size: expected WIDTHxHEIGHT, each from 1 to 65536, found \"-1x1\""},
    {"render a --threads 0", "--threads: expected a whole number from 1 to 1024, found \"0\""},
    {"render a --threads 1.5", "--threads: expected a whole number from 1 to 1024, found \"1.5\""},
    {"render a --threads 99999999999",
     "--threads: expected a whole number from 1 to 1024, found \"99999999999\""},
    {"render a --min-weight nan", "--min-weight: expected a number from 0 to 1, found \"nan\""},
    {"render a --min-weight 1.5", "--min-weight: expected a number from 0 to 1, found \"1.5\""},
    {"render a --depth -1", "--depth: expected a whole number from 1 to 4096, found \"-1\""},
    {"render a --density 0", "--density: expected a number above 0 and up to 1000, found \"0\""},
    {"render a --density nan",
     "--density: expected a number above 0 and up to 1000, found \"nan\""},
    {"render a --density 1e-60",
     "--density: expected a number above 0 and up to 1000, found \"1e-60\""},
    {"render a --accel bvh", "--accel: expected one of grid, none, found \"bvh\""},
    {"render a --isa vmx",
     "--isa: expected one of scalar, sse2, avx2, avx512, neon, best, found \"vmx\""},
    {"render a --packet 8", "--packet: expected one of 1, 16, 64, 256, found \"8\""},
    {"render a --samples 0", "--samples: expected a whole number from 1 to 65536, found \"0\""},
    {"render a --sampler halton",
     "--sampler: expected one of sobol, blue, jitter, random, found \"halton\""},
    {"render a --error 0", "--error: expected a number from 0.000001 to 1, found \"0\""},
    {"render a --error nan", "--error: expected a number from 0.000001 to 1, found \"nan\""},
    {"render a --time -1",
     "--time: expected seconds above 0 and up to 1e9, or samples:N, found \"-1\""},
    {"render a --time samples:0",
     "--time: expected samples:N with N from 1 to 2^64 - 1, found \"samples:0\""},
    {"render a --error .1 --samples 4",
     "--samples: expected at least 8 with --error or --time, which begin with as many, found 4"},
    {"render a --time 1 --aa jitter:2",
     "--error and --time choose the samples: no --aa beside them"},
    {"render a --error .1 --sampler jitter",
     "--sampler: expected sobol or random with --error or --time"},
    {"render a --samples-map s.png", "--samples-map and --error-map want --error or --time"},
    {"render a --error .1 --error-map s.txt",
     "--error-map: expected a name ending in .png, .hdr, .pfm or .exr, found \"s.txt\""},
    {"render a --aa 3", "--aa: expected off, jitter:N or adaptive:THRESHOLD,DEPTH, found \"3\""},
    {"render a --aa adaptive:.1", "--aa: expected adaptive:THRESHOLD,DEPTH, found \".1\""},
    {"render a --aa adaptive:1.5,3", "--aa: expected a threshold from 0 to 1, found \"1.5\""},
    {"render a --aa adaptive:nan,3", "--aa: expected a threshold from 0 to 1, found \"nan\""},
    {"render a --aa adaptive:.1,3 --error .01",
     "--error and --time choose the samples: no --aa beside them"},
    {"render a --aa adaptive:.1,9", "--aa: expected a whole number from 0 to 8, found \"9\""},
    {"render a --aa jitter:0", "--aa: expected a whole number from 1 to 256, found \"0\""},
    {"render a --shadows soft",
     "--shadows: expected hard, random:SIZE or area:SIZE,N, found \"soft\""},
    {"render a --shadows area:1", "--shadows: expected area:SIZE,N, found \"1\""},
    {"render a --shadows random:-1", "--shadows: expected a size from 0 to 1e18, found \"-1\""},
    {"render a --lens 1,2,3,4", "--lens: expected APERTURE,FOCUS,N, found \"1,2,3,4\""},
    {"render a --lens nan", "--lens: expected an aperture from 0 to 1e18, found \"nan\""},
    {"render a --glossy .1,0", "--glossy: expected a whole number from 1 to 256, found \"0\""},
    {"compare a", "B is required (see --help)"},
    {"compare a b --max-rmse -1",
     "--max-rmse: expected a number that is not negative, found \"-1\""},
    {"compare a b --max-rmse nan",
     "--max-rmse: expected a number that is not negative, found \"nan\""},
    {"render a --error .1 --error-map d.txt",
     "--error-map: expected a name ending in .png, .hdr, .pfm or .exr, found \"d.txt\""},
    {"scene", "NAME is required (see grelha scene --list)"},
    {"scene balls --size x", "--size: expected a whole number from 0 to 1000, found \"x\""},
};

TEST(Errors, SayWhatWasExpectedAndFound) {
  for (const auto& [line, message] : kWrong)
    EXPECT_EQ(error_of(line), message) << line;
}

/// Errors for values that are too large name the largest allowed value.
TEST(Errors, SayTheUpperBoundToo) {
  const std::pair<const char*, const char*> table[] = {
      {"render a --lens 1e30,1,1", "--lens: expected an aperture from 0 to 1e18, found \"1e30\""},
      {"render a --lens 1,1e30,1",
       "--lens: expected a focal distance from 0 to 1e18, found \"1e30\""},
      {"render a --lens 1,1,65537",
       "--lens: expected a whole number from 1 to 65536, found \"65537\""},
      {"render a --glossy 1e30", "--glossy: expected a roughness from 0 to 1e18, found \"1e30\""},
      {"render a --shadows area:1e30,2",
       "--shadows: expected a size from 0 to 1e18, found \"1e30\""},
      {"render a --shadows random:1e30",
       "--shadows: expected a size from 0 to 1e18, found \"1e30\""},
      {"render a --time 1e10",
       "--time: expected seconds above 0 and up to 1e9, or samples:N, found \"1e10\""},
      {"render a --time samples:99999999999999999999",
       "--time: expected samples:N with N from 1 to 2^64 - 1, found "
       "\"samples:99999999999999999999\""},
      {"render a --preview 1e10",
       "--preview: expected seconds above 0 and up to 1e9, found \"1e10\""},
      {"render a --checkpoint k --checkpoint-every 1e10",
       "--checkpoint-every: expected seconds above 0 and up to 1e9, found \"1e10\""},
      {"render a --max-memory 1e30",
       "--max-memory: expected a size from 64M to 1e18 bytes, such as 512M or 6G, found \"1e30\""},
      {"render a --aa jitter:256 --lens 1,1,2",
       "--aa jitter:256 and --lens APERTURE,FOCUS,N: expected at most 65536 samples a pixel, found "
       "131072"},
  };
  for (const auto& [line, message] : table)
    EXPECT_EQ(error_of(line), message) << line;
  EXPECT_EQ(error_of("render a --aa jitter:256 --lens 1,1,1"), "no error");
}

/// Of names that the system refuses to look at: the message is ours, or they are left to whoever
/// opens them.
TEST(Errors, NamesThatCannotBeLookedAt) {
  const TemporaryFolder folder;
  const std::string loop = folder.file("loop"), inside = loop + "/x", far(5000, 'x');
  std::filesystem::create_symlink("loop", loop);
  EXPECT_EQ(
      error_of("render a -o " + inside),
      "-o: expected a name ending in .png, .hdr, .pfm, .exr or .grelha, found \"" + inside + '"');
  EXPECT_EQ(
      error_of("render a -o " + far),
      "-o: expected a name ending in .png, .hdr, .pfm, .exr or .grelha, found \"" + far + '"');
  EXPECT_EQ(error_of("render a -o " + inside + ".png --checkpoint " + inside), "no error");
  try {
    commands_for(std::get<RenderCommand>(
        parse("render a -o " + inside + ".png --checkpoint " + loop + "/./x.png")));
    ADD_FAILURE() << "one file twice is not found";
  } catch (const UsageError& error) {
    EXPECT_EQ(std::string(error.what()),
              "--checkpoint and -o: expected two files, found \"" + inside + ".png\" twice");
  }
  EXPECT_EQ(error_of("render a -o " + far + ".png --checkpoint " + far), "no error");
}

}  // namespace
}  // namespace grelha
