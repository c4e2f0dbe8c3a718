// Files of parts: joined, told apart, and refused where they are damaged.
#include "frontend/files/parse_error.hpp"
#include "frontend/jobs/merge.hpp"
#include "grelha/accumulator.hpp"
#include "tests/support/partials.hpp"
#include "tests/support/temporary_folder.hpp"

#include <gtest/gtest.h>

namespace grelha::test {
namespace {

/// A small part with sums that show where they belong.
Partial part_of(const Range& rows, const Range& samples) {
  Partial p{{"0123", "seed=0 depth=5"}, {3, 10, 8, {rows, samples}, {}, {}}};
  p.sums.sums.resize(static_cast<std::size_t>(rows.end - rows.begin) * 9,
                     samples.end - samples.begin);
  p.sums.done.assign(piece_count(p.sums.part), 1);
  return p;
}

class Merge : public testing::Test {
 protected:
  void put(const std::string& name, const Partial& p) { write_partial(folder_.file(name), p); }
  /// Returns the error message of merging the named files, without their folder.
  std::string complaint(const std::vector<std::string>& names) const {
    std::vector<std::string> files;
    for (const std::string& n : names)
      files.push_back(folder_.file(n));
    std::string text;
    try {
      merge_parts(files);
    } catch (const std::runtime_error& error) {
      text = error.what();
    }
    for (std::size_t at; (at = text.find(folder_.path().string() + '/')) != text.npos;)
      text.erase(at, folder_.path().string().size() + 1);
    return text;
  }
  TemporaryFolder folder_;
};

TEST_F(Merge, JoinsToALargerPart) {
  put("a", part_of({2, 5}, {0, 4}));
  put("b", part_of({2, 5}, {4, 8}));
  put("c", part_of({5, 9}, {0, 8}));
  const Partial all = merge_parts({folder_.file("c"), folder_.file("a"), folder_.file("b")});
  EXPECT_EQ(all.sums, part_of({2, 9}, {0, 8}).sums);
  EXPECT_EQ(complaint({"a"}), "");
}

TEST_F(Merge, NamesFilesThatOverlapAndWhere) {
  put("a", part_of({0, 5}, {0, 8}));
  put("b", part_of({5, 10}, {0, 5}));
  put("c", part_of({3, 10}, {4, 8}));
  EXPECT_EQ(complaint({"a", "b", "c"}), "c and a both have rows 3:5, samples 4:8");
  EXPECT_EQ(complaint({"b", "c"}), "c and b both have rows 5:10, samples 4:5");
  EXPECT_EQ(complaint({"a", "a"}), "a and a both have rows 0:5, samples 0:8");
}

TEST_F(Merge, NamesWhatIsMissing) {
  put("a", part_of({0, 3}, {0, 8}));
  put("b", part_of({3, 10}, {0, 5}));
  put("c", part_of({6, 10}, {5, 8}));
  put("d", part_of({9, 10}, {0, 8}));
  EXPECT_EQ(complaint({"a", "b", "c"}), "no part has rows 3:6, samples 5:8");
  put("e", part_of({0, 10}, {0, 2}));
  put("f", part_of({0, 10}, {5, 8}));
  EXPECT_EQ(complaint({"f", "e"}), "no part has rows 0:10, samples 2:5");
  EXPECT_EQ(complaint({"a", "d"}), "no part has rows 3:9, samples 0:8");
  EXPECT_EQ(complaint({"a", "b"}), "no part has rows 3:10, samples 5:8");
  EXPECT_EQ(complaint({"b", "c"}), "no part has rows 3:6, samples 5:8");
}

TEST_F(Merge, RefusesOtherPictures) {
  put("a", part_of({0, 5}, {0, 8}));
  const auto put_changed = [&](const std::string& name, const auto& change) {
    Partial p = part_of({5, 10}, {0, 8});
    change(p);
    put(name, p);
  };
  put_changed("scene", [](Partial& p) { p.identity.scene = "4567"; });
  put_changed("seed", [](Partial& p) { p.identity.settings = "seed=1 depth=5"; });
  put_changed("shadows", [](Partial& p) { p.identity.settings = "seed=0 depth=5 shadows=2"; });
  put_changed("begun", [](Partial& p) { p.sums.done[0] = 0; });
  put_changed("narrow", [](Partial& p) {
    p.sums.width = 1;
    p.sums.sums.resize(15);
  });
  EXPECT_EQ(complaint({"a", "scene"}), "scene is of another scene than a");
  EXPECT_EQ(complaint({"a", "seed"}), "seed has seed=1, a has seed=0");
  EXPECT_EQ(complaint({"a", "shadows"}), "shadows has shadows=2, a has no shadows=");
  EXPECT_EQ(complaint({"shadows", "a"}), "a has no shadows=, shadows has shadows=2");
  folder_.write("squeezed", "\x1F\x8B\x08");
  EXPECT_EQ(complaint({"a", "squeezed"}), "squeezed: error: damaged: its gzip data are broken");
  EXPECT_EQ(complaint({"a", "narrow"}), "narrow is of a picture of another size than a");
  EXPECT_EQ(complaint({"a", "begun"}),
            "begun is not finished, 0 % are done: the command that made it goes on");
  EXPECT_EQ(complaint({"a", "gone"}), "gone: error: cannot open: No such file or directory");
}

/// 103 GB, were all of the picture kept: of rows that no part has nothing is.
TEST_F(Merge, TakesTheMemoryOfWhatIsThere) {
  Partial p = part_of({0, 5}, {0, 8});
  const int rows[][2] = {{40000, 40001}, {40001, 40003}};
  for (const auto& [begin, end] : rows) {
    p.sums.width = p.sums.height = 65536;
    p.sums.part.rows = {begin, end};
    p.sums.sums.assign(std::size_t(end - begin) * 65536 * 3, begin);
    p.sums.done.assign(piece_count(p.sums.part), 1);
    put(std::to_string(begin), p);
  }
  EXPECT_EQ(merge_parts({folder_.file("40001"), folder_.file("40000")}).sums.part,
            (Part{{40000, 40003}, {0, 8}}));
}

TEST_F(Merge, RefusesAFileWithAnyByteFlippedOrLost) {
  const Partial p = part_of({0, 5}, {0, 8});
  put("a", p);
  const std::string good = folder_.read("a");
  EXPECT_EQ(parse_partial("a", good).sums, p.sums);
  for (std::size_t i = 0; i < good.size(); ++i) {
    std::string bad = good;
    bad[i] = static_cast<char>(bad[i] ^ (1 << i % 8));
    EXPECT_THROW(parse_partial("a", bad), FileError) << "byte " << i;
    EXPECT_THROW(parse_partial("a", std::string_view(good).substr(0, i)), FileError)
        << "cut at " << i;
  }
  EXPECT_THROW(parse_partial("a", good + '\0'), FileError);
  folder_.write("b", good.substr(0, good.size() - 1) + '!');
  EXPECT_EQ(complaint({"b"}), "b: error: damaged: its checksum is wrong");
  folder_.write("c", "P6\n1 1\n255\n...");
  EXPECT_EQ(complaint({"c"}), "c: error: not a .grelha partial this program reads");
}

/// A head that lies, under a checksum that does not.
TEST_F(Merge, RefusesSizesThatCannotBe) {
  const std::pair<const char*, Accumulator> wrong[] = {
      {"sums too few", {3, 10, 8, {{0, 5}, {0, 8}}, std::vector<std::int64_t>(44), {1}}},
      {"huge", {65536, 65536, 65536, {{0, 65536}, {0, 65536}}, {}, {}}},
      {"no rows", {3, 10, 8, {{5, 5}, {0, 8}}, {}, {}}},
      {"rows outside", {3, 10, 8, {{6, 11}, {0, 8}}, std::vector<std::int64_t>(45), {1}}},
      {"negative", {3, 10, 8, {{-1, 4}, {0, 8}}, std::vector<std::int64_t>(45), {1}}},
      {"no width", {0, 10, 8, {{0, 5}, {0, 8}}, {}, {1}}},
      {"piece half done", {3, 10, 8, {{0, 5}, {0, 8}}, std::vector<std::int64_t>(45), {2}}}};
  for (const auto& [name, sums] : wrong) {
    put("x", {{"s", "t"}, sums});
    EXPECT_EQ(complaint({"x"}), "x: error: not a .grelha partial this program reads") << name;
  }
}

/// Written bytes must be the same everywhere and for ever: a digest that changes makes parts of one
/// picture strangers.
TEST(Partial, BytesAreAsTheyEverWere) {
  const TemporaryFolder folder;
  write_partial(folder.file("a"), part_of({2, 3}, {0, 4}));
  using namespace std::string_literals;
  std::string wanted =
      "grelha partial 1\nscene 0123\nsettings seed=0 depth=5\npicture 3 10 8\n"
      "rows 2 3\nsamples 0 4\n\1"s;
  for (int i = 0; i < 9; ++i)
    wanted += "\4\0\0\0\0\0\0\0"s;
  const std::string found = folder.read("a");
  EXPECT_EQ(found.substr(0, wanted.size()), wanted);
  ASSERT_EQ(found.size(), wanted.size() + 8);
  std::uint64_t checksum = 0;
  for (int i = 7; i >= 0; --i)
    checksum = checksum << 8 |
               static_cast<unsigned char>(found[wanted.size() + static_cast<std::size_t>(i)]);
  EXPECT_EQ(checksum, 4836196064112502952u) << "the lower half of XXH128";
}

}  // namespace
}  // namespace grelha::test
