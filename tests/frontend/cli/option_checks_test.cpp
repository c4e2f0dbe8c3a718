// Options that contradict each other.
#include "tests/support/parsing.hpp"

#include <gtest/gtest.h>

namespace grelha {
namespace {

using test::error_of;

struct Line {
  const char *line, *message;
};

/// Pairs that would have one silently win, or say something about nothing.
const Line kContradictions[] = {
    {"render a --aa jitter:4 --samples 3",
     "--aa jitter:4 and --samples: expected one number of samples, found 16 and 3"},
    {"render a --aa off --samples 64",
     "--aa off and --samples: expected one number of samples, found 1 and 64"},
    {"render a --lens 8,7,32 --samples 16",
     "--lens APERTURE,FOCUS,N and --samples: expected one number of samples, found 32 and 16"},
    {"render a --lens 8,7,2 --aa jitter:2 --samples 4",
     "--aa jitter:2 and --samples: expected one number of samples, found 8 and 4"},
    {"render a --aa adaptive:.1,2 --lens 8,7,4 --samples 2",
     "--lens APERTURE,FOCUS,N and --samples: expected one number of samples, found 4 and 2"},
    {"render a --aa jitter:4 --sampler sobol",
     "--aa jitter:N and --sampler: expected jitter for jittered subpixels"},
    {"render a --aa adaptive:.1,2 --sampler blue",
     "--aa adaptive and --sampler: expected any but blue, which is of whole pixels"},
    {"render a --error .1 --sampler blue",
     "--sampler: expected sobol or random with --error or --time"},
    {"render a --error .1 --lens 8,7,4",
     "--error and --time choose the samples: no N in --lens beside them"},
    {"render a --time 1 --shadows area:1,4",
     "--error and --time choose the samples: --shadows random:SIZE beside them, not area:SIZE,N"},
    {"render a -o a.hdr --format png", "--format png and -o: expected one format, found \"a.hdr\""},
    {"render a -o a.grelha --format png",
     "--format png and -o: expected one format, found \"a.grelha\""},
    {"merge a.grelha -o b.hdr --format pfm",
     "--format pfm and -o: expected one format, found \"b.hdr\""},
    {"render a -o - --preview 1",
     "--preview wants a picture that can be written again, not stdout"},
    {"render a --checkpoint -",
     "--checkpoint: expected a file that can be read again, found \"-\""},
    {"render a --srgb -o a.hdr",
     "--srgb and -o: expected a .png, other pictures hold light as it is; found \"a.hdr\""},
    {"render a --srgb -o a.pfm",
     "--srgb and -o: expected a .png, other pictures hold light as it is; found \"a.pfm\""},
    {"render a --srgb -o a.grelha",
     "--srgb: a .grelha holds no colours for a screen, say it to merge"},
    {"merge a.grelha --srgb -o a.hdr",
     "--srgb and -o: expected a .png, other pictures hold light as it is; found \"a.hdr\""},
    {"merge a.grelha --srgb -o b.grelha",
     "--srgb: a .grelha holds no colours for a screen, say it to merge"},
    {"render a --checkpoint-every 5", "--checkpoint-every wants --checkpoint"},
    {"render a --density 2 --accel none",
     "--density and --accel none: without a grid there are no cells"},
    {"info a --density 2 --accel none",
     "--density and --accel none: without a grid there are no cells"},
    {"render a -o a.hdr --layers depth",
     "--layers and -o: expected a .exr, which alone holds layers, found \"a.hdr\""},
    {"render a -o a.exr --layers depth,depth",
     "--layers: expected some of depth,normal,id, each once, found \"depth,depth\""},
    {"render a -o a.exr --layers z",
     "--layers: expected some of depth,normal,id, each once, found \"z\""},
    {"render a --transparent -o a.pfm",
     "--transparent and -o: expected a .png or .exr, which alone hold alpha, found \"a.pfm\""},
    {"render a --transparent -o a.hdr",
     "--transparent and -o: expected a .png or .exr, which alone hold alpha, found \"a.hdr\""},
    {"render a --transparent -o a.grelha",
     "--transparent and -o: expected a .png or .exr, which alone hold alpha, found \"a.grelha\""},
    {"render a --transparent --error .1",
     "--transparent: no --error, --time, --aa adaptive, --checkpoint or --preview"},
    {"render a --transparent --aa adaptive:.1,2",
     "--transparent: no --error, --time, --aa adaptive, --checkpoint or --preview"},
    {"render a --transparent --checkpoint k",
     "--transparent: no --error, --time, --aa adaptive, --checkpoint or --preview"},
    {"render a --transparent --preview 1",
     "--transparent: no --error, --time, --aa adaptive, --checkpoint or --preview"},
    {"scene --list balls", "--list: expected alone, it writes no scene"},
    {"scene --list -o x.nff", "--list: expected alone, it writes no scene"},
    {"scene balls -o x.ply",
     "-o: expected a name for an NFF scene, such as balls.nff, found \"x.ply\""},
    {"scene boat -o x.ply",
     "-o: expected a name for an NFF scene, such as boat.nff, found \"x.ply\""},
    {"scene balls -o x.nff.gz",
     "-o: expected a name for an NFF scene, such as balls.nff, found \"x.nff.gz\""},
    {"scene balls -o x.png",
     "-o: expected a name for an NFF scene, such as balls.nff, found \"x.png\""},
};

/// The nearest pairs that agree.
const char* const kAgreeing[] = {"render a --format exr --layers id,depth",
                                 "render a --format exr --transparent --layers id --stats -",
                                 "render a --aa jitter:4 --samples 16",
                                 "render a --aa off --samples 1",
                                 "render a --aa jitter:2 --samples 0:3 -o a.grelha",
                                 "render a --lens 8,7,32 --samples 32",
                                 "render a --lens 0,0,8 --samples 4",
                                 "render a --srgb -o pictures/",
                                 "render a --aa jitter:4 --sampler jitter",
                                 "render a --samples 9 --sampler blue",
                                 "render a --error .1 --shadows random:1 --lens 8",
                                 "render a --checkpoint k --checkpoint-every 5",
                                 "merge a.grelha --srgb -o a.png",
                                 "scene balls -o x",
                                 "info a --accel none"};

TEST(Errors, ContradictionsAreRefusedByName) {
  for (const auto& [line, message] : kContradictions)
    EXPECT_EQ(error_of(line), message) << line;
  for (const char* const line : kAgreeing)
    EXPECT_EQ(error_of(line), "no error") << line;
}

}  // namespace
}  // namespace grelha
